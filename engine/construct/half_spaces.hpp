#pragma once
/// Finds where a collapsed edge's new vertex goes: the nearest point of a polyhedron.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/mesh.hpp>

namespace lrb::construct {

/// The points x with n.x >= d; n has length 1.
struct HalfSpace {
  Eigen::Vector3d n;
  double d;
};

/// Returns the point of the intersection of half-spaces that is nearest to `target`, or nothing if they have
/// no point in common, as far as floating point can tell: half-spaces are kept to within `slack` (unit of the
/// coordinates).
///
/// Incremental, after Seidel (1991): takes the half-spaces one by one. As long as the nearest point so far is
/// in the next half-space it stays; else the new one lies in that half-space's plane, where the same problem
/// is solved in 2D for the half-spaces before it, and there in turn in 1D. Linear in their number if they
/// come in random order, at worst cubic.
std::optional<Eigen::Vector3d> nearest_point(const Eigen::Vector3d& target,
                                             std::span<const HalfSpace> half_spaces, double slack);

/// Does the same: adds the half-space that is violated most, solves again, and repeats until none is
/// violated. Of a dozen planes about four decide, and the others are only compared. Reorders them.
std::optional<Eigen::Vector3d> nearest_point_worst_first(const Eigen::Vector3d& target,
                                                         std::span<HalfSpace> half_spaces, double slack);

// Limits how far hulls may swell.

/// A convex region that holds a body.
class BodyBounds {
 public:
  /// Makes the polytope whose 26 faces look along the axes and their diagonals, moved outward by `swell`
  /// times the body's width in each direction.
  BodyBounds(std::span<const Eigen::Vector3d> points, double swell);
  /// Makes the region that lies behind all faces of a convex mesh of triangles by at least `distance`.
  BodyBounds(const Mesh& convex, double distance);

  std::span<const HalfSpace> half_spaces() const { return half_spaces_; }
  bool contains(const Eigen::Vector3d& p) const {
    for (const HalfSpace& h : half_spaces_)
      if (h.n.dot(p) < h.d) return false;
    return true;
  }

 private:
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace lrb::construct
