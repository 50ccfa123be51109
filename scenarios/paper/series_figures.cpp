#include "scenarios/paper/series_figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "scenarios/io/number_text.hpp"

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

}  // namespace lrb::paper
