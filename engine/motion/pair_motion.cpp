/// Conservative advancement of one pair of simplices, and a proof that a pair has passed through.
///
/// - separated_for(): bounds the motion of each pair of corners along a direction by a quadratic of t; the
/// least
///   first root is the time for which the slab separates the simplices.
/// - has_passed(): a continuity argument on the Minkowski difference, explained there.

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/collide/candidate_cache.hpp"
#include "engine/collide/tree_query.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/motion/motion_bounds.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

/// Roots are reduced by this factor, which covers their rounding: 8 u, u = 2^-53.
constexpr double kRootDown = 1 - 0x1p-40;

/// Returns the largest d up to which c + v d - k d^2 / 2 > 0, for c > 0 and k >= 0, rounded down.
double first_root(double c, double v, double k) {
  // Linear motion: the root is -c / v, or there is no root.
  if (!(k > 0)) return v >= 0 ? kInfinity : c / -v * kRootDown;
  // Of the two forms of the quadratic formula, use the one without cancellation for this sign of v.
  const double root = std::sqrt(v * v + 2 * k * c);
  return (v >= 0 ? (v + root) / k : 2 * c / (root - v)) * kRootDown;
}

/// Returns a unit direction perpendicular to n.
Vector3d across(const Vector3d& n) {
  int least = 0;
  // The axis on which n is shortest is never parallel to n.
  n.cwiseAbs().minCoeff(&least);
  return n.cross(Vector3d::Unit(least)).normalized();
}

/// A difference of two corners, projected along d: see has_passed().
struct Difference {
  double u, v;
};

double cross(const Difference& x, const Difference& y) {
  return x.u * y.v - x.v * y.u;
}

/// Returns true if a 2D triangle contains the origin, even if each of its corners moves by up to `distance`.
bool holds_origin(const Difference* k, double distance) {
  double sign = 0;
  for (int i = 0; i < 3; ++i) {
    const Difference &x = k[i], &y = k[(i + 1) % 3];
    // Twice the signed area of the triangle of the origin and this edge.
    const double turn = cross(x, y);
    const double most = std::abs(x.u) + std::abs(x.v) + std::abs(y.u) + std::abs(y.v);
    // Moving both ends by `distance` changes this by less than the first term; the second covers rounding.
    if (!(std::abs(turn) > 2 * distance * (most + distance) + kPairRounding * most * most)) return false;
    // The origin is inside if it is on the same side of all three edges.
    if (i > 0 && (turn > 0) != (sign > 0)) return false;
    sign = turn;
  }
  return true;
}

}  // namespace

PairMotion::PairMotion(const MovingBody& a, const MovingBody& b, SimplexPair pair)
    : body_{&a, &b}, n_(a.rep().dim()) {
  for (int side = 0; side < 2; ++side) {
    const LrbRep& rep = body_[side]->rep();
    VertexId v[3];
    rep.simplex(side == 0 ? pair.a : pair.b, v);
    for (int k = 0; k < n_; ++k) {
      Corner& corner = corner_[side][k];
      corner.in_body = rep.vertices()[v[k]];
      // The rotational velocity w x z is constant in the rotating frame: compute it once.
      const MovingBody::Spin spin = body_[side]->spin_of(corner.in_body);
      corner.spin = spin.velocity;
      corner.acceleration = spin.acceleration;
    }
  }
}

void PairMotion::place(const PieceState& a, const PieceState& b) {
  reach_ = 0;
  for (int side = 0; side < 2; ++side) {
    const PieceState& state = side == 0 ? a : b;
    const bool turns = body_[side]->turn_rate() > 0;
    for (int k = 0; k < n_; ++k) {
      Corner& corner = corner_[side][k];
      corner.x = state.pose.apply(corner.in_body);
      // Velocity: the common travel, plus r E (w x z) from rotation (motion_bounds.hpp).
      corner.v = body_[side]->travel();
      if (turns) corner.v += state.turned * corner.spin;
      // The largest coordinate difference, to which rounding errors are relative.
      reach_ = std::max(reach_, (corner.x - corner_[0][0].x).cwiseAbs().maxCoeff());
    }
  }
}

double PairMotion::places_rounding(const Vector3d& n) const {
  // The rounding of the product, then the errors of both bodies' positions, now and later.
  return 0.25 * kPairRounding * reach_ * n.cwiseAbs().sum() +
         2 * n.norm() * kWorldUp * (body_[0]->rounding() + body_[1]->rounding());
}

double PairMotion::separated_for(const Vector3d& n) const {
  const double length = n.norm() * kWorldUp;
  // A degenerate direction proves nothing.
  if (!(length > 0) || !(length < kInfinity)) return 0;
  double ahead[2][3], speed[2][3];
  double low[2] = {kInfinity, kInfinity}, high[2] = {-kInfinity, -kInfinity};
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < n_; ++k) {
      const Corner& corner = corner_[side][k];
      // Relative to A's first corner: differences of nearby points are accurate even far from the origin.
      ahead[side][k] = n.dot(corner.x - corner_[0][0].x);
      speed[side][k] = n.dot(corner.v);
      low[side] = std::min(low[side], ahead[side][k]);
      high[side] = std::max(high[side], ahead[side][k]);
    }
  // B is ahead along n or along -n: take the wider of the two gaps.
  const double sign = low[1] - high[0] >= low[0] - high[1] ? 1 : -1;
  const double rounding = places_rounding(n);
  const double speed_rounding = length * (body_[0]->velocity_rounding() + body_[1]->velocity_rounding());
  // Centripetal acceleration is perpendicular to the axis: it is small along directions near the axis.
  const double share_a = looks_at_axes_ ? body_[0]->share_along(n) : 1;
  const double share_b = looks_at_axes_ ? body_[1]->share_along(n) : 1;
  double least = kInfinity;
  for (int i = 0; i < n_; ++i)
    for (int j = 0; j < n_; ++j) {
      // c + v d - k d^2 / 2 of motion_bounds.hpp, rounded to the safe side.
      const double c = sign * (ahead[1][j] - ahead[0][i]) - rounding;
      if (!(c > 0)) return 0;
      const double v = sign * (speed[1][j] - speed[0][i]) - speed_rounding;
      const double k = share_a * corner_[0][i].acceleration + share_b * corner_[1][j].acceleration;
      // All pairs of corners must stay separated: the least root counts.
      least = std::min(least, first_root(c, v, length * k * (looks_at_axes_ ? kWorldUp : 1)));
    }
  return least > 0 ? least : 0;  // NaN: 0
}

Vector3d PairMotion::centroid(int side) const {
  Vector3d sum(0, 0, 0);
  for (int k = 0; k < n_; ++k) sum += corner_[side][k].x;
  return sum / n_;
}

PairBounds PairMotion::bounds() const {
  const double* x[2][3];
  for (int side = 0; side < 2; ++side)
    for (int k = 0; k < n_; ++k) x[side][k] = corner_[side][k].x.data();
  return bound_distance(x[0], x[1], n_);
}

/// Velocity is an affine function of position, so it can be interpolated between a feature's corners.
Vector3d PairMotion::velocity_at(int side, const exact::Feature& on, const Vector3d& point) const {
  const Corner* const corner = corner_[side];
  const int first = on.dim == 2 ? 0 : on.index;
  const Corner &from = corner[first], &to = corner[(first + 1) % n_];
  const Vector3d along = to.x - from.x, direction = point - from.x;
  // A vertex, or a degenerate edge.
  if (on.dim == 0 || !(along.squaredNorm() > 0)) return from.v;
  // Linear interpolation along the edge.
  if (on.dim == 1) return from.v + direction.dot(along) / along.squaredNorm() * (to.v - from.v);
  const Vector3d other = corner[2].x - from.x;
  // Barycentric coordinates by Cramer's rule (Ericson 2005, section 3.4).
  const double uu = along.squaredNorm(), vv = other.squaredNorm(), uv = along.dot(other);
  const double area = uu * vv - uv * uv, uw = along.dot(direction), vw = other.dot(direction);
  if (!(area > 0)) return from.v;
  return from.v + (vv * uw - uv * vw) / area * (to.v - from.v) +
         (uu * vw - uv * uw) / area * (corner[2].v - from.v);
}

double PairMotion::approach_speed(const PairBounds& at, const Vector3d& n) const {
  return -n.dot(velocity_at(1, at.on[1], at.point[1]) - velocity_at(0, at.on[0], at.point[0]));
}

/// Returns the unit direction of projection in has_passed(): the direction of motion, because there is least
/// motion perpendicular to it, or n if the motion is nearly parallel to the slab.
Vector3d PairMotion::look_along(const Vector3d& n) const {
  constexpr double kMinCosine = 1e-3;
  const Vector3d direction = body_[1]->travel() - body_[0]->travel();
  return std::abs(direction.dot(n)) > kMinCosine * direction.norm() * n.norm() ? direction.normalized()
                                                                               : n.normalized();
}

/// Proves by continuity that the simplices have intersected. They intersect if the origin is in their
/// Minkowski difference, the convex hull of the differences b - a of their corners: nine points, in 2D four.
/// Suppose that three of these points (2D: two) are ahead along n before, and behind now. Project the
/// triangle (segment) between them along some direction d that is not perpendicular to n. Suppose that the
/// projection contains the origin before, and still does so for every possible motion of the corners since.
/// Then the line through the origin along d intersects the triangle at all times, and their common point
/// moves continuously along the line from ahead to behind: at some time it is the origin.
bool PairMotion::has_passed(const PairMotion& before, const Vector3d& n, double time) const {
  const Vector3d d = look_along(n);
  // u and v span the plane of projection.
  const Vector3d u = n_ == 3 ? across(d) : Vector3d(-d.y(), d.x(), 0), v = d.cross(u);
  const double sure = places_rounding(n), sure_before = before.places_rounding(n);
  const Vector3d travel = body_[1]->travel() - body_[0]->travel();
  const double aside = std::abs(u.dot(travel)) + std::abs(v.dot(travel)) + 4 * kWorldRounding * travel.norm();
  // Upper bound on the motion of any difference perpendicular to d: travel, both rotations, and rounding.
  const double moved = (time * aside + body_[0]->turned_by(time) + body_[1]->turned_by(time)) * kWorldUp +
                       2 * (body_[0]->rounding() + body_[1]->rounding()) + kPairRounding * reach_;
  Difference turned[9];
  int count = 0;
  for (int i = 0; i < n_; ++i)
    for (int j = 0; j < n_; ++j) {
      // Keep corner differences that are proven ahead along n before, and behind now.
      const Vector3d was = before.corner_[1][j].x - before.corner_[0][i].x;
      if (!(n.dot(was) > sure_before) || !(n.dot(corner_[1][j].x - corner_[0][i].x) < -sure)) continue;
      turned[count++] = {u.dot(was), v.dot(was)};
    }
  if (n_ == 2) {
    // 2D: a segment contains the origin throughout if its ends stay on different sides of it.
    const auto ahead = [&](const Difference& k) { return k.u > moved; };
    const auto behind = [&](const Difference& k) { return k.u < -moved; };
    return std::any_of(turned, turned + count, ahead) && std::any_of(turned, turned + count, behind);
  }
  // 3D: try all triangles of kept differences, at most 84. One that contains the origin throughout is a
  // proof.
  for (int i = 0; i < count; ++i)
    for (int j = i + 1; j < count; ++j)
      for (int k = j + 1; k < count; ++k) {
        const Difference three[3] = {turned[i], turned[j], turned[k]};
        if (holds_origin(three, moved)) return true;
      }
  return false;
}

// One dual traversal for an entire time interval: B is swept along its first-order motion relative to A. All
// deviations from this, that is second-order terms, A's rotation and rounding, become the margin of the
// kernel.

namespace {

using Eigen::Matrix3d;

/// Largest rotation angle of B from the middle of an interval, in radians, for which its rotation is
/// linearised.
constexpr double kStraight = 1;
/// Largest deviation from rotations for which bodies are swept by the kernel for rotations.
constexpr double kNearlyRigid = 0x1p-6;
constexpr std::size_t kBuffer = 192;
constexpr std::uint64_t kNodePairsPerResult = 64;  // node pairs for each pair of simplices that is allowed

Matrix3d cross_matrix(const Vector3d& w) {
  Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

/// Returns the sweep of B over `half` an interval to either side of its middle, on A's axes. The relative
/// displacement of A and B at a contact, seen from the middle, is the difference of their displacements in
/// the world, rotated to A's axes.
Sweep sweep_of(const MovingBody& a, const PieceState& at_a, const MovingBody& b, const PieceState& at_b,
               double half) {
  Sweep sweep;
  const Matrix3d to_a = at_a.pose.r.transpose();
  // B seen from A at the middle of the interval; both travels are combined into one relative travel.
  sweep.mid_pose = {to_a * at_b.pose.r, to_a * (at_b.pose.t - at_a.pose.t)};
  const Vector3d travel = b.travel() - a.travel();
  sweep.dt = half * (to_a * travel);
  // A's rotation displaces contacts in any direction: it widens the sweep.
  sweep.width = a.turned_by(half);
  double turning = 0;
  if (half * b.turn_rate() <= kStraight && b.turn_rate() > 0) {
    // A small angle: sweep along the velocity (Taylor), and widen by the second-order term below.
    const Motion::Piece& piece = b.piece();
    const Matrix3d spin = half / (piece.end - piece.begin) * (to_a * at_b.turned * cross_matrix(piece.turn));
    sweep.dm = spin * piece.first.r;
    sweep.dt += spin * piece.first.t;
    sweep.turn = sweep.dm.norm() * kWorldUp;
    turning = half * b.spin();
    sweep.width += 0.5 * half * half * b.acceleration();
  } else {
    // A large angle: allow for B's rotation in any direction.
    sweep.width += b.turned_by(half);
  }
  // From the world to A's axes; A need not be an exact rotation.
  const double to_a_size = stretch(at_a.pose);
  sweep.width *= to_a_size * kWorldUp;
  sweep.length = (half * travel.norm() + turning) * to_a_size * kWorldUp;
  return sweep;
}

}  // namespace

bool suits_sweeps(const MovingBody& a, const MovingBody& b) {
  const Matrix3d at_a = a.at(a.piece().begin).pose.r, at_b = b.at(b.piece().begin).pose.r;
  return rotation_defect(at_a) <= kNearlyRigid && rotation_defect(at_a.transpose() * at_b) <= kNearlyRigid;
}

bool find_swept_pairs(QueryContext& ctx, const MovingBody& a, const MovingBody& b, TimeSpan span,
                      std::uint64_t most, std::vector<SimplexPair>& pairs) {
  const double midpoint = span.begin + (span.end - span.begin) / 2;
  // The larger half, rounded up, so that both ends of the interval are covered.
  const double half = std::max(span.end - midpoint, midpoint - span.begin) * kWorldUp;
  const PieceState at_a = a.at(midpoint), at_b = b.at(midpoint);
  // Set up the kernel at the poses of the midpoint, then widen it to the sweep.
  ctx.body[0].begin(a.rep(), at_a.pose, WrapperMode::regularised);
  ctx.body[1].begin(b.rep(), at_b.pose, WrapperMode::regularised);
  TreeKernel k = start_rigid_kernel(ctx, at_a.pose, at_b.pose, kBuffer);
  const Sweep sweep = sweep_of(a, at_a, b, at_b, half);
  // Covers the errors of the bodies' positions in doubles, at the midpoint and at t.
  const double rounding = wrapper_margin(at_a.pose, a.rep().tree(), at_b.pose, b.rep().tree()) +
                          2 * rotation_defect(at_a.pose.r) * a.rep().tree().extent() +
                          4 * (a.rounding() + b.rounding()) + kWorldRounding * sweep.length;
  aim_at(sweep, rounding, query_unit(a.rep().tree(), b.rep().tree()), k);
  // A list beyond the limit is useless: bound the traversal as well.
  if (most != kNoLimit) k.max_node_pairs = kNodePairsPerResult * most;
  pairs.clear();
  while (!is_done(k)) {
    // Empty the kernel's buffer; give up once there are too many pairs or node pairs.
    k.out_size = 0;
    run_tree_kernel(k);
    for (std::uint32_t i = 0; i < k.out_size; ++i) pairs.push_back({k.out[i].a, k.out[i].b});
    if (!is_done(k) && (pairs.size() > most || k.node_pairs >= k.max_node_pairs)) return false;
  }
  return pairs.size() <= most;
}

}  // namespace lrb
