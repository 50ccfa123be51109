#include "render/pictures/marks.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include <lrbscope/core/strings.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/render/overlay.hpp>
namespace lrb::pictures {

void add_box(render::DrawList& list, const Eigen::Vector3d& centre,
             const std::array<Eigen::Vector3d, 3>& half, const BoxStyle& style) {
  const auto corner = [&](int x, int y, int z) -> Eigen::Vector3d {
    return centre + (x * 2 - 1) * half[0] + (y * 2 - 1) * half[1] + (z * 2 - 1) * half[2];
  };
  render::DrawLine line;
  line.colour = style.colour;
  line.width = style.width;
  line.dash = style.dash;
  line.layer = style.through ? render::Layer::on_top : render::Layer::translucent;
  for (int z = 0; z < 2; ++z) {
    line.points = {corner(0, 0, z), corner(1, 0, z), corner(1, 1, z), corner(0, 1, z)};
    line.closed = true;
    list.lines.push_back(line);
  }
  line.closed = false;
  for (int x = 0; x < 2; ++x)
    for (int y = 0; y < 2; ++y) {
      line.points = {corner(x, y, 0), corner(x, y, 1)};
      list.lines.push_back(line);
    }
}

using Eigen::Vector3d;

std::vector<Vector3d> corners_of(const LrbRep& rep, const Pose& pose, SimplexId s) {
  VertexId v[3];
  rep.simplex(s, v);
  std::vector<Vector3d> out;
  out.reserve(3);
  for (int k = 0; k < rep.simplex_size(); ++k) out.push_back(pose.apply(rep.vertices()[v[k]]));
  return out;
}

void outline(render::DrawList& list, const std::vector<Vector3d>& corners, render::Rgba colour, float width,
             render::Rgba halo) {
  render::DrawLine line;
  line.points = corners;
  line.closed = corners.size() > 2;
  line.colour = colour;
  line.width = width;
  line.halo = halo;
  line.halo_width = kHalo;
  line.layer = render::Layer::on_top;
  list.lines.push_back(line);
}

void add_sheet(render::DrawList& list, const std::vector<Vector3d>& corners) {
  render::DrawTriangle like;
  like.colour = render::with_alpha(kSeparationColour, 90);
  like.layer = render::Layer::translucent;
  like.lit = false;
  list.add_polygon(corners, like);
}

void add_mark(render::DrawList& list, const Vector3d& x, render::Rgba colour, float radius,
              render::Rgba halo) {
  render::DrawPoint point;
  point.x = x;
  point.colour = colour;
  point.radius = radius;
  point.halo = halo;
  point.halo_width = kHalo;
  point.layer = render::Layer::on_top;
  list.points.push_back(point);
}

void add_wrong_pairs(render::DrawList& list, std::span<const WrongPair> pairs, const PosedBodies& bodies,
                     render::Rgba halo) {
  constexpr float kLineWidth = 2.5F;
  for (const WrongPair& wrong : pairs) {
    outline(list, corners_of(bodies.a, bodies.pose_a, wrong.pair.a), render::palette::kWrong, kLineWidth,
            halo);
    outline(list, corners_of(bodies.b, bodies.pose_b, wrong.pair.b), render::palette::kWrong, kLineWidth,
            halo);
  }
}

namespace {

constexpr float kSegmentWidth = 4, kThin = 0.8F, kTextHeight = 19;

/// Writes a text beside the bodies: see with_leaders().
void write_at(render::DrawList& list, const Vector3d& x, const std::string& text,
              const render::Style& style) {
  list.labels.push_back({x, text, style.ink, kTextHeight, 0, 0, style.paper});
}

/// Draws the barbs of an arrowhead in the plane of the arrow and `across`.
void add_barbs(render::DrawList& list, const MarkedSegment& arrow, const Vector3d& across,
               render::Rgba colour, float width = kSegmentWidth) {
  constexpr double kHeadLength = 0.24, kHeadWidth = 0.11;
  const Vector3d along = arrow.to - arrow.from;
  const Vector3d back = arrow.to - kHeadLength * along, aside = kHeadWidth * along.norm() * across;
  for (const Vector3d& end : {Vector3d(back + aside), Vector3d(back - aside)})
    outline(list, {end, arrow.to}, colour, width);
}

}  // namespace

render::DrawList with_leaders(render::DrawList list, const render::Projection& projection,
                              const Eigen::AlignedBox2d& frame) {
  using Eigen::Vector2d;
  constexpr float kMaxShare = 0.05F,
                  kLeastHeight = 7;  // of labels, relative to the picture's height; pixels
  constexpr double kOff = 6, kBeside = 14, kOutside = 3, kOfLine = 10;
  constexpr int kSamples = 64;
  if (list.labels.empty()) return list;
  // Step 1: the points that a label should not cover: corners, and then points along lines.
  std::vector<Vector2d> taken;
  const auto take = [&](const Vector3d& x) {
    if (const auto at = projection.to_pixel(x)) taken.push_back(*at);
  };
  for (const Vector3d& x : render::extent_points(list)) take(x);
  const std::size_t corners = taken.size();
  for (const render::DrawLine& l : list.lines)
    for (std::size_t i = 0; i + 1 < l.points.size(); ++i)
      for (int k = 1; k < kSamples; ++k) take(l.points[i] + (l.points[i + 1] - l.points[i]) * k / kSamples);
  Eigen::AlignedBox2d all;
  for (const Vector2d& p : taken) all.extend(p);
  for (render::DrawLabel& label : list.labels) {
    const auto at = projection.to_pixel(label.x);
    if (label.dx != 0 || label.dy != 0 || !at) continue;
    render::TextStyle style;
    style.height = label.height =
        std::min(label.height, std::max(kLeastHeight, kMaxShare * static_cast<float>(frame.sizes().y())));
    const render::TextSize size = render::default_font().measure(label.text, style);
    const Vector2d half(size.width / 2.0 + kOff, size.height / 2.0 + kOff);
    // Step 2: the nearest place beside the point, or beside everything. One that has to be moved into the
    // picture, or that covers points, counts as farther away.
    Vector2d direction = Vector2d::Zero();
    double least = INFINITY;
    for (const int axis : {1, 0})
      for (const double end :
           {all.min()[axis], (*at)[axis] - kBeside, (*at)[axis] + kBeside, all.max()[axis]}) {
        Vector2d place = *at;
        place[axis] = end + (end < (*at)[axis] ? -1 : 1) * half[axis];
        const Vector2d inside = place.cwiseMin(frame.max() - half).cwiseMax(frame.min() + half);
        const Eigen::AlignedBox2d box(inside - half, inside + half);
        double far = (inside - *at).norm() + kOutside * (inside - place).norm();
        for (std::size_t i = 0; i < taken.size(); ++i)
          if (box.contains(taken[i])) far += i < corners ? 1 : kOfLine;
        if (far < least) least = far, direction = inside - *at;
      }
    label.dx = static_cast<float>(direction.x());
    label.dy = static_cast<float>(direction.y());
    // Step 3: a line to the border of the text, unless it is beside the point; in front of everything, so
    // that it is solid.
    const double end = 1 - (half.array() / direction.array().abs().max(1e-9)).minCoeff();
    if (end * direction.norm() <= kBeside + kOff) continue;
    const Vector3d shift = projection.axes().transpose() * Vector3d(direction.x(), -direction.y(), 0),
                   to_viewer = projection.towards_viewer(label.x);
    constexpr double kInFront = 0.98;  // of the way to the near plane
    const double depth = kInFront * (projection.to_eye(label.x).z() - projection.near_depth());
    const Vector3d from = label.x + depth / std::abs(projection.axes().row(2).dot(to_viewer)) * to_viewer;
    outline(list, {from, from + end * projection.unit_per_pixel(from) * shift}, label.colour, 1, label.halo);
    list.lines.back().halo_width = 1;
  }
  return list;
}

void add_arrow(render::DrawList& list, const Vector3d& from, const Vector3d& to, render::Rgba colour) {
  const Vector3d along = to - from;
  if (along.isZero()) return;
  // In the plane of a 2D body, and otherwise as upright as possible.
  Vector3d across = along.cross(Vector3d::UnitZ());
  if (across.norm() < 0.1 * along.norm()) across = along.cross(Vector3d::UnitX());
  constexpr float kWidth = kSegmentWidth / 2;
  outline(list, {from, to}, colour, kWidth);
  add_barbs(list, {from, to, ""}, across.normalized(), colour, kWidth);
}

std::string interval_text(double lower, double upper) {
  const std::string low = render::short_number(lower), high = render::short_number(upper);
  return low == high ? high : lower == 0 && std::isfinite(upper) ? "\u2264 " + high : low + " to " + high;
}

std::string kind_text(ClashKind kind) {
  switch (kind) {
    case ClashKind::a_inside_b:
      return "A inside B";
    case ClashKind::b_inside_a:
      return "B inside A";
    case ClashKind::touching_point:
      return "touching in points";
    case ClashKind::touching_edge:
      return "touching along lines";
    case ClashKind::touching_face:
      return "touching in faces";
    case ClashKind::protrudes:
      return "one protrudes into the other";
    case ClashKind::pierces:
      return "A pierces B";
    case ClashKind::cuts_through:
      return "A cuts through B";
    default:
      return io::in_words(name_of(kind));
  }
}

std::string kind_text(ClashKind kind, ClashReason reason) {
  return kind_text(kind) + (reason == ClashReason::none ? "" : ": ") + std::string(name_of(reason));
}

std::optional<MarkedSegment> gap_of(const ProvedInterval& distance, const Vector3d& point_a,
                                    const Vector3d& point_b) {
  if (!(distance.lower > 0) || !std::isfinite(distance.upper)) return std::nullopt;
  return MarkedSegment{point_a, point_b, interval_text(distance.lower, distance.upper)};
}

std::optional<MarkedSegment> separation_vector_of(const std::optional<ProvedInterval>& depth,
                                                  const Vector3d& translation, const PosedBodies& bodies,
                                                  std::span<const ContactRegion> contacts) {
  if (!depth || !std::isfinite(depth->upper) || translation.isZero(0)) return std::nullopt;
  const std::vector<Vector3d> points = render::contact_points(contacts);
  const Vector3d midpoint =
      points.empty() ? box_of(bodies.a, bodies.pose_a).intersection(box_of(bodies.b, bodies.pose_b)).center()
                     : render::bounds(points).center();
  return MarkedSegment{midpoint - translation / 2, midpoint + translation / 2,
                       interval_text(depth->lower, depth->upper)};
}

void add_gap(render::Scene& scene, const MarkedSegment& gap, const render::Style& style) {
  const render::Rgba colour = style.of(kGapColour);
  outline(scene.list, {gap.from, gap.to}, colour, kSegmentWidth);
  for (const Vector3d& x : {gap.from, gap.to}) add_mark(scene.list, x, colour, 4, style.paper);
  write_at(scene.list, (gap.from + gap.to) / 2, gap.text, style);
  scene.key.push_back({render::LegendItem::Mark::ends, colour, "nearest points"});
}

void add_near_pairs(render::Scene& scene, std::span<const NearMark> pairs, const render::Style& style) {
  const render::Rgba colour = style.of(kGapColour);
  bool has_segments = false;
  for (const NearMark& pair : pairs) {
    if (pair.intersects) {
      add_mark(scene.list, pair.points[0], render::palette::kContact, 2, style.paper);
      continue;
    }
    has_segments = true;
    outline(scene.list, {pair.points[0], pair.points[1]}, colour, kThin, render::kTransparent);
  }
  if (has_segments)
    scene.key.push_back({render::LegendItem::Mark::thin, colour, "closest points of near pairs"});
}

void ShownPoints::add(std::span<const Vector3d> points, std::span<const PointDistance> distances) {
  for (std::size_t i = 0; i < points.size(); ++i, ++seen_) {
    const PointDistance& d = distances[i];
    ++counts_[index(d.side)];
    if (seen_ == 0 || d.signed_lower() < smallest_.distance.signed_lower()) smallest_ = {seen_, points[i], d};
    if (seen_ == 0 || d.signed_lower() > largest_.distance.signed_lower()) largest_ = {seen_, points[i], d};
    if (seen_ % every_ == 0) shown_.push_back({seen_, points[i], d});
  }
}

render::LegendItem key_of_points(std::optional<Where> side) {
  using render::LegendItem;
  if (!side) return {LegendItem::Mark::point, kGapColour, "points without a side"};
  switch (*side) {
    case Where::inside:
      return {LegendItem::Mark::point, render::palette::kContact, "points inside"};
    case Where::outside:
      return {LegendItem::Mark::point, kGapColour, "points outside"};
    case Where::on_surface:
      break;
  }
  return {LegendItem::Mark::point, render::palette::kGreen, "points on the surface"};
}

std::vector<PointMark> ShownPoints::marks() const {
  std::vector<PointMark> out;
  for (const Shown& p : shown_) out.push_back({p.point, p.distance.closest.point, p.distance.side});
  return out;
}

void add_point_distances(render::Scene& scene, std::span<const PointMark> points,
                         const render::Style& style) {
  constexpr float kLarge = 3.5F, kSmall = 2;
  constexpr std::size_t kMany = 300;
  const float radius = points.size() > kMany ? kSmall : kLarge;
  bool has_segments = false;
  // Points inside are drawn last, on top of the others.
  for (const std::optional<Where> side : {std::optional<Where>(), std::optional(Where::outside),
                                          std::optional(Where::on_surface), std::optional(Where::inside)}) {
    render::LegendItem key = key_of_points(side);
    key.colour = style.of(key.colour);
    bool any = false;
    for (const PointMark& p : points) {
      if (p.side != side) continue;
      any = true;
      has_segments |= side != Where::on_surface;
      if (side != Where::on_surface)
        outline(scene.list, {p.point, p.closest}, key.colour, kThin, render::kTransparent);
      add_mark(scene.list, p.point, key.colour, radius, style.paper);
    }
    if (any) scene.key.push_back(key);
  }
  if (has_segments)
    scene.key.push_back({render::LegendItem::Mark::thin, style.of(kGapColour), "to the closest points"});
}

render::LegendItem key_of(SelfContact kind) {
  using render::LegendItem;
  switch (kind) {
    case SelfContact::touch:
      return {LegendItem::Mark::line, render::palette::kGreen, "where faces touch"};
    case SelfContact::cross:
      return {LegendItem::Mark::line, kGapColour, "where faces cross"};
    case SelfContact::overlap:
      break;
  }
  return {LegendItem::Mark::line, render::palette::kYellow, "around areas where faces overlap"};
}

void add_self_intersections(render::Scene& scene, const SelfIntersections& found,
                            const render::Style& style) {
  constexpr float kWidth = 2;
  const auto add = [&](const SelfIntersection& pair, render::Rgba colour, float width) {
    for (std::uint32_t i = 0; i < pair.segments; ++i) {
      const auto& [from, to] = found.segments[pair.first_segment + i];
      if (from == to)
        add_mark(scene.list, from, colour, width, style.paper);
      else
        outline(scene.list, {from, to}, colour, width, render::kTransparent);
    }
  };
  // The ground of all segments comes first: halos of single ones would interrupt the curve.
  for (const SelfIntersection& pair : found.pairs) add(pair, style.paper, kWidth + 2 * kHalo);
  // Crossings last, on top of the others.
  for (const SelfContact kind : {SelfContact::touch, SelfContact::overlap, SelfContact::cross}) {
    render::LegendItem key = key_of(kind);
    key.colour = style.of(key.colour);
    bool any = false;
    for (const SelfIntersection& pair : found.pairs) {
      if (pair.kind != kind) continue;
      any = true;
      add(pair, key.colour, kWidth);
    }
    if (any) scene.key.push_back(key);
  }
}

std::vector<double> normal_lengths(std::span<const ContactMark> contacts, double size) {
  constexpr double kLeast = 0.4;  // at gaps, relative to the longest
  Eigen::AlignedBox3d box;
  double deepest = 0;
  for (const ContactMark& c : contacts) {
    box.extend(c.point);
    deepest = std::max(deepest, c.depth);
  }
  const double longest =
      std::clamp(contacts.empty() ? 0 : 0.35 * box.diagonal().norm(), 0.03 * size, 0.1 * size);
  std::vector<double> out;
  for (const ContactMark& c : contacts)
    out.push_back(longest * std::max(kLeast, deepest > 0 ? c.depth / deepest : 1));
  return out;
}

void add_contact_points(render::Scene& scene, std::span<const ContactMark> contacts, double margin,
                        double size, const render::Style& style) {
  const std::vector<double> lengths = normal_lengths(contacts, size);
  const render::Rgba of_gap = style.of(kGapColour);
  bool has_gaps = false, has_contacts = false;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ContactMark& c = contacts[i];
    const bool is_gap = c.depth < 0;
    (is_gap ? has_gaps : has_contacts) = true;
    add_arrow(scene.list, c.point, c.point + lengths[i] * c.normal, kSeparationColour);
    add_mark(scene.list, c.point, is_gap ? of_gap : render::palette::kContact, 4, style.paper);
  }
  if (has_contacts)
    scene.key.push_back({render::LegendItem::Mark::point, render::palette::kContact, "contact points"});
  if (has_gaps)
    scene.key.push_back({render::LegendItem::Mark::point, of_gap,
                         "speculative, at most " + render::short_number(margin) + " apart"});
  if (!contacts.empty())
    scene.key.push_back({render::LegendItem::Mark::thin_arrow, kSeparationColour,
                         "normals, from A to B, longer where deeper"});
}

void add_separation_vector(render::Scene& scene, const MarkedSegment& arrow, int dim,
                           const render::Style& style) {
  outline(scene.list, {arrow.from, arrow.to}, kSeparationColour, kSegmentWidth);
  const Vector3d along = (arrow.to - arrow.from).normalized();
  const Vector3d across = dim == 2 ? Vector3d::UnitZ().cross(along) : along.unitOrthogonal();
  add_barbs(scene.list, arrow, across, kSeparationColour);
  if (dim == 3) add_barbs(scene.list, arrow, along.cross(across), kSeparationColour);
  write_at(scene.list, (arrow.from + arrow.to) / 2, arrow.text, style);
  scene.key.push_back({render::LegendItem::Mark::arrow, kSeparationColour, "B leaves A this way"});
}

// Separating planes.

namespace {

/// Returns a square around the projection of a point onto the plane n.x = at.
Square square(const Vector3d& n, double at, Vector3d centre, double half, int dim) {
  centre += n * (at - n.dot(centre));
  if (dim == 2) {
    const Vector3d u = half * Vector3d(-n.y(), n.x(), 0);
    return {centre + u, centre - u, centre - u, centre + u};
  }
  const Vector3d u = half * n.unitOrthogonal(), v = n.cross(u);
  return {centre + u, centre + v, centre - u, centre - v};
}

}  // namespace

Square separating_square(const SeparatingPlane& plane, const PosedBodies& bodies) {
  constexpr double kShare = 0.35;  // from the centre to a corner, relative to the smaller body's diagonal
  const Eigen::AlignedBox3d of_a = render::bounds(render::body_points(bodies.a, bodies.pose_a)),
                            of_b = render::bounds(render::body_points(bodies.b, bodies.pose_b));
  const Eigen::AlignedBox3d& smaller = of_a.diagonal().norm() < of_b.diagonal().norm() ? of_a : of_b;
  return square(plane.normal, (plane.of_a + plane.of_b) / 2, smaller.center(),
                kShare * smaller.diagonal().norm(), bodies.dim());
}

Square separating_square(const SeparatingBoxes& rejected, int dim) {
  const auto axis = static_cast<std::size_t>(rejected.pair.axis);
  const auto& [a, b] = rejected.boxes;
  Vector3d normal = axis < 3 ? a.across[axis] : b.across[axis - 3];
  if (normal.dot(b.centre - a.centre) < 0) normal = -normal;
  double end_of_a = normal.dot(a.centre);
  for (const Vector3d& h : a.half) end_of_a += std::abs(normal.dot(h));
  const auto size = [](const WorldBox& box) { return (box.half[0] + box.half[1] + box.half[2]).norm(); };
  return square(normal, end_of_a + rejected.pair.gap / 2, (a.centre + b.centre) / 2,
                std::min(size(a), size(b)), dim);
}

std::optional<Square> separating_square(const WalkExplanation& walk, const PosedBodies& bodies) {
  if (walk.plane) return separating_square(*walk.plane, bodies);
  if (walk.nearest_boxes) return separating_square(*walk.nearest_boxes, bodies.dim());
  return {};
}

void add_boxes(render::DrawList& list, const SeparatingBoxes& disjoint, const render::Style& style,
               bool through) {
  constexpr float kLine = 1.5F;
  for (const Side side : {Side::a, Side::b}) {
    const WorldBox& box = disjoint.boxes[static_cast<std::size_t>(side)];
    add_box(list, box.centre, box.half, {style.edge_of(style.body(side)), kLine, 0, through});
  }
}

void add_separating_plane(render::DrawList& list, const WalkExplanation& walk, const PosedBodies& bodies,
                          const render::Style& style, bool through) {
  constexpr float kLine = 1.5F, kStrip = 3;
  const std::optional<Square> square = separating_square(walk, bodies);
  if (!square) return;
  if (!walk.plane) add_boxes(list, *walk.nearest_boxes, style, through);
  render::DrawLine border;
  border.colour = kSeparationColour;
  border.layer = render::Layer::translucent;
  if (bodies.dim() == 2) {
    border.points = {(*square)[0], (*square)[1]};
    border.width = kStrip;
  } else {
    border.points = {square->begin(), square->end()};
    border.closed = true;
    border.width = kLine;
    add_sheet(list, border.points);
  }
  list.lines.push_back(border);
}

std::string separating_plane_text(const WalkExplanation& walk, const PosedBodies& bodies) {
  if (!walk.plane && !walk.nearest_boxes) return {};
  // Not the gap of the plane or of the boxes, which can grow while the bodies approach.
  DistanceRequest request;
  request.relation = false;
  const double gap = distance(bodies.a, bodies.pose_a, bodies.b, bodies.pose_b, request).lower;
  return std::string(walk.plane ? "by a plane" : "by boxes") +
         (gap > 0 ? ", gap >= " + io::lower_text(gap) : "");
}

// Boxes of tree nodes.

namespace {

/// Returns the box of a node's child, or with kWhole of the node itself, in the body's frame.
TreeBox box_in_body(const ObbTree& tree, std::uint32_t node, int child) {
  const WorldBox box = box_of(tree, node, child, Pose{});
  TreeBox out;
  out.centre = box.centre;
  for (int i = 0; i < 3; ++i) out.half.col(i) = box.half[static_cast<std::size_t>(i)];
  return out;
}

}  // namespace

std::vector<TreeBox> tree_boxes(const ObbTree& tree, std::size_t most) {
  std::vector<TreeBox> out;
  if (tree.empty() || most == 0) return out;
  const std::vector<TreeNode>& nodes = tree.nodes();
  out.push_back(box_in_body(tree, 0, kWhole));
  std::size_t level = 0;
  for (std::uint32_t depth = 1; level < out.size(); ++depth) {
    const std::size_t end = out.size();
    for (std::size_t i = level; i < end; ++i) {
      const TreeNode& node = nodes[out[i].node];
      for (std::uint32_t k = 0; node.is_leaf == 0 && k < node.count; ++k) {
        out.push_back(box_in_body(tree, out[i].node, static_cast<int>(k)));
        out.back().node = node.first + k;
        out.back().depth = depth;
      }
      if (out.size() <= most) continue;
      out.resize(end);
      return out;
    }
    level = end;
  }
  return out;
}

namespace {

/// Position of a node in the tree: its parent, and its index among the children.
struct Place {
  std::uint32_t parent = kNull, depth = 0;
  int child = kWhole;
};

/// Returns the positions of all nodes. Children come after their parents.
std::vector<Place> places_of(const ObbTree& tree) {
  const std::vector<TreeNode>& nodes = tree.nodes();
  std::vector<Place> out(nodes.size());
  std::vector<std::uint32_t> open;
  if (!nodes.empty()) open.push_back(0);
  while (!open.empty()) {
    const std::uint32_t n = open.back();
    open.pop_back();
    if (nodes[n].is_leaf != 0) continue;
    for (std::uint32_t k = 0; k < nodes[n].count; ++k) {
      out[nodes[n].first + k] = {n, out[n].depth + 1, static_cast<int>(k)};
      open.push_back(nodes[n].first + k);
    }
  }
  return out;
}

/// Returns the leaf of each real simplex.
std::vector<std::uint32_t> leaves_of(const ObbTree& tree) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t n = 0; n < tree.nodes().size(); ++n) {
    const TreeNode& node = tree.nodes()[n];
    for (std::uint32_t k = 0; node.is_leaf != 0 && k < node.count; ++k) {
      const SimplexId s = tree.blocks()[node.first].simplex[k];
      if (s >= out.size()) out.resize(s.value() + 1, kNull);
      out[s.value()] = n;
    }
  }
  return out;
}

}  // namespace

std::vector<std::uint32_t> nodes_by_depth(const ObbTree& tree) {
  std::vector<std::uint32_t> out;
  for (const Place& p : places_of(tree)) {
    if (p.depth >= out.size()) out.resize(p.depth + 1);
    ++out[p.depth];
  }
  return out;
}

std::vector<TreeBox> boxes_on_paths(const ObbTree& tree, std::uint32_t below,
                                    const std::vector<SimplexId>& to, std::size_t most) {
  std::vector<TreeBox> out;
  const std::vector<Place> places = places_of(tree);
  const std::vector<std::uint32_t> leaves = leaves_of(tree);
  std::vector<bool> taken(places.size());
  for (const SimplexId s : to) {
    if (s >= leaves.size()) continue;  // a pseudo face: the tree contains only real ones
    for (std::uint32_t n = leaves[s.value()]; n != kNull && places[n].depth > below; n = places[n].parent) {
      if (taken[n]) break;
      if (out.size() == most) return out;
      taken[n] = true;
      out.push_back(box_in_body(tree, places[n].parent, places[n].child));
      out.back().node = n;
      out.back().depth = places[n].depth;
    }
  }
  return out;
}

}  // namespace lrb::pictures
