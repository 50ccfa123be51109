#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "engine/collide/query_context.hpp"
#include "engine/exact/predicates.hpp"
#include <lrbscope/pose.hpp>

namespace lrb {

/// Returns the intersection of two simplices of the bodies of a query.
exact::PairContact contact_of(QueryContext& context, const SimplexPair& pair);

/// Finds the vertices of one body that are strictly inside the other and connected to given pairs. Uses the
/// context's buffers of this side.
///
/// Vertices of simplices in contact are *near*. Two ends of an edge are on the same side of the other surface
/// if the edge does not meet it, or if it crosses the interiors of an even number of its simplices and meets
/// it nowhere else; on different sides if that number is odd. So one point location decides a connected set
/// of near vertices. Other vertices are on the side from which the search reaches them.
class EnclosedVertices {
 public:
  /// Prepares the search for vertices of `side`; `result` has the contact of each pair. Every search is empty
  /// if the other body is not closed.
  EnclosedVertices(QueryContext& context, Side side, const CollideResult& result);

  /// Returns the vertices found by a search over the surface that starts at the simplices of some pairs
  /// (indices into result.pairs) and does not cross the other body's surface. Valid until the next search.
  std::span<const VertexId> from(std::span<const std::uint32_t> pairs);

 private:
  SimplexId simplex(std::uint32_t pair) const;
  void collect_cuts();
  void join_near();
  /// Returns whether a near vertex, given with its number, is inside the holder.
  bool is_inside(std::uint32_t near, VertexId v);
  /// Searches the part of a near vertex: the vertices inside the holder that edges inside it connect. Returns
  /// kOutside if the vertex is not inside.
  std::uint32_t find_part(std::uint32_t near, VertexId seed);

  QueryBody& body_;
  QueryBody& holder_;
  Side side_;
  const CollideResult& result_;
  EnclosedBuffers& buffers_;
  std::uint32_t calls_ = 0;  ///< of from()
};

/// Returns the side of the line p q on which r lies, as the sign of an orientation. All three points are in
/// the plane of the triangle `face`, which is projected along the first axis that keeps its area positive.
inline int side_in_plane(const double* const face[3], const double* p, const double* q, const double* r) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto turn = [&](const double* a, const double* b, const double* c) {
      const double x[2] = {a[u], a[v]}, y[2] = {b[u], b[v]}, z[2] = {c[u], c[v]};
      return exact::orient2d(x, y, z);
    };
    if (turn(face[0], face[1], face[2]) != 0) return turn(p, q, r);
  }
  return 0;
}

/// Returns true if the normals of two coplanar triangles of positive area have the same direction. Exact:
/// projected along an axis that keeps the first one's area positive, both then have the same orientation.
inline bool same_direction_3d(const double* const a[3], const double* const b[3]) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto turn = [&](const double* const t[3]) {
      const double p[2] = {t[0][u], t[0][v]}, q[2] = {t[1][u], t[1][v]}, r[2] = {t[2][u], t[2][v]};
      return exact::orient2d(p, q, r);
    };
    if (const int turn_a = turn(a); turn_a != 0) return turn_a == turn(b);
  }
  return false;
}

/// Collects the triangles that cut a face into cells. Each cell is inside, outside or on the surface of the
/// holder. Of the holder's triangles in the face's plane only the outline cuts: an edge between two of them
/// is left out, because both its sides are on the surface. Otherwise a fan of n triangles on another would
/// make n^2 cells.
class FaceCutters {
 public:
  using Corners = std::array<const double*, 3>;

  FaceCutters(const double* const face[3], QueryBody& holder)
      : face_{face[0], face[1], face[2]}, holder_(holder) {}

  void add(SimplexId t) {
    const double* c[3];
    holder_.world.corners(t, c);
    for (const double* corner : c)
      if (exact::orient3d(face_[0], face_[1], face_[2], corner) != 0) {
        triangles_.push_back({c[0], c[1], c[2]});
        return;
      }
    VertexId v[3];
    holder_.rep().simplex(t, v);
    for (int k = 0; k < 3; ++k)
      flat_edges_[std::minmax(v[k], v[(k + 1) % 3])].push_back({c[k], c[(k + 1) % 3], c[(k + 2) % 3]});
  }

  /// Returns the triangles, and the edges as degenerate triangles.
  std::vector<Corners> all() const {
    std::vector<Corners> r = triangles_;
    for (const auto& [ids, uses] : flat_edges_) {
      const double *p = uses[0][0], *q = uses[0][1];
      const bool is_inner =
          uses.size() == 2 &&
          side_in_plane(face_, p, q, uses[0][2]) * side_in_plane(face_, p, q, uses[1][2]) < 0;
      if (!is_inner) r.push_back({p, q, q});
    }
    return r;
  }

 private:
  const double* face_[3];
  QueryBody& holder_;
  std::vector<Corners> triangles_;
  /// For each edge its coplanar triangles, each with its third corner.
  std::map<std::pair<VertexId, VertexId>, std::vector<Corners>> flat_edges_;
};

/// Returns whether the interiors of two closed bodies that touch without crossing overlap. The answers yes
/// and no are exact.
///
/// Claim: the interiors overlap if and only if the surface of one body has a point strictly inside the other,
/// or the surfaces coincide somewhere with the same orientation. (Proof: otherwise each component of one
/// interior is entirely inside or outside the other body. If one were inside, so would be its boundary,
/// except where surfaces coincide with the same orientation: a contradiction.) This leaves three cases:
/// - Coplanar pairs whose intersection has area: the same direction means yes.
/// - A face in no pair is entirely on one side, and so is a connected patch of such faces: one vertex
///   decides.
/// - A face in pairs is cut into cells by its intersections: one exact rational point in each cell decides.
///
/// Returns unknown if a body is not closed or intersects itself, or if there are more than kInteriorCells
/// cells.
Answer interiors_overlap(QueryContext& context, const CollideResult& result);

/// Returns yes, with a proof, or unknown for closed bodies that cross. A crossing alone is no proof: faces of
/// a body that rounding has flattened in the world cross the other's faces as well, but enclose no volume. So
/// a crossing counts only where no further face of either body passes. All pairs must be in `result`.
Answer crossing_interiors_overlap(QueryContext& context, const CollideResult& result);

/// Returns true if a pose reverses orientation. Exact. In 2D only the map of the plane counts.
inline bool is_reflection(const Pose& pose, int dim) {
  const Eigen::Matrix3d& r = pose.r;
  const double origin[3] = {0, 0, 0};
  return (dim == 2 ? exact::orient2d(origin, r.col(0).data(), r.col(1).data())
                   : exact::orient3d(origin, r.col(0).data(), r.col(1).data(), r.col(2).data())) < 0;
}

}  // namespace lrb
