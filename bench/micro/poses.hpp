#pragma once
/// Micro benchmarks of queries of a body and a copy of itself, on Google's benchmark library:
///
///   PROGRAM [--benchmark_filter=REGEX] [BODY...]
///
/// BODY is a mesh or .lrb file. The default is a generated rock, and the models spot, rocker-arm and
/// nefertiti of the folder LRB_MESHES.

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include <lrbscope/body.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::micro {

struct Subject {
  std::string name;
  Body body;
  double diagonal, size;  ///< of its box: the diagonal and the largest side
};

/// Loads the named bodies, or the default ones, calls `add` for each, and runs the registered benchmarks.
/// Returns the exit code of the program.
int run(int argc, char** argv, void (*add)(const Subject&));

/// Registers a benchmark NAME/WHAT of a subject.
template <class Run>
benchmark::internal::Benchmark* add(const Subject& subject, const std::string& what, Run run) {
  return benchmark::RegisterBenchmark((subject.name + "/" + what).c_str(),
                                      [run](benchmark::State& state) { run(state); });
}

/// A pose class: `depth` diagonals beyond first contact; negative: separate.
struct Depth {
  const char* name;
  double depth;
};

/// Returns `count` poses of the copy, each reached along a random direction with a random rotation. Made
/// once.
const std::vector<Pose>& poses_at(const Subject& subject, double depth, int count = 16);

/// Returns `steps` poses: each moves by `length` diagonals and rotates about the body's centre, half of the
/// step each, in a constant direction that changes when the copy would leave its surroundings or, if
/// `separate`, intersect.
std::vector<Pose> path_from(const Subject& subject, const Pose& start, double length, int steps,
                            bool separate);

/// Runs `ask` at every pose in each iteration, after one round that is not measured. The counter `pose` is
/// the time of one pose.
template <class Ask>
void at_all_poses(benchmark::State& state, std::span<const Pose> poses, const Ask& ask) {
  for (const Pose& pose : poses) ask(pose);
  for (auto _ : state)
    for (const Pose& pose : poses) ask(pose);
  state.counters["pose"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(poses.size()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Returns the mean of a number over poses.
template <class Number>
double mean(std::span<const Pose> poses, const Number& number) {
  double sum = 0;
  for (const Pose& pose : poses) sum += static_cast<double>(number(pose));
  return sum / static_cast<double>(poses.size());
}

}  // namespace lrb::micro
