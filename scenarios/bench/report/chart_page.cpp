#include "scenarios/bench/report/chart_page.hpp"

#include <algorithm>
#include <cstdio>

#include "render/overlay.hpp"
#include "scenarios/bench/report/chart_words.hpp"
#include "scenarios/bench/report/series_style.hpp"

namespace lrb::bench {
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
  if (p.proved_off) out += "\nproved: off by no more than " + render::short_number(*p.proved_off);
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
  for (const char* c : {"proved off", "failed", "frontier"}) t.columns.emplace_back(c);
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
      "A dash: the method does not answer that, or proves nothing. Proved off: what \"off\" is proved to be "
      "at most, or how wide an interval of the number is.";
  return t;
}

report::PageTable table_of_metrics(const std::vector<Point>& points) {
  report::PageTable t;
  t.title = "Errors";
  t.columns = {"name", "what it is", "worst value"};
  for (const std::size_t m : errors_in(points)) {
    const MetricInfo& info = metric_info(static_cast<Metric>(m));
    t.rows.push_back({info.name, info.what, render::short_number(info.worst)});
  }
  t.note =
      "A crash, a refusal and a time-out score the worst value of every error that the method answers for.";
  return t;
}

report::PageTable table_of_methods(const std::vector<methods::MethodInfo>& methods) {
  report::PageTable t;
  t.title = "Methods";
  t.columns = {"name", "what", "how it was asked"};
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

}  // namespace lrb::bench
