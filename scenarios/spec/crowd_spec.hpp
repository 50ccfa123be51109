#pragma once
/// A crowd: many bodies with given poses, or in a box with constant linear and angular velocities. They pass
/// through each other; at every time step each pair with overlapping boxes is queried.
/// schema/crowd.schema.json describes the file format.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

inline constexpr std::uint32_t kMaxCrowdBodies = 10'000;
inline constexpr std::size_t kMaxCrowdPoses = 10'000'000;  ///< bodies times steps: 1 GB of poses
inline constexpr double kFar = 1e150;                      ///< maximum coordinate: its square is still finite

/// Bodies of one shape, which share one LRB-rep.
struct CrowdKind {
  std::string name;
  BodySpec body;
  std::uint32_t count = 1;
};

struct Crowd {
  enum class Arrangement : std::uint8_t {
    grid,    ///< each at a separate grid position, assigned at random
    random,  ///< random positions in the box
  };
  std::string name, purpose;
  std::uint64_t seed = 1;
  std::vector<CrowdKind> kinds;
  /// Side lengths of the box, centred at 0. In 2D only x and y are used. 0: no box, for given poses only.
  Eigen::Vector3d room{0, 0, 0};
  Arrangement arrangement = Arrangement::grid;
  /// Minimum and maximum distance that a body moves in a step; mesh units.
  std::array<double, 2> speed{0, 0};
  std::array<double, 2> spin{0, 0};  ///< minimum and maximum angle in degrees that a body rotates in a step
  std::uint32_t steps = 1;
  /// By step and body, applied after a body's own pose; empty: the bodies have constant velocities.
  std::vector<std::vector<Pose>> poses;
  CollideRequest request;
  StepQuestions more;              ///< distance, clash and near, of each pair that is queried
  std::vector<std::string> notes;  ///< keys of 1.x without effect; to be printed
  std::uint64_t hash = 0;          ///< FNV-1a hash (64 bits) of the file's bytes, and of given poses

  std::uint32_t body_count() const;
};
constexpr auto enum_names(Crowd::Arrangement) {
  return std::to_array<EnumName<Crowd::Arrangement>>(
      {{Crowd::Arrangement::grid, "grid"}, {Crowd::Arrangement::random, "random"}});
}

/// Reads a crowd. `file` names it in messages; files of bodies and poses are relative to its folder. Throws
/// InputError:
/// "file:line:column: pointer: fault, valid values".
Crowd parse_crowd(const std::string& text, const std::string& file);

/// Reads a shipped crowd by name, or a crowd from a file. Throws InputError.
Crowd open_crowd(const std::string& name_or_path);

}  // namespace lrb::spec
