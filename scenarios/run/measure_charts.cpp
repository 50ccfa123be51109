#include "scenarios/run/measure_charts.hpp"

#include <cmath>
#include <string>
#include <utility>

namespace lrb::run {
namespace {

/// Two curves that hold a number between them.
struct Ends {
  report::PageSeries lower, upper;

  explicit Ends(const std::string& what) {
    lower.label = what + ", lower end";
    upper.label = what + ", upper end";
  }
  void add(double x, double low, double high) {
    lower.x.push_back(x);
    lower.y.push_back(low);
    if (!std::isfinite(high)) return;
    upper.x.push_back(x);
    upper.y.push_back(high);
  }
  void move_to(report::PageChart& chart) {
    if (lower.x.empty()) return;
    chart.series.push_back(std::move(lower));
    if (!upper.x.empty()) chart.series.push_back(std::move(upper));
  }
};

report::PageChart steps_chart(const trace::Trace& trace) {
  report::PageChart chart;
  chart.title = "Distance and depth, step by step";
  chart.x_label = "step";
  chart.y_label = "length in the meshes' unit";
  chart.cursor = report::PageCursor::step;
  Ends distance("distance"), depth("depth");
  for (const trace::Step& step : trace.steps) {
    const trace::StepResult& r = step.result;
    if (r.distance) distance.add(step.index, r.distance->lower, r.distance->upper);
    if (r.clash && r.clash->depth) depth.add(step.index, (*r.clash->depth)[0], (*r.clash->depth)[1]);
  }
  distance.move_to(chart);
  depth.move_to(chart);
  return chart;
}

report::PageChart course_chart(const std::vector<Bounds>& course, const std::string& what,
                               std::uint32_t step) {
  report::PageChart chart;
  chart.title = "How the bounds of the " + what + " tightened, step " + std::to_string(step);
  chart.x_label = "work";
  chart.y_label = "length in the meshes' unit";
  chart.stepped = true;
  Ends ends(what);
  for (const Bounds& b : course) ends.add(static_cast<double>(b.work), b.lower, b.upper);
  ends.move_to(chart);
  return chart;
}

report::PageChart search_chart(const trace::MeasuredApproach& search) {
  report::PageChart chart;
  chart.title = "How the first contact was found";
  chart.x_label = "percent of the way without a contact";
  chart.y_label = "distance there";
  chart.note = "Each point is where the search stood: until there the bodies are proved not to meet.";
  Ends distance("distance");
  for (const ContactBounds& b : search.course) {
    const double percent = 100 * b.t0;
    if (distance.lower.x.empty() || percent > distance.lower.x.back())
      distance.add(percent, b.lower, b.upper);
  }
  distance.move_to(chart);
  return chart;
}

}  // namespace

std::vector<report::PageChart> measure_charts(const trace::Trace& trace) {
  std::vector<report::PageChart> out;
  const trace::Step *of_distance = nullptr, *of_depth = nullptr;
  std::size_t most_distance = 1, most_depth = 1;  // a curve has two points at least
  for (const trace::Step& step : trace.steps) {
    const trace::StepResult& r = step.result;
    if (r.distance && r.distance->course.size() > most_distance) {
      of_distance = &step;
      most_distance = r.distance->course.size();
    }
    if (r.clash && r.clash->course.size() > most_depth) {
      of_depth = &step;
      most_depth = r.clash->course.size();
    }
  }
  const bool measured =
      was_measured(trace, &trace::StepResult::distance) || was_measured(trace, &trace::StepResult::clash);
  if (measured && trace.steps.size() > 1) out.push_back(steps_chart(trace));
  if (of_distance != nullptr)
    out.push_back(course_chart(of_distance->result.distance->course, "distance", of_distance->index));
  if (of_depth != nullptr)
    out.push_back(course_chart(of_depth->result.clash->course, "depth", of_depth->index));
  if (trace.header.first_contact && trace.header.first_contact->course.size() > 1)
    out.push_back(search_chart(*trace.header.first_contact));
  std::erase_if(out, [](const report::PageChart& c) { return c.series.empty(); });
  return out;
}

}  // namespace lrb::run
