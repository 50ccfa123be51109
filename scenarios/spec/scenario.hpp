#pragma once
/// A scenario: two bodies (or one), their motion, the queries, the recording and the pictures, and the
/// expected results. schema/scenario.schema.json describes the file format.

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "render/pictures/frame_spec.hpp"
#include "scenarios/bodies/generators.hpp"
#include "scenarios/spec/motion.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/pose.hpp>
#include <lrbscope/trace/event.hpp>

namespace lrb::io {
class JsonNode;
}

namespace lrb::spec {

/// Content kind of a scenario.
enum class Show : std::uint8_t {
  collision,     ///< two bodies: a query at every time step
  refinement,    ///< one body: refinement of its wrapper from the outermost one down to the body itself
  construction,  ///< one body: construction of its regions by the builder, pass by pass, from the body
                 ///< outward
};
constexpr auto enum_names(Show) {
  return std::to_array<EnumName<Show>>({{Show::collision, "collision"},
                                        {Show::refinement, "refinement"},
                                        {Show::construction, "construction"}});
}

struct BodySpec {
  std::string file;  ///< mesh or .lrb, relative to the scenario's folder; empty: generated
  std::string generator;
  generators::GeneratorValues parameters;
  BuildOptions build;
  Pose pose;  ///< initial pose, and the constant one if it does not move
};

using pictures::FrameSpec;

/// Further queries at each step, and whether steps are coherent.
struct StepQuestions {
  bool coherent = false;              ///< each step continues from the previous one: engine/collide
  bool distance = false;              ///< query the distance of the bodies
  std::optional<ClashRequest> clash;  ///< query the kind and depth of their contact
  std::optional<double> near;         ///< list the pairs of faces at most this far apart
  std::optional<double> manifold;     ///< find the contact manifolds, with this margin
  std::string points;  ///< file of points that move with B, whose distances to A are computed; may be empty
};

struct Expectation {
  std::uint32_t step = 0;
  std::optional<Relation> relation;
  std::optional<std::uint64_t> pairs;
  std::optional<std::uint64_t> fingerprint;
  std::optional<std::uint64_t> max_tests;  ///< of boxes and faces, at this step
  std::string place;                       ///< file:line:column, for the message
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
  /// A refinement: only regions between the outside and the face nearest to a point, for one point after the
  /// other, each from the outermost wrapper. Empty: all regions.
  std::vector<Eigen::Vector3d> towards;
  bool gzip = false, keeps_trace = true;
  FrameSpec frames;
  std::vector<Expectation> expect;
  std::uint64_t hash = 0;  ///< FNV-1a hash (64 bits) of the file's bytes
};

/// Reads a scenario. `file` names it in messages; body files are relative to its folder. Throws InputError:
/// "file:line:column: pointer: fault, valid values".
Scenario parse_scenario(const std::string& text, const std::string& file);

/// The largest integer that every JSON reader supports.
inline constexpr std::uint64_t kAnySeed = std::numeric_limits<std::int64_t>::max();

/// Reads a body of a scenario or an experiment. Files are relative to `folder`; `seed` is the default seed.
BodySpec read_body(const io::JsonNode& node, const std::filesystem::path& folder, std::uint64_t seed);

/// Reads the "query" part of a scenario, with the further queries of steps if `more` is not null. Rejects
/// combinations that the engine does not support.
CollideRequest read_query(const io::JsonNode& node, StepQuestions* more = nullptr);

/// Reads a name that is valid for a folder.
std::string read_name(const io::JsonNode& node);

inline constexpr double kMinDpi = 24, kMaxDpi = 2400;
/// Maximum depth of tree nodes whose boxes can be requested.
inline constexpr std::uint32_t kMaxDepth = 64;

/// Returns the default frames of a run.
FrameSpec default_frames(Show show);

/// Reads the "frames" part of a scenario; missing settings are taken from `fallback`.
FrameSpec read_frames(const io::JsonNode& node, const FrameSpec& fallback);

/// Convert between the drawing options of a run that traces store, as a part of a scenario's "frames", and
/// their text: sizes, style, views and columns, but not the selection of frames. `name` names the trace in
/// messages; empty text gives `fallback`. Reading throws InputError.
std::string pictures_text(const FrameSpec& frames);
FrameSpec read_pictures(const std::string& text, const std::string& name, const FrameSpec& fallback = {});

// Shipped files, and those that users give by their paths.

/// Returns the names NAME of the shipped files "NAME<ending>", in alphabetical order.
std::vector<std::string> shipped_names(std::string_view ending);

/// Returns the "purpose" that the shipped file "NAME<ending>" states.
std::string shipped_purpose(const std::string& name, std::string_view ending);

struct NamedText {
  std::string text, file;  ///< `file` is for messages
};

/// Returns the text of a shipped file "NAME<ending>", or of a file by its path. `what` is the kind of file,
/// for messages. Throws InputError; for a word that is neither, it suggests the closest shipped name.
NamedText open_named(const std::string& name_or_path, std::string_view ending, std::string_view what);

inline constexpr std::string_view kScenarioEnding = ".scenario.json", kCrowdEnding = ".crowd.json",
                                  kExperimentEnding = ".experiment.json";

/// Reads a shipped scenario by name, or a scenario from a file. Throws InputError.
Scenario open_scenario(const std::string& name_or_path);

}  // namespace lrb::spec
