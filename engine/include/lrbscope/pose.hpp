#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <lrbscope/error.hpp>

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

// Makes poses of what others keep them in, and the reverse. Numbers are taken as they are, to the bit;
// whether they are finite is for the query to say.

/// Returns the pose that an Eigen::Isometry3d or Eigen::Affine3d is.
template <int Mode, int Options>
Pose pose_of(const Eigen::Transform<double, 3, Mode, Options>& transform) {
  static_assert(Mode != Eigen::Projective, "a pose has no perspective");
  return {transform.linear(), transform.translation()};
}

/// Returns the pose of a rotation and a translation.
inline Pose pose_of(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation) {
  return {rotation.toRotationMatrix(), translation};
}

/// Returns the pose of a 3 x 4 or 4 x 4 matrix that columns are multiplied by. Refuses other shapes, and a
/// last row other than 0 0 0 1.
Expected<Pose> pose_of(const Eigen::MatrixXd& matrix);

/// Does the same for the matrix's numbers row by row, as C arrays and numpy have them: 12 or 16.
Expected<Pose> pose_of_rows(std::span<const double> numbers);

/// Does the same for `count` matrices, one after another: (count, 3, 4) or (count, 4, 4) numbers. A refusal
/// names the pose.
Expected<std::vector<Pose>> poses_of_rows(std::span<const double> numbers, std::size_t count);

/// Returns the matrix (4 x 4) of a pose. (Inline, because how Eigen aligns it depends on the compiler's
/// flags.)
inline Eigen::Matrix4d matrix_of(const Pose& pose) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = pose.r;
  m.topRightCorner<3, 1>() = pose.t;
  return m;
}

/// Returns a pose as Eigen's type for maps of any kind.
inline Eigen::Affine3d transform_of(const Pose& pose) {
  return Eigen::Affine3d(matrix_of(pose));
}

}  // namespace lrb
