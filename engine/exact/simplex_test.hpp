#pragma once
/// Tells whether two faces meet: the exact answer for triangles in space and for segments in the plane,
/// degenerate ones included. A triangle whose corners have become collinear or equal counts as the segment or
/// point that they span.

#include <cstdint>

#include "engine/core/enum_words.hpp"
#include "engine/core/ids.hpp"

namespace lrb::exact {

/// How two simplices meet. `cross`: their relative interiors share a point and they do not lie in one plane
/// (in 2D: on one line), so that each passes through the other. `touch`: they share a point, but do not
/// cross.
enum class Meet : std::uint8_t { disjoint = 0, touch = 1, cross = 2 };
constexpr auto words_of(Meet) {
  return std::to_array<EnumWord<Meet>>(
      {{Meet::disjoint, "disjoint"}, {Meet::touch, "touch"}, {Meet::cross, "cross"}});
}

/// Tells how two triangles (closed sets), given by their corners, meet. Degenerate ones (zero area) never
/// cross.
Meet meet_triangles(const double* const a[3], const double* const b[3]);

/// Tells how two segments (closed sets) in the plane z = 0 meet; reads only x and y.
Meet meet_segments(const double* const a[2], const double* const b[2]);

/// Returns true if two triangles of one complex meet in nothing but the vertices and edges that they share by
/// index: the empty set, one common corner, or one common edge. ia, ib: vertex indices of the corners.
bool meet_only_in_shared(const double* const a[3], const VertexId ia[3], const double* const b[3],
                         const VertexId ib[3]);
/// Does the same for two segments in the plane.
bool meet_only_in_shared_2d(const double* const a[2], const VertexId ia[2], const double* const b[2],
                            const VertexId ib[2]);

/// Returns the number of times that the floating-point filter could not decide since the thread started (for
/// counters).
std::uint64_t exact_fallbacks();

}  // namespace lrb::exact
