#pragma once
/// Charts of what was measured in a run besides the pairs of faces: distances and depths step by step, and
/// how their bounds tightened with the work.

#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {

/// Puts a construction into its page: its numbers, charts of the hull and of caps, and tables of its passes
/// and of why caps were refused.
void add_construction(report::Page& page, const RecordedRun& recorded);

/// Returns true if a step of a trace has it.
template <class Measured>
bool was_measured(const trace::Trace& trace, Measured trace::StepResult::*what) {
  for (const trace::Step& step : trace.steps)
    if (step.result.*what) return true;
  return false;
}

/// Returns the charts; none if nothing was measured. Of bounds, those of the step that narrowed them most
/// often.
std::vector<report::PageChart> measure_charts(const trace::Trace& trace);

}  // namespace lrb::run
