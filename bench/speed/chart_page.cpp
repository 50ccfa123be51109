#include "bench/speed/chart_page.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <utility>

#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::speed {
namespace {

/// The texts of charts, by the queried quantity.
struct ChartText {
  std::string title, purpose;
  std::string error;   ///< for the axis
  std::string proved;  ///< in the key: the meaning of a cross; empty: no proof bounds the error on the axis
  std::vector<report::Text> texts;
};

constexpr const char* kHowToRead =
    "Down is faster, left is more accurate; an error of 0 is at the left end. The tooltip of a point has all of its numbers; a "
    "click leads to the panel's scene, with trace and pictures.";
constexpr const char* kTimes =
    "The time of a query in a round is the shortest of up to 26 runs, with warm caches; cold times, in the table and in "
    "tooltips, are of the first run, after caches were overwritten. Each round times all methods, one after the other. A point "
    "is the median over rounds of the median over queries; its bar spans the rounds.";
constexpr const char* kFrontier =
    "The Pareto frontier joins the points that none beats: a point beats another if it is as accurate, and faster in every round "
    "than the other in any. Points that are as accurate and whose bars overlap are too close to call; the line passes "
    "through the best of them, and the table lists them. Methods that are wrong in every case are no points; those that answer "
    "only yes or no, or that know earlier poses, are points, but not on the frontier. Each panel names what it leaves out.";

constexpr const char* kAllSets = "all bodies";

/// `judged`: the definition of the error; `proved`: that of the interval.
ChartText of_number(const char* name, const char* purpose, const char* error, const std::string& judged,
                    const std::string& proved) {
  return {
      std::string("Speed versus accuracy: ") + name,
      purpose,
      error,
      "width of the interval: proven",
      {{"Error",
        judged +
            " The true number is lrbscope's certified interval at its finest setting, which `lrbscope stability "
            "--quantity` checks against rational arithmetic on small bodies."},
       {"Proof",
        proved +
            " Its width, in the unit of the error, is a cross at the same height: an upper bound of the error. "
            "Other methods prove nothing."}}};
}

/// The texts that differ between quantities.
ChartText own_text(Quantity quantity) {
  if (quantity == Quantity::near_pairs)
    return {
        "Speed versus accuracy: near pairs",
        "All pairs of triangles within a distance of 0.1, 1 or 5 % of the larger body's diagonal. B is half that distance away: "
        "time of a query, and error of the list.",
        "error of the list or distances",
        "width of the widest interval: proven",
        {{"Error",
          "The pairs that are missing or extra, as a share of all listed and all near ones, or the largest error of a listed "
          "distance over the larger body's diagonal, whichever is larger; averaged over poses. The table has each: list, recall "
          "(missing), precision (extra), distance. An interval counts by its upper end. Errors of distances below 1e-14 count as 0. "
          "A missing answer counts as 1. The right list is by exact predicates for all pairs with boxes within the distance, right distances by integers."},
         {"Proof",
          "lrbscope reports an interval that contains the distance of each pair; its list is exact. The width of the widest "
          "interval is a cross at the same height. Other methods prove nothing."}}};
  if (quantity == Quantity::first_contact)
    return of_number(
        "time of first contact",
        "B moves in a straight line, two diagonals far, past A or into it: time of a query, and error of the time of impact.",
        "error of the time of contact / motion",
        "The difference of the time of impact from the true one, as a share of the motion, averaged over motions. A contact "
        "reported as none, or the reverse, counts as the whole motion, and so does a missing answer. An interval counts by "
        "its upper end, at which contact was found.",
        "lrbscope reports an interval: no contact before it, contact at its end.");
  if (quantity == Quantity::depth)
    return of_number(
        "penetration depth", "Two overlapping bodies: time of a query, and error of the penetration depth.",
        "error of the depth / diagonal",
        "The distance of the depth from the interval that is known to contain it, over the larger body's diagonal, averaged "
        "over poses: a lower bound of the error. An interval counts by its upper end, the length of a separating "
        "translation. A missing answer counts as one diagonal.",
        "lrbscope reports an interval: no translation shorter than its lower end separates the bodies, one as long as its "
        "upper end does.");
  if (quantity == Quantity::distance)
    return of_number(
        "distance", "Two separate bodies: time of a query, and error of the distance.",
        "error of the distance / diagonal",
        "The difference of the distance from the true one, over the larger body's diagonal, averaged over poses. An interval "
        "counts by its upper end, the distance of two points that were found. A missing answer counts as one diagonal.",
        "lrbscope reports an interval that contains the distance, at every tolerance and within every budget.");
  return {
      "Speed against accuracy",
      "Every method at every setting of its parameter, on the same bodies and poses: median time of a query, and deviation of "
      "the reported contact from the exact one.",
      "error of the contact region / diagonal",
      "",
      {{"Error",
        "The Hausdorff distance between the exact and the reported contact region, over the larger body's diagonal, "
        "averaged over poses; for methods with boolean answers, the share of wrong ones. A false contact, a missed one and a "
        "missing answer count as one diagonal each."},
       {"Proof",
        "Only lrbscope proves its answers. Exact ones have no deviation; approximate ones come with a bound on "
        "the sum of the distances from both bodies where listed faces intersect: column \"proven bound\", beside the measured "
        "deviation, column \"off\". It does not bound the error on the axis: at a tangential contact, a small deviation "
        "moves the contact far."}}};
}

ChartText chart_text(Quantity quantity) {
  ChartText out = own_text(quantity);
  out.texts.insert(out.texts.begin(), {{"Axes", kHowToRead}, {"Times", kTimes}, {"Frontier", kFrontier}});
  return out;
}

}  // namespace

std::vector<const Point*> panel(const std::vector<Point>& points, const std::string& set, PoseClass c) {
  std::vector<const Point*> out;
  for (const Point& p : points)
    if (p.set == set && p.pose_class == c) out.push_back(&p);
  return out;
}

namespace {

std::string percent_or_dash(const std::optional<double>& x) {
  return x ? render::short_number(*x) : "\u2013";
}

/// Returns a time with the span of its rounds: "4.2 (4.1 to 4.6)".
std::string span_text(double time, double least, double most) {
  std::string out = render::short_number(time);
  if (least < most) out += " (" + render::short_number(least) + " to " + render::short_number(most) + ")";
  return out;
}

/// Returns the point's place on the frontier: "yes", "too close to ours-floating", "no" or why it is left
/// out.
std::string frontier_text(const Point& p) {
  if (!p.left_out.empty()) return "left out: " + p.left_out;
  if (p.frontier) return "yes";
  std::string out;
  for (const std::string& name : p.ties) out += (out.empty() ? "too close to " : ", ") + name;
  return out.empty() ? "no" : out;
}

/// Returns the tooltip of a point, with its line breaks.
std::string note_of(const Point& p) {
  std::string out =
      name_of(p.method, p.setting) + "\nmedian " + span_text(p.median, p.least, p.most) + " \u00b5s";
  if (p.set == kAllSets) return out + ", largest error " + render::short_number(p.error());
  out += ", p95 " + render::short_number(p.p95) + ", p99 " + render::short_number(p.p99) + "\ncold " +
         span_text(p.cold, p.cold_least, p.cold_most) + " \u00b5s";
  for (std::size_t m = 0; m < kMetrics; ++m)
    if (p.errors[m] && *p.errors[m] > 0)
      out += std::string("\n") + metric_info(static_cast<Metric>(m)).name + " " +
             render::short_number(*p.errors[m]);
  if (p.error() <= 0) out += "\nno error";
  if (p.proven_deviation) out += "\nproven max deviation " + render::short_number(*p.proven_deviation);
  if (p.failed() > 0)
    out += "\n" + std::to_string(p.crashed) + " crashed, " + std::to_string(p.timed_out) + " timed out, " +
           std::to_string(p.rejected) + " refused, of " + std::to_string(p.questions);
  if (p.build_seconds > 0)
    out += "\nbuild " + render::short_number(p.build_seconds) + " s, " + render::short_number(p.bytes / 1e6) +
           " MB";
  return out + "\nfrontier: " + frontier_text(p) + "\nworst: question " + std::to_string(p.worst_question);
}

/// Styles for methods that define none, assigned in turn. They differ from the styles of lrbscope's methods.
constexpr std::array<std::pair<const char*, const char*>, 8> kSpares = {{
    {"#2f4b7c", "triangle"},
    {"#f95d6a", "rectRot"},
    {"#4f7942", "star"},
    {"#8f5bd9", "cross"},
    {"#c04000", "rectOpen"},
    {"#00798c", "rect"},
    {"#a0522d", "circle"},
    {"#b0006d", "crossRot"},
}};

/// Returns the styles of a chart's series, one for each title in the methods' own styles (variants of
/// lrbscope and engines of one project may share a title). A method without a style gets its own series under
/// its name, with a spare colour and shape, distinct as long as there are enough.
std::vector<methods::MethodStyle> styles_of(const std::vector<methods::MethodInfo>& methods,
                                            std::map<std::string, std::size_t>& series_of) {
  std::vector<methods::MethodStyle> out;
  std::size_t spares = 0;
  for (const methods::MethodInfo& m : methods) {
    methods::MethodStyle style = m.style;
    if (style.title.empty()) {
      const auto& [colour, shape] = kSpares[spares++ % kSpares.size()];
      style = {m.name, colour, shape};
    }
    const auto same =
        std::ranges::find_if(out, [&](const methods::MethodStyle& s) { return s.title == style.title; });
    series_of[m.name] = static_cast<std::size_t>(same - out.begin());
    if (same == out.end()) out.push_back(std::move(style));
  }
  return out;
}

/// Returns the value at which a zero error is drawn on a logarithmic axis. Numbers are known to about 1e-12.
double no_error(Quantity quantity) {
  return quantity == Quantity::pairs ? 1e-7 : 1e-14;
}
double drawn_error(double error, Quantity quantity) {
  return std::max(error, no_error(quantity));
}

/// Points without any answer are drawn above all others of their panel.
double drawn_time(const Point& p, double slowest) {
  constexpr double kAbove = 3;
  return p.median > 0 ? p.median : kAbove * slowest;
}

/// Returns the slowest median of all panels, which have the same axes.
double slowest_of(const std::vector<Point>& points) {
  double slowest = 1;
  for (const Point& p : points) slowest = std::max(slowest, p.median);
  return slowest;
}

/// Returns a panel's frontier, from exact to coarse. Of points that are too close to call, it contains those
/// whose medians are beaten by none.
std::vector<const Point*> frontier(const std::vector<const Point*>& panel) {
  std::vector<const Point*> all, out;
  for (const Point* p : panel)
    if (p->frontier || !p->ties.empty()) all.push_back(p);
  std::ranges::sort(all, [](const Point* p, const Point* q) {
    return p->error() != q->error() ? p->error() < q->error() : p->median < q->median;
  });
  for (const Point* p : all)
    if (out.empty() || p->median < out.back()->median) out.push_back(p);
  return out;
}

/// Returns a sentence that names the points that are not drawn, and those left out of the frontier.
/// Reasons that hold in all panels are only in the first chart.
std::string left_out_text(const std::vector<const Point*>& panel) {
  std::map<std::string, std::string> by_reason;
  for (const Point* p : panel)
    if (!p->left_out.empty() && (p->set == kAllSets || !(p->median > 0) || p->always_wrong)) {
      std::string& names = by_reason[p->left_out];
      names += (names.empty() ? "" : ", ") + name_of(p->method, p->setting);
    }
  std::string out;
  for (const auto& [reason, names] : by_reason)
    out += (out.empty() ? "Not on the frontier. " : " ") +
           std::string(1, static_cast<char>(std::toupper(reason[0]))) + reason.substr(1) + ": " + names + ".";
  return out;
}

/// Returns a logarithmic axis with ticks at these powers of ten.
report::Axis decades(const std::string& label, double min, double max, const std::vector<int>& exponents) {
  report::Axis axis{label, true, min, max};
  for (const int e : exponents) axis.ticks.push_back({std::pow(10, e), report::power_label(e)});
  return axis;
}

report::Axis error_axis(Quantity quantity, const std::string& label) {
  const double zero = no_error(quantity);
  report::Axis axis =
      decades(label, 0.3 * zero, 3,
              quantity == Quantity::pairs ? std::vector{-5, -3, -1, 0} : std::vector{-10, -6, -2, 0});
  axis.ticks.insert(axis.ticks.begin(), {zero, "0"});
  return axis;
}

report::Axis time_axis(double slowest) {
  constexpr double kRoom = 6;  // above the slowest
  std::vector<int> exponents;
  for (int e = -1; std::pow(10, e) <= kRoom * slowest; ++e) exponents.push_back(e);
  return decades("median, \u00b5s", 0.05, kRoom * slowest, exponents);
}

report::Chart chart_of(const DataSet& set, PoseClass c, const std::vector<Point>& points,
                       const std::vector<methods::MethodInfo>& methods,
                       const std::function<std::string(const Point&)>& scene_of) {
  const double slowest = slowest_of(points);
  const std::vector<const Point*> current = panel(points, set.name, c);
  const ChartText words = chart_text(set.quantity);
  report::Chart chart{set.name + ", " + info_of(c).title, error_axis(set.quantity, words.error),
                      time_axis(slowest)};
  chart.note = left_out_text(current);
  const auto add = [&](report::Series& series, const Point& p, double error) {
    series.x.push_back(drawn_error(error, set.quantity));
    series.y.push_back(drawn_time(p, slowest));
    series.low.push_back(p.median > 0 ? p.least : series.y.back());
    series.high.push_back(p.median > 0 ? p.most : series.y.back());
    series.notes.push_back(note_of(p));
    series.targets.push_back(scene_of(p));
  };
  report::Series best{"Pareto frontier", {}, {}, {report::Line::steps, "#9fb4c2", "none"}};
  for (const Point* p : frontier(current)) {
    best.x.push_back(drawn_error(p->error(), set.quantity));
    best.y.push_back(p->median);
  }
  chart.series.push_back(std::move(best));
  // A line connects the settings of a method.
  std::map<std::string, std::size_t> series_of;
  const std::vector<methods::MethodStyle> styles = styles_of(methods, series_of);
  for (std::size_t i = 0; i < styles.size(); ++i) {
    const methods::MethodStyle& style = styles[i];
    std::string last;
    for (const Point* p : current) {
      if (const auto it = series_of.find(p->method); it == series_of.end() || it->second != i) continue;
      if (p->always_wrong) continue;  // named, not drawn
      const report::Line line = p->setting ? report::Line::straight : report::Line::none;
      const std::string label = last.empty() ? style.title : "";
      if (p->method != last || !p->setting)
        chart.series.push_back({label, {}, {}, {line, style.colour, style.shape}});
      add(chart.series.back(), *p, p->error());
      last = p->method;
    }
  }
  report::Series proved{words.proved, {}, {}, {report::Line::none, "#0072b2", "cross"}};
  report::Series failed{"crash, refusal or time-out", {}, {}, {report::Line::none, "#d00000", "crossRot"}};
  for (const Point* p : current) {
    if (p->always_wrong) continue;
    if (p->failed() > 0) add(failed, *p, p->error());
    if (words.proved.empty() || p->proven_deviation.value_or(0) <= 0) continue;
    add(proved, *p, *p->proven_deviation);
    proved.from.push_back(drawn_error(p->error(), set.quantity));
  }
  for (report::Series* s : {&proved, &failed})
    s->low.clear(), s->high.clear();  // those of the points are drawn
  for (report::Series* s : {&proved, &failed})
    if (!s->x.empty()) chart.series.push_back(std::move(*s));
  return chart;
}

constexpr int kCsvDigits = 6;

/// Returns the errors that at least one method provides.
std::vector<std::size_t> errors_in(const std::vector<Point>& points) {
  std::vector<std::size_t> out;
  for (std::size_t m = 0; m < kMetrics; ++m)
    if (std::ranges::any_of(points, [&](const Point& p) { return p.errors[m].has_value(); }))
      out.push_back(m);
  return out;
}

report::Table table_of_points(const std::vector<Point>& points) {
  report::Table t{"All points", {"bodies", "pose", "method", "median \u00b5s", "p95", "p99", "cold \u00b5s"}};
  const std::vector<std::size_t> errors = errors_in(points);
  const bool built = std::ranges::any_of(points, [](const Point& p) { return p.build_seconds > 0; });
  for (const std::size_t m : errors) t.columns.emplace_back(metric_info(static_cast<Metric>(m)).name);
  for (const char* c : {"proven bound", "failed", "frontier"}) t.columns.emplace_back(c);
  if (built) t.columns.insert(t.columns.end(), {"build s", "MB", "face tests"});
  for (const Point& p : points) {
    std::vector<std::string> row = {p.set,
                                    info_of(p.pose_class).title,
                                    name_of(p.method, p.setting),
                                    span_text(p.median, p.least, p.most),
                                    render::short_number(p.p95),
                                    render::short_number(p.p99),
                                    span_text(p.cold, p.cold_least, p.cold_most)};
    for (const std::size_t m : errors) row.push_back(percent_or_dash(p.errors[m]));
    row.push_back(percent_or_dash(p.proven_deviation));
    row.push_back(std::to_string(p.failed()));
    row.push_back(frontier_text(p));
    if (built) {
      row.push_back(render::short_number(p.build_seconds));
      row.push_back(render::short_number(p.bytes / 1e6));
      row.push_back(p.face_tests > 0 ? render::short_number(p.face_tests) : "\u2013");
    }
    t.rows.push_back(std::move(row));
  }
  t.note =
      "A dash: not reported, or not proven. Proven bound: of \"off\", or the width of the number's interval.";
  return t;
}

/// A method at a setting, over all classes of poses of a data set.
struct Setting {
  std::string name;
  double error = 0;  ///< the largest
  double time = 0;   ///< the geometric mean over the classes
};

/// Returns the settings with answers that may be on a frontier in every class. `ours`: only of lrbscope.
std::vector<Setting> settings_of(const DataSet& set, const std::vector<Point>& points,
                                 const std::vector<methods::MethodInfo>& methods, bool ours) {
  struct Answers {
    double error = 0;
    std::vector<double> times;  ///< (classes)
  };
  std::map<std::string, Answers> all;
  for (const Point& p : points) {
    const auto info = std::ranges::find(methods, p.method, &methods::MethodInfo::name);
    if (p.set != set.name || !p.left_out.empty() || info == methods.end()) continue;
    if (ours && info->role != methods::Role::ours && info->role != methods::Role::ours_other) continue;
    Answers& s = all[name_of(p.method, p.setting)];
    s.error = std::max(s.error, p.error());
    s.times.push_back(p.median);
  }
  std::vector<Setting> out;
  for (const auto& [name, s] : all)
    if (s.times.size() == classes_of(set.quantity).size())
      out.push_back({name, s.error, geometric_mean(s.times)});
  return out;
}

report::Table table_of_metrics(const std::vector<Point>& points) {
  report::Table t{"Errors", {"name", "definition", "worst value"}};
  for (const std::size_t m : errors_in(points)) {
    const MetricInfo& info = metric_info(static_cast<Metric>(m));
    t.rows.push_back({info.name, info.what, render::short_number(info.worst)});
  }
  t.note = "A crash, a refusal and a time-out score the worst value of every error that the method reports.";
  return t;
}

report::Table table_of_methods(const std::vector<methods::MethodInfo>& methods) {
  report::Table t{"Methods", {"name", "title", "how it is called"}};
  for (const methods::MethodInfo& m : methods)
    t.rows.push_back({m.name, m.title + (m.present ? "" : " (absent)"), m.remark});
  return t;
}

}  // namespace

std::string drawn_csv(const std::vector<Point>& points) {
  report::Table t{
      "",
      {"bodies", "pose", "method", "setting", "error", "proven", "us", "us_least", "us_most", "frontier"}};
  for (const Point& p : points) {
    if (p.always_wrong) continue;
    std::vector<std::string>& row = t.rows.emplace_back();
    row = {p.set,
           std::string(name_of(p.pose_class)),
           p.method,
           p.setting ? io::number_text(*p.setting, kCsvDigits) : "",
           io::number_text(p.error(), kCsvDigits),
           p.proven_deviation ? io::number_text(*p.proven_deviation, kCsvDigits) : ""};
    for (const double us : {p.median, p.least, p.most})
      row.push_back(p.median > 0 ? io::number_text(us, kCsvDigits) : "");
    row.push_back(frontier_text(p));
  }
  return report::csv(t);
}

report::Table table_of_settings(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                                const std::vector<methods::MethodInfo>& methods) {
  constexpr double kBounds[] = {0.1, 0.01, 0.001, 1e-6, 1e-12};
  report::Table t{"Which setting for an error of at most x?",
                  {"bodies", "faces", "error", "fastest", "median \u00b5s", "error in fact",
                   "fastest of lrbscope", "median \u00b5s", "error in fact"}};
  for (const DataSet& set : sets) {
    std::uint32_t faces = 0;
    for (const BodyFile& b : set.bodies) faces = std::max(faces, b.faces);
    const std::vector<Setting> of_all = settings_of(set, points, methods, false),
                               of_ours = settings_of(set, points, methods, true);
    for (const double bound : kBounds) {
      std::vector<std::string> row = {set.name, std::to_string(faces), render::short_number(bound)};
      for (const std::vector<Setting>* settings : {&of_all, &of_ours}) {
        const Setting* best = nullptr;
        for (const Setting& s : *settings)
          if (s.error <= bound && (best == nullptr || s.time < best->time)) best = &s;
        std::vector<std::string> cells(3, "\u2013");
        if (best != nullptr)
          cells = {best->name, render::short_number(best->time), render::short_number(best->error)};
        row.insert(row.end(), cells.begin(), cells.end());
      }
      t.rows.push_back(std::move(row));
    }
  }
  t.note =
      "Errors are the largest of a class of poses, times geometric means over the classes. A dash: no method keeps the error "
      "in every class. Methods that a frontier leaves out are not considered.";
  return t;
}

namespace {

/// Returns the chart over all bodies and poses, of the methods that answer everywhere.
report::Chart summary_chart(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                            const std::vector<methods::MethodInfo>& methods) {
  DataSet all;
  all.name = kAllSets;
  all.quantity = sets.front().quantity;
  const std::span<const PoseClass> classes = classes_of(all.quantity);
  std::map<std::string, std::vector<const Point*>> by_name;
  std::set<std::pair<std::string, PoseClass>> panels;  // an unfinished survey lacks some
  for (const Point& p : points) {
    by_name[name_of(p.method, p.setting)].push_back(&p);
    panels.insert({p.set, p.pose_class});
  }
  std::vector<Point> means;
  for (const Point& like : points) {  // in the order of the methods
    std::vector<const Point*>& of = by_name[name_of(like.method, like.setting)];
    if (of.size() == panels.size() && std::ranges::all_of(of, [](const Point* p) { return p->median > 0; })) {
      Point& mean = means.emplace_back(**std::ranges::max_element(
          of, [](const Point* p, const Point* q) { return p->error() < q->error(); }));
      mean.set = kAllSets;
      mean.pose_class = classes.front();
      for (double Point::*time : {&Point::median, &Point::least, &Point::most}) {
        std::vector<double> times;
        for (const Point* p : of) times.push_back(p->*time);
        mean.*time = geometric_mean(times);
      }
      mean.ties.clear();
      mean.always_wrong = std::ranges::all_of(of, [](const Point* p) { return p->always_wrong; });
    }
    of.clear();
  }
  mark_frontiers(means, methods);
  report::Chart chart =
      chart_of(all, classes.front(), means, methods, [](const Point&) { return std::string(); });
  chart.title = "All bodies and poses: geometric mean of the times, largest error";
  return chart;
}

}  // namespace

std::vector<report::Chart> accuracy_charts(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                                           const std::vector<methods::MethodInfo>& methods,
                                           const std::function<std::string(const Point&)>& scene_of) {
  std::vector<report::Chart> out;
  for (const DataSet& set : sets)
    for (const PoseClass c : classes_of(set.quantity)) {
      out.push_back(chart_of(set, c, points, methods, scene_of));
      out.back().has_key = false;
    }
  return out;
}

report::Document accuracy_page(Quantity quantity, const std::vector<DataSet>& sets,
                               const std::vector<Point>& points,
                               const std::vector<methods::MethodInfo>& methods,
                               const std::vector<report::Chart>& charts, const std::string& unfinished) {
  const ChartText words = chart_text(quantity);
  report::Document doc(words.title, words.purpose);
  if (!unfinished.empty()) doc.verdict("unfinished", false).purpose(unfinished);
  if (!sets.empty()) {
    report::Chart summary = summary_chart(sets, points, methods);
    // Its key is that of all charts.
    for (const report::Chart& chart : charts)
      for (const report::Series& s : chart.series)
        if (!s.label.empty() &&
            std::ranges::none_of(summary.series, [&](const auto& known) { return known.label == s.label; }))
          summary.series.push_back({s.label, {}, {}, s.style});
    doc.chart(summary);
  }
  doc.table(table_of_settings(sets, points, methods)).each(charts, &report::Document::chart);
  doc.each(words.texts, &report::Document::reading);
  return doc.table(table_of_metrics(points)).table(table_of_methods(methods)).table(table_of_points(points));
}

}  // namespace lrb::speed
