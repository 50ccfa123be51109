#pragma once
/// A scenario: two bodies (or one), how they move, what is asked, recorded and drawn, and what must come out.
/// The file format is described by schema/scenario.schema.json.

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "render/pictures/frame_spec.hpp"
#include "scenarios/bodies/generators.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/enum_words.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/trace.hpp>

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
  bool coherent = false;  ///< each step goes on from the one before: engine/collide
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

/// The largest integer that every reader of JSON can hold.
inline constexpr std::uint64_t kAnySeed = std::numeric_limits<std::int64_t>::max();

/// Reads a body of a scenario or an experiment. Files are looked up in `folder`; `seed` is for what does not
/// name one.
BodySpec read_body(const io::JsonNode& node, const std::filesystem::path& folder, std::uint64_t seed);

/// Reads the "query" part of a scenario, with what else is asked of steps where there is a place for it.
/// Refuses what the engine cannot give together.
CollideRequest read_query(const io::JsonNode& node, StepQuestions* more = nullptr);

/// Reads a name that a folder can have.
std::string read_name(const io::JsonNode& node);

inline constexpr double kLeastDpi = 24, kMostDpi = 2400;
/// The greatest depth of tree nodes whose boxes can be asked for.
inline constexpr std::uint32_t kMostDepth = 64;

/// Returns what a run's frames are if nothing is said.
FrameSpec default_frames(Show show);

/// Reads the "frames" part of a scenario; what it leaves out is as in `fallback`.
FrameSpec read_frames(const io::JsonNode& node, const FrameSpec& fallback);

/// Return what traces keep of how a run is drawn, as a part of a scenario's "frames", and read it: sizes,
/// style, views and columns, but not which moments. `name` names the trace in messages; empty text gives
/// `fallback`. Reading throws InputError.
std::string pictures_text(const FrameSpec& frames);
FrameSpec read_pictures(const std::string& text, const std::string& name, const FrameSpec& fallback = {});

// Reads poses and motions of a scenario, and computes the poses of those motions that need no query.

/// Reads a pose: 12 numbers (3x4, row by row), or {position, axis, degrees}.
Pose read_pose(const io::JsonNode& node);
Motion read_motion(const io::JsonNode& node);

/// Returns the poses of B, one for each step, for every kind of motion but approach (approach.hpp). `start`
/// is the body's own pose, applied first.
std::vector<Pose> poses_of(const Motion& motion, const Pose& start);

/// Returns the pose that applies `first`, then `second`.
Pose then(const Pose& first, const Pose& second);

}  // namespace lrb::spec
