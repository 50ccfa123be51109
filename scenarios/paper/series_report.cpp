#include "scenarios/paper/series_report.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include <nlohmann/json.hpp>

#include "scenarios/io/files.hpp"
#include "scenarios/paper/number_text.hpp"
#include "scenarios/paper/series_figures.hpp"
#include "trace/names.hpp"

namespace lrb::paper {
namespace {

constexpr std::array<const char*, 3> kRecursionNames = {"the paper's recursion",
                                                        "the paper's recursion, strict", "complete"};

const char* against(SeriesPartner p) {
  return p == SeriesPartner::a ? "A" : "itself";
}

std::string text_of(const std::optional<resolutions::PowerFit>& fit) {
  return fit ? power_text(*fit) : "–";
}

report::PageTable table(std::span<const SeriesRow> rows, SeriesPartner partner, std::size_t recursion) {
  report::PageTable t;
  t.title = std::string("Resolutions against ") + against(partner) + ", " + kRecursionNames[recursion];
  t.columns = {
      "body",    "real faces",        "total faces",  "outermost",        "steps", "minimum", "average",
      "maximum", "refinements (avg)", "pairs missed", "time (median, µs)"};
  const bool complete = kRecursions[recursion] == Recursion::complete;
  if (complete) t.columns.insert(t.columns.begin() + 9, "bound tests (avg)");
  for (const SeriesRow& row : rows) {
    if (row.partner != partner) continue;
    const RecursionRow& x = row.counts.recursions[recursion];
    const auto all = static_cast<double>(x.pairs + x.missed);
    t.rows.push_back({row.body, render::group_digits(row.counts.real_faces),
                      render::group_digits(row.counts.total_faces), render::group_digits(row.outer_faces),
                      render::group_digits(row.counts.steps), whole(x.comparisons.min),
                      whole(x.comparisons.average), whole(x.comparisons.max),
                      fixed(x.refinements.average, 1)});
    if (complete) t.rows.back().push_back(whole(x.bound_tests));
    t.rows.back().push_back(all > 0 ? fixed(100 * static_cast<double>(x.missed) / all, 2) + " %" : "–");
    t.rows.back().push_back(fixed(row.microseconds[recursion], 0));
  }
  return t;
}

report::PageTable fit_table(std::span<const SeriesFit> fits, std::uint32_t jobs) {
  report::PageTable t{
      "Growth with the resolution",
      {"body", "against", "recursion", "comparisons", "refinements", "time"},
      {},
      "Powers of n, the body's real and pseudo faces, fitted by least squares in both logarithms to the "
      "averages (time: medians) of all resolutions, with the exponent's standard error. Against A one "
      "body grows, against itself both do. For n log n, which the paper sets beside its counts, the power "
      "would be above 1. Times are of one query each, on this machine" +
          (jobs > 1 ? ", while " + std::to_string(jobs) + " threads worked" : std::string()) + "."};
  for (const SeriesFit& f : fits)
    t.rows.push_back({f.body, against(f.partner), kRecursionNames[f.recursion], text_of(f.comparisons),
                      text_of(f.refinements), text_of(f.microseconds)});
  return t;
}

report::PageChart chart(std::span<const SeriesRow> rows, SeriesPartner partner, bool time) {
  report::PageChart c;
  c.title = std::string(time ? "Time" : "Comparisons") + " against size: " +
            (partner == SeriesPartner::a ? "A against each body" : "each body against itself");
  c.x_label = "real and pseudo faces";
  c.y_label = time ? "median of a query, µs" : "face comparisons, average";
  c.log_x = c.log_y = true;
  for (std::size_t i = 0; i < kRecursions.size(); ++i) {
    for (const SeriesRow& row : rows) {
      const std::string label = row.body + ", " + kRecursionNames[i];
      const double y = time ? row.microseconds[i] : row.counts.recursions[i].comparisons.average;
      if (row.partner != partner || !(y > 0)) continue;
      if (c.series.empty() || c.series.back().label != label) c.series.push_back({label, {}, {}});
      // Rows begin with the finest resolution, charts with the coarsest.
      c.series.back().x.insert(c.series.back().x.begin(), row.counts.total_faces);
      c.series.back().y.insert(c.series.back().y.begin(), y);
    }
  }
  return c;
}

nlohmann::ordered_json to_json(const std::optional<resolutions::PowerFit>& fit) {
  if (!fit) return nullptr;
  return {{"exponent", fit->exponent}, {"standard_error", fit->error}, {"factor", fit->factor}};
}

std::string series_json(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits) {
  nlohmann::ordered_json j;
  j["rows"] = nlohmann::ordered_json::array();
  for (const SeriesRow& row : rows) {
    nlohmann::ordered_json r = {{"body", row.body},
                                {"against", against(row.partner)},
                                {"real_faces", row.counts.real_faces},
                                {"total_faces", row.counts.total_faces},
                                {"outer_faces", row.outer_faces},
                                {"steps", row.counts.steps}};
    for (std::size_t i = 0; i < kRecursions.size(); ++i) {
      const RecursionRow& x = row.counts.recursions[i];
      r[std::string(trace::name_of(kRecursions[i]))] = {{"comparisons_min", x.comparisons.min},
                                                        {"comparisons_avg", x.comparisons.average},
                                                        {"comparisons_max", x.comparisons.max},
                                                        {"refinements_avg", x.refinements.average},
                                                        {"bound_tests_avg", x.bound_tests},
                                                        {"pairs", x.pairs},
                                                        {"missed", x.missed}};
    }
    j["rows"].push_back(std::move(r));
  }
  j["powers_of_total_faces"] = nlohmann::ordered_json::array();
  for (const SeriesFit& f : fits)
    j["powers_of_total_faces"].push_back({{"body", f.body},
                                          {"against", against(f.partner)},
                                          {"recursion", trace::name_of(kRecursions[f.recursion])},
                                          {"comparisons", to_json(f.comparisons)},
                                          {"refinements", to_json(f.refinements)}});
  return j.dump(2) + "\n";
}

template <class Measure>
std::optional<resolutions::PowerFit> fit(std::span<const SeriesRow> rows, const SeriesFit& of,
                                         Measure measure) {
  std::vector<double> x, y;
  for (const SeriesRow& row : rows) {
    if (row.body != of.body || row.partner != of.partner) continue;
    const double value = measure(row);
    if (!(value > 0)) continue;
    x.push_back(row.counts.total_faces);
    y.push_back(value);
  }
  if (x.size() < 2) return std::nullopt;
  return resolutions::fit_power(x, y);
}

}  // namespace

std::vector<SeriesFit> series_fits(std::span<const SeriesRow> rows) {
  std::vector<SeriesFit> fits;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (r > 0 && rows[r].body == rows[r - 1].body && rows[r].partner == rows[r - 1].partner) continue;
    for (std::size_t i = 0; i < kRecursions.size(); ++i) {
      SeriesFit f{rows[r].body, rows[r].partner, i, {}, {}, {}};
      f.comparisons =
          fit(rows, f, [&](const SeriesRow& x) { return x.counts.recursions[i].comparisons.average; });
      f.refinements =
          fit(rows, f, [&](const SeriesRow& x) { return x.counts.recursions[i].refinements.average; });
      f.microseconds = fit(rows, f, [&](const SeriesRow& x) { return x.microseconds[i]; });
      fits.push_back(std::move(f));
    }
  }
  return fits;
}

std::string add_series(const SeriesReport& report, const std::string& folder, bool figures,
                       report::Page& page) {
  const std::vector<SeriesRow> rows = series_rows(report.a, report.objects, report.steps);
  const std::vector<SeriesFit> fits = series_fits(rows);
  io::write_text(folder + "/series.jsonl", to_json_lines(report.steps));
  io::write_text(folder + "/series_times.jsonl", times_to_json_lines(report.steps));
  io::write_text(folder + "/series.json", series_json(rows, fits));
  page.tables.push_back(fit_table(fits, report.jobs));
  for (const SeriesPartner partner : kSeriesPartners)
    for (std::size_t i = 0; i < kRecursions.size(); ++i) page.tables.push_back(table(rows, partner, i));
  for (const bool time : {false, true})
    for (const SeriesPartner partner : kSeriesPartners) page.charts.push_back(chart(rows, partner, time));
  page.links.push_back({"series.jsonl", "series.jsonl", "every counted time step of the resolutions"});
  page.links.push_back({"series_times.jsonl", "series_times.jsonl", "what the queries took"});
  page.links.push_back({"series.json", "series.json", "tables and fitted exponents as data"});
  if (!figures) return "";
  std::string markdown;
  for (const auto& [name, what, chart] :
       {std::tuple{"series-comparisons", "Comparisons against size", series_comparisons(rows, fits)},
        std::tuple{"series-time", "Time against size", series_time(rows, fits)}}) {
    for (const char* ending : {".svg", ".png"}) {
      report::draw(chart, folder + "/" + name + ending);
      page.links.push_back({std::string(name) + ending, std::string(name) + ending, ""});
    }
    markdown += std::string("\n![") + what + "](" + name + ".svg)\n";
  }
  return markdown;
}

}  // namespace lrb::paper
