#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/speed/data_set.hpp"
#include "bench/speed/metrics.hpp"
#include "scenarios/report/document.hpp"
#include "scenarios/report/gnuplot.hpp"

namespace lrb::bench {

/// Makes the page of speed against accuracy, which opens from disk: a chart for each pair of bodies and class
/// of poses. The sets are one at least, and all asked for the same. `scene_of` returns where a point leads,
/// relative to the page; empty: nowhere.
report::Page accuracy_page(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                           const std::vector<methods::MethodInfo>& methods,
                           const std::function<std::string(const Point&)>& scene_of);

/// Makes the chart of speed against accuracy for print: a row of panels for each pair of bodies, a column for
/// each class of poses.
report::Gnuplot accuracy_chart(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                               const std::vector<methods::MethodInfo>& methods);

// What charts of speed against accuracy say, by what methods were asked for.

struct ChartWords {
  std::string title, purpose;
  std::string error;   ///< for the axis
  std::string proved;  ///< in the key: what a cross is
  std::vector<report::PageText> texts;
};

ChartWords chart_words(Quantity quantity);

}  // namespace lrb::bench
