#pragma once
/// Draws the series' figures for print: a panel for each partner and recursion, sizes and counts on log axes.

#include "scenarios/paper/series_report.hpp"
#include "scenarios/report/charts/gnuplot.hpp"

namespace lrb::paper {

/// Draws faces against comparisons: average with minimum and maximum, and the fitted power.
report::Gnuplot series_comparisons(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits);
/// Draws faces against the median time of a query, and the fitted power.
report::Gnuplot series_time(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits);

/// Returns a fitted power in words, such as "n^0.52 ± 0.01".
std::string power_text(const resolutions::PowerFit& fit);

}  // namespace lrb::paper
