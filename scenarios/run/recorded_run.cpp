#include "scenarios/run/recorded_run.hpp"

#include <algorithm>
#include <numeric>
#include <optional>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "engine/query/coherent/coherent_query.hpp"
#include "engine/query/collide_impl.hpp"
#include "scenarios/run/approach.hpp"
#include "scenarios/spec/scenario_frames.hpp"
#include "scenarios/spec/scenario_motion.hpp"
#include "trace/construct_recorder.hpp"
#include "trace/hex.hpp"
#include "trace/recorder.hpp"

namespace lrb::run {
namespace {

std::string source_of(const spec::BodySpec& spec) {
  return spec.file.empty() ? "generator " + spec.generator : spec.file;
}

trace::RecorderSettings recorder_settings(const spec::Scenario& s) {
  trace::RecorderSettings settings;
  settings.scenario = s.name;
  settings.scenario_hash = s.hash;
  for (std::size_t i = 0; i < s.bodies.size(); ++i) settings.sources[i] = source_of(s.bodies[i]);
  settings.request = s.request;
  settings.clock = s.clock;
  settings.event_cap = s.event_cap;
  settings.level = std::max(s.events, render::needed_level(s.frames));
  settings.coherent = s.more.coherent;
  return settings;
}

std::string note_of(const Approach& approach) {
  const std::string step = contact_step(approach.search);
  if (!step.empty())
    return "first contact at " + step + ", " + contact_way(approach.search) +
           "; the first step in contact is step " + std::to_string(approach.first_contact);
  return approach.met ? "first contact at step " + std::to_string(approach.first_contact)
                      : "the bodies did not meet on the way";
}

std::vector<Pose> poses_of_b(const spec::Scenario& s, Recording& r) {
  if (s.motion.kind != spec::Motion::Kind::approach) return spec::poses_of(s.motion, s.bodies[1].pose);
  Approach approach = find_approach(r.bodies[0].rep, s.bodies[0].pose, r.bodies[1].rep, s.bodies[1].pose,
                                    s.motion, s.more.distance);
  r.notes.push_back(note_of(approach));
  r.trace.header.first_contact = std::move(approach.search);
  return std::move(approach.poses);
}

/// Asks the queries of a run's steps, one after another.
class StepQueries {
 public:
  StepQueries(const spec::Scenario& s, const LrbRep& a, const LrbRep& b) : s_(s), a_(a), b_(b) {
    // Caches are made whenever they can be: where they pay is a matter of time, and a trace is to be the same
    // again.
    if (s.more.coherent) coherent_.emplace(a, b, s.request, CoherentQuery::CacheUse::always);
  }

  CollideResult ask(std::uint32_t step, const Pose& pose_b, trace::Recorder& recorder) {
    const Pose& pose_a = s_.bodies[0].pose;
    try {
      CollideResult result = coherent_ ? coherent_->collide(pose_a, pose_b, recorder)
                                       : collide(a_, pose_a, b_, pose_b, s_.request, context_, recorder);
      ask_more(pose_a, pose_b, recorder);
      return result;
    } catch (const InputError& e) {
      throw InputError("scenario " + s_.name + ", step " + std::to_string(step) + ": " + e.what());
    }
  }

 private:
  void ask_more(const Pose& pose_a, const Pose& pose_b, trace::Recorder& recorder) const {
    if (s_.more.distance) {
      BoundsCourse told;
      const DistanceResult found = distance(a_, pose_a, b_, pose_b, {}, told);
      recorder.add(trace::measured(found, std::move(told.course)));
    }
    if (s_.more.clash) {
      ClashCourse told;
      const ClashResult found = clash(a_, pose_a, b_, pose_b, {}, told);
      recorder.add(trace::measured(found, std::move(told.of_depth)));
    }
  }

  const spec::Scenario& s_;
  const LrbRep &a_, &b_;
  std::optional<CoherentQuery> coherent_;
  QueryContext context_;
};

void record_collision(const spec::Scenario& s, Recording& r, const ProgressReport& progress) {
  const LrbRep &a = r.bodies[0].rep, &b = r.bodies[1].rep;
  const std::vector<Pose> poses = poses_of_b(s, r);
  trace::Recorder recorder(a, b, recorder_settings(s));
  StepQueries queries(s, a, b);
  for (std::uint32_t step = 0; step < poses.size(); ++step) {
    progress("query", step, poses.size());
    recorder.begin_step(step, s.bodies[0].pose, poses[step]);
    r.results.push_back(queries.ask(step, poses[step], recorder));
    recorder.end_step(r.results.back());
  }
  trace::Trace recorded = recorder.take();
  recorded.header.first_contact = std::move(r.trace.header.first_contact);
  r.trace = std::move(recorded);
}

/// Returns all regions, those of the builder's last pass (the outermost ones) first: each can then be refined
/// when its turn comes.
std::vector<RegionId> outside_in(const LrbRep& rep) {
  std::vector<RegionId> order(rep.region_count());
  std::iota(order.begin(), order.end(), RegionId{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](RegionId x, RegionId y) { return rep.layer(x) > rep.layer(y); });
  return order;
}

void require_closed(const spec::Scenario& s, const LrbRep& rep) {
  if (rep.closed()) return;
  throw InputError("scenario " + s.name + ": body a, " + printable_name(source_of(s.bodies[0])) +
                   ", is open: it has no inside, and so no wrapper to refine or to construct; close it "
                   "(lrbscope inspect names its open edges), or show a collision");
}

void record_refinement(const spec::Scenario& s, Recording& r) {
  const LrbRep& rep = r.bodies[0].rep;
  require_closed(s, rep);
  trace::Recorder recorder(rep, recorder_settings(s));
  recorder.begin_step(0, s.bodies[0].pose);
  for (const RegionId region : outside_in(rep))
    recorder.refine(Side::a, region, static_cast<std::uint32_t>(rep.floor(region).size()));
  r.trace = recorder.take();
}

void record_known(const spec::Scenario& s, Recording& r) {
  const LrbRep& rep = r.bodies[0].rep;
  require_closed(s, rep);
  r.trace = trace::known_construction(rep, s.bodies[0].pose, recorder_settings(s));
  if (rep.region_count() > 0)
    r.notes.push_back(rep.name() +
                      ": came with its regions: no builder could be watched, and they are shown by layers");
}

void record_construction(const spec::Scenario& s, Recording& r) {
  trace::ConstructRecorder recorder(recorder_settings(s));
  spec::BodySpec body = s.bodies[0];
  body.build.probe = &recorder;
  r.bodies.push_back(make_body(body));
  if (recorder.empty()) return record_known(s, r);
  r.trace = recorder.take(r.bodies[0].rep, body.pose);
}

/// Adds what follows from a run that has been recorded: how it is to be drawn, its trees, what people should
/// know of it.
void finish(const spec::Scenario& s, Recording& r) {
  r.trace.header.pictures = spec::pictures_text(s.frames);
  r.trees = trees_of(r.trace, r.bodies);
  std::vector<std::string> of_bodies;
  for (const bodies::LoadedBody& body : r.bodies)
    of_bodies.insert(of_bodies.end(), body.notes.begin(), body.notes.end());
  r.notes.insert(r.notes.begin(), of_bodies.begin(), of_bodies.end());
  if (r.trace.truncated())
    r.notes.push_back("the trace holds the first " + std::to_string(r.trace.events.size()) + " of " +
                      std::to_string(r.trace.events_seen) + " events (trace.max_events)");
}

}  // namespace

std::vector<trace::TreeShape> trees_of(const trace::Trace& trace,
                                       const std::vector<bodies::LoadedBody>& bodies) {
  std::vector<trace::TreeShape> out;
  if (trace.header.level == EventLevel::faces || !trace.header.engine.empty() || bodies.size() != 2)
    return out;
  for (const bodies::LoadedBody& body : bodies) out.emplace_back(body.rep.tree());
  return out;
}

bodies::LoadedBody make_body(const spec::BodySpec& spec) {
  if (!spec.file.empty()) return bodies::load_body(spec.file, spec.build);
  if (std::optional<LrbRep> rep = generators::generate_rep(spec.generator, spec.parameters, spec.build.seed))
    return {std::move(*rep), {}, 0};
  return bodies::body_of_mesh(generators::generate(spec.generator, spec.parameters, spec.build.seed),
                              spec.build);
}

Recording record(const spec::Scenario& scenario, const ProgressReport& progress) {
  if (scenario.show == spec::Show::construction) {
    progress("build", 0, 1);
    Recording r;
    record_construction(scenario, r);
    finish(scenario, r);
    return r;
  }
  std::vector<bodies::LoadedBody> bodies;
  for (std::size_t i = 0; i < scenario.bodies.size(); ++i) {
    progress("build", i, scenario.bodies.size());
    bodies.push_back(make_body(scenario.bodies[i]));
  }
  return record(scenario, std::move(bodies), progress);
}

Recording record(const spec::Scenario& scenario, std::vector<bodies::LoadedBody> bodies,
                 const ProgressReport& progress) {
  Recording r;
  r.bodies = std::move(bodies);
  switch (scenario.show) {
    case spec::Show::collision:
      record_collision(scenario, r, progress);
      break;
    case spec::Show::refinement:
      record_refinement(scenario, r);
      break;
    case spec::Show::construction:
      record_known(scenario, r);
      break;
  }
  finish(scenario, r);
  return r;
}

std::vector<std::string> mismatches(const spec::Scenario& scenario, const Recording& r) {
  std::vector<std::string> out;
  for (const spec::Expectation& e : scenario.expect) {
    const std::string where = e.place + ": step " + std::to_string(e.step) + ": ";
    if (e.step >= r.results.size()) {
      out.push_back(where + "the run has " + std::to_string(r.results.size()) + " steps only");
      continue;
    }
    const CollideResult& result = r.results[e.step];
    const std::uint64_t print = fingerprint(result.pairs);
    if (e.relation && *e.relation != result.relation)
      out.push_back(where + "expected relation " + to_string(*e.relation) + ", found " +
                    to_string(result.relation));
    if (e.pairs && *e.pairs != result.pairs.size())
      out.push_back(where + "expected " + std::to_string(*e.pairs) + " pairs, found " +
                    std::to_string(result.pairs.size()));
    if (e.fingerprint && *e.fingerprint != print)
      out.push_back(where + "expected fingerprint " + trace::to_hex(*e.fingerprint) + ", found " +
                    trace::to_hex(print));
  }
  return out;
}

}  // namespace lrb::run
