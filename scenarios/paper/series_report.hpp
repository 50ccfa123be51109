#pragma once
/// The part of the paper's report about the series: tables, fitted exponents, charts.

#include <optional>

#include "scenarios/bodies/resolutions/power_fit.hpp"
#include "scenarios/paper/series.hpp"
#include "scenarios/report/page/page.hpp"

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

}  // namespace lrb::paper
