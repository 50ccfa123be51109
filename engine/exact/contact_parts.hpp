#pragma once
/// The building blocks of pair contacts. Private to engine/exact.

#include <cstdint>

#include "engine/exact/cut_point.hpp"
#include "engine/exact/pair_contact.hpp"

namespace lrb::exact {

inline Feature corner(int i) {
  return {0, static_cast<std::uint8_t>(i)};
}
/// Returns the edge of a triangle between its corners i and j.
inline Feature edge_between(int i, int j) {
  return {1, static_cast<std::uint8_t>((i + 1) % 3 == j ? i : j)};
}

inline Eigen::Vector3d as_vector(const double* p) {
  return {p[0], p[1], p[2]};
}

inline void append(PairContact& r, const ContactCorner& c) {
  r.corners[r.corner_count++] = c;
}

/// Intersects two triangles with area that lie in one plane: a polygon, a segment, a point or nothing.
PairContact contact_in_plane(const double* const a[3], const double* const b[3]);

/// Intersects two triangles of which at least one has no area: a segment, a point or nothing.
PairContact contact_of_degenerate(const double* const a[3], const double* const b[3]);

}  // namespace lrb::exact
