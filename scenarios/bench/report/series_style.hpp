#pragma once

#include <cmath>
#include <string>

#include "scenarios/bench/report/metrics.hpp"

namespace lrb::bench {

/// How a method is drawn, on the page and in print.
struct SeriesStyle {
  const char* title;   ///< for the key
  const char* colour;  ///< #rrggbb
  const char* shape;   ///< Chart.js's name of the point's shape
  int point;           ///< gnuplot's number of it
};

/// Ours is "ours"; variants of ours, and engines of one house, look alike.
std::size_t look_of(const std::string& method);
std::size_t look_count();
const SeriesStyle& look(std::size_t i);

/// Where no error stands on an axis that has no place for 0.
inline constexpr double kNoError = 1e-7;
inline double drawn_error(const Point& p) {
  return p.error() > kNoError ? p.error() : kNoError;
}
/// Points without a single answer stand above all others of their panel.
double drawn_time(const Point& p, double slowest);

/// The slowest median on a data set, over all classes of poses.
double slowest_of(const std::vector<Point>& points, const std::string& set);
/// A panel's points, and of these its frontier, from exact to coarse.
std::vector<const Point*> panel(const std::vector<Point>& points, const std::string& set, PoseClass c);
std::vector<const Point*> frontier(const std::vector<const Point*>& panel);

}  // namespace lrb::bench
