#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::bodies {

/// Returns an LRB-rep in numbers: name, faces, regions, layers, volumes (in 2D: areas) and memory. The keys
/// are those of `lrbscope build --json`.
nlohmann::ordered_json body_figures(const LrbRep& rep);

/// Returns the volume of the convex hull of points; 0 if all lie in one plane. The hull is exact
/// (lrb::convex_hull()), the volume rounded.
double hull_volume(std::span<const Eigen::Vector3d> points);

/// Returns the area of the convex hull of points in the plane z = 0.
double hull_area(std::span<const Eigen::Vector3d> points);

/// The coarsest wrapper within a tolerance, in numbers.
struct LevelFigures {
  double share;         ///< the tolerance as a share of the largest side of the body's box
  double tolerance;     ///< mesh's unit
  std::uint32_t faces;  ///< of the wrapper
  double bound;         ///< proved: no point of the wrapper is further from the body than this; mesh's unit
};

/// Tolerances to look at, as shares of the largest side of the body's box.
inline constexpr double kLevelShares[] = {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1};

/// Returns the largest side of the box round the real faces; mesh's unit.
double largest_side(const LrbRep& rep);

/// Returns the wrapper at a tolerance (mesh's unit); it refers to `rep`.
Wrapper wrapper_at(const LrbRep& rep, double tolerance, unsigned threads);

/// Returns the wrappers at a row of tolerances, on `threads` threads. A region is in a wrapper with all that
/// it hides or not at all. Of a body that is not closed or intersects itself every wrapper is the body
/// itself.
std::vector<LevelFigures> level_figures(const LrbRep& rep, std::span<const double> shares, unsigned threads);

/// Levels as `lrbscope build --json` and `lrbscope levels --json` write them.
nlohmann::ordered_json level_json(std::span<const LevelFigures> levels);

}  // namespace lrb::bodies
