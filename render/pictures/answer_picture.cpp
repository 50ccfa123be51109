#include "render/pictures/answer_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/core/strings.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::pictures {

using namespace render;
using Eigen::Vector3d;

namespace {

/// A detail smaller than this fraction of the bodies gets a close-up.
constexpr double kSmallDetail = 0.12;
constexpr int kGhosts = 4;

Scene scene_of(const PosedBodies& bodies, std::span<const ContactRegion> contacts = {}) {
  SceneHighlight highlight;
  highlight.contacts = contacts;
  SceneOptions options;
  options.contact_rims = true;
  return build_scene(bodies.in_scene(), highlight, options);
}

/// Makes faces translucent, and drops their edges: all, or those that look in a direction. The others are
/// then seen from inside, and show the shape.
void make_translucent(DrawList& list, std::uint8_t alpha, const Vector3d& towards = Vector3d::Zero()) {
  for (DrawTriangle& t : list.triangles) {
    if (!towards.isZero() &&
        (t.layer != Layer::opaque || (t.x[1] - t.x[0]).cross(t.x[2] - t.x[0]).dot(towards) <= 0))
      continue;
    t.layer = Layer::translucent;
    t.colour.a = alpha;
    t.edges = 0;
  }
}

std::string digits(double value) {
  return io::number_text(value, 9);
}

/// The picture of an answer: the whole and, if its subject is small, a close-up to the right.
struct AnswerPicture {
  AnswerPicture(const PosedBodies& posed, std::span<const ContactRegion> contacts = {})
      : AnswerPicture(posed, scene_of(posed, contacts)) {}
  AnswerPicture(const PosedBodies& posed, Scene drawn) : bodies(posed), scene(std::move(drawn)) {
    overlay.title = posed.title();
    add_points(posed.a, posed.pose_a);
    add_points(posed.b, posed.pose_b);
  }

  /// Of one body.
  AnswerPicture(const LrbRep& body, SceneBody drawn, const Look& look)
      : bodies{body, {}, body, {}}, alone(true) {
    drawn.rep = &body;
    drawn.name = "body";
    SceneOptions options;
    options.style = look.style;
    options.contact_rims = true;
    scene = build_scene({&drawn, 1}, {}, options);
    make_translucent(scene.list, 140);
    overlay.title = body.name();
    overlay.style = look.style;
    overlay.event_colour = palette::kContact;
    add_points(body, {});
  }

  void add_points(const LrbRep& rep, const Pose& pose) {
    for (const Vector3d& x : real_corners(rep, pose)) whole.push_back(x);
  }

  /// Draws B at another pose, translucent, below the rest of the list.
  void add_ghost(const Pose& pose, std::uint8_t alpha) {
    SceneBody body = bodies.in_scene()[1];
    body.pose = pose;
    body.colour = palette::body(Side::b);
    SceneOptions options;
    options.real_edges = false;
    DrawList list = build_scene({&body, 1}, {}, options).list;
    make_translucent(list, alpha);
    for (DrawFill& fill : list.fills) fill.colour = mix(fill.colour, kWhite, 0.75);
    for (DrawLine& line : list.lines) line.colour.a = alpha;
    list.append(scene.list);
    scene.list = std::move(list);
    add_points(bodies.b, pose);
  }

  void mark_point(const Vector3d& x, const std::string& what) {
    add_mark(scene.list, x, palette::kContact, 5);
    scene.key.push_back({Mark::point, palette::kContact, what});
  }

  /// Draws the path of B's centre from t = 0 to a given time.
  void add_path(const Motion& motion, double until) {
    constexpr int kPieces = 64;
    const Vector3d centre = bounds(body_points(bodies.b, {})).center();
    DrawLine line;
    for (int i = 0; i <= kPieces; ++i) line.points.push_back(motion.at(until * i / kPieces).apply(centre));
    line.colour = palette::kFaint;
    line.width = 1.5F;
    line.dash = 6;
    line.layer = Layer::on_top;
    scene.list.lines.push_back(line);
    scene.key.push_back({Mark::dashed, palette::kFaint, "path of B's centre"});
  }

  void show(const MarkedSegment& segment) {
    detail = {segment.from, segment.to};
    across = segment.to - segment.from;
  }

  void add_interval(const std::string& what, double lower, double upper) {
    overlay.counters.push_back({what + " at least", digits(lower)});
    overlay.counters.push_back({"at most", std::isfinite(upper) ? digits(upper) : "not known"});
  }

  /// Returns the direction of the picture, beside `across`.
  ViewDirection direction(const Look& look) const {
    const Vector3d up = look.first_view().up;
    return view_beside(across.norm() > 0 ? across : up.unitOrthogonal(), up);
  }

  Image draw(const Look& look) {
    FitOptions fit;
    fit.view = direction(look);
    overlay.key = scene.key;
    CameraFit camera = fit_points(whole, bodies.dim(), fit);
    if (alone) {
      const Framing framing{whole, {}, bodies.dim()};
      fit.view = {look.first_view().from, look.first_view().up};
      camera = [view = look.first_view(), framing](double width, double height) {
        return camera_for(view, framing, width, height);
      };
    }
    std::vector<Panel> panels = {{scene.list, camera, ""}};
    const double size = bounds(whole).diagonal().norm();
    if (!detail.empty() && bounds(detail).diagonal().norm() < kSmallDetail * size) {
      panels.push_back({scene.list, close_up(fit), "from nearby"});
      panels[0].list.labels.clear();  // they are in the other
      if (opens) make_translucent(panels[1].list, 60, fit.view.from);
    }
    return draw_panels(panels, overlay, look);
  }

  PosedBodies bodies;
  bool opens = false;  ///< from nearby, faces that look at the viewer hide nothing
  bool alone = false;  ///< one body: both are the same, which is seen from the look's view
  Scene scene;
  Overlay overlay;
  std::vector<Vector3d> whole;         ///< all points that the picture shows
  std::vector<Vector3d> detail;        ///< its subject; may be empty
  Vector3d across = Vector3d::Zero();  ///< a direction to show from the side; 0: none

 private:
  CameraFit close_up(const FitOptions& fit) const {
    constexpr double kContext = 4, kLeast = 0.001;
    const Eigen::AlignedBox3d part = bounds(detail), all = bounds(whole);
    if (bodies.dim() == 3)
      return [this, all, fit](double width, double height) {
        return fit_contact(detail, all, width, height, fit, kContext, kLeast);
      };
    const double half = std::max(kContext * part.diagonal().norm(), kLeast * all.diagonal().norm()) / 2;
    return fit_points({part.center() - Vector3d(half, half, 0), part.center() + Vector3d(half, half, 0)}, 2);
  }
};

std::string outcome_text(const FirstContactResult& r) {
  if (r.at_start) return "in contact from the start";
  if (r.outcome == MotionOutcome::never) return "they never meet";
  if (r.outcome == MotionOutcome::undecided) return "they come as near as rounding: undecided";
  return "first contact at t = " + digits(r.t1) + (r.passed ? ", passing through" : "");
}

}  // namespace

Image picture_of(const DistanceResult& result, const PosedBodies& bodies, const Look& look) {
  AnswerPicture p(bodies);
  p.overlay.event_colour = kGapColour;
  if (const auto gap =
          gap_of({result.lower, result.upper}, result.witness[0].point, result.witness[1].point)) {
    add_gap(p.scene, *gap, style_of(StyleName::screen));
    p.show(*gap);
    p.overlay.event = "distance " + gap->text + (result.solids_meet() ? ", one inside the other" : "");
  } else if (result.meet) {
    p.mark_point(result.witness[0].point, "a point of both");
    p.overlay.event = "the surfaces intersect";
  } else {
    p.overlay.event = "undecided";
  }
  p.add_interval("distance", result.lower, result.upper);
  return p.draw(look);
}

Image picture_of(const NearPairsResult& result, double within, const PosedBodies& bodies, const Look& look) {
  constexpr std::size_t kMaxSegments = 1000;
  std::vector<std::uint8_t> near[2] = {std::vector<std::uint8_t>(bodies.a.real_face_count()),
                                       std::vector<std::uint8_t>(bodies.b.real_face_count())};
  for (const NearPair& pair : result.pairs) {
    near[0][bodies.a.face_of_simplex(pair.a)] = 1;
    near[1][bodies.b.face_of_simplex(pair.b)] = 1;
  }
  std::vector<SceneBody> marked = bodies.in_scene();
  for (std::size_t side = 0; side < 2; ++side) {
    marked[side].in_contact = near[side];
    marked[side].contact_name = "faces at most " + short_number(within) + " apart";
  }
  SceneOptions options;
  options.contact_rims = true;
  AnswerPicture p(bodies, build_scene(marked, {}, options));

  std::vector<NearPair> drawn(std::min(kMaxSegments, result.pairs.size()));
  std::partial_sort_copy(result.pairs.begin(), result.pairs.end(), drawn.begin(), drawn.end(),
                         [](const NearPair& x, const NearPair& y) { return x.lower < y.lower; });
  std::vector<NearMark> marks;
  for (const NearPair& pair : drawn) {
    marks.push_back({{pair.point[0], pair.point[1]}, pair.upper == 0});
    p.detail.insert(p.detail.end(), {pair.point[0], pair.point[1]});
    p.across += pair.point[1] - pair.point[0];
  }
  add_near_pairs(p.scene, marks, style_of(look.style));
  p.overlay.event_colour = palette::kContact;
  p.overlay.event = group_digits(result.found) + (result.found == 1 ? " pair" : " pairs") +
                    " of triangles at most " + short_number(within) + " apart";
  if (drawn.size() < result.found)
    p.overlay.counters.push_back({"segments of the nearest", group_digits(drawn.size())});
  return p.draw(look);
}

Image picture_of(const FirstContactResult& result, const LrbRep& a, const LrbRep& b, const Motion& motion_b,
                 const Look& look) {
  const double last = result.is_contact() ? result.t1 : 1;
  const Pose at_last = motion_b.at(last);
  AnswerPicture p({a, {}, b, at_last});
  for (int i = kGhosts - 1; i >= 0 && last > 0; --i) p.add_ghost(motion_b.at(last * i / kGhosts), 52);
  if (last > 0) {
    p.scene.key.push_back(
        {Mark::translucent, palette::body(Side::b), "B at " + std::to_string(kGhosts) + " times before"});
    p.add_path(motion_b, last);
    p.across = at_last.t - motion_b.at(0).t;
  }
  if (result.is_contact() && result.witness[0].corner_count > 0)
    p.mark_point(result.witness[0].point, "first contact");
  p.overlay.event = outcome_text(result);
  p.overlay.event_colour = palette::kContact;
  p.overlay.counters.push_back({"no contact before t", digits(result.t0)});
  if (result.is_contact()) p.overlay.counters.push_back({"interval", short_number(result.t1 - result.t0)});
  return p.draw(look);
}

Image picture_of(const ClashResult& result, const PosedBodies& bodies, const Look& look) {
  CollideRequest request;
  request.contacts = true;
  const CollideResult found = collide(bodies.a, bodies.pose_a, bodies.b, bodies.pose_b, request);
  AnswerPicture p(bodies, found.regions);
  p.overlay.title = kind_text(result.kind, result.reason) + "  ·  " + p.overlay.title;
  p.overlay.event_colour = kSeparationColour;
  if (const auto vector = separation_vector_of(result.depth, result.translation, bodies, found.regions)) {
    Pose apart = bodies.pose_b;
    apart.t += result.translation;
    p.across = result.translation;
    p.opens = true;
    p.add_ghost(apart, 26);
    add_separation_vector(p.scene, *vector, bodies.dim(), style_of(look.style));
    p.show(*vector);
    p.overlay.event = "depth " + vector->text + ": the arrow separates B from A";
    p.scene.key.push_back({Mark::translucent, palette::body(Side::b), "B after separation"});
  } else {
    p.overlay.event = result.distance.upper > 0
                          ? interval_text(result.distance.lower, result.distance.upper) + " apart"
                          : "nothing has to move";
  }
  if (result.depth) p.add_interval("depth", result.depth->lower, result.depth->upper);
  if (result.volume && result.volume->upper > 0)
    p.overlay.counters.push_back(
        {"volume shared", interval_text(result.volume->lower, result.volume->upper)});
  return p.draw(look);
}

Image picture_of(const ManifoldResult& result, double margin, const PosedBodies& bodies, const Look& look) {
  AnswerPicture p(bodies);
  if (!result.manifolds.empty()) p.across = result.manifolds[0].normal;
  p.opens = true;
  std::vector<ContactMark> marks;
  for (const ContactManifold& manifold : result.manifolds)
    for (const ManifoldPoint& point : manifold.points) {
      marks.push_back({point.point[1], manifold.normal, point.depth});
      p.detail.push_back(point.point[1]);
    }
  const std::size_t count = marks.size();
  add_contact_points(p.scene, marks, margin, size_of(bodies), style_of(look.style));
  const std::size_t manifolds = result.manifolds.size();
  p.overlay.event_colour = palette::kContact;
  p.overlay.event = group_digits(manifolds) + (manifolds == 1 ? " manifold, " : " manifolds, ") +
                    group_digits(count) + (count == 1 ? " point" : " points");
  p.overlay.counters.push_back({"pairs of triangles", group_digits(result.pairs.size())});
  return p.draw(look);
}

namespace {

std::string signed_text(const PointDistance& d) {
  return interval_text(d.signed_lower(), d.signed_upper());
}

}  // namespace

Image picture_of(const ShownPoints& points, const LrbRep& body, const Look& look) {
  AnswerPicture p(body, SceneBody(), look);
  for (const ShownPoints::Shown& shown : points.shown()) p.whole.push_back(shown.point);
  add_point_distances(p.scene, points.marks(), style_of(look.style));
  p.overlay.event_colour = kGapColour;
  p.overlay.event = (points.all() ? "" : group_digits(points.shown().size()) + " of ") +
                    counted(points.total(), "point", "points") + (points.all() ? "" : ", evenly chosen") +
                    (body.closed() ? "" : "; the body is not closed: distances have no sign");
  for (const Where side : {Where::inside, Where::outside, Where::on_surface})
    if (points.count(side) > 0)
      p.overlay.counters.push_back({std::string(name_of(side)), group_digits(points.count(side))});
  p.overlay.counters.push_back({"smallest distance", signed_text(points.smallest().distance)});
  p.overlay.counters.push_back({"largest", signed_text(points.largest().distance)});
  return p.draw(look);
}

Image picture_of(const SelfIntersections& found, const LrbRep& body, const Look& look) {
  std::vector<std::uint8_t> crossing(body.real_face_count());
  std::array<std::uint64_t, kEnumNames<SelfContact>.size()> counts{};
  for (const SelfIntersection& pair : found.pairs) {
    crossing[pair.a] = crossing[pair.b] = 1;
    ++counts[static_cast<std::size_t>(pair.kind)];
  }
  SceneBody drawn;
  drawn.in_contact = crossing;
  drawn.contact_name = "faces that intersect";
  AnswerPicture p(body, drawn, look);
  add_self_intersections(p.scene, found, style_of(look.style));
  for (const auto& segment : found.segments) p.detail.insert(p.detail.end(), segment.begin(), segment.end());
  p.overlay.event = counted(found.pairs.size(), "pair", "pairs") + " of faces in " +
                    counted(found.curves, "curve", "curves");
  for (const SelfContact kind : {SelfContact::cross, SelfContact::touch, SelfContact::overlap})
    if (const std::uint64_t n = counts[static_cast<std::size_t>(kind)]; n > 0)
      p.overlay.counters.push_back({std::string(name_of(kind)), group_digits(n)});
  return p.draw(look);
}

namespace {

Look screen_of(int width, int height) {
  Look look;
  look.width = width;
  look.height = height;
  return look;
}

/// Returns a direction that shows the fronts of both faces. For faces with opposite normals it shows A's
/// front and B's back.
ViewDirection onto_both(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b, const Vector3d& up) {
  constexpr double kOpposite = 0.5;  // of unit normals' sum
  const Vector3d of_a = (a[1] - a[0]).cross(a[2] - a[0]).stableNormalized(),
                 of_b = (b[1] - b[0]).cross(b[2] - b[0]).stableNormalized();
  const Vector3d sum = of_a + of_b;
  ViewDirection out;
  out.from = sum.norm() > kOpposite ? sum : Vector3d(of_a - of_b);
  constexpr double kSteep = 0.95;
  if (out.from.isZero()) return {};  // both are needles without a normal
  const bool is_steep = std::abs(out.from.normalized().dot(up)) > kSteep;
  out.up = is_steep ? Vector3d(up.y(), up.z(), up.x()) : up;
  return out;
}

/// Adds a square of the plane perpendicular to the segment between two points, at its midpoint. `side`: its
/// length.
void add_plane(DrawList& list, const std::array<Vector3d, 2>& nearest, double side) {
  const Vector3d normal = (nearest[1] - nearest[0]).normalized(), u = normal.unitOrthogonal() * (side / 2);
  const Vector3d v = normal.cross(u), midpoint = (nearest[0] + nearest[1]) / 2;
  add_sheet(list, {midpoint + u + v, midpoint - u + v, midpoint - u - v, midpoint + u - v});
}

/// Returns the boxes whose gap decides a pair; nullopt if no boxes do.
std::optional<SeparatingBoxes> deciding_boxes(const PairExplanation& pair, const PosedBodies& bodies) {
  const bool of_faces = pair.decided_by == DecidedBy::face_boxes;
  if (!of_faces && pair.decided_by != DecidedBy::node_boxes) return {};
  SeparatingBoxes out{of_faces ? pair.face_boxes : pair.nodes.back(), {}, of_faces};
  const BoxPair* before = pair.nodes.size() > 1 ? &pair.nodes[pair.nodes.size() - 2] : nullptr;
  const SimplexId simplices[] = {pair.pair.a, pair.pair.b};
  for (std::size_t side = 0; side < 2; ++side) {
    const ObbTree& tree = (side == 0 ? bodies.a : bodies.b).tree();
    std::uint32_t node = out.pair.node[side];
    int child = kWhole;  // of a node that was not descended
    if (of_faces) {
      const auto& block = tree.blocks()[tree.nodes()[node].first].simplex;
      child = static_cast<int>(std::find(std::begin(block), std::end(block), simplices[side]) -
                               std::begin(block));
    } else if (before != nullptr && before->node[side] != node) {
      child = static_cast<int>(node - tree.nodes()[before->node[side]].first);
      node = before->node[side];
    }
    out.boxes[side] = box_of(tree, node, child, side == 0 ? bodies.pose_a : bodies.pose_b);
  }
  return out;
}

std::vector<Vector3d> box_corners(const SeparatingBoxes& disjoint) {
  std::vector<Vector3d> out;
  for (const WorldBox& box : disjoint.boxes)
    for (int i = 0; i < 8; ++i)
      out.emplace_back(box.centre + (i & 1 ? 1 : -1) * box.half[0] + (i & 2 ? 1 : -1) * box.half[1] +
                       (i & 4 ? 1 : -1) * box.half[2]);
  return out;
}

void add_key_of_boxes(std::vector<LegendItem>& key, int dim) {
  for (const Side side : {Side::a, Side::b})
    key.push_back(
        {Mark::line, palette::edge_of(palette::body(side)), "box of " + std::string(name_of(side)) + "'s"});
  key.push_back({dim == 2 ? Mark::line : Mark::translucent, kSeparationColour, "between the boxes"});
}

}  // namespace

Image picture_of(const PairExplanation& pair, const PosedBodies& bodies, bool wrong, const Vector3d& up) {
  const bool apart = pair.meet == exact::Meet::disjoint, in_3d = bodies.dim() == 3;
  const std::vector<Vector3d> of_a = corners_of(bodies.a, bodies.pose_a, pair.pair.a),
                              of_b = corners_of(bodies.b, bodies.pose_b, pair.pair.b);
  std::vector<Vector3d> both = of_a;
  both.insert(both.end(), of_b.begin(), of_b.end());
  std::vector<SceneBody> named = bodies.in_scene();
  for (SceneBody& body : named) body.name.clear();
  SceneHighlight highlight;
  if (!wrong) highlight.under_test = {pair.pair.a, pair.pair.b};
  Scene scene = build_scene(named, highlight);
  const std::optional<SeparatingBoxes> boxes = deciding_boxes(pair, bodies);
  DrawList whole;
  if (wrong) {
    whole = scene.list;
    add_mark(whole, bounds(both).center(), palette::kWrong, 8);
    // Of the bodies, which may hide the faces, the close-up shows what is near them.
    const Eigen::AlignedBox3d box = bounds(both);
    const Eigen::AlignedBox3d near(box.min() - box.diagonal() / 2, box.max() + box.diagonal() / 2);
    std::erase_if(scene.list.triangles, [&](const DrawTriangle& t) {
      return !near.intersects(bounds({t.x.begin(), t.x.end()}));
    });
  }
  // The bodies are ghosts around two boxes or around a wrong pair.
  if (boxes || wrong) make_translucent(scene.list, 60);
  for (const auto& [side, corners] : {std::pair(Side::a, &of_a), {Side::b, &of_b}}) {
    DrawTriangle face;
    face.colour = palette::body(side);
    if (wrong) scene.list.add_polygon(*corners, face);
    outline(scene.list, *corners, wrong ? palette::kWrong : palette::edge_of(palette::body(side)), 3);
  }
  // The contact's corners, or the closest points, with the segment, polygon or plane between them.
  std::vector<Vector3d> points(pair.nearest.begin(), pair.nearest.end());
  if (!apart) points.clear();
  for (int i = 0; i < pair.contact.corner_count && !apart; ++i) points.push_back(pair.contact.corners[i].x);
  for (const Vector3d& x : points) add_mark(scene.list, x, palette::kContact, 5);
  if (points.size() > 1) outline(scene.list, points, palette::kContact, 4);
  Vector3d across = pair.nearest[1] - pair.nearest[0];
  if (boxes) {
    // The gap between the boxes is seen from the side.
    add_boxes(scene.list, *boxes, style_of(StyleName::screen), true);
    const Square square = separating_square(*boxes, bodies.dim());
    if (in_3d) add_sheet(scene.list, {square.begin(), square.end()});
    if (!in_3d) outline(scene.list, {square[0], square[1]}, kSeparationColour, 3);
    across = (square[0] - square[2]).cross(square[1] - square[3]);
    for (const Vector3d& x : box_corners(*boxes)) both.push_back(x);
  } else if (apart && in_3d && pair.distance > 0) {
    add_plane(scene.list, pair.nearest, bounds(both).diagonal().norm());
  }

  Overlay overlay;
  overlay.title = bodies.a.name() + ", simplex " + std::to_string(pair.pair.a) + "  ·  " + bodies.b.name() +
                  ", simplex " + std::to_string(pair.pair.b);
  overlay.event =
      boxes ? "apart by " + short_number(pair.distance) + ", their boxes by " + short_number(boxes->pair.gap)
      : apart                           ? "apart by " + short_number(pair.distance)
      : pair.meet == exact::Meet::cross ? "the faces cross"
                                        : "the faces touch";
  overlay.key = std::move(scene.key);
  if (wrong) overlay.key.push_back({Mark::line, palette::kWrong, "wrong pair"});
  overlay.key.push_back({Mark::line, palette::kContact, apart ? "closest points" : "contact"});
  if (boxes)
    add_key_of_boxes(overlay.key, bodies.dim());
  else if (apart && in_3d)
    overlay.key.push_back({Mark::translucent, palette::kGreen, "separating plane"});

  FitOptions fit;
  if (in_3d) fit.view = apart && across.norm() > 0 ? view_beside(across, up) : onto_both(of_a, of_b, up);
  const auto camera = [&](double width, double height) {
    return in_3d ? fit_contact(both, bounds(bodies.points()), width, height, fit, boxes || wrong ? 1.2 : 2.5,
                               0.001)
                 : fit_top(both, width, height, 0.3);
  };
  std::vector<Panel> panels = {{std::move(scene.list), camera, "", false}};
  if (wrong)
    panels.insert(panels.begin(),
                  {std::move(whole), fit_points(bodies.points(), bodies.dim(), fit), "", false});
  return draw_panels(panels, overlay, screen_of(1200, wrong ? 560 : 900));
}

namespace {

/// Returns the points of a close-up: the points of both bodies that are closest to the plane, or both boxes.
std::vector<Vector3d> close_points(const WalkExplanation& walk) {
  if (walk.plane) return {walk.plane->reach.begin(), walk.plane->reach.end()};
  return box_corners(*walk.nearest_boxes);
}

/// Returns a close camera that looks along the plane, so that the gap is visible.
CameraFit camera_along(const WalkExplanation& walk, const Square& square, int dim,
                       const Eigen::AlignedBox3d& whole) {
  constexpr double kContext = 1.5, kLeast = 0.03;
  std::vector<Vector3d> points = close_points(walk);
  const Vector3d centre = bounds(points).center();
  if (dim == 2) {
    const double room = kLeast * whole.diagonal().norm();
    for (const double offset : {-room, room}) points.emplace_back(centre + Vector3d(offset, offset, 0));
    return [points](double width, double height) { return fit_top(points, width, height, 0.2); };
  }
  FitOptions fit;
  fit.view = view_beside((square[0] - square[2]).cross(square[1] - square[3]));
  return [=](double width, double height) {
    return fit_contact(points, whole, width, height, fit, kContext, kLeast);
  };
}

}  // namespace

Image picture_of(const WalkExplanation& walk, const PosedBodies& bodies) {
  const int dim = bodies.dim();
  Scene scene = build_scene(bodies.in_scene());
  add_separating_plane(scene.list, walk, bodies, style_of(StyleName::screen), true);
  const std::optional<Square> square = separating_square(walk, bodies);
  Overlay overlay;
  overlay.title = bodies.title();
  overlay.event = std::string(name_of(walk.result.relation));
  if (const std::string text = separating_plane_text(walk, bodies); !text.empty())
    overlay.event += ": " + text;
  overlay.event_colour = kSeparationColour;
  overlay.key = scene.key;
  const std::vector<Vector3d> points = bodies.points();
  std::vector<Panel> panels = {{scene.list, fit_points(points, dim), square ? "Overview" : ""}};
  if (square) {
    if (walk.plane)
      overlay.key.push_back(
          {dim == 2 ? Mark::line : Mark::translucent, kSeparationColour, "separating plane"});
    else
      add_key_of_boxes(overlay.key, dim);
    panels.push_back(
        {scene.list, camera_along(walk, *square, dim, bounds(points)), "Closest to the separating plane"});
  }
  return draw_panels(panels, overlay, screen_of(1600, 900));
}

Image picture_of(const Separation& separation, const PosedBodies& bodies) {
  const CameraFit camera = fit_points(bodies.points(), bodies.dim());
  Wrapper wrapper_a(bodies.a), wrapper_b(bodies.b);
  std::vector<Panel> panels;
  for (const char* what : {"outermost wrappers", "apart"}) {
    std::vector<SceneBody> wrapped = bodies.in_scene();
    wrapped[0].wrapper = &wrapper_a;
    wrapped[1].wrapper = &wrapper_b;
    panels.push_back({build_scene(wrapped).list, camera,
                      std::string(what) + ": " + group_digits(wrapper_a.boundary_size()) + " and " +
                          group_digits(wrapper_b.boundary_size()) + " faces",
                      false});
    for (const RegionId r : separation.refined[0]) wrapper_a.refine(r);
    for (const RegionId r : separation.refined[1]) wrapper_b.refine(r);
  }
  return draw_sheet(panels, screen_of(900, 720));
}

}  // namespace lrb::pictures
