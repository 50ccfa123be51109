#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/speed/data_set.hpp"
#include "bench/speed/metrics.hpp"
#include "bench/speed/survey.hpp"
#include "scenarios/report/document.hpp"

namespace lrb::speed {

/// Returns the charts of speed against accuracy: for each pair of bodies (at least one, all for the same
/// quantity) one per class of poses. `scene_of` returns the link of a point, relative to the page; empty: no
/// link.
std::vector<report::Chart> accuracy_charts(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                                           const std::vector<methods::MethodInfo>& methods,
                                           const std::function<std::string(const Point&)>& scene_of);

/// Returns the page of these charts. `unfinished`: a sentence on missing answers, or empty.
report::Document accuracy_page(Quantity quantity, const std::vector<DataSet>& sets,
                               const std::vector<Point>& points,
                               const std::vector<methods::MethodInfo>& methods,
                               const std::vector<report::Chart>& charts, const std::string& unfinished);

/// A figure of charts for print.
struct ChartPrint {
  double width = 0;  ///< millimetres; 0: as wide as a column per class of poses requires
  /// Names of the panels: a pair of bodies, a class of poses, or both as "BODIES/CLASS". Empty: all.
  std::vector<std::string> panels;
};

/// Arranges the charts for print, with common axes, one key and text at 7 points: a row per pair of bodies
/// and a column per class of poses, or the reverse where the width requires it, without rows that have no
/// points; some panels, in as many columns as fit. `missing`: of an unfinished survey; the title of the first
/// panel of its pairs names it. Throws InputError for an unknown name of a panel, and if the width is too
/// small.
report::Gnuplot accuracy_print(Quantity quantity, const std::vector<DataSet>& sets,
                               const std::vector<Missing>& missing, const std::vector<report::Chart>& charts,
                               const ChartPrint& print = {});

/// Returns what the charts draw as CSV with a head, a line for each point, for plotting programs.
std::string drawn_csv(const std::vector<Point>& points);

/// Returns a table of the setting to take for an error of at most x: for each pair of bodies the one that is
/// fastest of all that keep it in every class of poses, and the fastest of lrbscope's. The error of a class
/// is the mean over its poses. Points that cannot be on a frontier are not considered.
report::Table table_of_settings(const std::vector<DataSet>& sets, const std::vector<Point>& points,
                                const std::vector<methods::MethodInfo>& methods);

/// Returns the points of a panel.
std::vector<const Point*> panel(const std::vector<Point>& points, const std::string& set, PoseClass c);

}  // namespace lrb::speed
