#pragma once
/// Reports the paper's experiment: tables beside the published ones, figures, and what differs.

#include <string>

#include "scenarios/paper/experiment.hpp"
#include "scenarios/paper/series_report.hpp"
#include "scenarios/paper/tables.hpp"
#include "scenarios/report/document.hpp"
#include "scenarios/report/gnuplot.hpp"

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
/// add_series() writes. Returns lines for people (what could not be drawn). Throws EnvironmentError.
std::vector<std::string> write_paper_report(const PaperReport& report, const std::string& folder);

// Pictures of the paper's report: written as files, and put into its page.

/// Throws InputError if the steps are not those of the experiment, as far as the numbers of collisions and
/// its close-ups tell.
void check_records(const PaperReport& report);

/// Draws heat maps of the easiest and the hardest collision, and the refinement tree of the hardest one's
/// busiest step, each if the experiment reports it. Adds what could not be drawn to `notes`.
void draw_close_ups(const PaperReport& report, const std::string& folder, report::Page& page,
                    std::vector<std::string>& notes);

// The paper's figures 3.1 and 3.2, from the records, for print.

/// Makes figure 3.1: the other object's size (real and pseudo faces, log axis) against comparisons: minimum,
/// average and maximum, measured with the paper's recursion and as published.
report::Gnuplot figure_3_1(std::span<const ObjectRow> rows);

/// Makes figure 3.2: for each number of comparisons, how many time steps needed it, a line for each object,
/// with the paper's recursion.
report::Gnuplot figure_3_2(std::span<const ObjectRow> rows, std::span<const ContactStep> steps);

}  // namespace lrb::paper
