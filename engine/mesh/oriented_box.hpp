#pragma once
/// Boxes that are turned to fit: for needles and flat pieces, whose boxes along the axes are mostly empty.

#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lrb {

/// Positions moved and scaled so that all of them lie in the cube [-1, 1]^3.
///
/// The scales are powers of two. The first one is exact but for coordinates that are smaller than the largest
/// one by a factor of 2^1000 and lose less than 2^-1074. The difference from the middle is rounded once,
/// relative to itself, so that a scaled position is off by less than 2^-52 on each axis.
class UnitCube {
 public:
  explicit UnitCube(const Eigen::AlignedBox3d& box);
  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const;

 private:
  /// A power of two as two factors, so that neither overflows nor underflows.
  struct Scale {
    double half = 1, rest = 1;
    static Scale by(int exponent);
    Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return (x * half) * rest; }
  };

  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  Scale first_, last_;  ///< before the middle is subtracted, and after
};

/// A box along three axes of its own, in the unit cube.
struct OrientedBox {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< rows, of length 1 and perpendicular to rounding
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< in coordinates of the cube
  Eigen::Vector3d half = Eigen::Vector3d::Zero();      ///< half the sizes, with room for rounding

  /// Fits a box to points of the unit cube (at least one), along their principal axes.
  static OrientedBox about(std::span<const Eigen::Vector3d> points);
};

/// Returns true if what one box was fitted to has no point in common with what the other was fitted to: some
/// direction separates the boxes by more than rounding can account for. False proves nothing.
bool surely_apart(const OrientedBox& a, const OrientedBox& b);

}  // namespace lrb
