// Coherent queries compared with queries from scratch, by step length, for bodies that are separate, touch
// and penetrate deeply.
#include "bench/micro/poses.hpp"
#include <lrbscope/coherent.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/workspace.hpp>

using namespace lrb;
using namespace lrb::micro;

namespace {

constexpr Depth kDepths[] = {{"separate 0.5 %", -0.005}, {"touching 0.2 %", 0.002}, {"deep 10 %", 0.1}};
constexpr double kSteps[] = {0.0001, 0.0003, 0.001, 0.003, 0.01};  // of the diagonal
constexpr int kPaths = 5, kPoses = 100;

std::vector<std::vector<Pose>> paths_of(const Subject& s, double depth, double step) {
  std::vector<std::vector<Pose>> paths;
  for (const Pose& start : poses_at(s, depth, kPaths))
    paths.push_back(path_from(s, start, step, kPoses, depth < 0));
  return paths;
}

void add_all(const Subject& s) {
  for (const Depth& d : kDepths)
    for (const double step : kSteps) {
      const std::string name = std::string(d.name) + "/step " + io::number_text(100 * step) + " %/";
      add(s, name + "from scratch", [&s, depth = d.depth, step](benchmark::State& state) {
        Workspace workspace;
        const auto paths = paths_of(s, depth, step);
        for (auto _ : state)
          for (const auto& path : paths)
            for (const Pose& p : path)
              benchmark::DoNotOptimize(collide(s.body, {}, s.body, p, {}, workspace)->pairs.size());
      })->Unit(benchmark::kMillisecond);
      add(s, name + "coherent", [&s, depth = d.depth, step](benchmark::State& state) {
        const auto paths = paths_of(s, depth, step);
        CoherentQuery::Statistics seen;
        for (auto _ : state)
          for (const auto& path : paths) {
            CoherentQuery coherent(s.body, s.body);
            for (const Pose& p : path) benchmark::DoNotOptimize(coherent.collide({}, p).pairs.size());
            seen = coherent.statistics();
          }
        state.counters["from_cache"] = static_cast<double>(seen.from_cache);
        state.counters["caches_made"] = static_cast<double>(seen.caches_made);
        state.counters["from_scratch"] = static_cast<double>(seen.from_scratch);
      })->Unit(benchmark::kMillisecond);
    }
}

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv, add_all);
}
