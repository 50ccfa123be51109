#pragma once

#include <string>
#include <vector>

#include "scenarios/bench/report/metrics.hpp"
#include "scenarios/report/charts/gnuplot.hpp"

namespace lrb::bench {

/// Makes the chart of speed against accuracy for print: a row of panels for each pair of bodies, a column for
/// each class of poses.
report::Gnuplot accuracy_chart(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                               const std::vector<methods::MethodInfo>& methods);

}  // namespace lrb::bench
