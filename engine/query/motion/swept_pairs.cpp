/// One dual traversal for a whole time interval: B is swept along its first-order motion relative to A, and
/// all that differs from this, second-order terms, A's rotation and rounding, becomes the margin of the
/// kernel.

#include "engine/query/motion/swept_pairs.hpp"

#include <algorithm>

#include <Eigen/Geometry>

#include "engine/core/tolerances.hpp"
#include "engine/query/coherent/candidate_cache.hpp"
#include "engine/query/walk/tree_query.hpp"
#include "engine/tree/pose_bounds.hpp"

namespace lrb {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Largest angle, in radians, by which B may turn from the middle of a span for its turning to be followed
/// straight.
constexpr double kStraight = 1;
/// Bodies that are further from rotations than this are not swept by the kernel for rotations.
constexpr double kNearlyRigid = 0x1p-6;
constexpr std::size_t kBuffer = 192;
constexpr std::uint64_t kPatience = 64;  // pairs of nodes for each pair of simplices that is asked for

Matrix3d cross_matrix(const Vector3d& w) {
  Matrix3d m;
  m << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -w.y(), w.x(), 0;
  return m;
}

/// Returns the sweep of B over `half` a span to either side of its middle, on A's axes. What A and B are
/// displaced by at a contact, seen from the middle, is the difference of their displacements in the world,
/// turned to A's axes.
Sweep sweep_of(const MovingBody& a, const PieceState& at_a, const MovingBody& b, const PieceState& at_b,
               double half) {
  Sweep sweep;
  const Matrix3d to_a = at_a.pose.r.transpose();
  // B seen from A at the middle of the interval; both travels become one relative travel.
  sweep.middle = {to_a * at_b.pose.r, to_a * (at_b.pose.t - at_a.pose.t)};
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
  // From the world to A's axes; A need not be exactly a rotation.
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
  const double middle = span.begin + (span.end - span.begin) / 2;
  // The larger half, rounded up: both ends of the interval are covered.
  const double half = std::max(span.end - middle, middle - span.begin) * kWorldUp;
  const PieceState at_a = a.at(middle), at_b = b.at(middle);
  // Set up the kernel at the poses of the middle, then widen it to the sweep.
  ctx.body[0].begin(a.rep(), at_a.pose, WrapperMode::regularised);
  ctx.body[1].begin(b.rep(), at_b.pose, WrapperMode::regularised);
  TreeKernel k = start_rigid_kernel(ctx, at_a.pose, at_b.pose, kBuffer);
  const Sweep sweep = sweep_of(a, at_a, b, at_b, half);
  // The bodies in doubles are off their exact places at the middle and at t.
  const double rounding = wrapper_margin(at_a.pose, a.rep().tree(), at_b.pose, b.rep().tree()) +
                          2 * rotation_defect(at_a.pose.r) * a.rep().tree().extent() +
                          4 * (a.rounding() + b.rounding()) + kWorldRounding * sweep.length;
  aim_at(sweep, rounding, query_unit(a.rep().tree(), b.rep().tree()), k);
  // A list that would be too long is useless: bound the traversal as well.
  if (most != kNoLimit) k.most_node_pairs = kPatience * most;
  pairs.clear();
  while (!is_done(k)) {
    // Empty the kernel's buffer; give up as soon as there are too many pairs or node pairs.
    k.out_size = 0;
    run_tree_kernel(k);
    for (std::uint32_t i = 0; i < k.out_size; ++i) pairs.push_back({k.out[i].a, k.out[i].b});
    if (!is_done(k) && (pairs.size() > most || k.node_pairs >= k.most_node_pairs)) return false;
  }
  return pairs.size() <= most;
}

}  // namespace lrb
