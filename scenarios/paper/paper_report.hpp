#pragma once
/// Reports the paper's experiment: tables beside the published ones, figures, and what differs.

#include <string>

#include "scenarios/paper/experiment.hpp"
#include "scenarios/paper/series_report.hpp"
#include "scenarios/paper/tables.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::paper {

struct PaperReport {
  std::span<const PaperObject> objects;  ///< A first
  std::span<const ContactStep> steps;
  const PaperExperiment& experiment;
  std::string command;                                       ///< the command that made it
  const SeriesReport* series = nullptr;                      ///< bodies at several resolutions; may be null
  std::vector<std::pair<std::string, double>> seconds = {};  ///< times that its parts took; may be empty
};

/// Writes records.jsonl, tables.json, report.md, index.html, with gnuplot figure3-1 and figure3-2 as SVG and
/// PNG, heat_maps.png and refinement_tree.svg, each if the experiment reports it; for a series, what
/// add_series() adds. Returns notes (what could not be drawn). Throws EnvironmentError.
std::vector<std::string> write_paper_report(const PaperReport& report, const report::Folder& folder);

/// Throws InputError if the steps are not those of the experiment, as far as the numbers of collisions and
/// its close-ups tell.
void check_records(const PaperReport& report);

}  // namespace lrb::paper
