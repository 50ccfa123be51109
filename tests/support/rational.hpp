#pragma once
/// Simplices of bodies for the oracles in rational arithmetic.

#include "bench/stability/rational_oracles.hpp"
#include "tests/support/simplex_distance.hpp"

namespace lrb::test {

inline oracle::Corners corners_of(const Points& points) {
  oracle::Corners out;
  for (const Eigen::Vector3d& x : points) out.push_back({x.x(), x.y(), x.z()});
  return out;
}

inline oracle::Corners corners_of(const LrbRep& rep, const Pose& pose, SimplexId s) {
  return corners_of(simplex_points(rep, pose, s));
}

inline oracle::Corners corners_of(const Eigen::Vector3d& point) {
  return {{point.x(), point.y(), point.z()}};
}

/// Returns the real simplices of a body in the world.
inline std::vector<Points> real_simplices(const LrbRep& rep, const Pose& pose) {
  std::vector<Points> out;
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) out.push_back(simplex_points(rep, pose, s));
  return out;
}

}  // namespace lrb::test
