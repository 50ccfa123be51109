#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <lrbscope/error.hpp>

namespace lrb {

/// The placement of a body: a matrix, usually a rotation, and a translation from body to world coordinates
/// (mesh units). Any finite numbers are valid: scaled, sheared, mirrored and flattened bodies are queried as
/// transformed, in about the time of a rotated body.
///
/// World coordinates are *defined* by apply(): every operation is rounded to double separately, in the order
/// written, without fused multiply-add. The engine's answers are exact for the resulting doubles. apply() is
/// therefore the only function that transforms a vertex, in brute force and the oracle as well.
struct Pose {
  Eigen::Matrix3d r = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  /// Maps a point to the world: x' = ((r00*x + r01*y) + r02*z) + tx; y' and z' by rows 1 and 2.
  Eigen::Vector3d apply(const Eigen::Vector3d& p) const {
    return {((r(0, 0) * p.x() + r(0, 1) * p.y()) + r(0, 2) * p.z()) + t.x(),
            ((r(1, 0) * p.x() + r(1, 1) * p.y()) + r(1, 2) * p.z()) + t.y(),
            ((r(2, 0) * p.x() + r(2, 1) * p.y()) + r(2, 2) * p.z()) + t.z()};
  }

  /// Returns the translation by t.
  static Pose translation(const Eigen::Vector3d& t) { return {Eigen::Matrix3d::Identity(), t}; }
  /// Returns the rotation by `angle` (radians) about `axis`, followed by the translation by t. `axis` is
  /// normalised, whatever its length, and must not be zero.
  static Pose rotation(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& t = {0, 0, 0});
};

// Conversions between Pose and other representations. Numbers are copied bit for bit; queries check that they
// are finite.

/// Converts an Eigen::Isometry3d, Eigen::Affine3d or similar.
template <int Mode, int Options>
Pose pose_of(const Eigen::Transform<double, 3, Mode, Options>& transform) {
  static_assert(Mode != Eigen::Projective, "a pose has no perspective");
  return {transform.linear(), transform.translation()};
}

/// Returns the pose with a given rotation and translation.
inline Pose pose_of(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation) {
  return {rotation.toRotationMatrix(), translation};
}

/// Converts a 3 x 4 or 4 x 4 matrix that is applied to column vectors. Returns an error for other shapes, or
/// if the last row of a 4 x 4 matrix is not 0 0 0 1.
Expected<Pose> pose_of(const Eigen::MatrixXd& matrix);

/// Converts 12 or 16 numbers in row-major order (C arrays, numpy).
Expected<Pose> pose_of_rows(std::span<const double> numbers);

/// Converts `count` row-major matrices, shape (count, 3, 4) or (count, 4, 4). The error names the index of
/// the invalid pose.
Expected<std::vector<Pose>> poses_of_rows(std::span<const double> numbers, std::size_t count);

/// Returns the 4 x 4 matrix of a pose. (Inline, because Eigen's alignment depends on compiler flags.)
inline Eigen::Matrix4d matrix_of(const Pose& pose) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = pose.r;
  m.topRightCorner<3, 1>() = pose.t;
  return m;
}

/// Returns a pose as an affine transform of Eigen.
inline Eigen::Affine3d transform_of(const Pose& pose) {
  return Eigen::Affine3d(matrix_of(pose));
}

}  // namespace lrb
