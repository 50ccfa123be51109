#pragma once

#include <string>
#include <vector>

#include "scenarios/charts/gnuplot.hpp"
#include "scenarios/measure/metrics.hpp"

namespace lrb::measure {

/// Speed against accuracy for print: a row of panels for each pair of bodies, a column for each class of
/// poses.
Gnuplot accuracy_chart(const std::vector<DataSet>& sets, const std::vector<Point>& points);

}  // namespace lrb::measure
