#pragma once
/// Recorded runs that the trace tests share, with the wrappers that were really there after each event.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/lrb_shapes.hpp"
#include "tests/support/toy_query.hpp"
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

struct Snapshot {
  std::vector<FaceId> a, b;  ///< boundaries
};

struct Run {
  Trace trace;
  std::vector<Snapshot> after;  ///< (|events seen|)
};

/// One time step for each translation of B; B is turned a little, so that its numbers have all their digits.
inline Run record(const LrbRep& a, const LrbRep& b, const std::vector<Eigen::Vector3d>& translations,
                  RecorderSettings settings = {}) {
  settings.scenario = settings.scenario.empty() ? "a \"test\"\n run, äöü" : settings.scenario;
  if (settings.request.recursion == Recursion::complete)  // the toy query's refinements follow tests
    settings.request.recursion = Recursion::paper;
  settings.scenario_hash = 0xfedcba9876543210u;
  settings.sources = {"shapes/a.obj", "shapes/b.obj"};
  const WrapperMode mode = settings.request.wrapper;
  Recorder recorder(a, b, std::move(settings));
  Run run;
  std::uint32_t index = 0;
  for (const Eigen::Vector3d& t : translations) {
    const Pose pose_b = Pose::rotation({0, 0, 1}, 0.1, t);
    recorder.begin_step(index++, {}, pose_b);
    const Wrapper fresh_a(a, mode), fresh_b(b, mode);
    run.after.push_back({fresh_a.boundary(), fresh_b.boundary()});
    const toy::Query<Recorder, std::function<void()>>* running = nullptr;
    toy::Query<Recorder, std::function<void()>> query(a, {}, b, pose_b, mode, recorder, [&] {
      run.after.push_back({running->wrapper(0).boundary(), running->wrapper(1).boundary()});
    });
    running = &query;
    recorder.end_step(query.run());
    run.after.push_back({query.wrapper(0).boundary(), query.wrapper(1).boundary()});
  }
  run.trace = recorder.take();
  return run;
}

/// Two plates: apart, the second's corner deep in the first's notch, crossing.
inline const std::vector<Eigen::Vector3d> kPlatePoses = {{20, 0, 0}, {2.5, 2.6, 0}, {0.3, 5.1, 0}};
/// Two boxes: apart, one's corner in the other's dent, crossing through the side.
inline const std::vector<Eigen::Vector3d> kBoxPoses = {{0, 0, 9}, {1.7, 1.8, 2.5}, {3.5, 0.2, 0.3}};

}  // namespace lrb::trace::runs
