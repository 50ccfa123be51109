#pragma once
/// The part of the paper's report about the series: tables, fitted exponents, charts.

#include <optional>

#include "scenarios/paper/series.hpp"
#include "scenarios/report/document.hpp"
#include "scenarios/report/gnuplot.hpp"

namespace lrb::paper {

struct SeriesReport {
  const LrbRep& a;
  std::span<const SeriesObject> objects;
  std::span<const ContactStep> steps;
  std::uint32_t jobs = 1;  ///< number of threads that worked while times were taken
};

/// How the work of one recursion grows with a body's faces, real and pseudo, against one partner. Empty where
/// fewer than two resolutions have contacts.
struct SeriesFit {
  std::string body;
  SeriesPartner partner;
  std::size_t recursion;  ///< index into kRecursions
  std::optional<resolutions::PowerFit> comparisons, refinements, microseconds;
};
std::vector<SeriesFit> series_fits(std::span<const SeriesRow> rows);

/// Writes series.jsonl (records), series_times.jsonl, series.json (rows and fits, without times) and, if
/// `figures`, series-comparisons and series-time as SVG and PNG. Adds tables, charts and links to the page;
/// returns what Markdown shows beside them.
std::string add_series(const SeriesReport& report, const std::string& folder, bool figures,
                       report::Page& page);

// Draws the series' figures for print: a panel for each partner and recursion, sizes and counts on log axes.

/// Draws faces against comparisons: average with minimum and maximum, and the fitted power.
report::Gnuplot series_comparisons(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits);
/// Draws faces against the median time of a query, and the fitted power.
report::Gnuplot series_time(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits);

/// Returns a fitted power in words, such as "n^0.52 ± 0.01".
std::string power_text(const resolutions::PowerFit& fit);

}  // namespace lrb::paper
