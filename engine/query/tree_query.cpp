#include "engine/query/tree_query.hpp"

#include <cmath>

#include "engine/tolerances.hpp"

namespace lrb {
namespace {

/// Largest |r|-row-sum times extent, plus |t|: a bound of every world coordinate and of every term on the way
/// to it.
double world_size(const Pose& p, double extent) {
  return p.r.cwiseAbs().rowwise().sum().maxCoeff() * extent + p.t.cwiseAbs().maxCoeff();
}

/// How far r^T r is from the identity, largest row sum.
double defect(const Eigen::Matrix3d& r) {
  return (r.transpose() * r - Eigen::Matrix3d::Identity()).cwiseAbs().rowwise().sum().maxCoeff();
}

}  // namespace

/// The kernel compares boxes after the map w -> r_a^T (w - t_a), a linear functional of world coordinates w
/// on each axis (and on B's axes likewise with r_b), so what it proves apart there is apart in the world. It
/// computes with m = r_a^T r_b and t = r_a^T (t_b - t_a) and takes A's own points as they are. The
/// differences, all bounded by `slack`:
/// - world coordinates are rounded: at most 4 u times the sizes of their terms (u = 2^-53), turned by r_a^T;
/// - r_a^T r_a is the identity only to `defect`, so A's points and the offset are off by defect times their
/// sizes;
///   the same for B on B's axes;
/// - m, t and the offsets between nodes are rounded to double: another 16 u of the same sizes.
/// The factor kPoseSafety covers the change between the largest coordinate and the Euclidean length, and the
/// turning by matrices whose rows are a little longer than 1. The bound holds for any matrix; for one that is
/// not a rotation it is merely so large that little is culled.
TreeKernel set_up_kernel(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  TreeKernel k{};
  k.nodes_a = a.tree().nodes().data();
  k.nodes_b = b.tree().nodes().data();
  k.blocks_a = a.tree().blocks().data();
  k.blocks_b = b.tree().blocks().data();
  const double unit = std::max(a.tree().unit(), b.tree().unit());
  k.ratio_a = static_cast<float>(a.tree().unit() / unit);
  k.ratio_b = static_cast<float>(b.tree().unit() / unit);

  const Eigen::Matrix3d m = pose_a.r.transpose() * pose_b.r;
  const Eigen::Vector3d t = pose_a.r.transpose() * (pose_b.t - pose_a.t) / unit;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) k.m[i][j] = m(i, j);
    k.t[i] = t[i];
  }
  const double size = (world_size(pose_a, a.tree().extent()) + world_size(pose_b, b.tree().extent())) / unit;
  const double turn = std::max({1.0, pose_a.r.cwiseAbs().maxCoeff(), pose_b.r.cwiseAbs().maxCoeff()});
  const double offset = (pose_b.t - pose_a.t).cwiseAbs().maxCoeff() / unit;
  const double own = (a.tree().extent() + b.tree().extent()) / unit;
  const double slack =
      kPoseSafety * turn *
      (kWorldRounding * size + (defect(pose_a.r) + defect(pose_b.r)) * (own + turn * offset));
  k.slack = static_cast<float>(slack) * (1 + 0x1p-20f) + kKernelTiny;
  const double row_sum = m.cwiseAbs().rowwise().sum().maxCoeff();
  k.m_size = static_cast<float>(std::max(1.0, row_sum / std::sqrt(3.0))) * (1 + 0x1p-20f);
  return k;
}

}  // namespace lrb
