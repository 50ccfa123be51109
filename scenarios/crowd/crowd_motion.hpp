#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "scenarios/spec/crowd_spec.hpp"

namespace lrb::crowd {

/// Where every body of a crowd is at every step: straight on, thrown back by the walls of the room, in closed
/// form, so that steps can be asked for in any order. Or as a trace has it.
class CrowdMotion {
 public:
  /// `reps`: one a kind, of one dimension.
  CrowdMotion(const spec::Crowd& crowd, std::span<const LrbRep* const> reps);
  /// As it was recorded: `poses` by step and body; no other step can be asked for.
  CrowdMotion(const spec::Crowd& crowd, std::vector<std::vector<Pose>> poses);

  /// Bodies are numbered kind by kind.
  std::uint32_t body_count() const { return static_cast<std::uint32_t>(kinds_.size()); }
  std::uint32_t kind(std::uint32_t body) const { return kinds_[body]; }
  Pose pose(std::uint32_t body, std::uint32_t step) const;

 private:
  struct Mover {
    Eigen::Vector3d start, speed, axis;
    Eigen::Vector3d reach;  ///< how far from the room's middle its origin may go, so that it stays inside
    Eigen::Matrix3d turned;
    double spin;  ///< radians a step
    Pose own;     ///< of its kind, applied first
  };
  std::vector<std::uint32_t> kinds_;  ///< of bodies
  std::vector<Mover> movers_;         ///< of bodies; none where poses were recorded
  std::vector<std::vector<Pose>> recorded_;
};

}  // namespace lrb::crowd
