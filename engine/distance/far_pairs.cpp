/// The cache of separating planes along a motion: passed to the kernel at each step, and cleared when the
/// relative rotation accumulated since the planes were stored, which weakens them, becomes too large.

#include "engine/distance/far_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/LU>

#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/distance/distance_kernel.hpp"
#include "engine/tree/kernel_setup.hpp"

namespace lrb {
namespace {

/// Maximum number of cache slots. Smaller: pairs evict each other and are expanded again; larger: the cache
/// exceeds a processor's L2 cache.
constexpr std::size_t kMaxSlots = 4096;
/// Accumulated rotation of B at which all planes are cleared. Larger: the float sum has larger errors, and
/// planes separate less.
constexpr double kMaxTurned = 0.5;
constexpr FarNodes kNone = {~0U, ~0U, {0, 0, 0}, 0, 0};

/// Returns the Frobenius norm of the change of a map, rounded up.
double change(const double (&from)[3][4], const double (&to)[3][4]) {
  double square = 0;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) square += std::pow(to[column][row] - from[column][row], 2);
  constexpr double kUp = 1 + 0x1p-40;
  return std::sqrt(square) * kUp;
}

}  // namespace

void FarPairs::lend(DistanceKernel& k, std::size_t node_pairs) {
  // A power of two, because the slot is the masked hash.
  nodes_.resize(std::bit_ceil(std::clamp<std::size_t>(node_pairs, 1, kMaxSlots)), kNone);
  // The length of the path of the relative rotation bounds its change since any earlier step.
  turned_ += change(m_, k.tree.m);
  // Too much rotation, or NaN. The first step, which starts from a zero map, is such a case.
  if (!(turned_ <= kMaxTurned)) {
    std::fill(nodes_.begin(), nodes_.end(), kNone);
    turned_ = 0;
  }
  for (int column = 0; column < 3; ++column) std::copy_n(k.tree.m[column], 4, m_[column]);
  k.far = nodes_.data();
  k.far_slots = static_cast<std::uint32_t>(nodes_.size());
  // One rounded up, the other down: their difference is never less than the true one.
  k.turned = rounded_up(turned_);
  k.min_turned = rounded_down(turned_);
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

}  // namespace lrb
