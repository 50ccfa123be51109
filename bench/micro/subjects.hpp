#pragma once
/// Micro benchmarks of a body or of queries of it and a copy of itself, on Google's benchmark library:
///
///   PROGRAM [--benchmark_filter=REGEX] [BODY...]
///
/// BODY is a mesh or .lrb file. The default is a generated rock, and the models spot, rocker-arm and
/// nefertiti of the folder LRB_MESHES.

#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/body.hpp>
#include <lrbscope/error.hpp>

namespace lrb::micro {

struct Subject {
  std::string name;
  Body body;
  double diagonal, size;  ///< of its box: the diagonal and the largest side
};

/// Registers a benchmark NAME/WHAT of a subject.
template <class Run>
benchmark::internal::Benchmark* add(const Subject& subject, const std::string& what, Run run) {
  return benchmark::RegisterBenchmark((subject.name + "/" + what).c_str(),
                                      [run](benchmark::State& state) { run(state); });
}

/// Loads the named bodies, or the default ones, calls `add` for each, and runs the registered benchmarks.
/// Returns the exit code of the program.
inline int run(int argc, char** argv, void (*add)(const Subject&)) try {
  namespace fs = std::filesystem;
  benchmark::Initialize(&argc, argv);
  std::vector<fs::path> files(argv + 1, argv + argc);
  static std::deque<Subject> subjects;  // benchmarks keep references
  const auto add_subject = [add](std::string name, Body body) {
    const Eigen::AlignedBox3d box = shapes::box_of(body);
    add(subjects.emplace_back(
        Subject{std::move(name), std::move(body), box.diagonal().norm(), box.sizes().maxCoeff()}));
  };
  if (files.empty()) {
    add_subject("rock", Body::from(shapes::bumpy_sphere(5, 7)).value());
    if (const char* folder = std::getenv("LRB_MESHES"))
      for (const char* name : {"spot.obj", "rocker-arm.obj", "nefertiti.obj"})
        if (fs::exists(fs::path(folder) / name)) files.push_back(fs::path(folder) / name);
  }
  for (const fs::path& file : files) add_subject(file.stem(), Body::load(file).value());
  benchmark::RunSpecifiedBenchmarks();
  return 0;
} catch (const InputError& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}

}  // namespace lrb::micro
