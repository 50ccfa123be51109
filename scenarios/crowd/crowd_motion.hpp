#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scenarios/spec/crowd_spec.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb::crowd {

/// Knows where every body of a crowd is at every step. Bodies move straight and are thrown back by the walls
/// of the room; this has a closed form, so that steps can be asked for in any order. Or it gives the poses
/// that a trace holds.
class CrowdMotion {
 public:
  /// `reps`: one for each kind, all of one dimension.
  CrowdMotion(const spec::Crowd& crowd, std::span<const LrbRep* const> reps);
  /// Gives recorded poses: `poses` by step and body; no other step can be asked for.
  CrowdMotion(const spec::Crowd& crowd, std::vector<std::vector<Pose>> poses);

  /// Bodies are numbered kind by kind.
  std::uint32_t body_count() const { return static_cast<std::uint32_t>(kinds_.size()); }
  std::uint32_t kind(std::uint32_t body) const { return kinds_[body]; }
  Pose pose(std::uint32_t body, std::uint32_t step) const;

 private:
  struct Mover {
    Eigen::Vector3d start, speed, axis;
    Eigen::Vector3d reach;  ///< largest distance of its origin from the room's middle on each axis, so that
                            ///< it stays inside
    Eigen::Matrix3d turned;
    double spin;  ///< radians for each step
    Pose own;     ///< of its kind, applied first
  };
  std::vector<std::uint32_t> kinds_;  ///< the kind of each body
  std::vector<Mover> movers_;         ///< of each body; empty where poses were recorded
  std::vector<std::vector<Pose>> recorded_;
};

}  // namespace lrb::crowd
