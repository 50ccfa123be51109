#pragma once
/// Recorded runs that the trace tests share, with the wrappers that were really there after each event.

#include <string>
#include <utility>
#include <vector>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/lrb_shapes.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/trace/recorder.hpp>

namespace lrb::trace::runs {

inline const LrbRep& plate() {
  static const LrbRep rep(toy::notched_plate());
  return rep;
}
inline const LrbRep& box() {
  static const LrbRep rep(toy::dented_box());
  return rep;
}

inline EventId first_of(const Trace& t, EventKind kind) {
  EventId e = 0;
  while (t.events.at(e).kind != kind) ++e;
  return e;
}

struct Snapshot {
  std::vector<FaceId> a, b;  ///< boundaries
};

struct Run {
  Trace trace;
  std::vector<Snapshot> after;  ///< (|events seen|)
};

/// Records a query, and keeps its wrappers after each event.
struct Watch : NullProbe {
  static constexpr bool kEnabled = true;
  Recorder& recorder;
  QueryContext& context;
  std::vector<Snapshot>& after;

  Watch(Recorder& r, QueryContext& c, std::vector<Snapshot>& a) : recorder(r), context(c), after(a) {}
  void keep() {
    after.push_back({context[Side::a].wrapper->boundary(), context[Side::b].wrapper->boundary()});
  }
  void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t depth_a, std::uint32_t depth_b) {
    recorder.face_test(a, b, meet, depth_a, depth_b);
    keep();
  }
  void refine(Side side, RegionId region, std::uint32_t added) {
    recorder.refine(side, region, added);
    keep();
  }
  void contact(SimplexId a, SimplexId b, exact::Meet meet) {
    recorder.contact(a, b, meet);
    keep();
  }
};

/// One time step for each translation of B, with the paper's recursion, whose refinements follow tests; B is
/// turned a little, so that its numbers have all their digits.
inline Run record(const LrbRep& a, const LrbRep& b, const std::vector<Eigen::Vector3d>& translations,
                  RecorderSettings settings = {}) {
  settings.scenario = settings.scenario.empty() ? "a \"test\"\n run, äöü" : settings.scenario;
  if (settings.request.recursion == Recursion::complete) settings.request.recursion = Recursion::paper;
  settings.scenario_hash = 0xfedcba9876543210u;
  settings.sources = {"shapes/a.obj", "shapes/b.obj"};
  const CollideRequest request = settings.request;
  Recorder recorder(a, b, std::move(settings));
  Run run;
  QueryContext context;
  Watch watch(recorder, context, run.after);
  std::uint32_t index = 0;
  for (const Eigen::Vector3d& t : translations) {
    const Pose pose_b = Pose::rotation({0, 0, 1}, 0.1, t);
    recorder.begin_step(index++, {}, pose_b);
    run.after.push_back({Wrapper(a, request.wrapper).boundary(), Wrapper(b, request.wrapper).boundary()});
    recorder.end_step(collide(a, {}, b, pose_b, request, context, watch));
    watch.keep();
  }
  run.trace = recorder.take();
  return run;
}

/// A body, and how it was built.
struct Built {
  LrbRep rep;
  Trace trace;
};
inline Built build(const Mesh& mesh, BuildOptions options = {}, const RecorderSettings& settings = {}) {
  ConstructRecorder recorder(settings);
  options.probe = &recorder;
  LrbRep rep = build_lrb(mesh, options);
  Trace trace = recorder.take(rep, {});
  return {std::move(rep), std::move(trace)};
}

/// Two bodies, and their queries at random poses, recorded.
struct BodyPair {
  const LrbRep *a, *b;
};
struct Recorded {
  Trace trace;
  std::vector<CollideResult> results;
};
/// Poses are apart, touch and cross; change(step, pose) may replace them.
inline Recorded record(const BodyPair& bodies, const CollideRequest& request, EventLevel level,
                       std::uint64_t seed, int steps, void (*change)(int step, Pose& pose) = nullptr) {
  RecorderSettings settings;
  settings.request = request;
  settings.level = level;
  Recorder recorder(*bodies.a, *bodies.b, settings);
  QueryContext context;
  shapes::RandomEngine random(seed);
  Recorded out;
  for (int i = 0; i < steps; ++i) {
    Pose pose = shapes::random_pose(random, *bodies.a, *bodies.b, shapes::uniform(random, 0, 1.2));
    if (change != nullptr) change(i, pose);
    recorder.begin_step(static_cast<std::uint32_t>(i), {}, pose);
    out.results.push_back(collide(*bodies.a, {}, *bodies.b, pose, request, context, recorder));
    recorder.end_step(out.results.back());
  }
  out.trace = recorder.take();
  return out;
}

/// Two plates: apart, the second's corner deep in the first's notch, crossing.
inline const std::vector<Eigen::Vector3d> kPlatePoses = {{20, 0, 0}, {2.5, 2.6, 0}, {0.3, 5.1, 0}};
/// Two boxes: apart, one's corner in the other's dent, crossing through the side.
inline const std::vector<Eigen::Vector3d> kBoxPoses = {{0, 0, 9}, {1.7, 1.8, 2.5}, {3.5, 0.2, 0.3}};

}  // namespace lrb::trace::runs
