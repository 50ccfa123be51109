#include "engine/core/geometry.hpp"

#include <string>

#include <Eigen/Eigenvalues>

#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/core/random.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

Eigen::Matrix3d eigenvectors_of_symmetric(const Eigen::Matrix3d& m) {
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvectors();
}

Pose Pose::rotation(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& t) {
  const FloatMode float_mode;
  return {deterministic::rotation(deterministic::scaled_direction(axis).normalized(), angle), t};
}

namespace {

constexpr std::size_t kOf3x4 = 12, kOf4x4 = 16;
constexpr std::size_t kRow = 4;  // numbers in a row

/// Returns the rest of the error message for a matrix in row-major order, or an empty string if it is valid.
std::string fault_of(std::span<const double> n) {
  if (n.size() != kOf3x4 && n.size() != kOf4x4)
    return ": expected 12 numbers (3 x 4) or 16 (4 x 4), row by row, found " + std::to_string(n.size());
  // An affine map has the last row 0 0 0 1. The comparison also rejects NaN.
  if (n.size() == kOf4x4 && !(n[12] == 0 && n[13] == 0 && n[14] == 0 && n[15] == 1))
    return ": expected an affine matrix for column vectors, with the last row 0 0 0 1, found another last row";
  return {};
}

Pose pose_of_checked(std::span<const double> n) {
  Pose pose;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const std::size_t row = kRow * static_cast<std::size_t>(i);
    for (Eigen::Index j = 0; j < 3; ++j) pose.r(i, j) = n[row + static_cast<std::size_t>(j)];
    pose.t[i] = n[row + 3];
  }
  return pose;
}

}  // namespace

Expected<Pose> pose_of_rows(std::span<const double> numbers) {
  if (const std::string fault = fault_of(numbers); !fault.empty()) return Error{"pose" + fault};
  return pose_of_checked(numbers);
}

Expected<Pose> pose_of(const Eigen::MatrixXd& matrix) {
  if (matrix.cols() != 4 || (matrix.rows() != 3 && matrix.rows() != 4))
    return Error{"pose: expected a matrix of 3 x 4 or 4 x 4, found " + std::to_string(matrix.rows()) + " x " +
                 std::to_string(matrix.cols())};
  // Eigen stores columns; the common path expects rows.
  const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = matrix;
  return pose_of_rows({rows.data(), static_cast<std::size_t>(rows.size())});
}

Expected<std::vector<Pose>> poses_of_rows(std::span<const double> numbers, std::size_t count) {
  std::vector<Pose> poses;
  if (count == 0 && numbers.empty()) return poses;
  // All poses have the same shape, so the number of values decides between 3 x 4 and 4 x 4.
  const std::size_t each = count == 0 ? 0 : numbers.size() / count;
  if (count == 0 || numbers.size() % count != 0 || (each != kOf3x4 && each != kOf4x4))
    return Error{std::to_string(count) +
                 " poses: expected 12 numbers (3 x 4) or 16 (4 x 4) for each, row by row, found " +
                 std::to_string(numbers.size()) + " in all"};
  poses.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::span<const double> n = numbers.subspan(i * each, each);
    if (const std::string fault = fault_of(n); !fault.empty())
      return Error{"pose " + std::to_string(i) + fault};
    poses.push_back(pose_of_checked(n));
  }
  return poses;
}

}  // namespace lrb
