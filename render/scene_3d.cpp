#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <span>
#include <vector>

#include "render/scene_parts.hpp"
#include <lrbscope/render/style.hpp>

namespace lrb::render::scene {
namespace {

using Eigen::Vector3d;
using Mark = LegendItem::Mark;

/// Opacity of pseudo faces: translucent, so that covered faces look fainter than uncovered ones.
constexpr std::uint8_t kLidAlpha = 124;
constexpr std::uint8_t kLidEdgeAlpha = 220;
/// Edges on the far side are almost invisible: the hundreds of faces of a refined wrapper would clutter the
/// picture.
constexpr float kLidEdgeBack = 0.3F;
constexpr std::uint8_t kTellingAlpha = 175;  ///< if their colour carries information
constexpr std::uint8_t kRefiningAlpha = 120;
constexpr std::uint8_t kGhostAlpha = 14;
/// Faces that meet at a larger angle than this, in radians, have a crease between them. Connected creases
/// shorter than a share of the body's size are the noise of scans.
constexpr double kCrease = 0.7, kShortCrease = 0.08;
/// Lids of earlier passes of a construction: share by which their colour fades, and its opacity.
constexpr double kEarlierPale = 0.72;
constexpr std::uint8_t kEarlierAlpha = 215;

class Scene3dBuilder {
 public:
  explicit Scene3dBuilder(const Context& c) : c_(c), rep_(*c.body.rep), style_(c.style()) {
    const Rgba body = c.colour();
    const auto ink = palette::edge_of(body);
    real_edges_ = c.out.list.edge_style({with_alpha(ink, 150), 0.9F * c.options.scale});
    pale_edges_ = c.out.list.edge_style({with_alpha(ink, 90), 0.8F * c.options.scale});
    cell_edges_ = c.out.list.edge_style({with_alpha(palette::kInk, 150), 0.9F * c.options.scale});
    lid_edges_ = c.out.list.edge_style({lid_edge_colour(), 1.5F * c.options.scale, kLidEdgeBack});
  }

  void run() {
    if (!c_.refining().empty()) {
      const Rgba dark = with_alpha(style_.edge_of(style_.refining), kLidEdgeAlpha);
      refining_edges_ = c_.out.list.edge_style({dark, 1.4F * c_.options.scale, 0.5F});
    }
    if (c_.isolating()) {
      isolate();
    } else if (exploded()) {
      explode();
    } else {
      wrapper();
    }
    if (!exploded())
      for (const RegionId r : c_.refining()) refining(r);
    if (c_.options.contact_rims && !c_.isolating()) contact_rims();
  }

 private:
  /// Whether regions are drawn away from their places. Nothing then marks these.
  bool exploded() const { return c_.options.explode > 0 && !c_.isolating(); }

  // ---- the standard picture

  void wrapper() {
    real_faces();
    if (c_.body.wrapper == nullptr) return;
    lids_in_contact();
    std::vector<FaceId> lids;
    for (const FaceId f : c_.body.wrapper->boundary()) {
      const CellId behind = rep_.inner_cell(f);
      // Lids that are highlighted are drawn later in another style.
      const bool drawn_apart =
          is_region(behind) && (c_.refining(behind.as_region()) || c_.built(behind.as_region()));
      if (!rep_.is_real(f) && !c_.in_contact(f) && !drawn_apart) lids.push_back(f);
    }
    if (c_.options.borders) mark_region_borders(lids);
    // Translucent, in the painting order that the rasterizer determines.
    for (const FaceId f : lids) {
      DrawTriangle t = translucent(lid_colour(f));
      // Edges of faces, not lines, so that edges behind other lids show through them instead of being drawn
      // on top.
      t.edges = 7;
      t.edge_style = lid_edges_;
      add_face(f, t);
    }
    if (c_.building()) return built_lids(!lids.empty());
    if (lids.empty()) return;
    add_lid_key(lids.front());
  }

  void add_lid_key(FaceId lid) {
    if (c_.options.colour_by == ColourBy::kind)
      c_.add_key(Mark::translucent, c_.colour(), c_.name() + ", pseudo faces",
                 LegendItem::Swatch{lid_colour(lid), lid_edge_colour(), c_.colour()});
    if (c_.options.colour_by == ColourBy::region)
      c_.add_key(Mark::translucent, palette::category(0), "pseudo faces, one colour per region");
  }

  /// Draws the lids that a construction has just made, opaque like real faces. `others`: there are earlier
  /// ones.
  void built_lids(bool others) {
    for (const RegionId r : *c_.highlight.built) {
      std::vector<FaceId> lids;
      for (const FaceId f : rep_.lids(r))
        if (c_.on_boundary(f)) lids.push_back(f);
      // Real faces are opaque, and coloured by the highest priority that applies: contact, value, kind.
      DrawTriangle t;
      t.colour = c_.built_colour(r);
      t.nudge = 2;  // if they are coplanar with the covered faces
      t.edges = 7;
      t.edge_style = cell_edges_;
      for (const FaceId f : lids) add_face(f, t);
      add_outlines(lids, {mix(t.colour, style_.ink, 0.6), 2.2F * c_.options.scale}, Edges::rim);
    }
    const bool each = c_.options.colour_by == ColourBy::region;
    if (!c_.highlight.built->empty())
      c_.add_key(Mark::solid, c_.built_colour(c_.highlight.built->front()),
                 each ? "new lids, one colour per region" : "new lids");
    const Rgba earlier = each ? style_.pale(palette::category(0), kEarlierPale) : c_.colour();
    if (others) c_.add_key(each ? Mark::solid : Mark::translucent, earlier, "lids of earlier passes");
  }

  void lids_in_contact() {
    const std::vector<FaceId> lids = c_.pseudo_in_contact();
    DrawTriangle t = translucent(with_alpha(style_.contact, kTellingAlpha), 2);
    t.edges = 7;
    t.edge_style = lid_edges_;
    for (const FaceId f : lids) add_face(f, t);
    if (!lids.empty()) c_.add_key(Mark::translucent, style_.contact, "intersecting pseudo faces");
  }

  void contact_rims() {
    std::vector<FaceId> faces;
    if (c_.body.wrapper != nullptr && !exploded()) faces = c_.pseudo_in_contact();
    for (FaceId f = 0; f < rep_.real_face_count(); ++f)
      if (c_.in_contact(f)) faces.push_back(f);
    add_outlines(faces, {style_.contact, 2 * c_.options.scale}, Edges::rim_on_top);
  }

  void real_faces() {
    bool any_in_contact = false;
    if (c_.options.borders) mark_creases();
    for (FaceId f = 0; f < rep_.real_face_count(); ++f) {
      DrawTriangle t;
      t.colour = c_.in_contact(f) ? style_.contact : c_.colour_of(f, kSolid);
      if (is_region(rep_.outer_cell(f)) && c_.refining(rep_.outer_cell(f).as_region())) {
        t.colour = mix(t.colour, style_.refining, 0.6);
      }
      t.edges = c_.options.real_edges ? 7 : 0;
      t.edge_style = c_.body.wrapper != nullptr && !c_.on_boundary(f) ? pale_edges_ : real_edges_;
      any_in_contact |= c_.in_contact(f);
      add_face(f, t);
      add_degenerate(f, t.colour);
    }
    borders_.clear();
    if (any_in_contact) c_.add_key(Mark::solid, style_.contact, c_.body.contact_name);
    if (c_.options.colour_by == ColourBy::value) {
      c_.add_key(Mark::solid, style_.pale(c_.colour(), palette::kNoValuePale),
                 c_.name() + (c_.value_low > 0 ? ", faces with fewer " : ", faces without ") +
                     c_.options.value_name);
    } else {
      c_.add_key(Mark::solid, c_.colour_of(0, kSolid), c_.name() + ", real faces");
    }
  }

  Rgba lid_edge_colour() const { return with_alpha(mix(c_.colour(), c_.wrapper_edge(), 0.7), kLidEdgeAlpha); }

  Rgba lid_colour(FaceId f) const {
    if (c_.building() && c_.options.colour_by == ColourBy::region)
      return with_alpha(style_.pale(c_.colour_of(f, rep_.inner_cell(f)), kEarlierPale), kEarlierAlpha);
    const Rgba colour = c_.colour_of(f, rep_.inner_cell(f));
    switch (c_.options.colour_by) {
      case ColourBy::kind:
        return with_alpha(style_.pale(colour, style_.lid_pale[static_cast<std::size_t>(c_.side)]), kLidAlpha);
      case ColourBy::value:
        return with_alpha(colour, c_.has_value(f) ? kTellingAlpha : kLidAlpha);
      default:
        return with_alpha(colour, kTellingAlpha);
    }
  }

  void refining(RegionId r) {
    std::vector<FaceId> lids(rep_.lids(r).begin(), rep_.lids(r).end()), floor;
    // Real floor faces are drawn already; pseudo ones contribute their edges only.
    for (const FaceId f : rep_.floor(r)) {
      if (!rep_.is_real(f)) floor.push_back(f);
    }
    // Edges of faces fade where they are dense; a small region shows only its border and colour.
    DrawTriangle t = translucent(with_alpha(style_.refining, kRefiningAlpha), 2);
    t.edges = 7;
    t.edge_style = refining_edges_;
    for (const FaceId f : lids) add_face(f, t);
    t.colour = with_alpha(t.colour, 0);
    for (const FaceId f : floor) add_face(f, t);
    add_outlines(lids, {mix(style_.refining, style_.ink, 0.4), 2 * c_.options.scale}, Edges::rim_on_top);
  }

  // ---- single regions

  void isolate() {
    for (const RegionId r : c_.isolated()) region(r);
    if (!c_.isolated().empty()) {
      const Rgba colour = c_.region_colour(c_.isolated().front());
      c_.add_key(Mark::solid, colour,
                 c_.name() + ", region " + std::to_string(c_.isolated().front()) +
                     (c_.isolated().size() > 1 ? " and others" : ""));
    }
    if (!c_.options.ghost_rest) return;
    for (FaceId f = 0; f < rep_.real_face_count(); ++f) {
      if (is_region(rep_.outer_cell(f)) && c_.isolated(rep_.outer_cell(f).as_region()))
        continue;  // the region's floor is drawn
      add_face(f, translucent(with_alpha(c_.colour(), kGhostAlpha)));
    }
    c_.add_key(Mark::translucent, c_.colour(), c_.name() + ", the rest");
  }

  /// Draws the lids of the outer layers away from the body, and the outermost lids that stay.
  void explode() {
    real_faces();
    const auto is_shown = [&](CellId cell) {
      return is_region(cell) &&
             (c_.body.wrapper == nullptr || c_.included(cell) || c_.refining(cell.as_region()));
    };
    std::vector<Vector3d> ways;
    for (RegionId r = 0; r < rep_.region_count(); ++r)
      ways.push_back(exploded_way(rep_, c_.body.pose, r, c_.options.explode));
    for (FaceId f(rep_.real_face_count()); f < rep_.face_count(); ++f) {
      if (!is_shown(rep_.inner_cell(f))) continue;
      const RegionId r = rep_.inner_cell(f).as_region();
      const CellId before = rep_.outer_cell(f);
      if (ways[r].isZero(0) && is_shown(before) && ways[before.as_region()].isZero(0)) continue;
      DrawTriangle t =
          translucent(c_.refining(r) ? with_alpha(style_.refining, kRefiningAlpha) : lid_colour(f));
      t.edges = 7;
      t.edge_style = c_.refining(r) ? refining_edges_ : lid_edges_;
      add_face(f, t, ways[r]);
      add_lid_key(f);
    }
  }

  /// Draws a single region: its floor opaque, its lids translucent so that the floor is visible.
  void region(RegionId r) {
    Rgba colour = c_.region_colour(r);
    if (c_.options.colour_by == ColourBy::kind) colour = style_.pale(colour, 0.5);
    // A face of the collector is a lid if the region is on its inner side, else floor.
    for (const FaceId f : rep_.collector(r)) {
      DrawTriangle t;
      t.colour = c_.options.colour_by == ColourBy::value ? c_.colour_of(f, r) : colour;
      if (rep_.inner_cell(f) == r) {
        t = translucent(with_alpha(t.colour, kTellingAlpha));
      } else {
        t.edges = 7;
        t.edge_style = cell_edges_;
      }
      add_face(f, t);
    }
    const std::vector<FaceId> lids(rep_.lids(r).begin(), rep_.lids(r).end());
    add_outlines(lids, {style_.edge_of(colour), 1.8F * c_.options.scale});
  }

  // ---- helpers

  static DrawTriangle translucent(Rgba colour, std::int8_t nudge = 1) {
    DrawTriangle t;
    t.colour = colour;
    t.layer = Layer::translucent;
    t.nudge = nudge;  // so that a lid that coincides with a real face, in a region without volume, is visible
    return t;
  }

  using Edge = std::array<VertexId, 2>;  ///< the smaller vertex first
  Edge edge(FaceId f, std::size_t i) const {
    const auto corners = rep_.face(f);
    const VertexId a = corners[i], b = corners[(i + 1) % corners.size()];
    return {std::min(a, b), std::max(a, b)};
  }

  void add_face(FaceId f, DrawTriangle like, const Vector3d& moved = Vector3d::Zero()) {
    like.id = face_id(c_.side, f);
    std::vector<bool> borders;
    for (std::size_t i = 0; !borders_.empty() && i < rep_.face(f).size(); ++i)
      borders.push_back(std::binary_search(borders_.begin(), borders_.end(), edge(f, i)));
    std::vector<Vector3d> shape;
    for (const VertexId v : rep_.face(f)) shape.push_back(rep_.vertices()[v]);
    c_.out.list.add_polygon(c_.corners(f, moved), like, borders, shape);
  }

  /// Draws a triangle whose corners are in one line, as a ray is, or in one point.
  void add_degenerate(FaceId f, Rgba colour) {
    const auto v = rep_.face(f);
    const auto side = [&](std::size_t i) { return Vector3d(rep_.vertices()[v[i]] - rep_.vertices()[v[0]]); };
    if (v.size() != 3 || !side(1).cross(side(2)).isZero(0)) return;
    const std::vector<Vector3d> x = c_.corners(f);
    if (x[0] == x[1] && x[1] == x[2])
      c_.out.list.points.push_back({.x = x[0], .colour = colour, .radius = 4 * c_.options.scale});
    else
      c_.out.list.lines.push_back({.points = x, .colour = colour, .width = 2 * c_.options.scale});
  }

  // ---- borders

  struct SharedEdge {
    Edge edge;
    FaceId face;
  };

  /// Calls `action` with each edge of the faces, in order, and with those of the faces that have it.
  template <class Action>
  void for_each_edge(const std::vector<FaceId>& faces, const Action& action) const {
    std::vector<SharedEdge> edges;
    for (const FaceId f : faces)
      for (std::size_t i = 0; i < rep_.face(f).size(); ++i) edges.push_back({edge(f, i), f});
    std::sort(edges.begin(), edges.end(), [](const SharedEdge& x, const SharedEdge& y) {
      return x.edge != y.edge ? x.edge < y.edge : x.face < y.face;
    });
    for (std::size_t first = 0, end = 0; first < edges.size(); first = end) {
      for (end = first; end < edges.size() && edges[end].edge == edges[first].edge;) ++end;
      action(edges[first].edge, std::span(edges).subspan(first, end - first));
    }
  }

  /// Sets borders_ to the edges of faces that have one side only, or for whose pair of faces `apart` holds.
  template <class Apart>
  void mark_borders(const std::vector<FaceId>& faces, const Apart& apart) {
    borders_.clear();
    for_each_edge(faces, [&](const Edge& at, std::span<const SharedEdge> sides) {
      if (sides.size() != 2 || apart(sides[0].face, sides[1].face)) borders_.push_back(at);
    });
  }

  void mark_region_borders(const std::vector<FaceId>& lids) {
    mark_borders(lids, [&](FaceId f, FaceId g) { return rep_.inner_cell(f) != rep_.inner_cell(g); });
  }

  void mark_creases() {
    std::vector<FaceId> real(rep_.real_face_count());
    std::iota(real.begin(), real.end(), FaceId{0});
    const auto normal = [&](FaceId f) -> Vector3d {
      // The area vector of the polygon.
      const std::vector<Vector3d> x = c_.corners(f);
      Vector3d sum = Vector3d::Zero();
      for (std::size_t i = 1; i + 1 < x.size(); ++i) sum += (x[i] - x[0]).cross(x[i + 1] - x[0]);
      return sum.normalized();
    };
    mark_borders(real, [&](FaceId f, FaceId g) { return normal(f).dot(normal(g)) < std::cos(kCrease); });
    remove_short_creases();
  }

  /// Removes the connected components of borders_ that are short.
  void remove_short_creases() {
    // Disjoint sets of vertices: each edge joins the sets of its ends.
    std::map<VertexId, VertexId> parent;
    const auto root = [&](VertexId v) {
      while (parent.at(v) != v) v = parent[v] = parent.at(parent.at(v));
      return v;
    };
    for (const auto& [a, b] : borders_) {
      parent.try_emplace(a, a);
      parent.try_emplace(b, b);
      parent[root(a)] = root(b);
    }
    std::map<VertexId, double> length;
    Eigen::AlignedBox3d box;
    for (const auto& [a, b] : borders_) length[root(a)] += (rep_.vertices()[a] - rep_.vertices()[b]).norm();
    for (FaceId f = 0; f < rep_.real_face_count(); ++f)
      for (const VertexId v : rep_.face(f)) box.extend(rep_.vertices()[v]);
    const double least = kShortCrease * box.diagonal().norm();
    std::erase_if(borders_, [&](const Edge& e) { return length.at(root(e[0])) < least; });
  }

  enum class Edges : std::uint8_t {
    all,
    rim,         ///< edges of exactly one face
    rim_on_top,  ///< as rim, visible through all faces
  };

  /// Draws edges of faces as lines, each once. Lines keep their full width at outlines, where face edges show
  /// half.
  void add_outlines(const std::vector<FaceId>& faces, const EdgeStyle& style, Edges which = Edges::all) {
    for_each_edge(faces, [&](const Edge& at, std::span<const SharedEdge> sides) {
      // An edge of two faces is not on the boundary of the set.
      if (which != Edges::all && sides.size() > 1) return;
      DrawLine line;
      for (const VertexId v : at) line.points.push_back(c_.body.pose.apply(rep_.vertices()[v]));
      line.colour = style.colour;
      line.width = style.width;
      line.layer = which == Edges::rim_on_top ? Layer::on_top : Layer::translucent;
      line.nudge = 2;
      c_.out.list.lines.push_back(std::move(line));
    });
  }

  const Context& c_;
  const LrbRep& rep_;
  const Style& style_;
  std::vector<Edge> borders_;  ///< of the faces that are being added, ascending
  std::uint8_t real_edges_ = 0, pale_edges_ = 0, lid_edges_ = 0, cell_edges_ = 0, refining_edges_ = 0;
};

}  // namespace

void add_body_3d(const Context& c) {
  Scene3dBuilder(c).run();
}

}  // namespace lrb::render::scene
