#pragma once

#include <random>

#include <Eigen/Geometry>

#include "engine/core/pose.hpp"
#include "engine/core/steady_math.hpp"
#include "engine/lrb/lrb_rep.hpp"

namespace lrb::shapes {

using RandomEngine = std::mt19937_64;

/// Draws uniformly from [0, 1), by our own means: the standard library's distributions differ between
/// implementations.
inline double uniform(RandomEngine& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}
inline double uniform(RandomEngine& random, double low, double high) {
  return low + (high - low) * uniform(random);
}

inline Eigen::Vector3d random_direction(RandomEngine& random) {
  while (true) {
    // Braces are evaluated in order, so that every compiler draws the same numbers.
    const Eigen::Vector3d d{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    if (d.norm() > 0.1 && d.norm() <= 1) return d.normalized();
  }
}

inline Eigen::Matrix3d random_rotation(RandomEngine& random, int dim = 3) {
  const double angle = uniform(random, 0, 6.283185307179586);
  return steady::rotation(dim == 2 ? Eigen::Vector3d::UnitZ() : random_direction(random), angle);
}

inline Eigen::AlignedBox3d box_of(const LrbRep& rep) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(rep.vertices()[v]);
  return box;
}

/// Draws a random rotation, and a translation that leaves the centres of the bodies' boxes about `share`
/// times the sum of their radii apart: 1 just misses round bodies, 0 puts one into the other.
inline Pose random_pose(RandomEngine& random, const LrbRep& a, const LrbRep& b, double share) {
  const Eigen::AlignedBox3d box_a = box_of(a), box_b = box_of(b);
  Pose p;
  p.r = random_rotation(random, a.dim());
  Eigen::Vector3d d = random_direction(random);
  if (a.dim() == 2) d = Eigen::Vector3d(d.x(), d.y(), 0).normalized();
  p.t = box_a.center() - p.r * box_b.center() +
        share * (box_a.diagonal().norm() + box_b.diagonal().norm()) / 2 * d;
  if (a.dim() == 2) p.t.z() = 0;
  return p;
}

}  // namespace lrb::shapes
