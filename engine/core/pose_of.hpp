#pragma once
/// Makes poses of what others keep them in, and the reverse. Numbers are taken as they are, to the bit;
/// whether they are finite is for the query to say.

#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/core/expected.hpp"
#include "engine/core/pose.hpp"

namespace lrb {

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
