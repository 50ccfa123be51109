#pragma once
/// The triangles of two bodies in the world, relative to the centre of their common box and in a unit in
/// which no coordinate exceeds 1/2.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "engine/query/walk/query_context.hpp"

namespace lrb::parting {

using Eigen::Vector3d;

struct UnitBody {
  std::vector<Vector3d> points;  ///< each coordinate within kUnitRounding of the exact one
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< outward, of mirrored bodies, too
};

/// From the world's coordinates to the unit's: subtract `origin`, divide by 2^exponent.
struct UnitFrame {
  Vector3d origin{0, 0, 0};
  int exponent = 0;

  Vector3d to_unit(const Vector3d& world) const;
  Vector3d to_world(const Vector3d& unit) const;
  /// Returns a length in the world's unit. Exact, unless it leaves the range of doubles.
  double length_to_world(double x) const;
};

struct UnitBodies {
  UnitFrame frame;
  UnitBody body[2];
};

/// Returns the bodies with which a context was begun. Both must have faces.
UnitBodies unit_bodies(QueryContext& context);

}  // namespace lrb::parting
