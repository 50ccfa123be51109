#pragma once

#include <Eigen/Core>

namespace lrb {

/// Where a body stands: a matrix, most often a rotation, and a translation from body to world coordinates
/// (unit: the mesh's). Any finite numbers will do: scaled, sheared, mirrored and flattened bodies are queried
/// as they stand in the world, in about the time that a rotation takes.
///
/// World coordinates are *defined* by apply(): every operation is rounded to double on its own, in the order
/// written, without fused multiply-add. The engine's answers are exact for the resulting doubles, so apply()
/// is the only function that moves a vertex; brute force and the oracle use it too.
struct Pose {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  /// Moves a point to the world: x' = ((r00*x + r01*y) + r02*z) + tx, and likewise for y and z.
  Eigen::Vector3d apply(const Eigen::Vector3d& p) const {
    return {((r(0, 0) * p.x() + r(0, 1) * p.y()) + r(0, 2) * p.z()) + t.x(),
            ((r(1, 0) * p.x() + r(1, 1) * p.y()) + r(1, 2) * p.z()) + t.y(),
            ((r(2, 0) * p.x() + r(2, 1) * p.y()) + r(2, 2) * p.z()) + t.z()};
  }

  static Pose translation(const Eigen::Vector3d& t) { return {Eigen::Matrix3d::Identity(), t}; }
  /// Returns a rotation by `angle` (radians) about `axis` (any length but zero; it is normalised), followed
  /// by a translation by t.
  static Pose rotation(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& t = {0, 0, 0});
};

}  // namespace lrb
