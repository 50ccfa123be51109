// Sets up the dual traversal: one relative pose, and a bound on all errors that come with it.
// 1. Compute B's pose relative to A, and how far the matrices are from rotations.
// 2. Nearly rotations: the rigid kernel, with the bounds derived at kernel_of().
// 3. Anything else, or bodies so far apart that floats could overflow: the affine kernel (affine_pose.hpp).

#include "engine/tree/kernel_setup.hpp"

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "engine/core/tolerances.hpp"
#include "engine/tree/affine_pose.hpp"

namespace lrb {

InstructionSet best_instruction_set() {
#if defined(__x86_64__)
  const char* const wish = std::getenv("LRB_SIMD");
  const std::string_view most = wish != nullptr ? wish : "";
  // All features that the AVX-512 kernels are compiled with must be present.
  const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                          __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
                          __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2") &&
                          __builtin_cpu_supports("popcnt");
  if (most != "baseline" && most != "avx2" && has_avx512) return InstructionSet::avx512;
  if (most != "baseline" && __builtin_cpu_supports("avx2")) return InstructionSet::avx2;
#endif
  return InstructionSet::baseline;
}

double rotation_defect(const Eigen::Matrix3d& r) {
  // PropagateNaN, because a plain maximum may skip a NaN and report a small defect.
  return (r.transpose() * r - Eigen::Matrix3d::Identity())
      .cwiseAbs()
      .rowwise()
      .sum()
      .maxCoeff<Eigen::PropagateNaN>();
}

double world_size(const Pose& pose, const ObbTree& tree) {
  return pose.r.cwiseAbs().rowwise().sum().maxCoeff() * tree.extent() + pose.t.cwiseAbs().maxCoeff();
}

double wrapper_margin(const Pose& pose_a, const ObbTree& a, const Pose& pose_b, const ObbTree& b) {
  return kWrapperMargin * (world_size(pose_a, a) + world_size(pose_b, b) + kWorldUnderflow);
}

/// Scales by a power of two, which is exact, so that squares fit into doubles, and back; mostly by a product,
/// which is faster.
double stretch(const Pose& pose) {
  // Normalise so that the largest entry is in [0.5, 1).
  int exponent = 0;
  std::frexp(pose.r.cwiseAbs().maxCoeff(), &exponent);
  const Eigen::Matrix3d r = std::abs(exponent) <= 1000
                                ? Eigen::Matrix3d(pose.r * std::ldexp(1.0, -exponent))
                                : pose.r.unaryExpr([exponent](double x) { return std::ldexp(x, -exponent); });
  // The largest row sum of r^T r bounds its spectral norm, which is the square of r's.
  const double norm = std::sqrt((r.transpose() * r).cwiseAbs().rowwise().sum().maxCoeff());
  const double size = std::ldexp(norm * (1 + kWrapperMargin), exponent);
  // Results near underflow are rounded absolutely; the least normal double covers that.
  return exponent < -1000 ? size + kWorldUnderflow : size;
}

namespace {

/// B's rotation seen from A, and how far that and A's own are from rotations.
struct RelativeTurn {
  Eigen::Matrix3d m;
  double defect_a, defect_m;

  RelativeTurn(const Pose& a, const Pose& b)
      : m(a.r.transpose() * b.r), defect_a(rotation_defect(a.r)), defect_m(rotation_defect(m)) {}

  /// Returns false also if something is not a number.
  bool is_near_rotation() const { return defect_a <= kNearRotation && defect_m <= kNearRotation; }
};

/// Sets the kernel up. It compares boxes on A's axes and on B's. Let w_a = r_a x_a + t_a + rounding and w_b
/// likewise be the world coordinates of a point of each body. If they are equal, then, with m = r_a^T r_b, t
/// = r_a^T (t_b - t_a) and Euclidean norms,
/// - on A's axes, where the kernel takes x_a as it is and m x_b + t for x_b, these differ by at most
///     on_a = D(r_a) |x_a| + |r_a| |rounding|,   D(r) = |r^T r - 1|;
/// - on B's axes, where it takes x_b as it is and m^T (x_a - t) for x_a, by at most
///     on_b = D(m) |x_b| + |m| on_a, seen from any point of B (then x_b is a distance of two of its points).
/// |r|^2 <= 1 + D(r). World coordinates are rounded by at most 4 u times the sizes of their terms (u =
/// 2^-53), m, t and the offsets between nodes by another 16 u of the same sizes. The factor kPoseSafety
/// covers the change from the largest coordinate to the Euclidean length (sqrt 3), and from a distance to an
/// extent (2). The bounds hold for any matrix, but for one that is far from a rotation they are so large that
/// little is culled; affine_pose.hpp has other bounds for those. Overflow makes bounds infinite or not a
/// number: then nothing is culled.
TreeKernel kernel_of(const RelativeTurn& turn, const ObbTree& a, const Pose& pose_a, const ObbTree& b,
                     const Pose& pose_b) {
  TreeKernel k{};
  k.nodes_a = a.nodes().data();
  k.nodes_b = b.nodes().data();
  k.blocks_a = a.blocks().data();
  k.blocks_b = b.blocks().data();
  // Powers of two at most 1, so scaling to the query's unit is exact.
  const double unit = query_unit(a, b);
  k.ratio_a = static_cast<float>(a.unit() / unit);
  k.ratio_b = static_cast<float>(b.unit() / unit);

  // m twice: in double for the offsets of nodes, in float for the rotation of boxes.
  const Eigen::Matrix3d& m = turn.m;
  const Eigen::Vector3d t = pose_a.r.transpose() * (pose_b.t - pose_a.t) / unit;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      k.m[j][i] = m(i, j);
      k.m_rows[i][j] = static_cast<float>(m(i, j));
    }
    k.t[i] = t[i];
  }
  // The bounds of the derivation above: on_a for A's axes, on_b for B's. One slack covers both.
  const double size = (world_size(pose_a, a) + world_size(pose_b, b) + kWorldUnderflow) / unit;
  const double turn_a = std::sqrt(1 + turn.defect_a), turn_m = std::sqrt(1 + turn.defect_m);
  const double on_a = turn.defect_a * (a.extent() / unit) + turn_a * kWorldRounding * size;
  const double on_b = turn.defect_m * (b.extent() / unit) + turn_m * on_a;
  // Rounded up, because the conversion to float may round down.
  k.slack = static_cast<float>(kPoseSafety * (on_a + on_b)) * kFloatUp + kKernelTiny;
  k.m_size = static_cast<float>(turn_m) * kFloatUp;
  k.most_node_pairs = kNoLimit;
  return k;
}

/// Returns true if floats of the kernel cannot overflow.
bool is_near(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b) {
  return (pose_b.t - pose_a.t).cwiseAbs().maxCoeff() <= kNearEnough * query_unit(a, b);
}

}  // namespace

TreeKernel set_up_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b) {
  return kernel_of({pose_a, pose_b}, a, pose_a, b, pose_b);
}

TreeKernel set_up_any_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b,
                             int dim, AffineTerms& terms) {
  const RelativeTurn turn(pose_a, pose_b);
  return turn.is_near_rotation() && is_near(a, pose_a, b, pose_b)
             ? kernel_of(turn, a, pose_a, b, pose_b)
             : set_up_affine_kernel(a, pose_a, b, pose_b, dim, terms);
}

void start_at_roots(TreeKernel& k, const ObbTree& a, const ObbTree& b, std::vector<NodePair>& room) {
  // One allocation for both stacks, kept from query to query.
  const std::size_t each = stack_room(a.height(), b.height());
  if (room.size() < 2 * each) room.resize(2 * each);
  k.stack = room.data();
  k.tested = k.stack + each;
  start_at(k, {0, 0});
}

void allow_for_wrappers(TreeKernel& k) {
  // A larger slack leaves more pairs to the exact tests, and never drops one.
  k.slack *= kWrapperSlack;
  if (k.affine == nullptr) return;
  for (AffineTerms::Axes& axes : k.affine->axes) axes.slack *= kWrapperSlack;
  k.affine->world_slack *= kWrapperSlack;
}

}  // namespace lrb
