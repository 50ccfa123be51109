#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "engine/collide/collide_into.hpp"
#include "engine/collide/explain_parts.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

/// The closest pairs of simplices among those compared.
class NearestPairs {
 public:
  explicit NearestPairs(QueryContext& ctx) : ctx_(ctx) {}

  void add(const SimplexPair& pair) {
    Corners a{}, b{};
    ctx_[Side::a].world.corners(pair.a, a.data());
    ctx_[Side::b].world.corners(pair.b, b.data());
    // At most kMaxNear + 1 entries are sorted each time.
    found_.push_back({nearest_points(ctx_[Side::a].rep().dim(), a, b).distance_sq, pair});
    std::sort(found_.begin(), found_.end(), [](const Found& x, const Found& y) {
      return x.distance_sq != y.distance_sq ? x.distance_sq < y.distance_sq : x.pair < y.pair;
    });
    if (found_.size() > WalkExplanation::kMaxNear) found_.pop_back();
  }

  std::vector<SimplexPair> take() const {
    std::vector<SimplexPair> out;
    for (const Found& f : found_) out.push_back(f.pair);
    return out;
  }

 private:
  struct Found {
    double distance_sq;
    SimplexPair pair;
  };
  QueryContext& ctx_;
  std::vector<Found> found_;
};

/// Finds the two closest boxes among those that the traversal compared and rejected.
class NearestBoxes {
 public:
  NearestBoxes(QueryContext& ctx, const Stepper& stepper) : ctx_(ctx), stepper_(stepper) {}

  void add(const NodePair& pair, const Stepper::Outcome& outcome) {
    // The nodes' own boxes were disjoint: their contents were not compared.
    if (outcome.parts_whole) {
      const auto whole = [&](Side side, std::uint32_t node) { return boxes(side, node, false).front(); };
      return add(whole(Side::a, pair.a), whole(Side::b, pair.b), false);
    }
    const bool leaf_a = stepper_.is_leaf(Side::a, pair.a), leaf_b = stepper_.is_leaf(Side::b, pair.b);
    // The returned pairs show which nodes were descended. If there are no pairs, assume every node that is
    // not a leaf.
    bool down_a = !leaf_a, down_b = !leaf_b;
    if (!outcome.children.empty()) {
      down_a = outcome.children.front().a != pair.a;
      down_b = outcome.children.front().b != pair.b;
    }
    const bool faces = leaf_a && leaf_b;
    const std::vector<Box> of_a = boxes(Side::a, pair.a, down_a || faces),
                           of_b = boxes(Side::b, pair.b, down_b || faces);
    for (const Box& a : of_a)
      for (const Box& b : of_b) {
        // A pair of children that was not returned was rejected. Faces have no such list, so all are
        // considered.
        const auto met = [&](const NodePair& c) { return c.a == a.node && c.b == b.node; };
        if (faces || std::none_of(outcome.children.begin(), outcome.children.end(), met)) add(a, b, faces);
      }
  }

  std::optional<SeparatingBoxes> take() const { return nearest_; }

 private:
  struct Box {
    std::uint32_t node;
    WorldBox box;
  };

  /// Returns the boxes of a node's children or faces, or its own.
  std::vector<Box> boxes(Side side, std::uint32_t node, bool down) const {
    const ObbTree& tree = ctx_[side].tree();
    const Pose& pose = ctx_[side].world.pose();
    if (!down) return {{node, box_of(tree, node, kWhole, pose)}};
    const TreeNode& n = tree.nodes()[node];
    std::vector<Box> out;
    for (std::uint32_t k = 0; k < n.count; ++k)
      out.push_back({n.is_leaf == 0 ? n.first + k : node, box_of(tree, node, static_cast<int>(k), pose)});
    return out;
  }

  void add(const Box& a, const Box& b, bool faces) {
    BoxPair pair;
    pair.node = {a.node, b.node};
    compare_boxes(a.box, b.box, pair, ctx_[Side::a].rep().dim());
    if (pair.gap > 0 && (!nearest_ || pair.gap < nearest_->pair.gap))
      nearest_ = SeparatingBoxes{pair, {a.box, b.box}, faces};
  }

  QueryContext& ctx_;
  const Stepper& stepper_;
  std::optional<SeparatingBoxes> nearest_;
};

/// Tests the normals of candidate separating planes of two bodies.
class PlaneFinder {
 public:
  explicit PlaneFinder(QueryContext& ctx) : points_{points_of(ctx, Side::a), points_of(ctx, Side::b)} {}

  void try_direction(const Vector3d& direction) {
    const double length = direction.norm();
    if (!(length > 0) || !std::isfinite(length)) return;
    const Vector3d n = direction / length;
    // Either body can be in front: try both orientations.
    for (const Vector3d& normal : {n, Vector3d(-n)}) {
      SeparatingPlane plane;
      plane.normal = normal;
      std::array<double, 2> at{};
      for (std::size_t side = 0; side < 2; ++side) {
        const double sign = side == 0 ? 1 : -1;
        at[side] = -std::numeric_limits<double>::infinity();
        for (const Vector3d& x : points_[side])
          // The support point of this body along the normal.
          if (const double far = sign * normal.dot(x); far > at[side]) at[side] = far, plane.reach[side] = x;
      }
      // Both offsets are rounded towards each other: a gap that remains proves separation.
      plane.of_a = at[0] + kPlaneRounding * size_;
      plane.of_b = -at[1] - kPlaneRounding * size_;
      if (plane.gap() > 0 && (!best_ || plane.gap() > best_->gap())) best_ = plane;
    }
  }

  std::optional<SeparatingPlane> take() const { return best_; }

 private:
  std::vector<Vector3d> points_of(QueryContext& ctx, Side side) {
    std::vector<Vector3d> out;
    const LrbRep& rep = ctx[side].rep();
    out.reserve(rep.vertices().size());
    for (VertexId v = 0; v < rep.vertices().size(); ++v) {
      out.push_back(point(ctx[side].world(v)));
      size_ = std::max(size_, out.back().lpNorm<1>());
    }
    return out;
  }

  double size_ = 0;  ///< largest sum of a vertex's coordinates
  std::array<std::vector<Vector3d>, 2> points_;
  std::optional<SeparatingPlane> best_;
};

/// Tries as normals: the axes of the root boxes, their cross products, the line between the boxes' centres,
/// the axes of the closest rejected boxes, and the lines between the closest faces.
std::optional<SeparatingPlane> find_plane(QueryContext& ctx, const WalkExplanation& walk) {
  PlaneFinder finder(ctx);
  const WorldBox a = box_of(ctx[Side::a].tree(), 0, kWhole, ctx[Side::a].world.pose()),
                 b = box_of(ctx[Side::b].tree(), 0, kWhole, ctx[Side::b].world.pose());
  // Separating axis candidates for the root boxes (Gottschalk et al. 1996).
  for (const WorldBox& box : {a, b})
    for (const Vector3d& axis : box.across) finder.try_direction(axis);
  for (const Vector3d& x : a.across)
    for (const Vector3d& y : b.across) finder.try_direction(x.cross(y));
  finder.try_direction(b.centre - a.centre);
  // The axes of the disjoint boxes that were closest to each other.
  if (walk.nearest_boxes)
    for (const WorldBox& box : walk.nearest_boxes->boxes)
      for (const Vector3d& axis : box.across) finder.try_direction(axis);
  for (const SimplexPair& pair : walk.near) {
    Corners of_a{}, of_b{};
    ctx[Side::a].world.corners(pair.a, of_a.data());
    ctx[Side::b].world.corners(pair.b, of_b.data());
    // The line between closest points: the best direction for convex bodies.
    const NearPoints near = nearest_points(ctx[Side::a].rep().dim(), of_a, of_b);
    finder.try_direction(near.b - near.a);
  }
  return finder.take();
}

}  // namespace

WalkExplanation explain_walk(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  const FloatMode float_mode;
  QueryContext ctx;
  NullProbe probe;
  WalkExplanation out;
  CollideRequest request;
  // The answer itself, with a certificate if the bodies are separate.
  request.separation = true;
  out.result = collide(a, pose_a, b, pose_b, request, ctx, probe);
  // Then the traversal again, pair by pair.
  begin(ctx, a, pose_a, b, pose_b);
  if (a.tree().empty() || b.tree().empty()) return out;
  compare_boxes(box_of(a.tree(), 0, kWhole, pose_a), box_of(b.tree(), 0, kWhole, pose_b), out.roots, a.dim());
  Stepper stepper(ctx);
  NearestPairs nearest(ctx);
  NearestBoxes nearest_boxes(ctx, stepper);
  std::vector<NodePair> now = {{0, 0}}, then;
  // Breadth first, so that work is counted by depth. The set of visited pairs is independent of the order.
  for (; !now.empty(); now.swap(then)) {
    then.clear();
    WalkDepth depth;
    for (const NodePair& pair : now) {
      const Stepper::Outcome outcome = stepper.step(pair);
      ++depth.node_pairs;
      depth.ended += outcome.children.empty() && outcome.face_pairs == 0;
      out.leaf_pairs +=
          !outcome.parts_whole && stepper.is_leaf(Side::a, pair.a) && stepper.is_leaf(Side::b, pair.b);
      out.face_pairs += outcome.face_pairs;
      // Closest boxes and faces are collected only if the surfaces do not intersect.
      if (out.result.pairs.empty()) nearest_boxes.add(pair, outcome);
      out.left += outcome.candidates.size();
      for (const Candidate& c : outcome.candidates) {
        out.certain += c.certainty == Certainty::cross || c.certainty == Certainty::disjoint;
        if (out.result.pairs.empty()) nearest.add({c.a, c.b});
      }
      then.insert(then.end(), outcome.children.begin(), outcome.children.end());
    }
    out.depths.push_back(depth);
  }
  out.near = nearest.take();
  out.nearest_boxes = nearest_boxes.take();
  if (out.result.relation == Relation::separate) out.plane = find_plane(ctx, out);
  return out;
}

}  // namespace lrb
