#pragma once
/// Limits how far hulls may swell.

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/placement.hpp"
#include "engine/mesh/mesh.hpp"

namespace lrb::construct {

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
