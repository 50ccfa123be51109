#include "scenarios/bench/report/chart_page.hpp"

#include <algorithm>
#include <cstdio>

#include "render/overlay.hpp"
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
  return out + "\nbuild " + render::short_number(p.build_seconds) + " s, " +
         render::short_number(p.bytes / 1e6) + " MB; worst: question " + std::to_string(p.worst_question);
}

void add(report::PageSeries& series, const Point& p, double slowest,
         const std::function<std::string(const Point&)>& scene_of) {
  series.x.push_back(drawn_error(p));
  series.y.push_back(drawn_time(p, slowest));
  series.notes.push_back(note_of(p));
  series.targets.push_back(scene_of(p));
}

report::PageChart chart_of(const DataSet& set, PoseClass c, const std::vector<Point>& points,
                           const SeriesStyles& styles,
                           const std::function<std::string(const Point&)>& scene_of) {
  const double slowest = slowest_of(points, set.name);
  const std::vector<const Point*> here = panel(points, set.name, c);
  report::PageChart chart;
  chart.title = set.name + ", " + title(c);
  chart.x_label = "error of the contact region / diagonal";
  chart.y_label = "median, \u00b5s";
  chart.log_x = chart.log_y = chart.scatter = true;
  chart.least_x = kNoError;
  chart.most_x = 1;
  report::PageSeries best;
  best.label = "Pareto frontier";
  best.colour = "#9fb4c2";
  best.line = true;
  for (const Point* p : frontier(here)) {
    best.x.push_back(drawn_error(*p));
    best.y.push_back(p->median);
  }
  for (std::size_t i = 0; i < styles.count(); ++i) {
    report::PageSeries series;
    series.label = styles.style(i).title;
    series.colour = styles.style(i).colour;
    series.shape = styles.style(i).shape;
    for (const Point* p : here)
      if (styles.series_of(p->method) == i) add(series, *p, slowest, scene_of);
    if (!series.x.empty()) chart.series.push_back(std::move(series));
  }
  chart.series.push_back(std::move(best));
  report::PageSeries proved;
  proved.label = "off the bodies by no more than this: proved";
  proved.colour = "#0072b2";
  proved.shape = "cross";
  for (const Point* p : here)
    if (p->proved_off && *p->proved_off > 0) {
      add(proved, *p, slowest, scene_of);
      proved.x.back() = std::max(kNoError, *p->proved_off);
    }
  if (!proved.x.empty()) chart.series.push_back(std::move(proved));
  report::PageSeries failed;
  failed.label = "crash, refusal or time-out";
  failed.colour = "#d00000";
  failed.shape = "crossRot";
  for (const Point* p : here)
    if (p->failed() > 0) add(failed, *p, slowest, scene_of);
  if (!failed.x.empty()) chart.series.push_back(std::move(failed));
  return chart;
}

report::PageTable table_of_points(const std::vector<Point>& points) {
  report::PageTable t;
  t.title = "All points";
  t.columns = {"bodies", "pose", "method", "median \u00b5s", "p95", "p99"};
  for (std::size_t m = 0; m < kMetrics; ++m) t.columns.emplace_back(metric_info(static_cast<Metric>(m)).name);
  for (const char* c : {"proved off", "failed", "build s", "MB", "face tests", "frontier"})
    t.columns.emplace_back(c);
  for (const Point& p : points) {
    std::vector<std::string> row = {p.set,
                                    title(p.pose_class),
                                    name_of(p.method, p.setting),
                                    render::short_number(p.median),
                                    render::short_number(p.p95),
                                    render::short_number(p.p99)};
    for (const auto& e : p.errors) row.push_back(percent_or_dash(e));
    row.push_back(percent_or_dash(p.proved_off));
    row.push_back(std::to_string(p.failed()));
    row.push_back(render::short_number(p.build_seconds));
    row.push_back(render::short_number(p.bytes / 1e6));
    row.push_back(p.face_tests > 0 ? render::short_number(p.face_tests) : "\u2013");
    row.emplace_back(p.frontier ? "yes" : "");
    t.rows.push_back(std::move(row));
  }
  t.note =
      "A dash: the method does not answer that, or proves nothing. Proved off: what \"off\" is proved to be "
      "at most.";
  return t;
}

report::PageTable table_of_metrics() {
  report::PageTable t;
  t.title = "Errors";
  t.columns = {"name", "what it is", "worst value"};
  for (std::size_t m = 0; m < kMetrics; ++m) {
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
  page.title = "Speed against accuracy";
  page.purpose =
      "Every method at every setting of its knob, on the same bodies and poses: how long the median query "
      "takes, and "
      "how far what it calls the contact is from the exact contact.";
  page.texts = {
      {"How to read it",
       "Down is faster, left is more accurate; what has no error stands at the left end. The frontier joins "
       "what "
       "nothing beats in both. Hover for all numbers; a click leads to the scene of the panel, with its "
       "trace and "
       "pictures."},
      {"What counts as error",
       "The Hausdorff distance between the exact contact region and that of the answer, over the larger "
       "body's "
       "diagonal, averaged over poses; for methods that say only yes or no, the share of wrong ones. Contact "
       "where "
       "there is none, or none where there is, counts as one whole diagonal, and so does what is no answer."},
      {"What is proved",
       "Ours alone proves what it says. Its exact answers are off by nothing; those to a tolerance, or of "
       "a level that a budget allowed, come with a bound (a cross at the same height): where listed faces "
       "meet, the distances from the two bodies add up to no more. That is another length than the error "
       "on the axis: where surfaces graze each other, moving them by a little moves the contact by far "
       "more. Column \"off\" is the length that is proved, measured."},
  };
  const SeriesStyles styles(methods);
  for (const DataSet& set : sets)
    for (const PoseClass c : kPoseClasses) page.charts.push_back(chart_of(set, c, points, styles, scene_of));
  page.tables = {table_of_metrics(), table_of_methods(methods), table_of_points(points)};
  page.footer = report::footer();
  return page;
}

}  // namespace lrb::bench
