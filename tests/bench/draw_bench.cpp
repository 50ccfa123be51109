// What encoding and writing add to drawing: a sequence of frames drawn and thrown away, and the same frames
// drawn, encoded and written, as `lrbscope run` does it.
//
//   draw_bench [--repeats N] [--frames N]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "tests/bench/timing.hpp"
#include "tests/mesh/io/encode.hpp"
#include "tests/support/folder.hpp"

using namespace lrb;
using bench::median;
using bench::seconds_since;

namespace {

constexpr double kAim = 0.8;  ///< of the rate of drawing alone

/// A rock turns beside a ball.
spec::Scenario turning_rock(int frames) {
  const std::string text =
      R"({"name": "rate", "purpose": "A rock turns beside a ball.", "bodies": {"a": {"generator": "ball"}, "b": {"generator": "rock",
          "parameters": {"frequency": 50}, "pose": {"position": [2.5, 0, 0]}}},
          "motion": {"kind": "spin", "axis": [0, 0, 1], "degrees": 90, "steps": )" +
      std::to_string(frames) + R"(}, "frames": {"at": "step", "size": [1280, 720]}})";
  return spec::parse_scenario(text, "draw_bench");
}

}  // namespace

int main(int argc, char** argv) {
  int repeats = 3, frames = 40;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--repeats") == 0) repeats = std::max(1, std::atoi(argv[i + 1]));
    if (std::strcmp(argv[i], "--frames") == 0) frames = std::max(2, std::atoi(argv[i + 1]));
  }
  const spec::Scenario scenario = turning_rock(frames);
  const run::Recording recording = run::record(scenario, run::kSilent);
  run::RecordedRun performance;
  performance.title = scenario.name;
  for (const bodies::LoadedBody& body : recording.bodies) performance.reps.push_back(&body.rep);
  performance.trace = &recording.trace;
  performance.results = &recording.results;
  const test::Folder directory;
  std::printf("%d frames of 1280x720, %u faces\n", frames, recording.bodies[1].rep.real_face_count());
  std::vector<double> alone, whole;
  for (int i = 0; i < repeats; ++i) {
    auto start = std::chrono::steady_clock::now();
    run::paint_frames(performance, scenario.frames, run::kSilent, nullptr);
    alone.push_back(seconds_since(start) / frames);
    start = std::chrono::steady_clock::now();
    run::draw_frames(performance, scenario.frames, directory / "sequence", {}, run::kSilent);
    whole.push_back(seconds_since(start) / frames);
  }
  const double rate = median(alone) / median(whole);
  std::printf("drawing alone         %6.1f ms a frame\n", 1e3 * median(alone));
  std::printf("encoded and written   %6.1f ms a frame: %.0f %% of the rate, aim %.0f %%: %s\n",
              1e3 * median(whole), 100 * rate, 100 * kAim, rate >= kAim ? "reached" : "NOT reached");
}
