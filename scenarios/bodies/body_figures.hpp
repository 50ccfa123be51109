#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::bodies {

/// Returns the statistics of an LRB-rep: name, faces, regions, layers, volumes (in 2D: areas) and memory. The
/// keys match `lrbscope build --json`.
nlohmann::ordered_json body_figures(const LrbRep& rep);

/// Returns the volume of the convex hull of points, or 0 if they are coplanar. The hull is exact
/// (lrb::convex_hull()), the volume rounded.
double hull_volume(std::span<const Eigen::Vector3d> points);

/// Returns the area of the convex hull of points in the plane z = 0.
double hull_area(std::span<const Eigen::Vector3d> points);

/// Statistics of the coarsest wrapper within a tolerance.
struct LevelFigures {
  double share;         ///< the tolerance as a share of the longest side of the body's box
  double tolerance;     ///< mesh units
  std::uint32_t faces;  ///< of the wrapper
  double bound;         ///< proven maximum deviation of the wrapper from the body; mesh units
};

/// Default tolerances, as shares of the longest side of the body's box.
inline constexpr double kLevelShares[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1};

/// Returns the longest side of the box of the real faces; mesh units.
double largest_side(const LrbRep& rep);

/// Returns the wrapper at a tolerance (mesh units); it refers to `rep`.
Wrapper wrapper_at(const LrbRep& rep, double tolerance, unsigned threads);

/// Returns the wrappers at several tolerances, on `threads` threads. A region is in a wrapper together with
/// all that it hides, or not at all. For a body that is not closed or intersects itself every wrapper is the
/// body itself.
std::vector<LevelFigures> level_figures(const LrbRep& rep, std::span<const double> shares, unsigned threads);

/// Levels in the form of `lrbscope build --json` and `lrbscope levels --json`.
nlohmann::ordered_json level_json(std::span<const LevelFigures> levels);

}  // namespace lrb::bodies
