#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "engine/collide/query_context.hpp"
#include "engine/exact/predicates.hpp"
#include <lrbscope/pose.hpp>

namespace lrb {

/// Finds the vertices of one body that lie strictly inside the other and are connected to given pairs.
class EnclosedVertices {
 public:
  /// Prepares the search for vertices of `side`. Finds nothing if the other body is not closed.
  EnclosedVertices(QueryContext& context, Side side, const CollideResult& result);

  /// Returns what is found by spreading over the surface from the simplices of some pairs (indices into
  /// result.pairs), without crossing the other body's surface.
  std::vector<VertexId> from(std::span<const std::uint32_t> pairs);

 private:
  SimplexId simplex(std::uint32_t pair) const;
  bool is_inside(VertexId v);

  QueryBody& body_;
  QueryBody& holder_;
  Side side_;
  const CollideResult& result_;
  std::unordered_set<VertexId> near_;  ///< corners of simplices in contact
};

/// Returns the side of the line p, q on which r lies, seen along the first axis on which the triangle `face`,
/// in whose plane all of them lie, keeps its area.
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

// What cuts a face into cells, for whoever asks where the cells lie.

/// Returns true if the normals of two coplanar triangles of positive area point the same way. Decides
/// exactly: seen along an axis on which the first keeps its area, both then turn the same way.
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

/// Collects what cuts a face into cells that are each inside or outside of the holder or on its surface. Of
/// the holder's triangles in the face's plane only the outline does: an edge with one of them on either side
/// is left out, because both its sides are on the surface. Without this a fan of n triangles on another would
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

  /// Returns the triangles, and the edges as triangles without area.
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
  /// The triangles at an edge, each with its third corner.
  std::map<std::pair<VertexId, VertexId>, std::vector<Corners>> flat_edges_;
};

/// Tells whether the interiors of two closed bodies that touch without crossing overlap. Exact where it
/// answers yes or no.
///
/// They overlap if and only if the surface of one has a point strictly inside the other, or the surfaces
/// coincide somewhere facing the same way (if neither holds, each component of one interior lies wholly
/// inside or outside the other; if it lies inside, its boundary does too, up to surfaces that coincide). So:
/// - for coplanar pairs whose intersection has area, the same direction means yes;
/// - a face in no pair lies on one side as a whole, and so does a connected patch of them: one vertex
///   decides;
/// - a face in pairs is cut into cells by its intersections: one exact rational point in each cell decides.
/// Answers unknown for a body that is not closed or intersects itself, and if there are more than
/// kInteriorCells cells.
Answer interiors_overlap(QueryContext& context, const CollideResult& result);

/// Does the same for closed bodies that cross: answers yes, with a proof, or unknown. Faces of a body that
/// rounding has made flat in the world pass through the other's faces too, but nothing lies between them: a
/// crossing counts only where no other face of either body lies. All pairs must be in `result`.
Answer crossing_interiors_overlap(QueryContext& context, const CollideResult& result);

/// Returns whether a pose turns surfaces inside out, exactly. In the plane only what it does there counts.
inline bool is_reflection(const Pose& pose, int dim) {
  const Eigen::Matrix3d& r = pose.r;
  const double origin[3] = {0, 0, 0};
  return (dim == 2 ? exact::orient2d(origin, r.col(0).data(), r.col(1).data())
                   : exact::orient3d(origin, r.col(0).data(), r.col(1).data(), r.col(2).data())) < 0;
}

}  // namespace lrb
