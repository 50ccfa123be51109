#pragma once
/// Runs of goldens, and their differences from the approved runs.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/crowd/crowd_run.hpp"
#include "scenarios/crowd/crowd_trace.hpp"
#include "scenarios/frames/frames.hpp"
#include "scenarios/golden/golden.hpp"
#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/trace/divergence.hpp>

namespace lrb::golden {

/// A crowd that has been run.
struct CrowdRecord {
  spec::Crowd crowd;
  crowd::CrowdRun run;
  crowd::CrowdTrace trace;  ///< of the run, as read from its file
};

/// A scenario, a crowd or a capture, run and drawn with its golden's settings.
struct GoldenRun {
  spec::Scenario scenario;   ///< of a crowd: its name, purpose, hash and frames, and a body for each kind
  std::string text;          ///< its JSON, see scenario_text(); empty: not recorded in the golden
  run::Recording recording;  ///< empty if `crowd` is set
  std::optional<CrowdRecord> crowd;
  std::vector<run::PaintedFrame> frames;

  /// Returns the bodies, of a crowd one for each kind.
  const std::vector<bodies::LoadedBody>& bodies() const {
    return crowd ? crowd->run.kinds : recording.bodies;
  }
};

/// Runs a scenario or a crowd, always on the event clock, regardless of its setting, or reads a capture,
/// without its times. Draws nothing.
/// `threads` affects only the time of a crowd. Thread-safe.
GoldenRun record_golden(Source source, const GoldenSpec& spec, const run::ProgressReport& progress,
                        std::uint32_t threads = 1);
/// Draws its pictures, if these are compared.
void paint_golden(GoldenRun& run, const GoldenSpec& spec, const run::ProgressReport& progress);
/// Runs and draws.
GoldenRun play_golden(Source source, const GoldenSpec& spec, const run::ProgressReport& progress,
                      std::uint32_t threads = 1);

/// Writes the trace of a run to a file, compressed if its name ends in ".gz".
void save_run_trace(const GoldenRun& run, const std::string& path);

/// Returns the facts of a run for golden.json.
GoldenFacts facts_of(const GoldenRun& run);

/// Returns a run of two bodies for its pictures.
run::RecordedRun recorded_run_of(const GoldenRun& run);

/// Returns the metadata of an approved picture: scenario, event and camera, which explain a later difference.
/// It contains no version and no folder, so that equal pictures are equal files.
std::vector<render::PngText> golden_text(const GoldenRun& run, std::size_t frame);

inline const char* const kCameraText = "lrbscope:camera";
/// Describes the cameras of a frame, one view after the other, separated by "; ".
std::string camera_text(const std::vector<render::Camera>& cameras);

/// Sets the default size of a golden's pictures if none is given: of the scenario's shape, small enough to be
/// kept and large enough for their text.
void set_default_size(GoldenSpec& spec, const render::FrameSpec& frames);

// Compares a run's answers with the approved ones, step by step, regardless of the cause.

struct Effect {
  /// If only answers are compared, they alone decide whether a run passes.
  enum class Kind : std::uint8_t { answer, measure, work };
  std::uint32_t step = 0;  ///< number of the step in the scenario
  std::string what;        ///< e.g. "relation", "pairs", "face tests", "gear 1 and rock 3: pairs"
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
std::vector<double> contact_lengths(const run::Recording& recording);

// Differences of two runs of a crowd, by their traces.

/// Returns the number of queries in all steps.
std::size_t query_count(const crowd::CrowdTrace& trace);

/// Returns the first difference: bodies and request, then per step poses, answers and counters. Returns
/// nullopt if the runs are equal.
std::optional<trace::Divergence> first_divergence(const crowd::CrowdTrace& expected,
                                                  const crowd::CrowdTrace& found);

/// Return a line about changed kinds or numbers of bodies, and about the first pose that differs. Empty: they
/// are equal.
std::string kinds_cause(const crowd::CrowdTrace& expected, const crowd::CrowdTrace& found);
std::string crowd_pose_cause(const crowd::CrowdTrace& expected, const crowd::CrowdTrace& found);

}  // namespace lrb::golden
