#pragma once
/// Tells whether two faces meet: the exact answer for triangles in space and for segments in the plane,
/// degenerate ones included. A triangle whose corners have become collinear or equal counts as the segment or
/// point that they span.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_words.hpp>
#include <lrbscope/ids.hpp>

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

// The intersection of two faces that meet, with exact combinatorics and coordinates rounded to double.

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

namespace lrb {

// The geometry of contact: that of each pair, and the connected contact regions that the pairs form. All
// points and vectors are in the world frame; lengths in the meshes' unit.

/// The intersection of the simplices of one pair.
using PairContactRecord = exact::PairContact;

/// A chain of points along which the surfaces cross or touch.
struct ContactLoop {
  std::vector<Eigen::Vector3d> points;  ///< world frame; not repeated at the end of a closed loop
  bool closed = false;
};

/// A connected part of the intersection of the two surfaces. Vertices that stand twice in one place (seams of
/// textures) count as one if their coordinates in the file are the same. A length or an area that is too
/// large for a double is infinity, which can happen to areas of bodies of 1e155 units and more, and to
/// lengths of 1e307 and more. Points, centroid and normal stay finite.
struct ContactRegion {
  std::vector<std::uint32_t> pairs;  ///< indices into CollideResult::pairs, ascending
  std::vector<ContactLoop>
      loops;          ///< curves of the region; for coplanar contact, the outline of its polygons
  double length = 0;  ///< total length of the loops (unit: the mesh's)
  double area = 0;    ///< coplanar contact: its area; closed loops: the area they span (unit squared)
  Eigen::Vector3d centroid{
      0, 0, 0};  ///< of the area for coplanar contact, of the curve's length, else of the points
  Eigen::Vector3d normal{0, 0, 0};  ///< unit, from A to B, averaged; zero where it has no meaning
  /// An estimate of how far B must move along `normal` to leave this region; 0: it only touches, or the
  /// bodies are flush. It is measured along `normal`: from the nearest point of the part of B that the region
  /// encloses in A to the farthest point of the part of A that it encloses in B, contact points included.
  /// Once B has moved that far a plane parts the two. Nothing but these two parts is considered; convex
  /// bodies have nothing else. Concave bodies may still meet in other regions, each with its own depth, or
  /// come to meet on the way; and parts that lie beside each other may be free after less.
  double depth_estimate = 0;
};

}  // namespace lrb
