#pragma once
/// What cuts a face into cells, for whoever asks where the cells lie.

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "engine/exact/predicates.hpp"
#include "engine/query/contact/side_in_plane.hpp"
#include "engine/query/walk/query_context.hpp"

namespace lrb {

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

}  // namespace lrb
