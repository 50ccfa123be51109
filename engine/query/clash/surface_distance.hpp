#pragma once
/// The distance of a point from a body's surface.

#include <vector>

#include <Eigen/Geometry>

#include "engine/query/clash/unit_bodies.hpp"

namespace lrb::parting {

/// An AABB tree of the triangles of a body.
class SurfaceDistance {
 public:
  /// Keeps a reference to the body.
  explicit SurfaceDistance(const UnitBody& body);

  /// Returns the clearance of a point whose coordinates are at most 2: the open ball of that radius around it
  /// contains no point of the surface; proven. It is less than the distance by kClearanceMargin and rounding,
  /// for any triangulation of the surface.
  double at(const Vector3d& x) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t begin, end;           ///< triangles, in `order_`
    std::uint32_t left = 0, right = 0;  ///< 0: a leaf
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end, const std::vector<Vector3d>& middles);
  double bound(std::uint32_t triangle, const Vector3d& x) const;

  const UnitBody& body_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace lrb::parting
