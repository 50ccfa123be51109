#pragma once
/// The part of the paper's report about the series: tables, fitted exponents, charts.

#include <optional>

#include "scenarios/paper/series.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::paper {

struct SeriesReport {
  const LrbRep& a;
  std::span<const SeriesObject> objects;
  std::span<const ContactStep> steps;
  std::uint32_t jobs = 1;  ///< number of threads during the measurement of times
};

/// The growth of one recursion's work with a body's faces, real and pseudo, against one partner. Empty if
/// fewer than two resolutions have contacts.
struct SeriesFit {
  std::string body;
  SeriesPartner partner;
  std::size_t recursion;  ///< index into kRecursions
  std::optional<resolutions::PowerFit> comparisons, refinements, microseconds;
};
std::vector<SeriesFit> series_fits(std::span<const SeriesRow> rows);

/// Returns a sentence on the growth of comparisons for bodies that collide with themselves.
std::string growth_text(const SeriesReport& report);

/// Adds charts, on the page and for print (series-comparisons, series-time), series.jsonl (records),
/// series_times.jsonl and series.json (rows and fits, without times). Returns the tables.
std::vector<report::Table> add_series(const SeriesReport& report, report::Document& doc);

/// Returns a fitted power as text, such as "n^0.52 ± 0.01".
std::string power_text(const resolutions::PowerFit& fit);

}  // namespace lrb::paper
