#pragma once
/// A crowd: many bodies in a room, each of which moves straight and turns evenly. They pass through each
/// other; at every time step a query is asked for each pair whose boxes meet. schema/crowd.schema.json
/// describes the file format.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/spec/scenario.hpp"

namespace lrb::spec {

inline constexpr std::uint32_t kMostCrowdBodies = 10'000;
inline constexpr double kFar = 1e150;  ///< largest coordinate: its square is still finite

/// A number of bodies of one shape, which share one LRB-rep.
struct CrowdKind {
  std::string name;
  BodySpec body;
  std::uint32_t count = 1;
};

struct Crowd {
  enum class Arrangement : std::uint8_t {
    grid,    ///< each at a place of its own, in rows; who stands where is shuffled
    random,  ///< anywhere in the room
  };
  std::string name, purpose;
  std::uint64_t seed = 1;
  std::vector<CrowdKind> kinds;
  Eigen::Vector3d room{1, 1, 1};  ///< its sizes, with its middle at 0. In 2D x and y matter
  Arrangement arrangement = Arrangement::grid;
  std::array<double, 2> speed{0, 0};  ///< least and largest distance that a body moves in a step, unit: the
                                      ///< meshes'
  std::array<double, 2> spin{0, 0};   ///< least and largest angle in degrees that a body turns in a step
  std::uint32_t steps = 1;
  CollideRequest request;
  trace::Clock clock = trace::Clock::event;
  std::uint32_t max_events = 1'000'000;  ///< largest number of slices of queries in the trace; a query takes
                                         ///< two
  FrameSpec frames;
  std::uint64_t hash = 0;  ///< FNV-1a hash (64 bits) of the file's bytes

  std::uint32_t body_count() const;
};
constexpr auto words_of(Crowd::Arrangement) {
  return std::to_array<EnumWord<Crowd::Arrangement>>(
      {{Crowd::Arrangement::grid, "grid"}, {Crowd::Arrangement::random, "random"}});
}

/// Reads a crowd. `file` names it in messages, and its folder is where body files are looked up. Throws
/// InputError: "file:line:column: pointer: what is wrong, what is known".
Crowd parse_crowd(const std::string& text, const std::string& file);

/// Reads a shipped crowd by its name, or a crowd from a file. Throws InputError.
Crowd open_crowd(const std::string& name_or_path);
std::vector<std::string> shipped_crowds();

}  // namespace lrb::spec
