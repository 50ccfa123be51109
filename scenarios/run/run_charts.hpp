#pragma once
/// The charts and tables of a run's page.

#include <string_view>
#include <vector>

#include "scenarios/frames/frames.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {

/// Returns the meaning of a column or a key figure of a run's page; empty: unknown.
std::string_view meaning_of_column(std::string_view name);
/// The same for the page of another engine's run, without terms of lrbscope's wrappers.
std::string_view meaning_for_engines(std::string_view name);

/// Returns the key figures of a step of two bodies, the relation first. Returns an empty list for a step that
/// is not finished, and for other runs.
std::vector<report::Number> step_numbers(const frames::RecordedRun& recorded, std::size_t step);

/// Returns what a verdict on a cap means, as a clause.
std::string_view meaning_of(CapVerdict verdict);

/// Adds a construction: its key figures, charts of the front and of caps, and tables of passes, of verdicts
/// on caps and of regions.
void add_construction(report::Document& doc, const frames::RecordedRun& recorded);

/// Returns true if any step of a trace has this measurement.
template <class Measured>
bool was_measured(const trace::Trace& trace, Measured trace::StepResult::*what) {
  for (const trace::Step& step : trace.steps)
    if (step.result.*what) return true;
  return false;
}

/// Returns charts of distances and depths step by step, and of the convergence of their bounds in the step
/// that narrowed them most often. Returns an empty list if nothing was measured.
std::vector<report::Chart> measure_charts(const trace::Trace& trace);

/// Returns the counters by region depth, and of the regions with the most tests, for each body. Returns
/// an empty list for a run of one body.
std::vector<report::Table> group_tables(const frames::RecordedRun& run);

/// Returns the parts of the queries with their costs, and the traversal of each body's tree by depth beside
/// the expectation of the surface area heuristic. Returns an empty list for a trace without these events.
std::vector<report::Table> work_tables(const frames::RecordedRun& run);

/// Returns the run of another engine in a sentence, for the top of its page.
std::string engine_sentence(const frames::RecordedRun& recorded);
/// Adds the verdict and the key figures of a run of another engine that reported its answers.
void add_engine_answer(report::Document& doc, const frames::RecordedRun& recorded);
/// Returns charts of tests, pairs and times by query; empty for a single query.
std::vector<report::Chart> engine_charts(const frames::RecordedRun& run);
/// Returns the table of such a run's queries: the engine's answers beside the exact ones.
report::Table engine_table(const frames::RecordedRun& run);
/// Returns a table of the counters that the engine reported; empty if there are none.
std::vector<report::Table> engine_counter_tables(const frames::RecordedRun& run);

/// Returns the quality sheet of the bodies.
report::Table quality_table(const frames::RecordedRun& run);

}  // namespace lrb::run
