#pragma once
/// Runs scenarios and writes their folders.

#include <string>
#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::run {

struct RunOutcome {
  std::vector<std::string> mismatches;  ///< failed expectations
  std::vector<std::string> notes;       ///< to be printed
  std::string summary;                  ///< text of summary.json
  std::size_t frames = 0;
};

/// Returns a recording with the settings for drawing its frames; both arguments must outlive it.
frames::RecordedRun recorded_run_of(const spec::Scenario& scenario, const record::Recording& recording);
/// Returns it for a run without a scenario.
frames::RecordedRun recorded_run_of(const std::string& title, const std::string& purpose,
                                    const record::Recording& recording);

/// Runs a scenario and writes folder/{index.html, trace.json[.gz], summary.json, a.lrb, b.lrb, frames/,
/// montage.png}.
RunOutcome run_scenario(const spec::Scenario& scenario, const std::string& folder, const std::string& command,
                        const record::ProgressReport& progress);
/// Writes the same files for a run that has been recorded.
RunOutcome write_run(const spec::Scenario& scenario, const record::Recording& recording,
                     const std::string& folder, const std::string& command,
                     const record::ProgressReport& progress);

}  // namespace lrb::run
