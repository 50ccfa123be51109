#pragma once
/// The motion of a scenario's bodies: read from its file, and as poses, one for each step.

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/measured.hpp>

namespace lrb::io {
class JsonNode;
}

namespace lrb::spec {

/// Maximum number of steps of a scenario or a crowd.
inline constexpr std::uint32_t kMaxSteps = 100'000;

/// Motion of B while A is at rest. Each kind uses some of the fields.
struct Motion {
  enum class Kind : std::uint8_t { poses, keyframes, sweep, approach, spin };
  struct Keyframe {
    std::uint32_t step = 0;
    Eigen::Vector3d position{0, 0, 0};
    Eigen::Vector3d axis{0, 0, 1};
    double degrees = 0;
  };
  Kind kind = Kind::poses;
  std::vector<Pose> poses;  ///< poses: one for each step, applied to B unchanged
  std::vector<Pose> of_a;   ///< poses: one for each step, applied to A unchanged; empty: A does not move
  /// Keyframes: positions interpolated linearly, rotations along the shortest arc.
  std::vector<Keyframe> keyframes;
  /// Sweep: position of B; approach: initial position of B, relative to the target.
  Eigen::Vector3d from{0, 0, 0};
  Eigen::Vector3d to{0, 0, 0};      ///< sweep
  Eigen::Vector3d target{0, 0, 0};  ///< approach: the point that B's origin moves towards
  Eigen::Vector3d axis{0, 0, 1};    ///< sweep, approach, spin: rotation axis of B
  double degrees = 0;               ///< sweep, spin: over all steps; approach: per step
  std::uint32_t steps = 1;          ///< sweep, spin: number of steps; approach: maximum number tried
  double step_length = 0.01;        ///< approach: as a share of the sum of the bodies' diagonals
  std::uint32_t before = 10;        ///< approach: steps shown before the first contact
  std::uint32_t into = 5;           ///< approach: steps shown after it
  bool exact = false;  ///< approach: a step is at the first contact itself, not at the first colliding one of
                       ///< equal steps
};
constexpr auto enum_names(Motion::Kind) {
  using Kind = Motion::Kind;
  return std::to_array<EnumName<Kind>>({{Kind::poses, "poses"},
                                        {Kind::keyframes, "keyframes"},
                                        {Kind::sweep, "sweep"},
                                        {Kind::approach, "approach"},
                                        {Kind::spin, "spin"}});
}

/// Returns the pose that applies `first`, then `second`.
Pose then(const Pose& first, const Pose& second);

/// Reads a pose: 12 numbers (3x4, row by row), or {position, axis, degrees}.
Pose read_pose(const io::JsonNode& node);
Motion read_motion(const io::JsonNode& node);

/// Returns the poses of B, one for each step, for every kind of motion except approach. `start` is
/// the body's own pose, applied first.
std::vector<Pose> poses_of(const Motion& motion, const Pose& start);

/// A straight motion of B towards a point, cut to the steps around the first contact.
struct Approach {
  std::vector<Pose> poses;         ///< of B, one for each step
  std::size_t first_contact = 0;   ///< index of the first of `poses` in contact
  trace::MeasuredApproach search;  ///< proven time of first contact, in steps of `poses`
  bool met = false;                ///< false: B passed without contact, and `poses` sample the whole motion
};

/// Moves B until the first contact (of the surfaces, or one body inside the other), and then for another
/// motion.into steps. B does not pass through A between two steps: the first contact is searched for in the
/// whole motion (first_contact()). With motion.exact, or if contact occurs only between two steps, a step is
/// at the contact itself. `watched`: records the convergence of the search.
Approach find_approach(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& start,
                       const spec::Motion& motion, bool watched = false);

/// Returns the time of first contact in a run's steps as text: "step 11.36". Empty if the surfaces do not
/// intersect.
std::string contact_step(const trace::MeasuredApproach& search);
/// Returns the distance that B has moved by then: "after B has moved 0.25 from step 0".
std::string contact_way(const trace::MeasuredApproach& search);

}  // namespace lrb::spec
