#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenarios/bench/report/metrics.hpp"
#include "scenarios/report/page/page.hpp"

namespace lrb::bench {

/// Makes the page of speed against accuracy, which opens from disk: a chart for each pair of bodies and class
/// of poses. The sets are one at least, and all asked for the same. `scene_of` returns where a point leads,
/// relative to the page; empty: nowhere.
report::Page accuracy_page(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                           const std::vector<methods::MethodInfo>& methods,
                           const std::function<std::string(const Point&)>& scene_of);

}  // namespace lrb::bench
