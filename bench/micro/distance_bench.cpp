// Distances by gap: from scratch, only whether it is at most slightly more than the gap, and along a path of
// small steps, from scratch and coherently. `lrbscope chart --quantity distance` compares with FCL.
#include "bench/micro/poses.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/workspace.hpp>

using namespace lrb;
using namespace lrb::micro;

namespace {

constexpr double kGaps[] = {0.001, 0.01, 0.1, 1};  // of the diagonal, along the direction of approach
constexpr double kStep = 0.001;                    // of the diagonal
constexpr int kPaths = 8, kPoses = 50;

void add_distance(const Subject& s, const std::string& what, double gap, const DistanceRequest& request) {
  add(s, what, [&s, gap, request](benchmark::State& state) {
    const std::vector<Pose>& poses = poses_at(s, -gap);
    Workspace workspace;
    const auto ask = [&](const Pose& p) {
      return distance(s.body, {}, s.body, p, request, workspace).value();
    };
    at_all_poses(state, poses, ask);
    state.counters["steps"] = mean(poses, [&](const Pose& p) { return ask(p).counters.steps; });
    state.counters["floats"] = mean(poses, [&](const Pose& p) { return ask(p).counters.pairs_in_floats; });
    state.counters["doubles"] = mean(poses, [&](const Pose& p) { return ask(p).counters.pairs_in_doubles; });
    state.counters["exact"] = mean(poses, [&](const Pose& p) { return ask(p).counters.pairs_exact; });
  });
}

/// along(path): queries every pose of a path in order.
template <class Along>
void add_paths(const Subject& s, const std::string& what, double gap, const Along& along) {
  add(s, what, [&s, gap, along](benchmark::State& state) {
    std::vector<std::vector<Pose>> paths;
    for (const Pose& start : poses_at(s, -gap, kPaths))
      paths.push_back(path_from(s, start, kStep, kPoses, true));
    for (auto _ : state)
      for (const std::vector<Pose>& path : paths) along(path);
  })->Unit(benchmark::kMillisecond);
}

void add_all(const Subject& s) {
  for (const double gap : kGaps) {
    const std::string name = "gap " + io::number_text(100 * gap) + " %/";
    add_distance(s, name + "distance", gap, {});
    DistanceRequest within;
    within.within = 1.05 * gap * s.diagonal;
    add_distance(s, name + "within", gap, within);
    add_paths(s, name + "path from scratch", gap, [&s](const std::vector<Pose>& path) {
      Workspace workspace;
      for (const Pose& p : path)
        benchmark::DoNotOptimize(distance(s.body, {}, s.body, p, {}, workspace)->upper);
    });
    add_paths(s, name + "path coherent", gap, [&s](const std::vector<Pose>& path) {
      CoherentDistance coherent(s.body, s.body);
      for (const Pose& p : path) benchmark::DoNotOptimize(coherent.distance({}, p).upper);
    });
  }
}

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv, add_all);
}
