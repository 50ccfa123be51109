// Oriented boxes along the principal axes of points, and the separating axis test of two of them (Gottschalk,
// Lin and Manocha 1996, "OBBTree"), with room for rounding so that "apart" is proven.
#include "engine/mesh/oriented_box.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "engine/core/eigenvectors.hpp"
#include "engine/core/infinity.hpp"

namespace lrb {
namespace {

/// Room for rounding, in the unit cube. Scaled positions are off by 2^-52; axes that the eigenvalue solver
/// found are perpendicular to within a few units in the last place; a sum of three products of numbers below
/// 2 is off by less than 2^-49. Together that is below 2^-46: a position is within kRoom of its box, and each
/// value that surely_apart() computes is within kRoom of the exact one. For nearly parallel axes a cross
/// product has hardly any length, and then nothing exceeds the room.
constexpr double kRoom = 0x1p-40;

int exponent_of(double x) {
  int exponent = 0;
  std::frexp(x, &exponent);
  return x > 0 ? exponent : 0;
}

Eigen::Matrix3d principal_axes(std::span<const Eigen::Vector3d> points) {
  // Covariance about the mean; weights before summation keep all terms within the unit cube.
  const double weight = 1.0 / static_cast<double>(points.size());
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) mean += weight * p;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& p : points) covariance += weight * (p - mean) * (p - mean).transpose();
  const Eigen::Matrix3d axes = eigenvectors_of_symmetric(covariance).transpose();
  // The axes must be orthonormal to rounding. If the solver failed, fall back to the coordinate axes.
  const double defect = (axes * axes.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  return defect < 0x1p-48 ? axes : Eigen::Matrix3d::Identity();  // not a number: false
}

}  // namespace

UnitCube::Scale UnitCube::Scale::by(int exponent) {
  return {std::ldexp(1.0, exponent / 2), std::ldexp(1.0, exponent - exponent / 2)};
}

UnitCube::UnitCube(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return;
  // Scale all coordinates below 1, so that the differences below cannot overflow.
  const double largest = box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  first_ = Scale::by(-exponent_of(largest));
  const Eigen::Vector3d low = first_(box.min()), high = first_(box.max());
  // Then centre them and scale again, so that the box fills the cube.
  middle_ = 0.5 * (low + high);
  last_ = Scale::by(-exponent_of((high - middle_).cwiseMax(middle_ - low).maxCoeff()));
}

Eigen::Vector3d UnitCube::operator()(const Eigen::Vector3d& x) const {
  return last_(first_(x) - middle_);
}

OrientedBox OrientedBox::about(std::span<const Eigen::Vector3d> points) {
  OrientedBox box;
  box.axes = principal_axes(points);
  // Interval of the projections on each axis.
  Eigen::Vector3d low = Eigen::Vector3d::Constant(kInfinity), high = -low;
  for (const Eigen::Vector3d& p : points) {
    const Eigen::Vector3d along = box.axes * p;
    low = low.cwiseMin(along);
    high = high.cwiseMax(along);
  }
  box.centre = box.axes.transpose() * (0.5 * (low + high));
  box.half = (0.5 * (high - low)).array() + kRoom;
  return box;
}

bool surely_apart(const OrientedBox& a, const OrientedBox& b) {
  // Rotation from b to a, its absolute values, and the offset of the centres in both frames.
  const Eigen::Vector3d between = b.centre - a.centre;
  const Eigen::Matrix3d turn = a.axes * b.axes.transpose(), size = turn.cwiseAbs();
  const Eigen::Vector3d seen_by_a = a.axes * between, seen_by_b = b.axes * between;
  // Face normals of a and of b: 6 axes.
  for (int i = 0; i < 3; ++i) {
    if (std::abs(seen_by_a[i]) > a.half[i] + size.row(i).dot(b.half) + kRoom) return true;
    if (std::abs(seen_by_b[i]) > b.half[i] + size.col(i).dot(a.half) + kRoom) return true;
  }
  // Cross products of an axis of a with one of b: 9 axes. They are not normalised, which only makes the test
  // more cautious.
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    for (int m = 0; m < 3; ++m) {  // the direction a.axes[i] x b.axes[m], in coordinates of a
      const int n = (m + 1) % 3, o = (m + 2) % 3;
      const double distance = std::abs(seen_by_a[k] * turn(j, m) - seen_by_a[j] * turn(k, m));
      const double reach =
          a.half[j] * size(k, m) + a.half[k] * size(j, m) + b.half[n] * size(i, o) + b.half[o] * size(i, n);
      if (distance > reach + kRoom) return true;
    }
  }
  return false;
}

}  // namespace lrb
