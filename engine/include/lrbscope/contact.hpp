#pragma once
/// Exact intersection tests for triangles in 3D and segments in 2D, degenerate ones included. A triangle with
/// collinear or coincident corners counts as the segment or point that they span.

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/ids.hpp>

namespace lrb::exact {

/// The intersection of two simplices. `cross`: their relative interiors share a point and they are not
/// coplanar (2D: collinear), so that each passes through the other. `touch`: they share a point but do not
/// cross.
enum class Meet : std::uint8_t { disjoint = 0, touch = 1, cross = 2 };
constexpr auto enum_names(Meet) {
  return std::to_array<EnumName<Meet>>(
      {{Meet::disjoint, "disjoint"}, {Meet::touch, "touch"}, {Meet::cross, "cross"}});
}

/// Classifies the intersection of two triangles (closed sets). Degenerate triangles (zero area) never cross.
Meet meet_triangles(const double* const a[3], const double* const b[3]);

/// Classifies the intersection of two segments (closed sets) in the plane z = 0; reads only x and y.
Meet meet_segments(const double* const a[2], const double* const b[2]);

/// Returns true if two triangles of one complex intersect only in the vertices and edges that they share by
/// index: they are disjoint, or share one corner or one edge. ia, ib: vertex indices of the corners.
bool meet_only_in_shared(const double* const a[3], const VertexId ia[3], const double* const b[3],
                         const VertexId ib[3]);
/// The 2D version, for two segments.
bool meet_only_in_shared_2d(const double* const a[2], const VertexId ia[2], const double* const b[2],
                            const VertexId ib[2]);

/// Returns how often the floating-point filter could not decide since the start of this thread (for
/// counters).
std::uint64_t exact_fallbacks();

// The intersection of two faces, with exact combinatorics and coordinates rounded to double.

/// A feature of a simplex: corner i (`dim` 0), the edge from corner i to corner i + 1 mod n (`dim` 1), or the
/// interior (`dim` 2, index 0). A point is assigned to its feature of lowest dimension.
struct Feature {
  std::uint8_t dim = 2;
  std::uint8_t index = 0;
  friend bool operator==(const Feature&, const Feature&) = default;
};

/// A corner of the intersection of two simplices.
struct ContactCorner {
  /// World frame. A corner of either simplex is copied. Any other point deviates from the exact one, in each
  /// coordinate, by at most 1e-13 of the extent of the cut edge plus two roundings.
  Eigen::Vector3d x{0, 0, 0};
  Feature on_a, on_b;  ///< location of the point on each simplex; exact
};

/// The intersection of two simplices, a convex set: a point, a segment or a coplanar polygon.
struct PairContact {
  Meet meet = Meet::disjoint;
  bool coplanar = false;          ///< both are in one plane (2D: on one line)
  std::uint8_t corner_count = 0;  ///< 0 none, 1 point, 2 segment, 3 to 6 polygon (in order around it)
  std::array<ContactCorner, 6> corners{};  ///< the first corner_count are valid
};

/// Return the intersection of two triangles or segments given by their corners.
PairContact contact_of_triangles(const double* const a[3], const double* const b[3]);
/// Segments are in the plane z = 0.
PairContact contact_of_segments(const double* const a[2], const double* const b[2]);

}  // namespace lrb::exact

namespace lrb {

// Contact geometry: of each pair, and of the connected contact regions that the pairs form. Points and
// vectors are in the world frame; lengths in mesh units.

/// The intersection of the simplices of one pair.
using PairContactRecord = exact::PairContact;

/// A half-edge of a loop: it runs from a point of the loop to the next one, in one simplex of each body. In
/// the list of its loop, the half-edges after and before it are its neighbours on both surfaces.
struct ContactHalfEdge {
  std::uint32_t pair = 0;  ///< index into CollideResult::pairs: its simplices, and so its faces
  /// Where it starts on these simplices: a corner, an edge or the inside. Where a curve crosses an edge, the
  /// half-edge before is in the simplex beyond it.
  exact::Feature on_a, on_b;
};

/// A chain of points along which the surfaces cross or touch.
struct ContactLoop {
  std::vector<Eigen::Vector3d> points;  ///< world frame; the first point of a closed loop is not repeated
  bool closed = false;
  std::vector<ContactHalfEdge>
      half_edges;  ///< from each point to the next; of a closed loop, also from the last
};

/// A connected component of the intersection of the two surfaces (cf. contact manifold). Vertices with equal
/// coordinates in the file (texture seams) count as one. A length or area that overflows is infinite
/// (possible for areas of bodies of 1e155 units and more, and for lengths from 1e307). Points, centroid and
/// normal stay finite.
struct ContactRegion {
  std::vector<std::uint32_t> pairs;  ///< indices into CollideResult::pairs, ascending
  /// Curves of the region; for coplanar contact, the outline of its polygons.
  std::vector<ContactLoop> loops;
  double length = 0;  ///< total length of the loops, mesh units
  double area = 0;    ///< coplanar contact: area; closed loops: area spanned by them; mesh units squared
  /// Of the area for coplanar contact, else of the curves' length, else of the points.
  Eigen::Vector3d centroid{0, 0, 0};
  Eigen::Vector3d normal{0, 0, 0};  ///< unit vector from A to B, averaged; zero if undefined
  /// An estimate of how far B must move along `normal` to leave this region; 0 if it only touches or the
  /// bodies are flush. It is the extent, along `normal`, from the nearest point of the part of B that the
  /// region encloses in A to the farthest point of the part of A that it encloses in B, contact points
  /// included. After such a move a plane separates these two parts. Other parts, which only concave bodies
  /// have, are not considered: these may still intersect in other regions, each with its own depth, or
  /// collide during the move. Parts that are side by side may separate earlier.
  double depth_estimate = 0;
};

}  // namespace lrb
