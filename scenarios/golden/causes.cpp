#include "scenarios/golden/causes.hpp"

#include <algorithm>

#include "render/overlay.hpp"
#include "scenarios/golden/kept_body.hpp"
#include "trace/record_fields.hpp"

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

}  // namespace lrb::golden
