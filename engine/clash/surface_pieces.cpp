/// Counts the pieces into which each of two surfaces is cut by the other; exact. Steps for each surface:
/// 1. Cut the triangles that intersect the other body into cells: by the chains of intersection segments
///    in the simple case, otherwise in rational arithmetic.
/// 2. Make a graph of the uncut triangles and the cells. Two nodes are connected if they share a part of an
///    edge that is not on the other surface. Its connected components, found by union-find, are the pieces.
/// 3. Locate one point of each piece: inside the other solid, outside, or on its surface.

#include "engine/clash/surface_pieces.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/clash/clash_tolerances.hpp"
#include "engine/clash/simple_cut.hpp"
#include "engine/collide/interiors.hpp"
#include "engine/collide/relation.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/locate.hpp"
#include "engine/exact/predicates.hpp"
#include "engine/mesh/vertex_groups.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/core/disjoint_sets.hpp>

namespace lrb {
namespace {

/// The use of an edge by a triangle.
struct EdgeUse {
  VertexId from, to;  ///< by position, from < to
  SimplexId simplex;
  int edge;
  bool reversed;  ///< the simplex traverses it from `to` to `from`
};

/// A triangle that intersects the other body. In the simple case, which is by far the most frequent, its
/// cells follow from the order along its border, otherwise from rational arithmetic.
struct TouchedFace {
  std::vector<std::uint32_t> pairs;  ///< into the result
  std::optional<SimpleCut> simple;
  std::optional<exact::CutFace> cut;
  std::uint32_t first_node = 0;

  std::size_t cell_count() const { return simple ? simple->cell_count() : cut->samples().size(); }
};

/// The surface of one body, cut by the other.
class CutSurface {
 public:
  CutSurface(QueryContext& ctx, Side side, const CollideResult& result,
             const std::vector<exact::PairContact>& contacts)
      : body_(ctx[side]),
        holder_(ctx[other(side)]),
        side_(side),
        result_(result),
        contacts_(contacts),
        place_(first_at_positions(body_.rep().vertices())),
        holder_place_(first_at_positions(holder_.rep().vertices())),
        nodes_(0),
        surface_(body_.rep().real_simplex_count()) {}

  /// Returns the counts of pieces, or nullopt if that fails; sets `why` then.
  std::optional<SurfacePieces> run(ClashReason& why) {
    const auto pieces = count_pieces();
    // The cause is a face that is degenerate in the world, or too many cells.
    if (!pieces) why = touches_flat_face() ? ClashReason::flat_face : ClashReason::many_cells;
    return pieces;
  }

  /// After run(): returns whether the body has interior points beside one of its pieces inside the holder. A
  /// face for which that is not decided counts.
  bool has_solid_inside() {
    for (SimplexId s = 0; s < body_.rep().real_simplex_count(); ++s) {
      const auto face = touched_.find(s);
      if (face == touched_.end()) {
        if (is_inside_[nodes_.leader(s.value())] && has_solid_at(s, corner_of(s))) return true;
        continue;
      }
      for (std::uint32_t i = 0; i < face->second.cell_count(); ++i)
        if (is_inside_[nodes_.leader(face->second.first_node + i)] &&
            has_solid_at(s, point_of_cell(s, face->second, i)))
          return true;
    }
    return false;
  }

 private:
  exact::RationalPoint corner_of(SimplexId s) {
    const double* corners[3];
    body_.world.corners(s, corners);
    return exact::RationalPoint(corners[0]);
  }

  /// Returns whether the body is solid beside a face, near a point of it inside the holder.
  bool has_solid_at(SimplexId s, const exact::RationalPoint& p) {
    const double* corners[3];
    body_.world.corners(s, corners);
    std::vector<exact::RationalPoint> points = {p};
    for (const double* corner : corners) points.emplace_back(corner);
    // Points inside the face, nearer and nearer, until one is inside the holder and on no edge.
    for (const double share : {0.25, 0x1p-10, 0x1p-20, 0x1p-40, 0x1p-80}) {
      const double weights[] = {1 - share, 0.31 * share, 0.27 * share, 0.42 * share};
      const auto near = exact::RationalPoint::combination(points, weights);
      if (locate(holder_, near) != Where::inside) continue;
      if (const auto solid = has_solid_beside(body_, near)) return *solid;
    }
    return true;
  }

  std::optional<SurfacePieces> count_pieces() {
    // Step 1: cut the triangles that intersect the other body.
    if (!cut_faces()) return std::nullopt;
    // Step 2: visit every edge with all its uses (two, unless the edge is non-manifold), and connect the
    // nodes at it.
    const std::vector<EdgeUse> uses = edge_uses();
    for (std::size_t i = 0; i < uses.size();) {
      std::size_t end = i + 1;
      while (end < uses.size() && uses[end].from == uses[i].from && uses[end].to == uses[i].to) ++end;
      if (!join_at({uses.data() + i, end - i})) return std::nullopt;
      i = end;
    }
    // Step 3: locate a point of each piece.
    return count();
  }

  bool touches_flat_face() {
    return std::any_of(result_.pairs.begin(), result_.pairs.end(), [&](const SimplexPair& pair) {
      // Rounding to world coordinates may make corners collinear.
      const double *x[3], *y[3];
      body_.world.corners(own(pair), x);
      holder_.world.corners(others(pair), y);
      return exact::collinear3d(x[0], x[1], x[2]) || exact::collinear3d(y[0], y[1], y[2]);
    });
  }

  SimplexId own(const SimplexPair& p) const { return side_ == Side::a ? p.a : p.b; }
  SimplexId others(const SimplexPair& p) const { return side_ == Side::a ? p.b : p.a; }

  bool cut_faces() {
    node_count_ = body_.rep().real_simplex_count();
    // Group the contacts by triangle.
    for (std::uint32_t i = 0; i < result_.pairs.size(); ++i)
      touched_[own(result_.pairs[i])].pairs.push_back(i);
    for (auto& [s, face] : touched_) {
      // Rational arithmetic is slow: used only if the simple method fails.
      face.simple = simple_cut(s, face);
      if (!face.simple) face.cut = rational_cut(s, face);
      if (!face.simple && !face.cut) return false;
      // One node of the graph for each cell.
      face.first_node = node_count_;
      node_count_ += static_cast<std::uint32_t>(face.cell_count());
    }
    nodes_.reset(node_count_);
    return true;
  }

  std::optional<exact::CutFace> rational_cut(SimplexId s, const TouchedFace& face) {
    const double* corners[3];
    body_.world.corners(s, corners);
    // Triangles in the face's plane cut only by their outline (collide/interiors.hpp).
    FaceCutters cutters(corners, holder_);
    for (const std::uint32_t i : face.pairs) cutters.add(others(result_.pairs[i]));
    return exact::CutFace::make(corners, cutters.all(), kInteriorCellsPerFace);
  }

  std::optional<SimpleCut> simple_cut(SimplexId s, const TouchedFace& face) {
    SimpleCut cut;
    const double* corners[3];
    body_.world.corners(s, corners);
    for (const std::uint32_t i : face.pairs) {
      const exact::PairContact& contact = contacts_[i];
      // Only a transversal crossing along a segment is simple: no touch, no coplanar overlap.
      if (contact.meet != exact::Meet::cross || contact.coplanar || contact.corner_count != 2)
        return std::nullopt;
      const SimplexId t = others(result_.pairs[i]);
      VertexId v[3] = {0, 0, 0};
      holder_.rep().simplex(t, v);
      SimpleCut::End ends[2];
      // At an end an edge of one triangle pierces the interior of the other. All other cases are degenerate.
      for (std::size_t c = 0; c < 2; ++c) {
        const exact::ContactCorner& corner = contact.corners[c];
        const exact::Feature own = side_ == Side::a ? corner.on_a : corner.on_b;
        const exact::Feature other = side_ == Side::a ? corner.on_b : corner.on_a;
        if (own.dim == 1 && other.dim == 2) {
          // An edge of this face ends the chain at the border: the end is identified by the other triangle.
          ends[c] = SimpleCut::End::on_border(own.index, corner.x, corners, t);
        } else if (own.dim == 2 && other.dim == 1) {
          // Inside: identified by the other surface's edge, so that the next segment of the chain has the
          // same identifier.
          const auto [low, high] =
              std::minmax(holder_place_[v[other.index]], holder_place_[v[(other.index + 1) % 3]]);
          ends[c] = SimpleCut::End::inside(low, high);
        } else {
          return std::nullopt;
        }
      }
      cut.add(ends[0], ends[1]);
    }
    return cut.close() ? std::optional(std::move(cut)) : std::nullopt;
  }

  std::vector<EdgeUse> edge_uses() const {
    const LrbRep& rep = body_.rep();
    std::vector<EdgeUse> uses;
    for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
      VertexId v[3] = {0, 0, 0};  // set by simplex(), which gcc 12 does not detect
      rep.simplex(s, v);
      for (int k = 0; k < 3; ++k) {
        // The key is independent of the direction, which `reversed` stores.
        const VertexId from = place_[v[k]], to = place_[v[(k + 1) % 3]];
        uses.push_back({std::min(from, to), std::max(from, to), s, k, to < from});
      }
    }
    std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
      return std::tie(a.from, a.to, a.simplex) < std::tie(b.from, b.to, b.simplex);
    });
    return uses;
  }

  /// Connects the nodes along one edge. Returns false if that cannot be decided.
  bool join_at(std::span<const EdgeUse> uses) {
    // Components of the uncut surface, for `max_outside`.
    for (const EdgeUse& use : uses) surface_.join(uses[0].simplex, use.simplex);
    const double *from = body_.world(uses[0].from), *to = body_.world(uses[0].to);
    bool is_free = false, any_touched = false;
    // If a triangle at this edge intersects nothing, no point of the edge is on the other surface.
    for (const EdgeUse& use : uses) (touched_.contains(use.simplex) ? any_touched : is_free) = true;
    // Case 1: no triangle here intersects the other body.
    if (!any_touched) {
      for (const EdgeUse& use : uses) nodes_.join(uses[0].simplex, use.simplex);
      return true;
    }
    // Case 2: all triangles are uncut or simple, and have the same parts of the edge.
    if (const std::size_t parts = simple_parts(uses)) {
      for (std::size_t i = 0; i < parts; ++i) join_parts(uses, i);
      return true;
    }
    // Case 3: a face was cut in rational arithmetic, or parts differ. Find the triangles that cut the edge.
    std::vector<std::array<const double*, 3>> cutting;
    bool ends_touched[2] = {false, false};
    if (!is_free) is_free = find_cutting(uses, cutting, ends_touched);
    // A rational point in each part of the edge.
    const auto samples = exact::sample_edge(from, to, cutting);
    if (!samples) return false;
    // Parts are numbered along the edge: a simple face must have the same number.
    for (const EdgeUse& use : uses)
      if (const auto face = touched_.find(use.simplex);
          face != touched_.end() && face->second.simple &&
          face->second.simple->part_count(use.edge) != samples->size())
        return false;
    // Connect the nodes beside each part, unless the part is on the other surface.
    for (std::size_t i = 0; i < samples->size(); ++i)
      if (is_free || locate(holder_, (*samples)[i]) != Where::on_surface) join_beside(uses, (*samples)[i], i);
    return true;
  }

  /// Returns the number of parts into which an edge is cut, or 0 unless its triangles are all uncut or simple
  /// and agree on that number.
  std::size_t simple_parts(std::span<const EdgeUse> uses) const {
    std::size_t parts = 0;
    for (const EdgeUse& use : uses) {
      const auto face = touched_.find(use.simplex);
      const bool is_touched = face != touched_.end();
      // Cells of rational cuts are found by points, not by numbers.
      if (is_touched && !face->second.simple) return 0;
      const std::size_t own = is_touched ? face->second.simple->part_count(use.edge) : 1;
      // The triangles disagree: left to the general case.
      if (parts != 0 && own != parts) return 0;
      parts = own;
    }
    return parts;
  }

  void join_parts(std::span<const EdgeUse> uses, std::size_t part) {
    const std::uint32_t first = node_at(uses[0], part);
    for (const EdgeUse& use : uses) nodes_.join(first, node_at(use, part));
  }

  /// Returns the node beside a part of an edge, counted from the edge's lower end, in an uncut or simple
  /// triangle.
  std::uint32_t node_at(const EdgeUse& use, std::size_t part) const {
    const auto face = touched_.find(use.simplex);
    if (face == touched_.end()) return use.simplex.value();
    const SimpleCut& cut = *face->second.simple;
    // The triangle traverses the edge in the other direction: count from its other end.
    const std::size_t own = use.reversed ? cut.part_count(use.edge) - 1 - part : part;
    return face->second.first_node + cut.cell_beside(use.edge, own);
  }

  /// Finds the triangles of the other body that intersect the interior of an edge in a point or in the end of
  /// a segment. Returns true if no triangle does and an end of the edge is free: then its entire interior is
  /// free.
  bool find_cutting(std::span<const EdgeUse> uses, std::vector<std::array<const double*, 3>>& cutting,
                    bool ends_touched[2]) {
    for (const EdgeUse& use : uses)
      for (const std::uint32_t i : touched_.at(use.simplex).pairs) {
        bool on_edge = false;
        // Corners of the contact that are inside this edge, or at its ends.
        for (int c = 0; c < contacts_[i].corner_count; ++c) {
          const exact::ContactCorner& corner = contacts_[i].corners[static_cast<std::size_t>(c)];
          const exact::Feature on = side_ == Side::a ? corner.on_a : corner.on_b;
          on_edge |= on.dim == 1 && on.index == use.edge;
          for (int end = 0; end < 2; ++end)
            ends_touched[end] |= on.dim == 0 && on.index == (use.edge + end) % 3;
        }
        if (!on_edge) continue;
        std::array<const double*, 3> corners;
        holder_.world.corners(others(result_.pairs[i]), corners.data());
        cutting.push_back(corners);
      }
    // Without such corners, only a contact along the entire edge remains, which would include both ends.
    return cutting.empty() && !(ends_touched[0] && ends_touched[1]);
  }

  std::uint32_t node_beside(const EdgeUse& use, const exact::RationalPoint& p, std::size_t part) const {
    const auto face = touched_.find(use.simplex);
    if (face == touched_.end() || face->second.simple) return node_at(use, part);
    return face->second.first_node + static_cast<std::uint32_t>(face->second.cut->cell_beside(use.edge, p));
  }

  /// With a simple face among the triangles, the edge is cut exactly where it intersects the other surface,
  /// so that the numbers of parts and samples agree.
  void join_beside(std::span<const EdgeUse> uses, const exact::RationalPoint& p, std::size_t part) {
    const std::uint32_t first = node_beside(uses[0], p, part);
    for (const EdgeUse& use : uses) nodes_.join(first, node_beside(use, p, part));
  }

  SurfacePieces count() {
    SurfacePieces out;
    std::map<std::uint32_t, std::uint32_t> outside;  // component of the surface -> its pieces outside
    std::vector<bool> seen(node_count_, false);
    is_inside_.assign(node_count_, false);
    const auto locate_group = [&](std::uint32_t node, SimplexId s, const auto& where) {
      const std::uint32_t group = nodes_.leader(node);
      // One point decides for the entire piece, because no piece crosses the other surface.
      if (seen[group]) return;
      seen[group] = true;
      const Where w = where();
      if (w == Where::inside) ++out.inside, is_inside_[group] = true;
      // Two or more pieces outside on one component mean that the other body passes through it.
      if (w == Where::outside)
        out.max_outside = std::max(out.max_outside, ++outside[surface_.leader(s.value())]);
      out.outside += w == Where::outside;
    };
    for (SimplexId s = 0; s < body_.rep().real_simplex_count(); ++s) {
      const auto face = touched_.find(s);
      if (face == touched_.end()) {
        VertexId v[3];
        body_.rep().simplex(s, v);
        // An uncut triangle: any corner will do.
        locate_group(s.value(), s, [&] { return locate(holder_, body_.world(v[0])); });
        continue;
      }
      // A cut triangle: one point for each cell.
      for (std::uint32_t i = 0; i < face->second.cell_count(); ++i)
        locate_group(face->second.first_node + i, s, [&] { return locate_cell(s, face->second, i); });
    }
    return out;
  }

  Where locate_cell(SimplexId s, const TouchedFace& face, std::uint32_t cell) {
    if (face.simple)
      if (const auto [edge, share] = face.simple->place_on_border(cell); share == 0) {
        const double* corners[3];
        body_.world.corners(s, corners);
        return locate(holder_, corners[edge]);
      }
    return locate(holder_, point_of_cell(s, face, cell));
  }

  exact::RationalPoint point_of_cell(SimplexId s, const TouchedFace& face, std::uint32_t cell) {
    // Rational cells have a sample point already.
    if (!face.simple) return face.cut->samples()[cell];
    const double* corners[3];
    body_.world.corners(s, corners);
    // A simple cell has a part of the border: take a point of it between the ends of chains.
    const auto [edge, share] = face.simple->place_on_border(cell);
    // Rational, so that the point is exactly on the edge.
    const exact::RationalPoint ends[] = {exact::RationalPoint(corners[edge]),
                                         exact::RationalPoint(corners[(edge + 1) % 3])};
    const double weights[] = {1 - share, share};
    return exact::RationalPoint::combination(ends, weights);
  }

  QueryBody& body_;
  QueryBody& holder_;
  const Side side_;
  const CollideResult& result_;
  const std::vector<exact::PairContact>& contacts_;
  const std::vector<VertexId> place_, holder_place_;
  std::map<SimplexId, TouchedFace> touched_;
  std::uint32_t node_count_ = 0;
  DisjointSets nodes_;           ///< simplices in no contact, by their number, then cells
  DisjointSets surface_;         ///< simplices
  std::vector<bool> is_inside_;  ///< (nodes) of a piece, by its leader: inside the holder
};

/// Returns the reason why two bodies do not bound two solids, or `none` if they do.
ClashReason reason_of_bodies(const LrbRep& a, const LrbRep& b) {
  return !a.closed()           ? ClashReason::a_open
         : !b.closed()         ? ClashReason::b_open
         : a.overlaps_itself() ? ClashReason::a_overlaps
         : b.overlaps_itself() ? ClashReason::b_overlaps
                               : ClashReason::none;
}

}  // namespace

std::optional<std::array<SurfacePieces, 2>> surface_pieces(QueryContext& context, const CollideResult& result,
                                                           ClashReason& why, bool* solid_inside) {
  why = reason_of_bodies(context[Side::a].rep(), context[Side::b].rep());
  if (why != ClashReason::none) return std::nullopt;
  std::vector<exact::PairContact> contacts;
  bool on_same = false, on_opposite = false;
  // A reflection reverses the normals of its body.
  const bool mirrored =
      is_reflection(context[Side::a].world.pose(), 3) != is_reflection(context[Side::b].world.pose(), 3);
  for (const SimplexPair& pair : result.pairs) {
    const double *a[3], *b[3];
    context[Side::a].world.corners(pair.a, a);
    context[Side::b].world.corners(pair.b, b);
    // The exact intersection of each pair, used for both surfaces.
    contacts.push_back(exact::contact_of_triangles(a, b));
    // Overlap of positive area in a common plane: are the solids on the same side of it?
    if (!contacts.back().coplanar || contacts.back().corner_count < 3) continue;
    (same_direction_3d(a, b) != mirrored ? on_same : on_opposite) = true;
  }
  if (solid_inside != nullptr) *solid_inside = false;
  std::array<SurfacePieces, 2> out;
  // Each surface is cut by the other.
  for (const Side side : {Side::a, Side::b}) {
    CutSurface surface(context, side, result, contacts);
    const std::optional<SurfacePieces> pieces = surface.run(why);
    if (!pieces) return std::nullopt;
    if (solid_inside != nullptr && !*solid_inside) *solid_inside = surface.has_solid_inside();
    out[static_cast<std::size_t>(side)] = *pieces;
    out[static_cast<std::size_t>(side)].on_same = on_same;
    out[static_cast<std::size_t>(side)].on_opposite = on_opposite;
  }
  return out;
}

}  // namespace lrb
