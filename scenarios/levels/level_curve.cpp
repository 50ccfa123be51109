#include "scenarios/levels/level_curve.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenarios/io/number_text.hpp"

namespace lrb::levels {
namespace {

constexpr const char* kDistance = "distance from the body / largest side of its box";

/// A series: distances as shares, faces, and how it is drawn.
struct CurveSeries {
  const char* name;
  const char* title;
  const char* print_style;
  const char* colour;
  std::vector<double> distances, faces;
  void add(double distance, std::uint32_t count) {
    if (!(distance > 0)) return;  // has no place on a logarithmic axis
    distances.push_back(distance);
    faces.push_back(count);
  }
};

std::vector<CurveSeries> series_of(const LevelCurve& c) {
  CurveSeries proved{
      "proved", "wrappers that enclose the body: proved", "linespoints lw 1.5 pt 7 ps 0.35", "#0072b2", {},
      {}};
  CurveSeries measured{"measured", "the same, measured", "points lw 1.2 pt 6 ps 0.9", "#56b4e9", {}, {}};
  CurveSeries both{"both_ways",
                   "free simplification (CGAL), both ways: measured",
                   "linespoints lw 1.5 pt 5 ps 0.6",
                   "#d55e00",
                   {},
                   {}};
  CurveSeries one{
      "one_way", "the same, from it to the body only: measured", "points lw 1.2 pt 4 ps 1", "#e69f00", {},
      {}};
  for (const bodies::LevelFigures& l : c.proved) proved.add(l.bound / c.size, l.faces);
  for (const ShownLevel& l : c.shown) measured.add(l.sampled / c.size, l.figures.faces);
  for (const FreeMesh& m : c.free) {
    both.add(std::max(m.to_body, m.from_body) / c.size, m.faces);
    one.add(m.to_body / c.size, m.faces);
  }
  std::vector<CurveSeries> out;
  for (CurveSeries& s : {std::ref(proved), std::ref(measured), std::ref(both), std::ref(one)})
    if (!s.faces.empty()) out.push_back(std::move(s));
  return out;
}

}  // namespace

std::vector<bodies::LevelFigures> many_levels(const LrbRep& rep, std::span<const double> shares,
                                              unsigned threads) {
  constexpr double kStep = 1.25, kBelow = 2;
  const auto [least, most] = std::minmax_element(shares.begin(), shares.end());
  std::vector<double> row(shares.begin(), shares.end());
  for (double share = *least / kBelow; share < *most; share *= kStep) row.push_back(share);
  std::sort(row.begin(), row.end());
  std::vector<bodies::LevelFigures> levels = bodies::level_figures(rep, row, threads);
  const auto same = [](const auto& a, const auto& b) { return a.bound == b.bound; };
  levels.erase(std::unique(levels.begin(), levels.end(), same), levels.end());
  return levels;
}

report::Gnuplot curve_for_print(const LevelCurve& c) {
  report::Gnuplot g;
  g.width = 130;
  g.height = 95;
  std::string plots;
  double least = 1, most = 0;
  for (const CurveSeries& s : series_of(c)) {
    std::vector<std::string> rows;
    for (std::size_t i = 0; i < s.faces.size(); ++i) {
      rows.push_back(io::number_text(s.distances[i]) + " " + io::number_text(s.faces[i]));
      least = std::min(least, s.distances[i]);
      most = std::max(most, s.distances[i]);
    }
    g.add_data(s.name, rows);
    plots += (plots.empty() ? "plot $" : ", $") + std::string(s.name) + " using 1:2 with " + s.print_style +
             " lc rgb '" + s.colour + "' title " + report::gnuplot_text(s.title);
  }
  constexpr double kRoom = 1.25;
  g.script +=
      "set logscale xy\nset xlabel " + report::gnuplot_text(kDistance) + "\nset ylabel 'faces'\n" +
      "set xrange [" + io::number_text(least / kRoom) + ":" + io::number_text(most * kRoom) + "]\n" +
      "set yrange [10:" + io::number_text(3.0 * c.real_faces) + "]\n" +
      "set key bottom left reverse Left\nset grid lc rgb '#dddddd'\nset border 3\nset tics nomirror out\n" +
      "set format y '%g'\nset format x '%g'\n" + plots + ", " + std::to_string(c.real_faces) +
      " with lines dt 3 lc rgb '#777777' title " +
      report::gnuplot_text("the body: " + std::to_string(c.real_faces) + " faces") + "\n";
  return g;
}

report::PageChart curve_for_page(const LevelCurve& c) {
  report::PageChart chart;
  chart.title = "Faces against distance";
  chart.x_label = kDistance;
  chart.y_label = "faces";
  chart.note =
      "A wrapper is off to one side only, because it encloses the body; a free mesh may cut through it, and "
      "for the same distance needs about half of the faces.";
  chart.log_x = chart.log_y = true;
  for (CurveSeries& s : series_of(c)) {
    // The page wants x ascending.
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = 0; i < s.faces.size(); ++i) points.emplace_back(s.distances[i], s.faces[i]);
    std::sort(points.begin(), points.end());
    report::PageSeries series;
    series.label = s.title;
    for (const auto& [x, y] : points) {
      series.x.push_back(x);
      series.y.push_back(y);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

}  // namespace lrb::levels
