#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/Geometry>

#include "render/scene_parts.hpp"
#include <lrbscope/render/style.hpp>

namespace lrb::render {

// Hairs: parts of an outline that enclose nothing visible.

namespace {

using Eigen::Vector2d;

/// The part [from, to] of a segment, as shares of its length, along which another one is within the width.
struct Cover {
  double from, to;
  int direction;  ///< 1: the other has the same direction, -1: the opposite one
};

/// Returns the distance of a point from the line through p in direction `along` (of length 1).
double off_line(const Vector2d& x, const Vector2d& p, const Vector2d& along) {
  const Vector2d d = x - p;
  return std::abs(along.x() * d.y() - along.y() * d.x());
}

/// Appends the part of segment s that t covers.
void add_cover(const Segment2d& s, const Segment2d& t, double width, std::vector<Cover>& covers) {
  const Vector2d p = s[0].head<2>(), q = s[1].head<2>(), u = t[0].head<2>(), v = t[1].head<2>();
  const double length = (q - p).norm();
  if (!(length > 0)) return;
  const Vector2d along = (q - p) / length;
  const double a = along.dot(u - p) / length, b = along.dot(v - p) / length;
  const double from = std::max(0.0, std::min(a, b)), to = std::min(1.0, std::max(a, b));
  if (!(from < to)) return;
  // Both ends of the common part must be near the line, so that all of it is.
  for (const double share : {from, to})
    if (off_line(u + (v - u) * ((share - a) / (b - a)), p, along) > width) return;
  covers.push_back({from, to, a < b ? 1 : -1});
}

/// Appends the parts of a segment that its covers do not cancel, unless they are shorter than the width.
void add_rest(const Segment2d& s, const std::vector<Cover>& covers, double width,
              std::vector<Segment2d>& out) {
  const auto at = [&](double share) -> Eigen::Vector3d {
    return share <= 0 ? s[0] : share >= 1 ? s[1] : s[0] + share * (s[1] - s[0]);
  };
  std::vector<double> cuts = {0, 1};
  for (const Cover& c : covers) cuts.insert(cuts.end(), {c.from, c.to});
  std::sort(cuts.begin(), cuts.end());
  double begin = -1;  // of the part that is being extended; negative: none
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const double centre = (cuts[i] + cuts[i + 1]) / 2;
    int net = 1;
    for (const Cover& c : covers) net += c.from < centre && centre < c.to ? c.direction : 0;
    const bool kept = net != 0 && cuts[i] < cuts[i + 1];
    if (kept && begin < 0) begin = cuts[i];
    if (begin >= 0 && (net == 0 || i + 2 == cuts.size())) {
      const double end = net == 0 ? cuts[i] : cuts[i + 1];
      if ((end - begin) * (s[1] - s[0]).norm() > width) out.push_back({at(begin), at(end)});
      begin = -1;
    }
  }
}

}  // namespace

std::vector<Segment2d> without_hairs(const std::vector<Segment2d>& segments, double width) {
  std::vector<Segment2d> out;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    std::vector<Cover> covers;
    for (std::size_t j = 0; j < segments.size(); ++j)
      if (j != i) add_cover(segments[i], segments[j], width, covers);
    const bool any_opposite =
        std::any_of(covers.begin(), covers.end(), [](const Cover& c) { return c.direction < 0; });
    if (any_opposite)
      add_rest(segments[i], covers, width, out);
    else
      out.push_back(segments[i]);
  }
  return out;
}

}  // namespace lrb::render

namespace lrb::render::scene {
namespace {

using Eigen::Vector3d;
using Mark = LegendItem::Mark;

constexpr double kGhost = 0.82;  ///< share by which ghosts fade
constexpr std::uint8_t kRegionAlpha = 78;

class Scene2dBuilder {
 public:
  explicit Scene2dBuilder(const Context& c)
      : c_(c), rep_(*c.body.rep), style_(c.style()), body_(c.colour()), scale_(c.options.scale) {}

  void run() {
    // Fills first, then lines over them, with contacts last.
    for (RegionId r = 0; r < rep_.region_count(); ++r) region(r);
    solid();
    if (c_.isolating() || c_.options.explode > 0) {
      for (RegionId r = 0; r < rep_.region_count(); ++r) {
        if (shown(r))
          add_lines({rep_.collector(r).begin(), rep_.collector(r).end()}, style_.edge_of(body_), 1.4F, 0,
                    moved(r));
      }
    } else if (c_.body.wrapper != nullptr) {
      region_lines();
      wrapper_line();
    }
    if (!c_.isolating()) contact_lines();
  }

 private:
  bool shown(RegionId r) const {
    return c_.isolating() ? c_.isolated(r) : c_.body.wrapper != nullptr && (c_.included(r) || c_.refining(r));
  }

  Vector3d moved(RegionId r) const {
    if (!(c_.options.explode > 0)) return Vector3d::Zero();
    return exploded_way(rep_, c_.body.pose, r, c_.options.explode);
  }

  void region(RegionId r) {
    if (!shown(r)) return;
    DrawFill fill;
    fill.id = region_id(c_.side, r);
    // By priority: construction, refinement, colouring by layer or region, the body's colour.
    const bool telling = c_.options.colour_by == ColourBy::layer || c_.options.colour_by == ColourBy::region;
    fill.colour = telling ? style_.pale(c_.region_colour(r), 0.35) : with_alpha(body_, kRegionAlpha);
    if (c_.refining(r)) fill.colour = style_.pale(style_.refining, kRefining2d);
    if (c_.building()) fill.colour = built_colour(r);
    for (const FaceId f : rep_.collector(r)) add_segment(fill, f, moved(r));
    c_.out.list.fills.push_back(std::move(fill));
    if (c_.building()) return built_key(r);
    if (!telling && !c_.refining(r))
      c_.add_key(Mark::translucent, body_, c_.name() + ", regions",
                 LegendItem::Swatch{with_alpha(body_, kRegionAlpha), region_edge(), style_.paper});
    if (c_.options.colour_by == ColourBy::region)
      c_.add_key(Mark::solid, palette::category(0), "regions, one colour each");
  }

  /// Returns the colour of a region of a construction: those of earlier passes are pale.
  Rgba built_colour(RegionId r) const { return style_.pale(c_.built_colour(r), c_.built(r) ? 0.15 : 0.78); }

  void built_key(RegionId r) {
    const bool each = c_.options.colour_by == ColourBy::region;
    if (c_.built(r))
      c_.add_key(Mark::solid, built_colour(r), each ? "new regions, one colour each" : "new regions");
    else
      c_.add_key(Mark::solid, built_colour(r), "regions of earlier passes");
  }

  void solid() {
    DrawFill fill;
    fill.id = region_id(c_.side, 0) | ((1U << 30) - 1);
    const bool ghost = c_.isolating();
    fill.colour = style_.solid_2d(body_, c_.side);
    if (ghost && !c_.options.ghost_rest) return;
    if (ghost) fill.colour = style_.pale(fill.colour, kGhost);
    for (FaceId f = 0; f < rep_.real_face_count(); ++f) add_segment(fill, f, Vector3d::Zero());
    c_.out.list.fills.push_back(std::move(fill));
    c_.add_key(Mark::solid, c_.out.list.fills.back().colour,
               c_.name() + (ghost ? ", the rest" : ", real faces"));
    std::vector<FaceId> real(rep_.real_face_count());
    for (FaceId f = 0; f < real.size(); ++f) real[f] = f;
    if (c_.options.colour_by == ColourBy::value && !c_.body.face_values.empty()) {
      for (const FaceId f : real) add_lines({f}, c_.colour_of(f, kSolid), 4, 0);
    } else {
      add_lines(real, style_.pale(style_.edge_of(body_), ghost ? 0.6 : 0.0), 1.2F, 0);
    }
  }

  /// Drawn on top of the wrapper's line, which also runs along real faces.
  void contact_lines() {
    std::vector<FaceId> real;
    for (FaceId f = 0; f < rep_.real_face_count(); ++f)
      if (c_.in_contact(f)) real.push_back(f);
    add_lines(real, style_.contact, 3.5F, 0);
    if (!real.empty()) c_.add_key(Mark::line, style_.contact, c_.body.contact_name);
    if (c_.body.wrapper == nullptr) return;
    const std::vector<FaceId> pseudo = c_.pseudo_in_contact();
    add_lines(pseudo, style_.contact, 3.5F, 7);
    if (!pseudo.empty()) c_.add_key(Mark::dashed, style_.contact, "intersecting pseudo faces");
  }

  Rgba region_edge() const { return style_.pale(body_, 0.15); }

  /// Draws thin lines between regions, dashed between refined ones.
  void region_lines() {
    std::vector<FaceId> inside, gone;
    // Each pseudo face is between a region and another cell: classify it by the state of the region inside.
    for (FaceId f(rep_.real_face_count()); f < rep_.face_count(); ++f) {
      const CellId in = rep_.inner_cell(f);
      if (!is_region(in)) continue;
      if (c_.refining(in.as_region())) {
        add_lines({f}, style_.edge_of(style_.refining), 2.4F, 0);
      } else if (c_.included(in) && !c_.on_boundary(f)) {
        inside.push_back(f);
      } else if (!c_.on_boundary(f)) {
        gone.push_back(f);
      }
    }
    add_lines(inside, region_edge(), 1.1F, 0);
    // In a construction these regions do not exist yet.
    if (c_.building() || gone.empty()) return;
    add_lines(uncovered(gone), style_.pale(body_, 0.45), 1, 5);
    c_.add_key(Mark::dashed, style_.pale(body_, 0.45), c_.name() + ", pseudo faces refined");
  }

  /// Leaves out faces that lie on another one: two dashed lines on each other would look solid.
  std::vector<FaceId> uncovered(const std::vector<FaceId>& faces) const {
    constexpr double kNear = 1e-3;  // of the length: less than a line's width
    std::vector<std::vector<Vector3d>> corners;
    for (const FaceId f : faces) corners.push_back(c_.corners(f, Vector3d::Zero()));
    const auto is_on = [&](std::size_t f, std::size_t g) {
      const std::vector<Vector3d>&x = corners[f], &y = corners[g];
      // Most are beside each other.
      const Eigen::AlignedBox3d box_x = Eigen::AlignedBox3d(x[0]).extend(x[1]);
      const Eigen::AlignedBox3d box_y = Eigen::AlignedBox3d(y[0]).extend(y[1]);
      if (box_x.squaredExteriorDistance(box_y) > kNear * kNear * (y[1] - y[0]).squaredNorm()) return false;
      std::vector<Cover> covers;
      add_cover({x[0], x[1]}, {y[0], y[1]}, kNear * (y[1] - y[0]).norm(), covers);
      return !covers.empty() && covers[0].to - covers[0].from > 1 - kNear;
    };
    std::vector<FaceId> out;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      bool is_covered = false;
      for (std::size_t g = 0; g < faces.size() && !is_covered; ++g)
        is_covered = g != f && is_on(f, g) && (g < f || !is_on(g, f));
      if (!is_covered) out.push_back(faces[f]);
    }
    return out;
  }

  void wrapper_line() {
    const std::vector<FaceId> boundary = c_.body.wrapper->boundary();
    const Rgba colour = c_.wrapper_edge();
    if (c_.options.colour_by == ColourBy::value && !c_.body.face_values.empty()) {
      for (const FaceId f : boundary) add_lines({f}, c_.colour_of(f, kSolid), 4, 0);
      return;
    }
    add_outline(boundary, colour, 3);
    c_.add_key(Mark::line, colour, c_.name() + (c_.building() ? ", front" : ", wrapper"));
  }

  /// Draws the faces of a boundary without hairs, which would seem to be edges that end outside the body.
  void add_outline(const std::vector<FaceId>& boundary, Rgba colour, float width) {
    std::vector<Segment2d> lids;
    Eigen::AlignedBox3d box;
    for (const FaceId f : boundary) {
      const std::vector<Vector3d> x = c_.corners(f, Vector3d::Zero());
      for (const Vector3d& p : x) box.extend(p);
      if (!rep_.is_real(f)) lids.push_back({x[0], x[1]});
    }
    constexpr double kHair = 2e-4;  // of the body's diagonal: a fraction of a pixel
    const std::vector<Segment2d> rest = without_hairs(lids, kHair * box.diagonal().norm());
    if (rest == lids) return add_lines(boundary, colour, width, 0);
    std::vector<FaceId> real;
    for (const FaceId f : boundary)
      if (rep_.is_real(f)) real.push_back(f);
    add_lines(real, colour, width, 0);
    for (const Segment2d& s : rest) add_line({s[0], s[1]}, false, colour, width, 0);
  }

  void add_segment(DrawFill& fill, FaceId f, const Vector3d& by) const {
    const std::vector<Vector3d> x = c_.corners(f, by);
    fill.segments.push_back({x[0], x[1]});
  }

  void add_lines(const std::vector<FaceId>& faces, Rgba colour, float width, float dash,
                 const Vector3d& by = Vector3d::Zero()) {
    std::vector<std::array<VertexId, 2>> segments;
    for (const FaceId f : faces) segments.push_back({rep_.face(f)[0], rep_.face(f)[1]});
    // Chains, so that dashes and joins run through vertices.
    for (const Chain& chain : chains(segments)) {
      std::vector<Vector3d> points;
      for (const VertexId v : chain.vertices) points.push_back(c_.body.pose.apply(rep_.vertices()[v]) + by);
      add_line(std::move(points), chain.closed, colour, width, dash);
    }
  }

  void add_line(std::vector<Vector3d> points, bool closed, Rgba colour, float width, float dash) {
    c_.out.list.lines.push_back({std::move(points), closed, colour, width * scale_, dash * scale_});
  }

  const Context& c_;
  const LrbRep& rep_;
  const Style& style_;
  Rgba body_;
  float scale_;
};

}  // namespace

void add_body_2d(const Context& c) {
  Scene2dBuilder(c).run();
}

}  // namespace lrb::render::scene
