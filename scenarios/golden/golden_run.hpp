#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/golden/golden.hpp"
#include "scenarios/record/recorded_run.hpp"

namespace lrb::golden {

/// A scenario, run and drawn as its golden is.
struct GoldenRun {
  spec::Scenario scenario;
  run::Recording recording;
  std::vector<run::PaintedFrame> frames;
};

/// Runs a scenario, always on the event clock, whatever the scenario says, and draws nothing. Several threads
/// may do this at once.
GoldenRun record_golden(spec::Scenario scenario, const GoldenSpec& spec, const run::ProgressReport& progress);
/// Draws its pictures, if these are compared.
void paint_golden(GoldenRun& run, const GoldenSpec& spec, const run::ProgressReport& progress);
/// Does both.
GoldenRun play_golden(spec::Scenario scenario, const GoldenSpec& spec, const run::ProgressReport& progress);

/// Returns what golden.json notes of a run.
GoldenFacts facts_of(const GoldenRun& run);

run::RecordedRun recorded_run_of(const GoldenRun& run);

/// Returns what an approved picture says about itself: scenario, event and camera, by which a later
/// difference is explained. It names no version and no folder, so that the same picture is the same file.
std::vector<render::PngText> golden_text(const GoldenRun& run, std::size_t frame);

inline const char* const kCameraText = "lrbscope:camera";
/// Describes the cameras of a frame in words, one view after the other, separated by "; ".
std::string camera_words(const std::vector<render::Camera>& cameras);

/// Sets the size of a golden's pictures unless one is asked for: of the scenario's shape, small enough to be
/// kept and large enough for their text.
void set_default_size(GoldenSpec& spec, const render::FrameSpec& frames);

// Finds what a run answers otherwise than was approved, step by step, whatever the cause.

struct Effect {
  /// Answers decide whether a run passes where only these are compared.
  enum class Kind : std::uint8_t { answer, measure, work };
  std::uint32_t step = 0;  ///< the number that the scenario gives it
  std::string what;        ///< e.g. "relation", "pairs", "face tests"
  std::string expected, found;
  Kind kind = Kind::answer;
};

/// Returns all of them: answers, then what is measured of them, then the work that led to them, each in the
/// order of the steps.
std::vector<Effect> find_effects(const Golden& golden, const GoldenRun& run);

/// Returns the total length of the contact curves of each step, in the scenario's unit; nothing where the
/// run did not ask for contacts.
std::vector<double> contact_lengths(const run::Recording& recording);

}  // namespace lrb::golden
