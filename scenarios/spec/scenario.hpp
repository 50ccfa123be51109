#pragma once
/// A scenario: two bodies (or one), how they move, what is asked, recorded and drawn, and what must come out.
/// The file format is described by schema/scenario.schema.json.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/construct/build.hpp"
#include "engine/core/enum_words.hpp"
#include "engine/core/pose.hpp"
#include "engine/query/collide.hpp"
#include "scenarios/bodies/generators/generators.hpp"
#include "scenarios/run/frame_spec.hpp"
#include "trace/trace.hpp"

namespace lrb::spec {

/// The most steps that a scenario or a crowd may have.
inline constexpr std::uint32_t kMostSteps = 100'000;

/// What a scenario shows.
enum class Show : std::uint8_t {
  collision,     ///< two bodies: a query at every time step
  refinement,    ///< one body: its wrapper from the outermost one down to the body itself
  construction,  ///< one body: how the builder made its regions, pass by pass, from the body outward
};
constexpr auto words_of(Show) {
  return std::to_array<EnumWord<Show>>({{Show::collision, "collision"},
                                        {Show::refinement, "refinement"},
                                        {Show::construction, "construction"}});
}

struct BodySpec {
  std::string file;  ///< mesh or .lrb, looked up from the scenario's folder; empty: generated
  std::string generator;
  generators::GeneratorValues parameters;
  BuildOptions build;
  Pose pose;  ///< where it starts and, if it does not move, stays
};

/// How B moves while A stays. Each kind reads some of the fields.
struct Motion {
  enum class Kind : std::uint8_t { poses, keyframes, sweep, approach, spin };
  struct Keyframe {
    std::uint32_t step = 0;
    Eigen::Vector3d position{0, 0, 0};
    Eigen::Vector3d axis{0, 0, 1};
    double degrees = 0;
  };
  Kind kind = Kind::poses;
  std::vector<Pose> poses;          ///< poses: one for each step, applied to B as it is
  std::vector<Keyframe> keyframes;  ///< keyframes: positions move straight, rotations along the shortest arc
  Eigen::Vector3d from{0, 0, 0};  ///< sweep: position of B; approach: where B starts, relative to the target
  Eigen::Vector3d to{0, 0, 0};    ///< sweep
  Eigen::Vector3d target{0, 0, 0};  ///< approach: the point that B's origin heads for
  Eigen::Vector3d axis{0, 0, 1};    ///< sweep, approach, spin: B turns about it
  double degrees = 0;               ///< sweep, spin: over all steps; approach: per step
  std::uint32_t steps = 1;          ///< sweep, spin: number of steps; approach: largest number that is tried
  double step_length = 0.01;        ///< approach: as a share of the sum of the bodies' diagonals
  std::uint32_t before = 10;        ///< approach: steps shown before the first contact
  std::uint32_t into = 5;           ///< approach: steps shown after it
  bool exact =
      false;  ///< approach: a step is at the first contact itself, not at the first of equal steps that meets
};
constexpr auto words_of(Motion::Kind) {
  using Kind = Motion::Kind;
  return std::to_array<EnumWord<Kind>>({{Kind::poses, "poses"},
                                        {Kind::keyframes, "keyframes"},
                                        {Kind::sweep, "sweep"},
                                        {Kind::approach, "approach"},
                                        {Kind::spin, "spin"}});
}

using render::FrameSpec;

/// What else is asked at each step, and how steps follow each other.
struct StepQuestions {
  bool coherent = false;  ///< each step goes on from the one before: engine/query/coherent
  bool distance = false;  ///< how far apart the bodies are
  bool clash = false;     ///< what kind of contact they have, and how deep
};

struct Expectation {
  std::uint32_t step = 0;
  std::optional<Relation> relation;
  std::optional<std::uint64_t> pairs;
  std::optional<std::uint64_t> fingerprint;
  std::string place;  ///< file:line:column, for the message
};

struct Scenario {
  std::string name, purpose;
  std::uint64_t seed = 1;
  Show show = Show::collision;
  std::vector<BodySpec> bodies;  ///< A and B; A alone unless `show` is collision
  Motion motion;
  CollideRequest request;
  trace::Clock clock = trace::Clock::event;
  std::uint32_t event_cap = 1'000'000;
  EventLevel events = EventLevel::faces;  ///< that are recorded
  StepQuestions more;
  bool gzip = false;
  FrameSpec frames;
  std::vector<Expectation> expect;
  std::uint64_t hash = 0;  ///< FNV-1a hash (64 bits) of the file's bytes
};

/// Reads a scenario. `file` names it in messages, and its folder is where body files are looked up. Throws
/// InputError: "file:line:column: pointer: what is wrong, what is known".
Scenario parse_scenario(const std::string& text, const std::string& file);

}  // namespace lrb::spec
