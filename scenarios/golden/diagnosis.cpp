#include "scenarios/golden/diagnosis.hpp"

#include <algorithm>
#include <span>

#include "scenarios/golden/golden.hpp"
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/record_fields.hpp>

namespace lrb::golden {
namespace {

std::string rep_words(const trace::BodyInfo& body) {
  return render::group_digits(body.regions) + " regions in " + std::to_string(body.layers) + " layers, " +
         render::group_digits(body.outer_faces) + " faces outermost";
}

/// Tells whether a body's mesh or only its LRB-rep is another one.
std::string body_cause(const Golden& golden, const GoldenRun& run, std::size_t i) {
  const trace::BodyInfo &expected = golden.trace.header.bodies[i],
                        &found = run.recording.trace.header.bodies[i];
  const std::string who = "body " + std::string(name_of(static_cast<Side>(i))) + " (" + found.name + "): ";
  const std::string built = rep_words(expected) + " became " + rep_words(found);
  if (i >= golden.facts.meshes.size())
    return who + "its mesh or its LRB-rep is another one: " + built +
           " (approved by a version that did not note which; approve it anew to have it told)";
  const Mesh mesh = kept_mesh(run.recording.bodies[i].rep);
  if (mesh_hash(mesh) == golden.facts.meshes[i])
    return who + "the mesh is the same, its LRB-rep was built otherwise: " + built;
  if (i < golden.meshes.size() && golden.meshes[i])
    return who + "its mesh changed: " + mesh_difference(*golden.meshes[i], mesh);
  return who + "its mesh changed: " + render::group_digits(expected.real_faces) + " faces became " +
         render::group_digits(found.real_faces);
}

/// Names the fields of the request that are not as approved.
std::string request_cause(const CollideRequest& x, const CollideRequest& y) {
  std::string names;
  for_each_field<CollideRequest>([&](const auto& field) {
    if (x.*field.member != y.*field.member) names.append(names.empty() ? "" : ", ").append(field.name);
  });
  return names.empty() ? names : "the query asks otherwise: " + names;
}

/// Names the first pose that is not as approved.
std::string pose_cause(const trace::Trace& x, const trace::Trace& y) {
  for (std::size_t i = 0; i < std::min(x.steps.size(), y.steps.size()); ++i)
    for (const auto& [name, pose] : {std::pair{"A", &trace::Step::pose_a}, {"B", &trace::Step::pose_b}}) {
      const Pose &p = x.steps[i].*pose, &q = y.steps[i].*pose;
      if (trace::equal(p, q)) continue;
      return "step " + std::to_string(y.steps[i].index) + ": body " + name +
             " is elsewhere: its origin moved by " + render::short_number((q.t - p.t).norm());
    }
  return {};
}

}  // namespace

std::vector<std::string> find_causes(const Golden& golden, const GoldenRun& run) {
  const trace::TraceHeader &x = golden.trace.header, &y = run.recording.trace.header;
  std::vector<std::string> out;
  if (x.scenario_hash != run.scenario.hash)
    out.emplace_back("the scenario's file is not the one that was approved");
  for (std::size_t i = 0; i < std::min(x.bodies.size(), y.bodies.size()); ++i)
    if (x.bodies[i].hash != y.bodies[i].hash) out.push_back(body_cause(golden, run, i));
  if (const std::string words = request_cause(x.request, y.request); !words.empty()) out.push_back(words);
  if (const std::string words = pose_cause(golden.trace, run.recording.trace); !words.empty())
    out.push_back(words);
  if (x.lrbscope != y.lrbscope)
    out.push_back("approved with lrbscope " + x.lrbscope + ", run by " + y.lrbscope);
  return out;
}

namespace {

using Events = std::span<const trace::Event>;

/// Returns true if two events do the same, whatever caused them: causes are numbers of events, which shift.
bool same_action(const trace::Event& x, const trace::Event& y) {
  return x.kind == y.kind && x.side == y.side && x.a == y.a && x.b == y.b && x.meet == y.meet;
}

/// Returns the index of the next event after `from` that does the same; events.size(): there is none.
std::size_t find_after(Events events, std::size_t from, const trace::Event& action) {
  for (std::size_t i = from + 1; i < events.size(); ++i)
    if (same_action(events[i], action)) return i;
  return events.size();
}

/// Returns "; the step has 53 contacts instead of 54", or nothing.
std::string contacts_words(Events expected, Events actual) {
  const std::uint64_t x = trace::count_events(expected).contacts, y = trace::count_events(actual).contacts;
  return x == y ? ""
                : "; the step has " + std::to_string(y) + (y == 1 ? " contact" : " contacts") +
                      " instead of " + std::to_string(x);
}

std::string several(const char* what, std::size_t count, trace::EventId first, const trace::Event& event) {
  if (count == 1) return "event " + std::to_string(first) + " " + what + ": " + trace::describe(event);
  return std::to_string(count) + " events " + what + ", event " + std::to_string(first) +
         " first: " + trace::describe(event);
}

}  // namespace

std::string diagnose(const trace::Trace& expected, const trace::Trace& actual,
                     const trace::Divergence& divergence) {
  if (!divergence.event || !divergence.step) return {};
  const Events x = expected.events_of(*divergence.step), y = actual.events_of(*divergence.step);
  const trace::EventId event = *divergence.event;
  const std::size_t i = event - expected.steps[*divergence.step].first_event;
  const bool in_x = i < x.size(), in_y = i < y.size();
  if (!in_x && !in_y) return {};
  const std::string contacts = contacts_words(x, y);
  if (!in_y) return several("lost", x.size() - i, event, x[i]) + contacts;
  if (!in_x) return several("added", y.size() - i, event, y[i]) + contacts;
  if (x[i].kind == y[i].kind && x[i].side == y[i].side && x[i].a == y[i].a && x[i].b == y[i].b)
    return {};  // the same action with another outcome: the message names the field
  const std::size_t found_in_x = find_after(x, i, y[i]), found_in_y = find_after(y, i, x[i]);
  const bool y_comes = found_in_x < x.size(), x_comes = found_in_y < y.size();
  if (y_comes && x_comes) {
    if (found_in_x != found_in_y) return "events come in another order" + contacts;
    return "events " + std::to_string(event) + " and " + std::to_string(event + found_in_x - i) +
           " are swapped: " + trace::describe(x[i]) + "; " + trace::describe(y[i]) + contacts;
  }
  if (y_comes) return several("lost", found_in_x - i, event, x[i]) + contacts;
  if (x_comes) return several("added", found_in_y - i, event, y[i]) + contacts;
  return "expected " + trace::describe(x[i]) + "; found " + trace::describe(y[i]) + contacts;
}

}  // namespace lrb::golden
