#pragma once
/// Places the new vertex of a collapsed edge: the nearest point of a polyhedron.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/core/geometry.hpp"
#include <lrbscope/mesh.hpp>

namespace lrb::construct {

/// The points x with n.x >= d; n has unit length.
struct HalfSpace {
  Eigen::Vector3d n;
  double d;
};

/// Returns the point of the intersection of half-spaces that is nearest to `target`, or nullopt if the
/// intersection is empty, up to rounding: half-spaces are satisfied to within `slack` (unit of the
/// coordinates).
///
/// Incremental, after Seidel (1991): adds the half-spaces one by one. While the nearest point is in the next
/// half-space, it is kept. Otherwise the new one is in that half-space's plane, where the same problem is
/// solved in 2D for the half-spaces before it, and there in 1D. Expected linear time if the half-spaces
/// are in random order, at worst cubic.
std::optional<Eigen::Vector3d> nearest_point(const Eigen::Vector3d& target,
                                             std::span<const HalfSpace> half_spaces, double slack);

/// As nearest_point(), but adds the most violated half-space each time, until none is violated. Of a dozen
/// planes about four are active, and the others are only compared. Reorders the half-spaces.
std::optional<Eigen::Vector3d> nearest_point_worst_first(const Eigen::Vector3d& target,
                                                         std::span<HalfSpace> half_spaces, double slack);

// Limits the growth of fronts.

/// A convex region that contains a body.
class BodyBounds {
 public:
  /// Builds the polytope with 26 faces, whose normals are the axes and their diagonals, moved outward by
  /// `swell` times the body's width in each direction.
  BodyBounds(std::span<const Eigen::Vector3d> points, double swell);
  /// Builds the region of points behind all faces of a convex triangle mesh by at least `distance`.
  BodyBounds(const Mesh& convex, double distance);

  std::span<const HalfSpace> half_spaces() const { return half_spaces_; }
  bool contains(const Eigen::Vector3d& p) const {
    for (const HalfSpace& h : half_spaces_)
      if (dot3(h.n, p) < h.d) return false;
    return true;
  }

 private:
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace lrb::construct
