#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "bench/speed/metrics.hpp"

namespace lrb::bench {

/// How the series of a chart are drawn: what every method says of itself, a series for each title (variants
/// of ours, and engines of one house, may share one). A method that says nothing gets a series of its own
/// under its name, with a colour and a shape that differ from those of the others as far as there are enough.
class SeriesStyles {
 public:
  /// The series come in the order of the methods.
  explicit SeriesStyles(const std::vector<methods::MethodInfo>& methods);

  std::size_t count() const { return series_.size(); }
  const methods::MethodStyle& style(std::size_t series) const { return series_[series]; }
  /// Returns the series of a method; count() if it is not among the methods.
  std::size_t series_of(const std::string& method) const;

 private:
  std::vector<methods::MethodStyle> series_;
  std::map<std::string, std::size_t> series_of_;
};

/// Returns the value at which an error of zero is drawn on a logarithmic axis. Numbers are known to about
/// 1e-12.
inline double no_error(Quantity quantity) {
  return quantity == Quantity::pairs ? 1e-7 : 1e-14;
}
inline double drawn_error(double error, Quantity quantity) {
  return std::max(error, no_error(quantity));
}
/// Points without a single answer stand above all others of their panel.
double drawn_time(const Point& p, double slowest);

/// The slowest median on a data set, over all classes of poses.
double slowest_of(const std::vector<Point>& points, const std::string& set);
/// A panel's points, and of these its frontier, from exact to coarse.
std::vector<const Point*> panel(const std::vector<Point>& points, const std::string& set, PoseClass c);
std::vector<const Point*> frontier(const std::vector<const Point*>& panel);

}  // namespace lrb::bench
