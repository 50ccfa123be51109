// Building a body lean and to fit, and its levels of detail, in processor time of one thread. Scaling:
// building and loading rocks of 31,000 to 2,000,000 faces, with the exponent of the growth of time
// (tests/scaling measures memory). `lrbscope bench --build` measures trees and LRB-reps beside other engines.
#include <filesystem>
#include <string>

#include <unistd.h>

#include "bench/methods/triangles.hpp"
#include "bench/micro/subjects.hpp"
#include "scenarios/bodies/generators.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>

using namespace lrb;
using namespace lrb::micro;

namespace {

void build(benchmark::State& state, const Mesh& mesh, bool lean) {
  BuildOptions options;
  options.lean = lean;
  const LrbRep rep = build_lrb(mesh, options);
  for (auto _ : state) benchmark::DoNotOptimize(build_lrb(mesh, options).face_count());
  const double faces = rep.real_face_count();
  state.counters["faces"] = faces;
  state.counters["total/real"] = static_cast<double>(rep.face_count()) / faces;
  state.counters["bytes_per_face"] = static_cast<double>(rep.memory_bytes()) / faces;
}

void load(benchmark::State& state, const LrbRep& rep) {
  const auto file = std::filesystem::temp_directory_path() / ("build_bench." + std::to_string(getpid()));
  save_lrb(rep, file.string());
  for (auto _ : state) benchmark::DoNotOptimize(load_lrb(file.string()).face_count());
  state.counters["bytes"] = static_cast<double>(std::filesystem::file_size(file));
  std::filesystem::remove(file);
}

Mesh rock(benchmark::State& state) {
  state.SetComplexityN(20 * state.range(0) * state.range(0));  // its faces
  return generators::generate("rock", {{"frequency", static_cast<double>(state.range(0))}});
}

void growth_build(benchmark::State& state) {
  build(state, rock(state), false);
}
void growth_load(benchmark::State& state) {
  load(state, build_lrb(rock(state)));
}
BENCHMARK(growth_build)->RangeMultiplier(2)->Range(39, 316)->Unit(benchmark::kMillisecond)->Complexity();
BENCHMARK(growth_load)->RangeMultiplier(2)->Range(39, 316)->Unit(benchmark::kMillisecond)->Complexity();

void add_all(const Subject& s) {
  for (const bool lean : {true, false})
    add(s, lean ? "lean" : "to fit", [&s, lean](benchmark::State& state) {
      build(state, methods::real_mesh(s.body), lean);
    })->Unit(benchmark::kMillisecond);
  add(s, "levels", [&s](benchmark::State& state) {
    const Mesh mesh = methods::real_mesh(s.body);
    for (auto _ : state) {
      state.PauseTiming();
      const LrbRep rep = build_lrb(mesh);  // without levels of detail
      state.ResumeTiming();
      rep.levels(1);
    }
  })->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv, add_all);
}
