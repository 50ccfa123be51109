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
/// coordinates). Also nullopt, rarely, if rounding prevents an answer.
///
/// A dual active-set method (Goldfarb and Idnani, "A numerically stable dual method for solving strictly
/// convex quadratic programs", 1983).
std::optional<Eigen::Vector3d> nearest_point(const Eigen::Vector3d& target,
                                             std::span<const HalfSpace> half_spaces, double slack);

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
