/// Decides exactly whether the interiors of two touching bodies overlap; interiors.hpp explains why this
/// suffices.
///
/// 1. Coplanar faces that overlap in an area and face the same way: look for a point inside both, near them.
/// 2. Patches of faces in no pair: locate one vertex of each in the other body.
/// 3. Faces in pairs: cut them into cells and locate one rational point of each.

#include "engine/query/contact/interiors.hpp"

#include <algorithm>
#include <map>
#include <unordered_set>

#include <Eigen/Geometry>

#include "engine/core/tolerances.hpp"
#include "engine/exact/locate.hpp"
#include "engine/exact/pair_contact.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/query/contact/face_cutters.hpp"
#include "engine/query/contact/reflection.hpp"
#include "engine/query/walk/relation.hpp"

namespace lrb {
namespace {

/// Returns true if two collinear segments of positive length point the same way: compares them along a
/// coordinate in which the first advances.
bool same_direction_2d(const double* const a[2], const double* const b[2]) {
  const int k = a[0][0] != a[1][0] ? 0 : 1;
  return (a[0][k] < a[1][k]) == (b[0][k] < b[1][k]);
}

class Decider {
 public:
  Decider(QueryContext& ctx, const CollideResult& result)
      : ctx_(ctx), result_(result), dim_(ctx[Side::a].rep().dim()) {}

  Answer run() {
    for (const Side side : {Side::a, Side::b}) {
      const LrbRep& rep = ctx_[side].rep();
      if (!rep.closed() || rep.overlaps_itself()) return Answer::unknown;
    }
    // First the faces that coincide.
    const Answer between = between_coinciding_faces();
    if (between == Answer::yes) return between;
    for (const Side side : {Side::a, Side::b}) {
      group_pairs(side);
      // Then the parts of the surfaces in no pair: one point each.
      if (free_patch_inside(side)) return Answer::yes;
    }
    for (const Side side : {Side::a, Side::b}) {
      group_pairs(side);
      // Last the faces in pairs, cell by cell, in rational arithmetic.
      if (const Answer answer = touched_face_inside(side); answer != Answer::no) return answer;
    }
    return between;
  }

 private:
  /// Answers for coplanar faces that overlap in an area (2D: a length) and face the same way. Both solids lie
  /// behind them, and a point there that is inside both proves it. Where none is found, rounding has folded a
  /// body in the world (far from the origin thin walls become flat) and faces need not face outward any more:
  /// unknown.
  Answer between_coinciding_faces() {
    // A reflection reverses orientations: if exactly one pose is one, equal orientations mean opposite sides.
    const bool mirrored =
        is_reflection(ctx_[Side::a].world.pose(), dim_) != is_reflection(ctx_[Side::b].world.pose(), dim_);
    Answer answer = Answer::no;
    for (const SimplexPair& pair : result_.pairs) {
      const double *a[3], *b[3];
      ctx_[Side::a].world.corners(pair.a, a);
      ctx_[Side::b].world.corners(pair.b, b);
      const exact::PairContact contact =
          dim_ == 3 ? exact::contact_of_triangles(a, b) : exact::contact_of_segments(a, b);
      // Only contacts with area count (2D: with length).
      if (!contact.coplanar || contact.corner_count < dim_) continue;
      // Opposite directions: the solids lie on different sides of the plane.
      if ((dim_ == 3 ? same_direction_3d(a, b) : same_direction_2d(a, b)) == mirrored) continue;
      if (inside_both_near(contact, a)) return Answer::yes;
      answer = Answer::unknown;
    }
    return answer;
  }

  /// Searches for a point inside both bodies on either side of a coplanar contact's centre, at decreasing
  /// distances, because the distance to the next faces is unknown. A point on a face proves nothing.
  bool inside_both_near(const exact::PairContact& contact, const double* const face[3]) {
    std::vector<exact::RationalPoint> corners;
    Eigen::AlignedBox3d box;
    for (int k = 0; k < contact.corner_count; ++k) {
      corners.emplace_back(contact.corners[k].x.data());
      box.extend(contact.corners[k].x);
    }
    // The mean of the corners lies in the contact, which is convex, up to their rounding.
    const auto middle = exact::RationalPoint::combination(corners, std::vector<double>(corners.size(), 1));
    const Eigen::Vector3d normal = normal_of(face);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d off = middle.rounded() + side * box.sizes().maxCoeff() * normal;
      const exact::RationalPoint ends[] = {middle, exact::RationalPoint(off.data())};
      for (const double share : kInteriorProbes) {
        // Ever nearer to the plane: the body may be arbitrarily thin there.
        const double weights[] = {1 - share, share};
        const auto p = exact::RationalPoint::combination(ends, weights);
        if (locate(ctx_[Side::a], p) == Where::inside && locate(ctx_[Side::b], p) == Where::inside)
          return true;
      }
    }
    return false;
  }

  /// Returns a normal of length about 1; it need not be accurate.
  Eigen::Vector3d normal_of(const double* const face[3]) const {
    const auto edge = [&](int k) {
      Eigen::Vector3d e = Eigen::Vector3d::Zero();
      for (int i = 0; i < dim_; ++i) e[i] = face[k][i] - face[0][i];
      return e.stableNormalized();
    };
    const Eigen::Vector3d e = edge(1);
    return dim_ == 2 ? Eigen::Vector3d(e.y(), -e.x(), 0) : e.cross(edge(2)).stableNormalized();
  }

  SimplexId own(Side side, const SimplexPair& p) const { return side == Side::a ? p.a : p.b; }

  void group_pairs(Side side) {
    partners_.clear();
    for (const SimplexPair& p : result_.pairs) partners_[own(side, p)].push_back(own(other(side), p));
  }

  /// Tests vertices of no touched face, one for each patch of the surface that touched faces leave connected.
  /// Patches are joined through vertices that no touched face has; a patch without such a vertex is made of
  /// faces all of whose corners are on touched faces: each of those faces is tested itself.
  bool free_patch_inside(Side side) {
    QueryBody &body = ctx_[side], &holder = ctx_[other(side)];
    const LrbRep& rep = body.rep();
    // Mark the corners of all faces in pairs.
    std::vector<bool> touched(rep.vertices().size(), false), seen(rep.vertices().size(), false);
    for (const auto& [s, partners] : partners_) {
      VertexId v[3];
      rep.simplex(s, v);
      for (int k = 0; k < dim_; ++k) touched[v[k]] = true;
    }
    const SurfaceGraph& graph = body.surface_graph();
    std::vector<VertexId> patch;
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
      if (partners_.contains(s)) continue;
      VertexId v[3];
      rep.simplex(s, v);
      // A vertex of no touched face represents its patch.
      const auto free = std::find_if(v, v + dim_, [&](VertexId x) { return !touched[x]; });
      if (free == v + dim_) {
        // The face itself touches nothing, so neither do its corners.
        if (locate(holder, body.world(v[0])) == Where::inside) return true;
      } else if (!seen[*free]) {
        if (locate(holder, body.world(*free)) == Where::inside) return true;
        // Depth-first search marks the patch, all of which is on the same side.
        patch.assign(1, *free);
        seen[*free] = true;
        for (; !patch.empty();) {
          const VertexId from = patch.back();
          patch.pop_back();
          for (const VertexId x : graph.neighbours(from))
            if (!touched[x] && !seen[x]) {
              seen[x] = true;
              patch.push_back(x);
            }
        }
      }
    }
    return false;
  }

  Answer touched_face_inside(Side side) {
    QueryBody &body = ctx_[side], &holder = ctx_[other(side)];
    std::size_t cells = 0;
    for (const auto& [s, partners] : partners_) {
      // One exact point in each cell. A cell does not cross the other surface: it is inside or outside as a
      // whole.
      const auto points = sample(body, s, holder, partners);
      if (!points || (cells += points->size()) > kInteriorCells) return Answer::unknown;
      for (const exact::RationalPoint& p : *points)
        if (locate(holder, p) == Where::inside) return Answer::yes;
    }
    return Answer::no;
  }

  std::optional<std::vector<exact::RationalPoint>> sample(QueryBody& body, SimplexId s, QueryBody& holder,
                                                          const std::vector<SimplexId>& partners) {
    const double* own_corners[3];
    body.world.corners(s, own_corners);
    if (dim_ == 3) {
      // 3D: cells of the arrangement of cuts. Limits bound its cubic cost.
      FaceCutters cutters(own_corners, holder);
      for (const SimplexId t : partners) cutters.add(t);
      return exact::sample_cells(own_corners, cutters.all(), kInteriorCellsPerFace);
    }
    // 2D: intervals between the crossings along the segment.
    const double* c[2];
    std::vector<std::array<const double*, 2>> others;
    for (const SimplexId t : partners) {
      holder.world.corners(t, c);
      others.push_back({c[0], c[1]});
    }
    return exact::sample_cells_2d(own_corners, others, kInteriorCellsPerFace);
  }

  QueryContext& ctx_;
  const CollideResult& result_;
  int dim_;
  /// Partners of each touched simplex of the current side.
  std::map<SimplexId, std::vector<SimplexId>> partners_;
};

}  // namespace

Answer interiors_overlap(QueryContext& context, const CollideResult& result) {
  return Decider(context, result).run();
}

}  // namespace lrb
