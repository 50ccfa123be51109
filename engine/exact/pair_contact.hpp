#pragma once
/// The intersection of two faces that meet, with exact combinatorics and coordinates rounded to double.

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "engine/exact/simplex_test.hpp"

namespace lrb::exact {

/// A part of a simplex: corner i (`dim` 0), the edge from corner i to corner i + 1 mod n (`dim` 1), or its
/// interior (`dim` 2, index 0). Of the features that hold a point, it is always the one of least dimension
/// that is named.
struct Feature {
  std::uint8_t dim = 2;
  std::uint8_t index = 0;
  friend bool operator==(const Feature&, const Feature&) = default;
};

/// A corner of the intersection of two simplices.
struct ContactCorner {
  /// World frame. A corner of either simplex is copied; in each coordinate, other points are within 1e-13 of
  /// the cut edge's extent plus two roundings of the exact point.
  Eigen::Vector3d x{0, 0, 0};
  Feature on_a, on_b;  ///< where the point lies on each simplex; exact
};

/// The intersection of two simplices, a convex set: a point, a segment or a coplanar polygon.
struct PairContact {
  Meet meet = Meet::disjoint;
  bool coplanar = false;                   ///< both lie in one plane (in 2D: on one line)
  std::uint8_t corner_count = 0;           ///< 0 none, 1 point, 2 segment, 3 to 6 polygon (in order round it)
  std::array<ContactCorner, 6> corners{};  ///< the first corner_count
};

PairContact contact_of_triangles(const double* const a[3], const double* const b[3]);
/// Intersects segments in the plane; corners have z = 0.
PairContact contact_of_segments(const double* const a[2], const double* const b[2]);

}  // namespace lrb::exact
