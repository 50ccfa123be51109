// The cost of encoding and writing frames: a sequence drawn and discarded, and the same frames drawn, encoded
// and written, as `lrbscope run` does it. The target is at most 1.25 times the time of drawing.
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>
#include <unistd.h>

#include "scenarios/frames/frames.hpp"
#include "scenarios/record/recorded_run.hpp"

using namespace lrb;

namespace {

/// A rock rotates beside a ball.
const spec::Scenario& scenario() {
  static const spec::Scenario scenario = spec::parse_scenario(
      R"({"name": "rate", "purpose": "A rock turns beside a ball.", "bodies": {"a": {"generator": "ball"}, "b": {"generator": "rock",
          "parameters": {"frequency": 50}, "pose": {"position": [2.5, 0, 0]}}},
          "motion": {"kind": "spin", "axis": [0, 0, 1], "degrees": 90, "steps": 40},
          "frames": {"at": "step", "size": [1280, 720]}})",
      "draw_bench");
  return scenario;
}

const run::RecordedRun& recorded() {
  static const run::Recording recording = run::record(scenario(), run::kSilent);
  static const run::RecordedRun recorded = [] {
    run::RecordedRun r;
    r.title = scenario().name;
    for (const bodies::LoadedBody& body : recording.bodies) r.reps.push_back(&body.rep);
    r.trace = &recording.trace;
    r.results = &recording.results;
    return r;
  }();
  return recorded;
}

void draw(benchmark::State& state) {
  for (auto _ : state) run::paint_frames(recorded(), scenario().frames, run::kSilent, nullptr);
}
BENCHMARK(draw)->Unit(benchmark::kMillisecond)->UseRealTime();

void draw_encode_write(benchmark::State& state) {
  const auto folder = std::filesystem::temp_directory_path() / ("draw_bench." + std::to_string(getpid()));
  for (auto _ : state)
    run::draw_frames(recorded(), scenario().frames, (folder / "sequence").string(), {}, run::kSilent);
  std::filesystem::remove_all(folder);
}
BENCHMARK(draw_encode_write)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
