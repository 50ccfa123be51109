#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenarios/measure/metrics.hpp"
#include "scenarios/page/page.hpp"

namespace lrb::measure {

/// Speed against accuracy as a page that opens from disk: a chart for each pair of bodies and class of poses.
/// `scene_of`: where a point leads, relative to the page; empty: nowhere.
Page accuracy_page(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                   const std::vector<methods::MethodInfo>& methods,
                   const std::function<std::string(const Point&)>& scene_of);

}  // namespace lrb::measure
