#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/speed/data_set.hpp"
#include "bench/speed/metrics.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::bench {

/// Returns the charts of speed against accuracy: for each pair of bodies (one at least, all asked for the
/// same) one for each class of poses. `scene_of` returns where a point leads, relative to the page; empty:
/// nowhere.
std::vector<report::Chart> accuracy_charts(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                                           const std::vector<methods::MethodInfo>& methods,
                                           const std::function<std::string(const Point&)>& scene_of);

/// Makes their page.
report::Document accuracy_page(Quantity quantity, const std::vector<Point>& points,
                               const std::vector<methods::MethodInfo>& methods,
                               const std::vector<report::Chart>& charts);

/// Lays them out for print: a row for each pair of bodies, a column for each class of poses.
report::Gnuplot accuracy_print(Quantity quantity, const std::vector<report::Chart>& charts);

/// Returns the points of a panel.
std::vector<const Point*> panel(const std::vector<Point>& points, const std::string& set, PoseClass c);

// What charts of speed against accuracy say, by what methods were asked for.

struct ChartWords {
  std::string title, purpose;
  std::string error;   ///< for the axis
  std::string proved;  ///< in the key: what a cross is
  std::vector<report::Text> texts;
};

ChartWords chart_words(Quantity quantity);

}  // namespace lrb::bench
