#include "scenarios/paper/series_report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include <nlohmann/json.hpp>

#include "scenarios/io/files.hpp"
#include "scenarios/paper/tables.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::paper {
namespace {

// Okabe and Ito's colours, which people with any colour vision tell apart; point types are told apart in
// grey, too.
constexpr std::array<const char*, 7> kBodyColours = {"#0072B2", "#D55E00", "#009E73", "#E69F00",
                                                     "#56B4E9", "#CC79A7", "#000000"};
constexpr std::array<int, 7> kPoints = {7, 5, 9, 13, 11, 4, 6};
constexpr std::array<const char*, 3> kRecursionTitles = {"paper", "paper, strict", "complete"};

constexpr double kPanelRows = 2;
constexpr double kKeyLine = 3.4;  // millimetres

/// What a figure shows of a row.
struct Measured {
  double low, average, high;
};

using Measure = Measured (*)(const SeriesRow&, std::size_t recursion);
using FitOf = const std::optional<resolutions::PowerFit>& (*)(const SeriesFit&);

/// One panel: its data blocks, and its plot command.
class Panel {
 public:
  Panel(report::Gnuplot& g, std::span<const SeriesRow> rows, std::span<const SeriesFit> fits, Measure measure,
        FitOf fit_of)
      : g_(g), rows_(rows), fits_(fits), measure_(measure), fit_of_(fit_of) {}

  void add(SeriesPartner partner, std::size_t recursion) {
    std::string plot;
    double lowest = std::numeric_limits<double>::infinity(), highest = 0;
    std::size_t bodies = 0;
    for (std::size_t i = 0; i < fits_.size(); ++i) {
      const SeriesFit& fit = fits_[i];
      if (fit.partner != partner || fit.recursion != recursion) continue;
      std::vector<std::string> points;
      double first = std::numeric_limits<double>::infinity(), last = 0;  // sizes
      for (const SeriesRow& row : rows_) {
        if (row.body != fit.body || row.partner != partner) continue;
        const Measured m = measure_(row, recursion);
        if (!(m.low > 0)) continue;
        points.push_back(io::number_text(row.counts.total_faces) + " " + io::number_text(m.average) + " " +
                         io::number_text(m.low) + " " + io::number_text(m.high));
        first = std::min<double>(first, row.counts.total_faces);
        last = std::max<double>(last, row.counts.total_faces);
        lowest = std::min(lowest, m.low);
        highest = std::max(highest, m.high);
      }
      if (points.empty()) continue;
      const std::string name = "series_" + std::to_string(panel_) + "_" + std::to_string(bodies);
      g_.add_data(name, points);
      const std::string colour = kBodyColours[bodies % kBodyColours.size()];
      const std::optional<resolutions::PowerFit>& power = fit_of_(fit);
      plot += (plot.empty() ? "plot $" : ", $") + name + " using 1:2:3:4 with yerrorbars lw 0.7 pt " +
              std::to_string(kPoints[bodies % kPoints.size()]) + " ps 0.5 lc rgb '" + colour + "' title " +
              report::gnuplot_text(fit.body + (power ? ": " + power_text(*power) : ""));
      if (power)
        plot += ", x < " + io::number_text(first) + " || x > " + io::number_text(last) +
                " ? 1/0 : " + io::number_text(power->factor) + " * x**(" + io::number_text(power->exponent) +
                ") with lines lw 1 dt 2 lc rgb '" + colour + "' notitle";
      ++bodies;
    }
    ++panel_;
    const std::string grown = partner == SeriesPartner::a ? "A against the body" : "the body against itself";
    g_.script +=
        "set title " + report::gnuplot_text(grown + ", " + kRecursionTitles[recursion]) + " offset 0,-0.7\n";
    if (plot.empty()) {
      g_.script += "set multiplot next\n";
      return;
    }
    // The key needs room above the points.
    const double share = static_cast<double>(bodies + 1) * kKeyLine * kPanelRows / g_.height;
    const double room = std::log10(highest / lowest) * share / (1 - share);
    g_.script += "set yrange [" + io::number_text(lowest / 1.3) + ":" +
                 io::number_text(highest * 1.2 * std::pow(10, room)) + "]\n" + plot + "\n";
  }

 private:
  report::Gnuplot& g_;
  std::span<const SeriesRow> rows_;
  std::span<const SeriesFit> fits_;
  Measure measure_;
  FitOf fit_of_;
  std::size_t panel_ = 0;
};

report::Gnuplot panels(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits, const char* y_label,
                       Measure measure, FitOf fit_of) {
  report::Gnuplot g;
  g.width = 210;
  g.height = 112 + 12 * static_cast<double>(fits.size()) / (kSeriesPartners.size() * kRecursions.size());
  g.font = 7;
  g.script = std::string(R"(set multiplot layout 2,3 margins 0.085,0.99,0.085,0.95 spacing 0.06,0.11
set logscale xy
set format xy '%.0s%c'
set key top left reverse Left samplen 1 spacing 1.1
set grid x y lc rgb '#dddddd'
set border 3
set tics nomirror out
)") + "set xlabel 'real and pseudo faces' offset 0,0.5\n";
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (const SeriesRow& row : rows) {
    smallest = std::min<double>(smallest, row.counts.total_faces);
    largest = std::max<double>(largest, row.counts.total_faces);
  }
  g.script += "set xrange [" + io::number_text(smallest / 1.5) + ":" + io::number_text(largest * 1.5) + "]\n";
  Panel panel(g, rows, fits, measure, fit_of);
  for (const SeriesPartner partner : kSeriesPartners) {
    for (std::size_t i = 0; i < kRecursions.size(); ++i) {
      g.script +=
          i == 0 ? "set ylabel " + report::gnuplot_text(y_label) + " offset 0.3,0\n" : "unset ylabel\n";
      panel.add(partner, i);
    }
  }
  g.script += "unset multiplot\n";
  return g;
}

}  // namespace

std::string power_text(const resolutions::PowerFit& fit) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(2) << "n^" << fit.exponent;
  if (fit.error > 0) out << " ± " << fit.error;
  return out.str();
}

report::Gnuplot series_comparisons(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits) {
  return panels(
      rows, fits, "face comparisons",
      [](const SeriesRow& row, std::size_t i) {
        const Spread& s = row.counts.recursions[i].comparisons;
        return Measured{s.min, s.average, s.max};
      },
      [](const SeriesFit& f) -> const std::optional<resolutions::PowerFit>& { return f.comparisons; });
}

report::Gnuplot series_time(std::span<const SeriesRow> rows, std::span<const SeriesFit> fits) {
  return panels(
      rows, fits, "median of a query, microseconds",
      [](const SeriesRow& row, std::size_t i) {
        const double us = row.microseconds[i];
        return Measured{us, us, us};
      },
      [](const SeriesFit& f) -> const std::optional<resolutions::PowerFit>& { return f.microseconds; });
}

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
