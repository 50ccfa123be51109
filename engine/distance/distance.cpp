/// The distance query; distance.hpp names its sources. Steps:
/// 1. Measure one pair of simplices for a first upper bound: the candidate of the previous step, or any pair.
/// 2. Traverse both trees, best first: in float where that is accurate enough, otherwise in double.
/// 3. Measure the remaining pairs, in double and, where needed, in integers.
/// 4. Complete the answer: closest points and relation of the bodies.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <Eigen/LU>

#include "engine/collide/collide_into.hpp"
#include "engine/collide/relation.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/distance/distance_context.hpp"
#include "engine/distance/distance_kernel.hpp"
#include "engine/distance/nearest_pairs.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/point_distance.hpp>

namespace lrb {

// Best-first traversal of two trees in double, for poses that are not rotations and for distant bodies.
// Slower than the float kernel.

/// Traverses the trees of the bodies of `ctx` and measures the pairs of simplices that may be the closest.
class WorldWalk {
 public:
  WorldWalk(QueryContext& ctx, NearestPairs& found);

  /// Returns true if the traversal was completed or the request is answered, false after `max_steps` steps
  /// (0: no limit). adapter: null, or notified of bounds.
  bool run(std::uint64_t max_steps, BoundsProbeAdapter* adapter);
  /// Returns a lower bound on the distances of all unmeasured pairs.
  double rest() const;
  std::uint64_t steps() const { return steps_; }
  std::uint64_t box_tests() const { return box_tests_; }

 private:
  using Vector3d = Eigen::Vector3d;
  using Matrix3d = Eigen::Matrix3d;

  /// A box along the traversal's axes.
  struct Box {
    Vector3d centre, half;
  };
  struct Waiting {
    double bound;
    std::uint32_t a, b;
  };
  struct Body {
    const ObbTree* tree;
    Matrix3d map;     ///< from the tree's units to the traversal's axes
    Vector3d origin;  ///< on the traversal's axes
    double margin;    ///< error bound of coordinates
    double turn;      ///< upper bound on the factor by which the map stretches lengths
  };

  Body body_of(const QueryBody& body, int exponent) const;
  void boxes_of(const Body& body, const TreeNode& node, std::vector<Box>& out) const;
  static double gap_between(const Box& a, const Box& b);
  void open(const Waiting& pair);
  void add_pair(const Waiting& parent, std::uint32_t a, std::uint32_t b, double bound, bool leaves);

  NearestPairs& found_;
  int exponent_;   ///< the unit of the traversal is 2^exponent_
  Matrix3d axes_;  ///< rows: the traversal's axes in the world
  Body body_[2];
  std::vector<Waiting> waiting_;
  std::vector<Box> boxes_[2];
  double dropped_ = std::numeric_limits<double>::infinity();  ///< least bound of the dropped pairs
  std::uint64_t steps_ = 0, box_tests_ = 0;
};

// Distances along a motion. Kept from the previous step:
// - The closest pair of simplices. Measured at the new poses, it gives an upper bound and the direction of
//   slabs before the traversal begins. If the surfaces intersected in it and still do, nothing is traversed.
// - The relation of the bodies. If the surfaces were disjoint, and no points can have approached by the whole
//   distance since, the surfaces do not intersect anywhere on the path between the steps: one body contains
//   the other now if and only if it did then.
// - Planes that separate pairs of nodes: while they do, these nodes are not expanded.
//
// Each step proves again that every other pair is at least as far.

class CoherentDistance::Work {
 public:
  Work(const LrbRep& a, const LrbRep& b, const DistanceRequest& request) : a_(a), b_(b), request_(request) {}

  DistanceResult distance(const Pose& pose_a, const Pose& pose_b) {
    const PosePair now{pose_a, pose_b};
    const bool lies_as_before = request_.relation && is_relation_kept(now);
    // A relation that is known to be unchanged is not computed.
    DistanceRequest ask = request_;
    ask.relation = request_.relation && !lies_as_before;
    DistanceResult result = lrb::distance(a_, pose_a, b_, pose_b, ask, context_, &before_);
    // The relation holds only if this step proves a positive distance, which an early stop may not.
    if (lies_as_before) result.relation = result.lower > 0 ? relation_ : Relation::unresolved;
    // The starting point of the next step.
    before_.likely = {result.witness[0].simplex, result.witness[1].simplex};
    apart_ = result.lower;
    relation_ = result.relation;
    poses_ = now;
    return result;
  }

 private:
  bool is_relation_kept(const PosePair& now) const {
    // Only for solids: the relation of open bodies is decided by boxes, which change with each pose. NaN or
    // an unknown distance keeps nothing.
    return a_.closed() && b_.closed() && apart_ > 0 && std::isfinite(apart_) &&
           nearer_by(a_, b_, poses_, now, apart_) < apart_;
  }

  const LrbRep &a_, &b_;
  const DistanceRequest request_;
  DistanceContext context_;
  // From the last answer:
  KnownFromBefore before_;
  double apart_ = 0;  ///< the lower bound
  Relation relation_ = Relation::undefined;
  PosePair poses_;
};

CoherentDistance::CoherentDistance(const LrbRep& a, const LrbRep& b, const DistanceRequest& request)
    : work_(std::make_unique<Work>(a, b, request)) {}
CoherentDistance::~CoherentDistance() = default;
CoherentDistance::CoherentDistance(CoherentDistance&&) noexcept = default;
CoherentDistance& CoherentDistance::operator=(CoherentDistance&&) noexcept = default;

DistanceResult CoherentDistance::distance(const Pose& pose_a, const Pose& pose_b) {
  const FloatMode float_mode;
  return work_->distance(pose_a, pose_b);
}

namespace {

DistanceResult of_nothing(const DistanceRequest& request) {
  DistanceResult result;
  result.lower = result.upper = std::numeric_limits<double>::infinity();
  if (request.within) result.within = false;
  return result;
}

void check_number(double x, const char* name) {
  if (!(x >= 0) || std::isinf(x))
    throw InputError(std::string("distance: expected a finite ") + name + " of at least 0, found " +
                     std::to_string(x));
}

}  // namespace

void check_request(const DistanceRequest& request) {
  if (request.within) check_number(*request.within, "`within`");
  check_number(request.tolerance, "`tolerance`");
  check_number(request.relative_tolerance, "`relative_tolerance`");
}

DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request, DistanceContext& context, KnownFromBefore* before,
                        BoundsProbe* probe) {
  const FloatMode float_mode;
  check_query(a, pose_a, b, pose_b);
  check_request(request);
  // A body without faces is infinitely far from everything.
  if (a.tree().empty() || b.tree().empty()) return of_nothing(request);
  QueryContext& query = context.query;
  query.body[0].begin(a, pose_a, WrapperMode::regularised);
  query.body[1].begin(b, pose_b, WrapperMode::regularised);
  NearestPairs found(query, request, context.pairs);
  // Only coherent queries accept that the last digits depend on the order of the pairs.
  if (before != nullptr) found.spare_equal_pairs();
  DistanceResult result;
  const bool is_likely = before != nullptr && before->likely[0] != kNull;
  if (is_likely) {
    // Step 1, coherent: the candidate is often still the closest. If it intersects, the query ends here.
    const std::array<SimplexId, 2>& likely = before->likely;
    if (!found.measure(likely[0], likely[1], 0) && found.pair_meets(likely)) {
      found.finish(0, true, result);
      return result;
    }
  } else if (request.max_steps > 0 || request.within) {  // an early stop needs an upper bound as well
    // Step 1, otherwise: an early stop needs some upper bound, and any pair gives one.
    found.measure(a.tree().blocks()[0].simplex[0], b.tree().blocks()[0].simplex[0], 0);
  }
  // Step 2: bring both bodies into one frame, and choose the traversal by its accuracy.
  const TreeKernel tree = set_up_any_kernel(a.tree(), pose_a, b.tree(), pose_b, a.dim(), query.affine);
  bool finished = false;
  double rest = 0;
  std::optional<BoundsProbeAdapter> adapted;
  if (probe != nullptr) adapted.emplace(*probe);
  BoundsProbeAdapter* const adapter = adapted ? &*adapted : nullptr;
  if (suits_floats(tree)) {
    // A likely candidate has given an upper bound already: no descent to a first pair.
    FloatWalk walk(context, found, request, tree, query_unit(a.tree(), b.tree()), !is_likely,
                   before != nullptr ? &before->far : nullptr);
    finished = walk.run(adapter);
    // Step 3. The other traversal measures pairs as it finds them.
    if (!found.known_to_meet()) rest = walk.measure();
    walk.count(result.counters);
  } else {
    WorldWalk walk(query, found);
    finished = walk.run(request.max_steps, adapter);
    rest = walk.rest();
    result.counters.steps = walk.steps();
    result.counters.box_tests = walk.box_tests();
  }
  // The probe gets the bounds before and after the exact measurements.
  if (adapter && !found.known_to_meet())
    adapter->notify(result.counters.steps + found.measured(), found.lower(rest), found.upper());
  // Step 4.
  found.finish(rest, finished, result);
  if (adapter) adapter->notify(result.counters.steps + found.measured(), result.lower, result.upper);
  return result;
}

DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request) {
  DistanceContext context;
  return distance(a, pose_a, b, pose_b, request, context);
}

DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request, BoundsProbe& probe) {
  DistanceContext context;
  return distance(a, pose_a, b, pose_b, request, context, nullptr, &probe);
}

std::vector<DistanceResult> distances(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                      std::span<const Pose> poses_b, const DistanceRequest& request,
                                      unsigned threads) {
  Workers workers(threads);
  std::vector<DistanceContext> contexts(workers.count());
  std::vector<DistanceResult> results(poses_b.size());
  // Results do not depend on which worker computes which pose: contexts are only buffers.
  workers.for_each(poses_b.size(), [&](std::size_t i, unsigned worker) {
    results[i] = distance(a, pose_a, b, poses_b[i], request, contexts[worker]);
  });
  return results;
}

// Best-first traversal in double. Steps:
// 1. Choose axes, orthonormal in the world, with the first axis pointing from one body to the other: in that
//    direction the near sides of distant bodies differ most from their far sides.
// 2. Enclose the boxes of a node in boxes along these axes. The distance of two such boxes is the root of the
//    sum of the squares of the positive gaps.
// 3. Expand the pair of nodes with the least bound, drop the pairs of children beyond the pruning distance,
//    and measure the pairs of simplices at the leaves.
//
// Errors, with u = 2^-53 and S the size of a body's world coordinates. World coordinates are rounded by 4 u S
// each, which is an error of at most 7 u S along any axis. The map to the chosen axes, and origins on them,
// have errors of at most 30 u S. The axes are orthonormal to 8 u. The margin, 4 kWorldRounding S, is 128 u S.
// The nodes' own axes are orthonormal to kFrameDefect: as in relation.cpp, kKernelRounding times the size of
// the node covers that.

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Covers the rounding of the axes, 10 u, of squares and of a root, 4 u; u = 2^-53.
constexpr double kRootDown = 1 - 0x1p-48;

int exponent_above(double x) {
  return std::isfinite(x) ? (x > 0 ? std::ilogb(x) + 1 : -1022) : 1024;
}

template <class Matrix>
Matrix scaled(const Matrix& x, int exponent) {
  return x.unaryExpr([exponent](double c) { return std::ldexp(c, exponent); });
}

/// Returns x 2^exponent, rounded down.
double scaled_down(double x, int exponent) {
  // ldexp() rounds only near underflow; one step down compensates for that. Overflow becomes the largest
  // double.
  constexpr double kSmall = 0x1p-1000;
  const double y = std::min(std::ldexp(x, exponent), std::numeric_limits<double>::max());
  return y < kSmall ? std::max(0.0, std::nextafter(y, 0.0)) : y;
}

/// Returns axes whose first one points along `towards`, or the world's axes if `towards` has no direction.
Matrix3d axes_along(const Vector3d& towards) {
  const double length = stable_norm3(towards);
  if (!(length > 0) || !std::isfinite(length)) return Matrix3d::Identity();
  // Householder reflection that maps the x axis to `towards`. It is symmetric, so its first row is `towards`.
  const Vector3d mirror = Vector3d::UnitX() - towards / length;
  constexpr double kNearlyX = 1e-6;
  // Almost along x: the mirror's normal would consist of rounding errors, and the world's axes serve as well.
  if (mirror.squaredNorm() < kNearlyX) return Matrix3d::Identity();
  return Matrix3d::Identity() - 2 / mirror.squaredNorm() * mirror * mirror.transpose();
}

}  // namespace

WorldWalk::WorldWalk(QueryContext& ctx, NearestPairs& found) : found_(found), axes_(Matrix3d::Identity()) {
  const auto size_of = [](const QueryBody& body) { return world_size(body.world.pose(), body.tree()); };
  // The unit is a power of two above all coordinates: scaling is exact, and squares cannot overflow.
  exponent_ = exponent_above(std::max(size_of(ctx.body[0]), size_of(ctx.body[1])));
  // The axes are still the world's at this point, so this returns the position of a body's root in the world.
  const auto centre_of = [&](const QueryBody& body) -> Vector3d {
    const Body b = body_of(body, exponent_);
    const double* at = b.tree->nodes()[0].origin;
    return b.map * Vector3d(at[0], at[1], at[2]) + b.origin;
  };
  axes_ = axes_along(centre_of(ctx.body[1]) - centre_of(ctx.body[0]));
  // Both maps again, to the axes just chosen.
  for (int side = 0; side < 2; ++side) body_[side] = body_of(ctx.body[side], exponent_);
  waiting_.push_back({0, 0, 0});
}

WorldWalk::Body WorldWalk::body_of(const QueryBody& body, int exponent) const {
  const Pose& pose = body.world.pose();
  const int unit = std::ilogb(body.tree().unit());
  Body out;
  out.tree = &body.tree();
  // The tree's unit is a power of two as well: one exact scaling covers both.
  out.map = axes_ * scaled(pose.r, unit - exponent);
  out.origin = axes_ * scaled(pose.t, -exponent);
  out.margin = 4 * kWorldRounding * std::ldexp(world_size(pose, body.tree()) + kWorldUnderflow, -exponent);
  out.turn = std::ldexp(stretch(pose), unit - exponent);
  return out;
}

void WorldWalk::boxes_of(const Body& body, const TreeNode& node, std::vector<Box>& out) const {
  Matrix3d frame;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) frame(j, i) = node.frame[i][j];
  // An oriented box fits into half extents |R| h along the chosen axes.
  const Matrix3d axes = body.map * frame, sizes = axes.cwiseAbs();
  const Vector3d origin = body.map * Vector3d(node.origin[0], node.origin[1], node.origin[2]) + body.origin;
  // Covers the rounding of coordinates and the defect of the node's axes.
  const double grow = body.margin + kKernelRounding * body.turn * static_cast<double>(node.radius);
  out.clear();
  for (std::uint32_t k = 0; k < node.count; ++k) {
    Vector3d centre, half;
    // Decode the quantised box on the node's axes.
    for (int i = 0; i < 3; ++i) {
      const double base = node.base[i], scale = node.scale[i];
      centre[i] = base + scale * 0.5 * (node.lo[i][k] + node.hi[i][k]);
      half[i] = scale * 0.5 * (node.hi[i][k] - node.lo[i][k]);
    }
    out.push_back({origin + axes * centre, sizes * half + Vector3d::Constant(grow)});
  }
}

/// Returns a lower bound on the distance of two boxes; 0 if anything is NaN.
double WorldWalk::gap_between(const Box& a, const Box& b) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    // Positive gaps only: overlapping projections add nothing.
    const double gap = std::abs(a.centre[axis] - b.centre[axis]) - (a.half[axis] + b.half[axis]);
    if (gap > 0) sum += gap * gap;
  }
  return sum > 0 ? std::sqrt(sum) * kRootDown : 0;
}

void WorldWalk::add_pair(const Waiting& parent, std::uint32_t a, std::uint32_t b, double bound, bool leaves) {
  // Children are inside their parents, so the parents' bound is valid for them.
  bound = std::max(bound, parent.bound);
  if (bound > 0 && bound >= std::ldexp(found_.dropped_from(), -exponent_)) {
    // dropped_ bounds all dropped pairs from below.
    dropped_ = std::min(dropped_, bound);
    return;
  }
  if (leaves) {
    const SimplexId of_a = body_[0].tree->blocks()[body_[0].tree->nodes()[parent.a].first].simplex[a];
    const SimplexId of_b = body_[1].tree->blocks()[body_[1].tree->nodes()[parent.b].first].simplex[b];
    // If contact is not excluded, the exact query decides for the surfaces as a whole.
    if (!found_.measure(of_a, of_b, scaled_down(bound, exponent_))) found_.surfaces_meet();
    return;
  }
  // Push to a binary min-heap.
  waiting_.push_back({bound, a, b});
  std::push_heap(waiting_.begin(), waiting_.end(),
                 [](const Waiting& x, const Waiting& y) { return x.bound > y.bound; });
}

void WorldWalk::open(const Waiting& pair) {
  const TreeNode &a = body_[0].tree->nodes()[pair.a], &b = body_[1].tree->nodes()[pair.b];
  const auto size = [&](int side, const TreeNode& n) { return n.radius * body_[side].turn; };
  const bool leaves = a.is_leaf && b.is_leaf;
  // Expand both nodes, except one that is a leaf or much smaller than the other.
  const bool open_a = leaves || (!a.is_leaf && (b.is_leaf || size(1, b) <= kMuchLarger * size(0, a)));
  const bool open_b = leaves || (!b.is_leaf && (a.is_leaf || size(0, a) <= kMuchLarger * size(1, b)));
  boxes_of(body_[0], a, boxes_[0]);
  boxes_of(body_[1], b, boxes_[1]);
  box_tests_ += (open_a ? a.count : 1) * (open_b ? b.count : 1);
  // A node that is not expanded is represented by the box around its boxes.
  const auto whole = [](const std::vector<Box>& boxes) {
    Vector3d low = Vector3d::Constant(kInfinity), high = -low;
    for (const Box& box : boxes)
      low = low.cwiseMin(box.centre - box.half), high = high.cwiseMax(box.centre + box.half);
    return Box{0.5 * (low + high), 0.5 * (high - low)};
  };
  if (!open_a) boxes_[0] = {whole(boxes_[0])};
  if (!open_b) boxes_[1] = {whole(boxes_[1])};
  // Every pair of boxes; in leaves these are the boxes of simplices.
  for (std::uint32_t i = 0; i < boxes_[0].size(); ++i)
    for (std::uint32_t j = 0; j < boxes_[1].size(); ++j) {
      const double bound = gap_between(boxes_[0][i], boxes_[1][j]);
      if (leaves)
        add_pair(pair, i, j, bound, true);
      else
        add_pair(pair, open_a ? a.first + i : pair.a, open_b ? b.first + j : pair.b, bound, false);
    }
}

bool WorldWalk::run(std::uint64_t max_steps, BoundsProbeAdapter* adapter) {
  std::uint64_t look = 1;
  const auto later = [](const Waiting& x, const Waiting& y) { return x.bound > y.bound; };
  while (!waiting_.empty()) {
    const double bound = waiting_.front().bound;
    // The least bound of all is beyond the pruning distance.
    if (bound > 0 && bound >= std::ldexp(found_.dropped_from(), -exponent_)) return true;
    // The request is answered already.
    if (found_.is_near_enough() || found_.known_to_meet()) return true;
    if (max_steps > 0 && steps_ >= max_steps) return false;
    ++steps_;
    std::pop_heap(waiting_.begin(), waiting_.end(), later);
    const Waiting pair = waiting_.back();
    waiting_.pop_back();
    open(pair);
    // Coordinates of very distant bodies have hardly a digit left for their shapes: allow a wider interval.
    const double upper = found_.upper();
    if (upper < kInfinity) found_.allow_width(upper > kVeryFar * found_.size() ? kFarWidth * upper : 0);
    if (adapter != nullptr && steps_ >= look) {
      // Each report visits all measured pairs, so reports become rarer as the work grows.
      adapter->notify(steps_, found_.lower(rest()), upper);
      look = BoundsProbeAdapter::next_look(steps_);
    }
  }
  return true;
}

double WorldWalk::rest() const {
  // Every unmeasured pair was dropped or is below a waiting pair; the heap's top has the least bound of
  // those.
  double least = dropped_;
  if (!waiting_.empty()) least = std::min(least, waiting_.front().bound);
  return least < kInfinity ? scaled_down(least, exponent_) : kInfinity;
}

// Bounds the approach of two bodies between two poses. Let Q = R_A' R_A^T, the rotation of A's axes from one
// pose to the next. Let w be the vector from a point x of A to a point y of B in the world, and w' the same
// vector at the next pose. Then
//     w' - Q w = (R_B' - Q R_B) y + (t_B' - t_A') - Q (t_B - t_A) + (Q R_A - R_A') x,
// where the last term is at most |R_A'| |R_A^T R_A - 1| |x|. With D = R_B' - Q R_B, d the sum of the terms in
// t, c the centre of B and r its radius, the other terms are at most |D c + d| + |D| r; turn_bound() bounds
// |D|. |Q w| equals |w| up to |Q^T Q - 1| |w|. Computed values are rounded by a few u = 2^-53 times the sizes
// of world coordinates, and these by 4 u at either pose: 128 u times the sum of all sizes covers both.

double nearer_by(const LrbRep& a, const LrbRep& b, const PosePair& from, const PosePair& to, double reach) {
  // Q, then Q R_B and D.
  const Eigen::Matrix3d turn = to.a.r * from.a.r.transpose();
  const Eigen::Matrix3d was = turn * from.b.r, d = to.b.r - was;
  const double defect_a = rotation_defect(from.a.r) + rotation_defect(to.a.r);
  const double defect_b = rotation_defect(was) + rotation_defect(to.b.r);
  // The bounds hold for rotations, up to kRigid, and only if the orientation of B is kept.
  if (!(defect_a <= kRigid && defect_b <= kRigid) || !(was.determinant() * to.b.r.determinant() > 0))
    return kInfinity;
  const TreeNode& root = b.tree().nodes()[0];
  const double unit = b.tree().unit();
  // c, and d: the displacement of B's origin relative to A.
  const Eigen::Vector3d centre = Eigen::Vector3d(root.origin[0], root.origin[1], root.origin[2]) * unit;
  const Eigen::Vector3d shift = (to.b.t - to.a.t) - turn * (from.b.t - from.a.t);
  const double turned = turn_bound(d, defect_b);
  // Displacement of the centre, plus the largest displacement by the rotation at distance r.
  const double moved = (d * centre + shift).norm() + turned * static_cast<double>(root.radius) * unit;
  // The term in x, with |x| at most sqrt(3) times the largest coordinate.
  const double of_a = 2 * defect_a * std::sqrt(3.0) * a.tree().extent();
  // The stretch of |Q w|; `reach` bounds |w|.
  const double stretched = 2 * (defect_a + kWorldRounding) * reach;
  // Rounding of world coordinates at both poses.
  const double sizes = world_size(from.a, a.tree()) + world_size(to.a, a.tree()) +
                       world_size(from.b, b.tree()) + world_size(to.b, b.tree()) + kWorldUnderflow;
  const double by = (moved + of_a + stretched) * (1 + kWorldRounding) + 4 * kWorldRounding * sizes;
  // Overflow: no bound is known.
  return std::isfinite(by) ? by : kInfinity;
}

// Signed distances of points; point_distance.hpp names the method.

namespace {

/// Returns a body of one simplex whose corners are all in the origin. A translation moves it to any point
/// without rounding.
LrbRep body_of_one_point(int dim) {
  Mesh mesh;
  mesh.dim = dim;
  mesh.vertices.assign(static_cast<std::size_t>(dim), Eigen::Vector3d::Zero());
  const std::array<VertexId, 3> corners{VertexId(0), VertexId(1), VertexId(2)};
  mesh.add_face(std::span(corners).first(static_cast<std::size_t>(dim)));
  return LrbRep::without_regions(mesh, false, false);
}

}  // namespace

std::vector<PointDistance> point_distances(const LrbRep& body, const Pose& pose,
                                           std::span<const Eigen::Vector3d> points,
                                           const PointDistanceRequest& request, unsigned threads) {
  const FloatMode float_mode;
  DistanceRequest ask;
  ask.tolerance = request.tolerance;
  ask.relative_tolerance = request.relative_tolerance;
  ask.relation = false;
  check_request(ask);
  // All points are checked first, so that the message names the first wrong one on any number of threads.
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].head(body.dim()).allFinite())
      throw InputError("point " + std::to_string(i) +
                       ": expected finite coordinates, found a NaN or an infinity");
  const LrbRep point = body_of_one_point(body.dim());
  Workers workers(threads);
  std::vector<DistanceContext> contexts(workers.count());
  std::vector<PointDistance> results(points.size());
  workers.for_each(points.size(), [&](std::size_t i, unsigned worker) {
    DistanceContext& context = contexts[worker];
    Eigen::Vector3d p = points[i];
    if (body.dim() == 2) p.z() = 0;
    const DistanceResult at = distance(body, pose, point, Pose::translation(p), ask, context);
    PointDistance& result = results[i];
    result.lower = at.lower;
    result.upper = at.upper;
    result.closest = at.witness[0];
    if (at.meet)
      result.side = Where::on_surface;
    else if (request.side && body.closed() && !body.tree().empty())
      // The query has left the body at its pose in the context.
      result.side = locate(context.query.body[0], p.data());
  });
  return results;
}

}  // namespace lrb
