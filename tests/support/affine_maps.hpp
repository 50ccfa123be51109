#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/pose.hpp>

namespace lrb::test {

/// Kinds of linear maps that are no rotations, and one that is.
enum class MapKind {
  rotation,
  barely_scaled,
  scaled,
  stretched,
  sheared,
  mirrored,
  thin,
  rank2,
  rank1,
  rank0,
  last
};

inline constexpr int kMapKinds = static_cast<int>(MapKind::last);

/// A random map of a kind, turned at random; of a plane body where dim is 2. Its size is about 1 but for
/// `scaled`.
inline Eigen::Matrix3d random_map(shapes::RandomEngine& random, MapKind kind, int dim = 3) {
  using shapes::uniform;
  Eigen::Matrix3d turn = shapes::random_rotation(random, dim);
  const Eigen::Matrix3d again = shapes::random_rotation(random, dim);
  const auto diagonal = [&](double x, double y, double z) -> Eigen::Matrix3d {
    return turn * Eigen::Vector3d(x, y, dim == 2 ? 1 : z).asDiagonal() * again;
  };
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 1) = uniform(random, -2, 2);
  switch (kind) {
    case MapKind::rotation:
      return turn;
    case MapKind::barely_scaled:
      return turn * (1 + std::pow(10, uniform(random, -12, -1)));
    case MapKind::scaled:
      return turn * std::pow(10, uniform(random, -3, 3));
    case MapKind::stretched:
      return diagonal(uniform(random, 0.3, 3), uniform(random, 0.3, 3), uniform(random, 0.3, 3));
    case MapKind::sheared:
      return turn * shear * again;
    case MapKind::mirrored:
      return diagonal(-1, 1, 1);
    case MapKind::thin:
      return diagonal(1, std::pow(10, uniform(random, -16, -1)), std::pow(10, uniform(random, -16, 0)));
    case MapKind::rank2:
      return dim == 2 ? diagonal(1, 0, 1) : diagonal(1, uniform(random, 0.3, 1), 0);
    case MapKind::rank1:
      return diagonal(uniform(random, 0.3, 1), 0, 0);
    default:
      return Eigen::Vector3d(0, 0, dim == 2 ? 1 : 0).asDiagonal();
  }
}

}  // namespace lrb::test
