/// Decides exactly whether the interiors of two touching bodies overlap; interiors.hpp explains why this
/// suffices.
///
/// 1. Coplanar faces that overlap in an area and face the same way: look for a point inside both, near them.
/// 2. Patches of faces in no pair: locate one vertex of each in the other body.
/// 3. Faces in pairs: cut them into cells and locate one rational point of each.

#include "engine/collide/interiors.hpp"

#include <algorithm>
#include <map>

#include <Eigen/Geometry>

#include "engine/collide/relation.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/locate.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/lrb/complex.hpp"
#include <lrbscope/contact.hpp>

namespace lrb {

exact::PairContact contact_of(QueryContext& context, const SimplexPair& pair) {
  const double *a[3], *b[3];
  context[Side::a].world.corners(pair.a, a);
  context[Side::b].world.corners(pair.b, b);
  return context[Side::a].rep().dim() == 3 ? exact::contact_of_triangles(a, b)
                                           : exact::contact_of_segments(a, b);
}

EnclosedVertices::EnclosedVertices(QueryContext& context, Side side, const CollideResult& result)
    : body_(context[side]),
      holder_(context[other(side)]),
      side_(side),
      result_(result),
      buffers_(context.contact.enclosed[static_cast<int>(side)]) {
  if (!holder_.rep().closed()) return;
  collect_cuts();
  join_near();
  buffers_.part.assign(buffers_.near.size(), kNull);
}

/// Collects where the edges of each simplex in contact meet the other surface. They do if and only if they
/// have a corner of the contact of some pair of this simplex.
void EnclosedVertices::collect_cuts() {
  const LrbRep& rep = body_.rep();
  const int n = rep.simplex_size();
  EnclosedBuffers& b = buffers_;
  b.simplices.begin(rep.real_simplex_count());
  b.near.begin(rep.vertices().size());
  b.cuts.clear();
  b.location.clear();
  b.reached.begin(rep.vertices().size());
  b.parts.clear();
  b.inside.clear();
  for (std::uint32_t i = 0; i < result_.pairs.size(); ++i) {
    VertexId v[3];
    rep.simplex(simplex(i), v);
    const auto [number, is_new] = b.simplices.add(simplex(i));
    if (is_new) {
      b.cuts.push_back({simplex(i)});
      for (int k = 0; k < n; ++k)
        if (b.near.add(v[k]).second) b.location.push_back(EnclosedBuffers::Location::unknown);
    }
    EnclosedBuffers::Cuts& cuts = b.cuts[number];
    const PairContactRecord& contact = result_.contacts[i];
    cuts.crosses |= contact.meet == exact::Meet::cross;
    for (std::size_t c = 0; c < contact.corner_count; ++c) {
      const exact::ContactCorner& corner = contact.corners[c];
      const exact::Feature &own = side_ == Side::a ? corner.on_a : corner.on_b,
                           &others = side_ == Side::a ? corner.on_b : corner.on_a;
      if (own.dim == 0) b.location[b.near(v[own.index])] = EnclosedBuffers::Location::on_surface;
      if (own.dim != 1) continue;
      const auto edge = static_cast<std::uint8_t>(1U << own.index);
      cuts.met |= edge;
      if (contact.meet == exact::Meet::cross && others.dim == n - 1)
        cuts.odd ^= edge;
      else
        cuts.unclear |= edge;
    }
  }
}

/// Joins near vertices along the edges of the simplices in contact.
void EnclosedVertices::join_near() {
  const LrbRep& rep = body_.rep();
  const int n = rep.simplex_size();
  EnclosedBuffers& b = buffers_;
  b.sides.begin(b.near.size());
  for (const EnclosedBuffers::Cuts& cuts : b.cuts) {
    // A triangle without area crosses nothing. Its edges overlap, and a point of several is assigned to one.
    if (!cuts.crosses) continue;
    VertexId v[3];
    rep.simplex(cuts.simplex, v);
    std::uint32_t near[3];
    bool on_surface[3];
    for (int k = 0; k < n; ++k) {
      near[k] = b.near(v[k]);
      on_surface[k] = b.location[near[k]] == EnclosedBuffers::Location::on_surface;
    }
    for (int k = 0; k < (n == 3 ? 3 : 1); ++k) {
      const int next = (k + 1) % n;
      if (on_surface[k] || on_surface[next] || (cuts.unclear >> k & 1) != 0) continue;
      // The paper's recursions miss pairs, so that the parity of their number is not known.
      if ((cuts.met >> k & 1) != 0 && result_.recursion != Recursion::complete) continue;
      b.sides.join(near[k], near[next], (cuts.odd >> k & 1) != 0);
    }
  }
}

SimplexId EnclosedVertices::simplex(std::uint32_t pair) const {
  return side_ == Side::a ? result_.pairs[pair].a : result_.pairs[pair].b;
}

bool EnclosedVertices::is_inside(std::uint32_t near, VertexId v) {
  using Location = EnclosedBuffers::Location;
  if (buffers_.location[near] == Location::on_surface) return false;
  const auto [leader, differs] = buffers_.sides.find(near);
  Location& known = buffers_.location[leader];
  if (known == Location::unknown) {
    const bool inside = (locate(holder_, body_.world(v)) == Where::inside) != differs;
    known = inside ? Location::inside : Location::outside;
  }
  return (known == Location::inside) != differs;
}

std::uint32_t EnclosedVertices::find_part(std::uint32_t near, VertexId seed) {
  EnclosedBuffers& b = buffers_;
  if (!is_inside(near, seed)) return b.part[near] = EnclosedBuffers::kOutside;
  // Breadth-first search over surface edges; each vertex is visited once.
  const auto part = static_cast<std::uint32_t>(b.parts.size());
  const auto visit = [&](VertexId v) {
    if (!b.reached.add(v).second) return;
    // Only edges of simplices in contact can cross the other surface, so that only their corners need to be
    // located. All other vertices reached from an inside vertex are inside.
    if (const std::uint32_t n = b.near(v); n != kNull) {
      if (!is_inside(n, v)) return;
      b.part[n] = part;
    }
    b.inside.push_back(v);
  };
  const std::size_t begin = b.inside.size();
  visit(seed);
  const SurfaceGraph& graph = body_.rep().surface_graph();
  for (std::size_t next = begin; next < b.inside.size(); ++next)
    for (const VertexId v : graph.neighbours(b.inside[next])) visit(v);
  b.parts.push_back({begin, b.inside.size()});
  return part;
}

std::span<const VertexId> EnclosedVertices::from(std::span<const std::uint32_t> pairs) {
  EnclosedBuffers& b = buffers_;
  if (!holder_.rep().closed()) return {};
  // The parts of the enclosed corners of the simplices in these pairs.
  b.listed.clear();
  ++calls_;
  for (const std::uint32_t i : pairs) {
    VertexId v[3];
    body_.rep().simplex(simplex(i), v);
    for (int k = 0; k < body_.rep().simplex_size(); ++k) {
      const std::uint32_t near = b.near(v[k]);
      std::uint32_t part = b.part[near];
      if (part == kNull) part = find_part(near, v[k]);
      if (part == EnclosedBuffers::kOutside || b.parts[part].call == calls_) continue;
      b.parts[part].call = calls_;
      b.listed.push_back(part);
    }
  }
  const auto vertices = [&](std::uint32_t part) {
    const auto& [begin, end, call] = b.parts[part];
    return std::span<const VertexId>(b.inside).subspan(begin, end - begin);
  };
  if (b.listed.empty()) return {};
  if (b.listed.size() == 1) return vertices(b.listed[0]);
  b.joined.clear();
  for (const std::uint32_t part : b.listed) {
    const std::span<const VertexId> more = vertices(part);
    b.joined.insert(b.joined.end(), more.begin(), more.end());
  }
  return b.joined;
}

namespace {

/// Returns true if two collinear segments of positive length have the same direction. Compares them along a
/// coordinate in which the first has extent.
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
      // Then one point of each part of the surfaces in no pair.
      if (free_patch_inside(side)) return Answer::yes;
    }
    for (const Side side : {Side::a, Side::b}) {
      group_pairs(side);
      // Last the cells of the faces in pairs, in rational arithmetic.
      if (const Answer answer = touched_face_inside(side); answer != Answer::no) return answer;
    }
    return between;
  }

 private:
  /// Answers for coplanar faces that overlap in an area (2D: a length) with the same orientation. Both solids
  /// are behind them, and a nearby point inside both proves the overlap. If no such point is found, the
  /// answer is unknown: rounding has folded a body in the world (far from the origin thin walls become flat),
  /// so that its faces need not face outward.
  Answer between_coinciding_faces() {
    // A reflection reverses orientations: if exactly one pose is a reflection, equal orientations mean
    // opposite sides.
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
      // Opposite directions: the solids are on different sides of the plane.
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
    const auto centroid = exact::RationalPoint::combination(corners, std::vector<double>(corners.size(), 1));
    const Eigen::Vector3d normal = normal_of(face);
    for (const double side : {-1.0, 1.0}) {
      const Eigen::Vector3d offset = centroid.rounded() + side * box.sizes().maxCoeff() * normal;
      const exact::RationalPoint ends[] = {centroid, exact::RationalPoint(offset.data())};
      for (const double share : kInteriorProbes) {
        // Decreasing distances from the plane: the body may be arbitrarily thin there.
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

  /// Tests one vertex of each patch of the surface that touched faces leave connected. Patches are connected
  /// by vertices that belong to no touched face. A patch without such a vertex consists of faces whose
  /// corners are all on touched faces; each of these faces is tested itself.
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
    const SurfaceGraph& graph = body.rep().surface_graph();
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
        // Depth-first search marks the patch, which is entirely on the same side.
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
      // One exact point in each cell. A cell does not cross the other surface, so it is entirely inside or
      // outside.
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
      // 3D: cells of the arrangement of cuts. The cell limit bounds its cubic cost.
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

// Proves that the interiors of two crossing bodies overlap: where two faces cross away from all further
// faces, they form four wedges, and one wedge is inside both bodies.

namespace {

using Corners = std::array<const double*, 3>;

/// Finds a face of A and a face of B that cross at a place without further faces of either surface. Parity
/// changes across each of the two faces, so that one of the four wedges between them is inside both bodies.
class CrossingProof {
 public:
  CrossingProof(QueryContext& ctx, const CollideResult& result)
      : ctx_(ctx), result_(result), dim_(ctx[Side::a].rep().dim()) {
    for (const SimplexPair& p : result.pairs) {
      // For each simplex, all simplices of the other body that it intersects.
      partners_[0][p.a].push_back(p.b);
      partners_[1][p.b].push_back(p.a);
    }
  }

  bool found() const {
    unsigned tries = 0;
    for (std::size_t i = 0; i < result_.pairs.size() && tries < kCrossingsTried; ++i) {
      if (result_.meets[i] != exact::Meet::cross) continue;
      ++tries;
      const SimplexPair& p = result_.pairs[i];
      // All simplices of A that could interfere near the crossing intersect p.b, and vice versa.
      if (is_alone(Side::a, p.a, partners_[1].at(p.b)) && is_alone(Side::b, p.b, partners_[0].at(p.a)))
        return true;
    }
    return false;
  }

 private:
  /// Returns true if, apart from `s`, none of the simplices in `others`, those of the body that intersect the
  /// partner of `s`, intersects the interior of `s`. Conservative: one that passes through the plane of `s`
  /// anywhere counts as intersecting.
  bool is_alone(Side side, SimplexId s, const std::vector<SimplexId>& others) const {
    Corners face;
    ctx_[side].world.corners(s, face.data());
    return std::all_of(others.begin(), others.end(), [&](SimplexId u) {
      if (u == s) return true;
      Corners other;
      ctx_[side].world.corners(u, other.data());
      return dim_ == 3 ? keeps_out(face, other) : keeps_out_2d(face, other);
    });
  }

  /// Returns true if the triangle `other` does not intersect the interior of `face`.
  static bool keeps_out(const Corners& face, const Corners& other) {
    std::vector<const double*> in_plane;
    bool above = false, below = false;
    for (const double* p : other) {
      // Exact side of each corner relative to the face's plane.
      const int side = exact::orient3d(face[0], face[1], face[2], p);
      above |= side > 0;
      below |= side < 0;
      if (side == 0) in_plane.push_back(p);
    }
    // It passes through the plane, possibly through the face.
    if (above && below) return false;
    for (int k = 0; k < 3; ++k) {
      // Otherwise only its corners in the plane can touch the face. If all are beyond the line of one edge,
      // they miss its interior.
      const double *p = face[k], *q = face[(k + 1) % 3];
      const int inward = side_in_plane(face.data(), p, q, face[(k + 2) % 3]);
      const bool beyond = std::all_of(in_plane.begin(), in_plane.end(), [&](const double* x) {
        return side_in_plane(face.data(), p, q, x) * inward <= 0;
      });
      if (beyond) return true;
    }
    return false;
  }

  /// The 2D case, for segments: all points on the line of `face` must be beyond one of its ends.
  static bool keeps_out_2d(const Corners& face, const Corners& other) {
    // A coordinate in which the segment has extent orders the points on its line.
    const int axis = face[0][0] != face[1][0] ? 0 : 1;
    const double low = std::min(face[0][axis], face[1][axis]), high = std::max(face[0][axis], face[1][axis]);
    bool above = false, below = false, before = true, after = true;
    for (int k = 0; k < 2; ++k) {
      const int side = exact::orient2d(face[0], face[1], other[k]);
      above |= side > 0;
      below |= side < 0;
      if (side != 0) continue;
      before &= other[k][axis] <= low;
      after &= other[k][axis] >= high;
    }
    return !(above && below) && (before || after);
  }

  QueryContext& ctx_;
  const CollideResult& result_;
  int dim_;
  std::map<SimplexId, std::vector<SimplexId>> partners_[2];
};

}  // namespace

Answer crossing_interiors_overlap(QueryContext& context, const CollideResult& result) {
  for (const Side side : {Side::a, Side::b})
    if (!context[side].rep().closed()) return Answer::unknown;
  return CrossingProof(context, result).found() ? Answer::yes : Answer::unknown;
}

}  // namespace lrb
