#pragma once
/// Reports the paper's experiment: tables beside the published ones, figures, and the differences.

#include <string>
#include <vector>

#include "scenarios/paper/experiment.hpp"
#include "scenarios/paper/series.hpp"
#include "scenarios/paper/tables.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::paper {

struct PaperReport {
  std::span<const PaperObject> objects;   ///< A first
  std::span<const ContactStep> steps;     ///< of all seeds, in the order of sorted()
  std::span<const ContactStep> settings;  ///< of other_settings(); may be empty
  const PaperExperiment& experiment;
  std::string command;                   ///< the command that made it
  const SeriesReport* series = nullptr;  ///< bodies at several resolutions; may be null
  bool tex = false;                      ///< also write each table for LaTeX
  std::vector<report::Table> more = {};  ///< tables that are shown after the counters
};

/// Writes records.jsonl, table1.csv, table2.csv, tables.json, report.md, index.html, with gnuplot
/// figure3-1 and figure3-2 as SVG and PNG, settings.csv and settings.jsonl, heat_maps.png and
/// refinement_tree.svg, each if the experiment reports it; for a series, the output of add_series(). Returns
/// notes on pictures that could not be drawn. Throws EnvironmentError.
std::vector<std::string> write_paper_report(const PaperReport& report, const report::Folder& folder);

/// Returns the work of the paper's recursion on kept wrappers and from scratch, in short steps after first
/// contact. `contacts`: see first_contacts(), with all objects.
report::Table incremental_table(std::span<const PaperObject> objects, std::span<const ContactStep> contacts);

}  // namespace lrb::paper
