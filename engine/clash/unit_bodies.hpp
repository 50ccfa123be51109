#pragma once
/// The triangles of two bodies in the world, relative to the centre of their common box and in a unit in
/// which no coordinate exceeds 1/2.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/collide/query_context.hpp"

namespace lrb::penetration {

using Eigen::Vector3d;

struct UnitBody {
  std::vector<Vector3d> points;  ///< each coordinate within kUnitRounding of the exact one
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< outward, also for mirrored bodies
};

/// From world to unit coordinates: subtract `origin`, divide by 2^exponent.
struct UnitFrame {
  Vector3d origin{0, 0, 0};
  int exponent = 0;

  Vector3d to_unit(const Vector3d& world) const;
  Vector3d to_world(const Vector3d& unit) const;
  /// Returns a length in world units. Exact, unless it overflows or underflows.
  double length_to_world(double x) const;
};

struct UnitBodies {
  UnitFrame frame;
  UnitBody body[2];
};

/// Returns the bodies with which a context was begun. Both must have faces.
UnitBodies unit_bodies(QueryContext& context);

/// An AABB tree of the triangles of a body, for the distance of a point from its surface.
class SurfaceDistance {
 public:
  /// Keeps a reference to the body.
  explicit SurfaceDistance(const UnitBody& body);

  /// Returns the clearance of a point whose coordinates are at most 2: the open ball of that radius around it
  /// is proven to contain no point of the surface. It is less than the distance by kClearanceMargin and
  /// rounding, independently of the triangulation of the surface.
  double at(const Vector3d& x) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    std::uint32_t begin, end;           ///< triangles, in `order_`
    std::uint32_t left = 0, right = 0;  ///< 0: a leaf
  };
  std::uint32_t build(std::uint32_t begin, std::uint32_t end, const std::vector<Vector3d>& centroids);
  double bound(std::uint32_t triangle, const Vector3d& x) const;

  const UnitBody& body_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace lrb::penetration
