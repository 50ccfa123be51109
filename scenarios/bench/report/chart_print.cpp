#include "scenarios/bench/report/chart_print.hpp"

#include <algorithm>
#include <utility>

#include "scenarios/bench/report/chart_words.hpp"
#include "scenarios/bench/report/series_style.hpp"
#include "scenarios/io/number_text.hpp"

namespace lrb::bench {
namespace {

constexpr double kPanelWidth = 50, kPanelHeight = 46, kLeft = 19, kTop = 7, kBottom = 12,
                 kKeyHeight = 16;  // mm
constexpr const char* kProvedPoint = "pt 1 ps 0.5 lw 0.9 lc rgb '#0072b2'";

std::string style_text(const methods::MethodStyle& s, double size) {
  return " lc rgb '" + s.colour + "' pt " + std::to_string(s.point) + " ps " + io::number_text(size);
}

/// Sizes of the whole, in millimetres from the lower left corner.
struct Layout {
  double width, height;
  std::string margins(double x0, double x1, double y0, double y1) const {
    return "set lmargin at screen " + io::number_text(x0 / width) + "\nset rmargin at screen " +
           io::number_text(x1 / width) + "\nset bmargin at screen " + io::number_text(y0 / height) +
           "\nset tmargin at screen " + io::number_text(y1 / height) + "\n";
  }
};

/// One panel: faint points, the frontier over them, and crosses where something failed.
std::string plots_of(report::Gnuplot& chart, const SeriesStyles& styles, const std::string& id,
                     const std::vector<const Point*>& panel, Quantity quantity, double slowest) {
  std::vector<std::vector<std::string>> rows(styles.count());
  std::vector<std::string> failed, best, proved;
  std::string last;
  for (const Point* p : panel) {
    const double error = drawn_error(p->error(), quantity);
    const std::string at = io::number_text(error) + " " + io::number_text(drawn_time(*p, slowest));
    if (styles.series_of(p->method) == styles.count()) continue;
    std::vector<std::string>& r = rows[styles.series_of(p->method)];
    if (!r.empty() && !(p->setting && p->method == last))
      r.emplace_back();  // a gap, so that no line joins
                         // two methods
    r.push_back(at);
    last = p->method;
    if (p->failed() > 0) failed.push_back(at);
    if (p->proved_off && *p->proved_off > 0)
      proved.push_back(at + " " + io::number_text(drawn_error(*p->proved_off, quantity) - error));
  }
  for (const Point* p : frontier(panel))
    best.push_back(io::number_text(drawn_error(p->error(), quantity)) + " " + io::number_text(p->median));
  std::string plots;
  const auto add = [&](const std::string& name, const std::vector<std::string>& data,
                       const std::string& how) {
    if (data.empty()) return;
    chart.add_data(name, data);
    plots += (plots.empty() ? "plot $" : ", $") + name + " using 1:2 with " + how;
  };
  add(id + "best", best, "steps lw 2.2 lc rgb '#c9d6df'");
  for (std::size_t i = 0; i < rows.size(); ++i)
    add(id + "m" + std::to_string(i), rows[i],
        "linespoints lw 0.6" + style_text(styles.style(i), i == 0 ? 0.75 : 0.5));
  if (!proved.empty()) {
    chart.add_data(id + "proved", proved);
    plots += ", $" + id + "proved using 1:2:3:(0) with vectors nohead lw 0.5 dt 3 lc rgb '#0072b2', $" + id +
             "proved using ($1+$3):2 with points " + kProvedPoint;
  }
  add(id + "failed", failed, "points pt 2 ps 0.9 lw 1.6 lc rgb '#d00000'");
  return plots.empty() ? "" : plots + "\n";
}

std::string key_of(report::Gnuplot& chart, const SeriesStyles& styles, const Layout& layout,
                   Quantity quantity) {
  const auto n = static_cast<int>(styles.count()) + 3;
  const auto columns = static_cast<int>(classes_of(quantity).size());
  const int lines = (n + columns - 1) / columns;
  std::string out =
      layout.margins(2, layout.width - 2, 1, kKeyHeight - 1) +
      "unset border\nunset tics\nunset title\nunset xlabel\nunset ylabel\nunset logscale\nunset grid\n"
      "set xrange [0:" +
      std::to_string(columns) + "]\nset yrange [0:" + std::to_string(lines) + "]\n";
  std::vector<std::string> titles;
  std::string plots;
  for (int i = 0; i < n; ++i) {
    const double x = i / lines, y = lines - 0.5 - i % lines;
    const std::string name = "key" + std::to_string(i);
    const auto k = static_cast<std::size_t>(i);
    const bool frontier = k == styles.count(), failed = k == styles.count() + 1,
               proved = k == styles.count() + 2;
    std::vector<std::string> at = {io::number_text(x + 0.05) + " " + io::number_text(y)};
    if (frontier) at.push_back(io::number_text(x + 0.09) + " " + io::number_text(y));
    chart.add_data(name, at);
    plots += (i == 0 ? "plot $" : ", $") + name + " using 1:2 with " +
             (frontier ? std::string("lines lw 2.2 lc rgb '#c9d6df'")
              : failed ? std::string("points pt 2 ps 0.9 lw 1.6 lc rgb '#d00000'")
              : proved ? std::string("points ") + kProvedPoint
                       : "points" + style_text(styles.style(k), 0.75));
    titles.push_back(io::number_text(x + 0.11) + " " + io::number_text(y) + " " +
                     report::gnuplot_data_text(frontier ? "Pareto frontier"
                                               : failed ? "crash, refusal or time-out: the worst"
                                               : proved ? chart_words(quantity).proved
                                                        : styles.style(k).title));
  }
  chart.add_data("titles", titles);
  return out + plots + ", $titles using 1:2:3 with labels left\n";
}

/// Sets the x axis of a panel, which is labelled in the last row.
std::string x_axis(Quantity quantity, bool labelled) {
  const std::vector<std::pair<const char*, const char*>> ticks =
      quantity == Quantity::pairs
          ? std::vector<std::pair<const char*, const char*>>{{"0", "1e-7"},
                                                             {"1e-5", "1e-5"},
                                                             {"1e-3", "1e-3"},
                                                             {"0.1", "0.1"},
                                                             {"1", "1"}}
          : std::vector<std::pair<const char*, const char*>>{
                {"0", "1e-14"}, {"1e-10", "1e-10"}, {"1e-6", "1e-6"}, {"0.01", "0.01"}, {"1", "1"}};
  std::string out;
  for (const auto& [label, at] : ticks)
    out += (out.empty() ? "set xtics ('" : ", '") + std::string(labelled ? label : "") + "' " + at;
  const std::string label = report::gnuplot_text(chart_words(quantity).error);
  return (labelled ? "set xlabel " + label + " offset 0,0.2\n" : "unset xlabel\n") + out + ") nomirror\n";
}

}  // namespace

report::Gnuplot accuracy_chart(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                               const std::vector<methods::MethodInfo>& methods) {
  const SeriesStyles styles(methods);
  const Quantity quantity = sets.front().quantity;
  const auto classes = classes_of(quantity);
  const auto rows = static_cast<double>(sets.size());
  const Layout layout{kLeft + static_cast<double>(classes.size()) * kPanelWidth + 3,
                      kTop + rows * kPanelHeight + kBottom + kKeyHeight};
  report::Gnuplot chart;
  chart.width = layout.width;
  chart.height = layout.height;
  chart.font = 6.5;
  std::string plots;
  for (std::size_t row = 0; row < sets.size(); ++row) {
    const double slowest = slowest_of(points, sets[row].name);
    for (std::size_t column = 0; column < classes.size(); ++column) {
      const auto here = panel(points, sets[row].name, classes[column]);
      const double x0 = kLeft + static_cast<double>(column) * kPanelWidth;
      const double y1 = layout.height - kTop - static_cast<double>(row) * kPanelHeight;
      plots += layout.margins(x0, x0 + kPanelWidth - 2, y1 - kPanelHeight + 3, y1);
      plots += row == 0 ? "set title " + report::gnuplot_text(title(classes[column])) + " offset 0,-0.6\n"
                        : "unset title\n";
      plots += x_axis(quantity, row + 1 == sets.size());
      plots += column == 0 ? "set ylabel " + report::gnuplot_text(sets[row].name + ": median, µs") +
                                 " offset 0.4,0\nset ytics 10 format '%g' nomirror\n"
                           : "unset ylabel\nset ytics 10 format '' nomirror\n";
      plots += "set yrange [0.05:" + io::number_text(6 * slowest) + "]\n";
      plots += plots_of(chart, styles, "r" + std::to_string(row) + "c" + std::to_string(column), here,
                        quantity, slowest);
    }
  }
  chart.script +=
      "set multiplot\nunset key\nset border 3 lw 0.6 lc rgb '#8a8f95'\nset logscale xy\nset xrange [" +
      io::number_text(0.3 * no_error(quantity)) + ":3]\nset grid lw 0.4 lc rgb '#e2e4e6' dt 1\n" + plots +
      key_of(chart, styles, layout, quantity) + "unset multiplot\n";
  return chart;
}

}  // namespace lrb::bench
