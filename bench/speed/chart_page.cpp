#include "bench/speed/chart_page.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "bench/speed/series_style.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::bench {
namespace {

constexpr const char* kHowToRead =
    "Lower is faster, left is more accurate; methods without error are at the left end. The frontier joins "
    "the methods that are not beaten in both. Hover over a point for all its numbers; click it for the scene "
    "of the panel, with its trace and pictures.";

ChartWords of_pairs() {
  return {
      "Speed versus accuracy",
      "Every method at every setting, on the same bodies and poses: the time of the median query, and the "
      "distance of its contact from the exact contact.",
      "error of the contact region / diagonal",
      "proven error bound",
      {{"Reading the chart", kHowToRead},
       {"Error measure",
        "The Hausdorff distance between the exact contact region and that of the result, relative to the "
        "larger body's diagonal, averaged over poses; for methods that return only yes or no, the fraction of "
        "wrong results. A false contact, a missed contact or a missing answer counts as an error of one "
        "diagonal."},
       {"Proven bounds",
        "Only lrbscope proves its results. Its exact results have no error; those with a tolerance or a limit "
        "have a bound (a cross at the same height) on the sum of the distances of the listed intersections "
        "from the two bodies. This is not the error on the axis: at tangential contacts, a small displacement "
        "of the surfaces moves the contact by far more. Column \"off\" is the measured value of the bounded "
        "length."}}};
}

/// What counts as error, and what is proved, for one number.
struct NumberWords {
  const char *name, *purpose, *error, *judged, *proved;
};

NumberWords words_of_number(Quantity quantity) {
  if (quantity == Quantity::first_contact)
    return {
        "time of first contact",
        "B moves in a straight line, two diagonals far, past A or into it: how long each method takes to "
        "compute the time of first contact, and its error.",
        "error of the time of contact / motion",
        "The difference between the time of first contact found by a method and the true one, as a fraction "
        "of the motion, averaged over motions. A false contact, a missed contact or a missing answer counts "
        "as the whole motion. An interval counts by its later end, at which contact was found.",
        "lrbscope returns an interval: no contact before it, a contact at its end."};
  if (quantity == Quantity::depth)
    return {
        "penetration depth",
        "Two bodies that overlap: how long each method takes to compute the penetration depth, and its error.",
        "error of the depth / diagonal",
        "The distance of the depth from the interval that is proven to contain it, relative to the larger "
        "body's diagonal, averaged over poses: a lower bound of the error. An interval counts by its upper "
        "end, the length of a translation that separates the bodies. A missing answer counts as one diagonal.",
        "lrbscope returns an interval: no translation shorter than its lower end separates the bodies, and "
        "one as long as its upper end does."};
  return {"distance",
          "Two separate bodies: how long each method takes to compute their distance, and its error.",
          "error of the distance / diagonal",
          "The difference between the distance found by a method and the true one, relative to the larger "
          "body's diagonal, averaged over poses. An interval counts by its upper end, the distance of two "
          "points found. A missing answer counts as one diagonal.",
          "lrbscope returns an interval that contains the distance, at every tolerance and within every "
          "limit."};
}

ChartWords of_number(Quantity quantity) {
  const NumberWords n = words_of_number(quantity);
  return {
      std::string("Speed versus accuracy: ") + n.name,
      n.purpose,
      n.error,
      "proven width of the interval",
      {{"Reading the chart", kHowToRead},
       {"Error measure",
        std::string(n.judged) +
            " The reference is lrbscope's own proven interval at its finest setting, which the command "
            "stability --quantity checks against rational arithmetic on small bodies."},
       {"Proven bounds",
        std::string(n.proved) +
            " Its width, in the unit of the error, is a cross at the same height and bounds the error. Other "
            "methods prove nothing."}}};
}

}  // namespace

ChartWords chart_words(Quantity quantity) {
  return quantity == Quantity::pairs ? of_pairs() : of_number(quantity);
}

namespace {

std::string percent_or_dash(const std::optional<double>& x) {
  return x ? render::short_number(*x) : "\u2013";
}

/// Returns what the page says about a point when the mouse is over it, line by line.
std::string note_of(const Point& p) {
  std::string out = name_of(p.method, p.setting) + "\nmedian " + render::short_number(p.median) +
                    " \u00b5s, p95 " + render::short_number(p.p95) + ", p99 " + render::short_number(p.p99);
  for (std::size_t m = 0; m < kMetrics; ++m)
    if (p.errors[m] && *p.errors[m] > 0)
      out += std::string("\n") + metric_info(static_cast<Metric>(m)).name + " " +
             render::short_number(*p.errors[m]);
  if (p.error() <= 0) out += "\nno error";
  if (p.proved_off) out += "\nproven error bound " + render::short_number(*p.proved_off);
  if (p.failed() > 0)
    out += "\n" + std::to_string(p.crashed) + " crashed, " + std::to_string(p.timed_out) + " timed out, " +
           std::to_string(p.refused) + " refused, of " + std::to_string(p.questions);
  if (p.build_seconds > 0)
    out += "\nbuild " + render::short_number(p.build_seconds) + " s, " + render::short_number(p.bytes / 1e6) +
           " MB";
  return out + "\nworst: question " + std::to_string(p.worst_question);
}

void add(report::PageSeries& series, const Point& p, double error, double slowest,
         const std::function<std::string(const Point&)>& scene_of) {
  series.x.push_back(error);
  series.y.push_back(drawn_time(p, slowest));
  series.notes.push_back(note_of(p));
  series.targets.push_back(scene_of(p));
}

report::PageSeries series_of(const char* colour, const char* shape, std::string label) {
  report::PageSeries series;
  series.label = std::move(label);
  series.colour = colour;
  series.shape = shape;
  return series;
}

report::PageSeries frontier_series(const std::vector<const Point*>& panel, Quantity quantity) {
  report::PageSeries best = series_of("#9fb4c2", "", "Pareto frontier");
  best.line = true;
  for (const Point* p : frontier(panel)) {
    best.x.push_back(drawn_error(p->error(), quantity));
    best.y.push_back(p->median);
  }
  return best;
}

report::PageChart chart_of(const DataSet& set, PoseClass c, const std::vector<Point>& points,
                           const SeriesStyles& styles,
                           const std::function<std::string(const Point&)>& scene_of) {
  const double slowest = slowest_of(points, set.name);
  const std::vector<const Point*> here = panel(points, set.name, c);
  const ChartWords words = chart_words(set.quantity);
  report::PageChart chart;
  chart.title = set.name + ", " + title(c);
  chart.x_label = words.error;
  chart.y_label = "median, \u00b5s";
  chart.log_x = chart.log_y = chart.scatter = true;
  chart.least_x = no_error(set.quantity);
  chart.most_x = 1;
  const auto add_series = [&](report::PageSeries series, auto takes, auto error) {
    for (const Point* p : here)
      if (takes(*p)) add(series, *p, drawn_error(error(*p), set.quantity), slowest, scene_of);
    if (!series.x.empty()) chart.series.push_back(std::move(series));
  };
  const auto error = [](const Point& p) { return p.error(); };
  for (std::size_t i = 0; i < styles.count(); ++i) {
    const methods::MethodStyle& style = styles.style(i);
    add_series(
        series_of(style.colour.c_str(), style.shape.c_str(), style.title),
        [&](const Point& p) { return styles.series_of(p.method) == i; }, error);
  }
  chart.series.push_back(frontier_series(here, set.quantity));
  add_series(
      series_of("#0072b2", "cross", words.proved),
      [](const Point& p) { return p.proved_off.value_or(0) > 0; },
      [](const Point& p) { return *p.proved_off; });
  add_series(
      series_of("#d00000", "crossRot", "crash, refusal or time-out"),
      [](const Point& p) { return p.failed() > 0; }, error);
  return chart;
}

/// Returns the errors that some method answers for.
std::vector<std::size_t> errors_in(const std::vector<Point>& points) {
  std::vector<std::size_t> out;
  for (std::size_t m = 0; m < kMetrics; ++m)
    if (std::any_of(points.begin(), points.end(), [&](const Point& p) { return p.errors[m].has_value(); }))
      out.push_back(m);
  return out;
}

report::PageTable table_of_points(const std::vector<Point>& points) {
  report::PageTable t;
  t.title = "All points";
  t.columns = {"bodies", "pose", "method", "median \u00b5s", "p95", "p99"};
  const std::vector<std::size_t> errors = errors_in(points);
  const bool built =
      std::any_of(points.begin(), points.end(), [](const Point& p) { return p.build_seconds > 0; });
  for (const std::size_t m : errors) t.columns.emplace_back(metric_info(static_cast<Metric>(m)).name);
  for (const char* c : {"proven bound", "failed", "frontier"}) t.columns.emplace_back(c);
  if (built) t.columns.insert(t.columns.end(), {"build s", "MB", "face tests"});
  for (const Point& p : points) {
    std::vector<std::string> row = {p.set,
                                    title(p.pose_class),
                                    name_of(p.method, p.setting),
                                    render::short_number(p.median),
                                    render::short_number(p.p95),
                                    render::short_number(p.p99)};
    for (const std::size_t m : errors) row.push_back(percent_or_dash(p.errors[m]));
    row.push_back(percent_or_dash(p.proved_off));
    row.push_back(std::to_string(p.failed()));
    row.emplace_back(p.frontier ? "yes" : "");
    if (built) {
      row.push_back(render::short_number(p.build_seconds));
      row.push_back(render::short_number(p.bytes / 1e6));
      row.push_back(p.face_tests > 0 ? render::short_number(p.face_tests) : "\u2013");
    }
    t.rows.push_back(std::move(row));
  }
  t.note =
      "A dash: the method does not report this, or proves nothing. Proven bound: the proven maximum of "
      "\"off\", or the width of the interval.";
  return t;
}

report::PageTable table_of_metrics(const std::vector<Point>& points) {
  report::PageTable t;
  t.title = "Errors";
  t.columns = {"name", "definition", "worst value"};
  for (const std::size_t m : errors_in(points)) {
    const MetricInfo& info = metric_info(static_cast<Metric>(m));
    t.rows.push_back({info.name, info.what, render::short_number(info.worst)});
  }
  t.note =
      "A crash, a refusal or a time-out counts as the worst value of each error that the method is judged by.";
  return t;
}

report::PageTable table_of_methods(const std::vector<methods::MethodInfo>& methods) {
  report::PageTable t;
  t.title = "Methods";
  t.columns = {"name", "what", "usage"};
  for (const methods::MethodInfo& m : methods)
    t.rows.push_back({m.name, m.title + (m.present ? "" : " (absent)"), m.remark});
  return t;
}

}  // namespace

report::Page accuracy_page(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                           const std::vector<methods::MethodInfo>& methods,
                           const std::function<std::string(const Point&)>& scene_of) {
  report::Page page;
  ChartWords words = chart_words(sets.front().quantity);
  page.title = std::move(words.title);
  page.purpose = std::move(words.purpose);
  page.texts = std::move(words.texts);
  const SeriesStyles styles(methods);
  for (const DataSet& set : sets)
    for (const PoseClass c : classes_of(set.quantity))
      page.charts.push_back(chart_of(set, c, points, styles, scene_of));
  page.tables = {table_of_metrics(points), table_of_methods(methods), table_of_points(points)};
  page.footer = report::footer();
  return page;
}

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
