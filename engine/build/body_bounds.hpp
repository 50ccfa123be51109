#pragma once
/// How far hulls may swell.

#include <array>
#include <span>

#include <Eigen/Core>

#include "engine/build/placement.hpp"

namespace lrb {

/// The polytope about a body whose 26 faces look along the axes and their diagonals, moved outward by a twentieth
/// of the body's width in each direction (so that it is 10 % wider).
class BodyBounds {
 public:
  explicit BodyBounds(std::span<const Eigen::Vector3d> points);
  const std::array<HalfSpace, 26>& half_spaces() const { return half_spaces_; }
  bool contains(const Eigen::Vector3d& p) const {
    for (const HalfSpace& h : half_spaces_)
      if (h.n.dot(p) < h.d) return false;
    return true;
  }

 private:
  std::array<HalfSpace, 26> half_spaces_;
};

}  // namespace lrb
