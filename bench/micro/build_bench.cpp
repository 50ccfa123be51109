// The OBB tree beside the trees of other engines, in wall time; a body of faces from a mesh; building a body
// lean and to fit, its levels of detail, and loading its .lrb. Scaling: the same benchmarks on rocks of
// 31,000 to 2,000,000 faces, with the exponent of the growth of time (tests/scaling measures memory). Other
// times are processor times of one thread; `lrbscope inspect` prints the figures of a body.
#include <filesystem>
#include <string>

#include <unistd.h>

#include "bench/methods/method.hpp"
#include "bench/methods/triangles.hpp"
#include "bench/micro/poses.hpp"
#include "scenarios/bodies/generators.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/lrb_rep.hpp>

using namespace lrb;
using namespace lrb::micro;

namespace lrb::methods {
std::vector<MethodEntry> bullet_methods();
std::vector<MethodEntry> embree_methods();
std::vector<MethodEntry> fcl_methods();
}  // namespace lrb::methods

namespace {

void tree(benchmark::State& state, const LrbRep& rep, unsigned threads) {
  for (auto _ : state) benchmark::DoNotOptimize(ObbTree(rep.simplices(), threads).height());
  state.counters["bytes_per_face"] =
      static_cast<double>(rep.tree().memory_bytes()) / static_cast<double>(rep.real_face_count());
}

/// Adds the trees of other engines. They include a copy of the triangles in the engine's form.
void add_others(const Subject& s) {
  for (const auto& all : {methods::bullet_methods(), methods::embree_methods(), methods::fcl_methods()})
    for (const methods::MethodEntry& entry : all) {
      if (entry.make == nullptr) continue;  // not installed
      add(s, "tree, " + entry.info.name,
          [&s, make = entry.make](benchmark::State& state) {
            const std::unique_ptr<methods::Method> method = make();
            for (auto _ : state) benchmark::DoNotOptimize(method->build(s.body));
          })
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
    }
}

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
  for (const unsigned threads : {1u, 2u})
    add(s, "tree, threads " + std::to_string(threads),
        [&s, threads](benchmark::State& state) { tree(state, s.body, threads); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  add_others(s);
  add(s, "faces", [&s](benchmark::State& state) {
    const Mesh mesh = methods::real_mesh(s.body);
    BodyOptions faces;
    faces.regions = false;
    for (auto _ : state) benchmark::DoNotOptimize(Body::from(mesh, faces)->name());
  })->Unit(benchmark::kMillisecond);
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
  add(s, "load", [&s](benchmark::State& state) { load(state, s.body); })->Unit(benchmark::kMillisecond);
}

}  // namespace

int main(int argc, char** argv) {
  return run(argc, argv, add_all);
}
