#pragma once
/// Runs of goldens, and their differences from the approved runs.

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/golden/golden.hpp"
#include "scenarios/record/recorded_run.hpp"

namespace lrb::golden {

/// A scenario or a capture, run and drawn with its golden's settings.
struct GoldenRun {
  spec::Scenario scenario;
  std::string text;  ///< its JSON, see scenario_text(); empty: not recorded in the golden
  record::Recording recording;
  std::vector<frames::PaintedFrame> frames;
};

/// Runs a scenario, always on the event clock, regardless of its setting, or reads a capture, without its
/// times. Draws nothing. Thread-safe.
GoldenRun record_golden(const Source& source, const GoldenSpec& spec, const record::ProgressReport& progress);
/// Draws its pictures, if these are compared.
void paint_golden(GoldenRun& run, const GoldenSpec& spec, const record::ProgressReport& progress);
/// Runs and draws.
GoldenRun play_golden(const Source& source, const GoldenSpec& spec, const record::ProgressReport& progress);

/// Returns the facts of a run for golden.json.
GoldenFacts facts_of(const GoldenRun& run);

/// Returns the run for its pictures.
frames::RecordedRun recorded_run_of(const GoldenRun& run);

/// Returns the metadata of an approved picture: scenario, event and camera, which explain a later difference.
/// It contains no version and no folder, so that equal pictures are equal files.
std::vector<render::PngText> golden_text(const GoldenRun& run, std::size_t frame);

inline const char* const kCameraText = "lrbscope:camera";
/// Describes the cameras of a frame, one view after the other, separated by "; ".
std::string camera_text(const std::vector<render::Camera>& cameras);

/// Sets the default size of a golden's pictures if none is given: of the scenario's shape, small enough to be
/// kept and large enough for their text.
void set_default_size(GoldenSpec& spec, const pictures::FrameSpec& frames);

// Compares a run's answers with the approved ones, step by step, regardless of the cause.

struct Effect {
  /// If only answers are compared, they alone decide whether a run passes.
  enum class Kind : std::uint8_t { answer, measure, work };
  std::uint32_t step = 0;  ///< number of the step in the scenario
  std::string what;        ///< e.g. "relation", "pairs", "face tests"
  std::string expected, found;
  Kind kind = Kind::answer;
};

/// Returns all differences: answers, then their measures, then the work that led to them, each in the order
/// of the steps.
std::vector<Effect> find_effects(const Golden& golden, const GoldenRun& run);

/// Returns the counters whose sums over all steps exceed the approved ones by more than the golden's
/// tolerance of work. `step` is meaningless.
std::vector<Effect> find_more_work(const Golden& golden, const GoldenRun& run);

/// Returns the total length of the contact curves of each step, in the scenario's unit. Returns an empty list
/// if the run did not request contacts.
std::vector<double> contact_lengths(const record::Recording& recording);

}  // namespace lrb::golden
