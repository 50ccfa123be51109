#pragma once

#include <string>

#include "scenarios/crowd/crowd_run.hpp"

namespace lrb::crowd {

/// Writes folder/{index.html, trace.json, summary.json, timing.json, KIND.lrb, frames/}. The number of
/// threads affects only timing.json, and a trace on the wall clock. Returns summary.json's text.
std::string write_crowd(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                        const std::string& command, const run::ProgressReport& progress);

/// Writes folder/{index.html, frames/} of a replayed run.
void redraw_crowd(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                  const std::string& command, const std::string& trace_file,
                  const run::ProgressReport& progress);

/// The pair of bodies with most face tests in all steps.
struct CostliestPair {
  std::string names;  ///< "gear 3,rock 5", as for find_pair(); empty if no pair was queried
  std::string text;   ///< one line
};
CostliestPair costliest_pair(const CrowdRun& run);

/// Returns one line of text with the duration of a step.
std::string crowd_speed(const CrowdRun& run);

}  // namespace lrb::crowd
