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

/// Which moments become pictures, and how these look.
struct FrameSpec {
  enum class At : std::uint8_t {
    none,
    step,
    refinement,
    pass,   ///< of a construction: the body itself, and the end of each pass that made regions
    every,  ///< event
    events  ///< given as a list, so the file has no word for it
  };
  enum class Camera : std::uint8_t { scene, contact, fixed, orbit };
  /// What the colours of faces mean. From face_tests on: numbers of the time step so far
  /// (trace/counters.hpp); some need more events than face tests: needed_level().
  enum class ColourBy : std::uint8_t {
    kind,
    layer,
    region,
    face_tests,
    refinements,
    hits,
    misses,
    expansions,
    box_tests,
    plane_tests,
  };
  /// How pictures look as a whole (render/style.hpp).
  enum class Style : std::uint8_t { screen, print, dark };
  /// Whose numbers colour a face: its own, or the sum over the faces of its region or of its level.
  enum class ColourPer : std::uint8_t { face, region, level };
  struct View {
    Camera camera = Camera::scene;
    bool orthographic = false;
    Eigen::Vector3d eye{0, 0, 0};             ///< fixed: place of the eye, world frame
    Eigen::Vector3d target{0, 0, 0};          ///< fixed: what it looks at
    Eigen::Vector3d from{0.62, -0.68, 0.42};  ///< scene, contact, orbit: direction from the target to the
                                              ///< viewer
    Eigen::Vector3d up{0, 0, 1};
    std::optional<Eigen::Vector3d>
        look_at;              ///< in the middle of the picture, at the same scale; nothing: what is shown
    double turn_degrees = 0;  ///< orbit: over all frames
    double zoom = 1;          ///< above 1: closer
    bool wrapper = true;      ///< false: the bodies alone, without the lids of their wrappers
    std::string title;
    bool directed =
        false;  ///< a call says from where to look, or how depth is shown: not for bodies in the plane
  };
  At at = At::step;
  std::uint32_t every = 1;            ///< steps, refinements or events between two frames
  std::vector<std::uint32_t> events;  ///< events: event numbers
  std::uint32_t most = 120;  ///< largest number of frames; if there are more, evenly chosen ones are drawn
  int width = 1280, height = 720;  ///< pixels of a screen, 1/96 inch each
  double dpi = 0;  ///< pixels per inch of what is printed; 0: as on a screen, and not written into the file
  int supersampling = 2;
  ColourBy colour_by = ColourBy::kind;
  ColourPer colour_per = ColourPer::face;
  std::vector<View> views;  ///< side by side; none: one of the whole scene
  bool transparent = false;
  Style style = Style::screen;
  bool titles = true;  ///< above and below a picture: what it is, the event, counters, and titles of views
  bool legend = true;  ///< what colours mean
  std::array<std::vector<RegionId>, 2> isolate;  ///< regions of A and B to show alone; none: everything
  bool ghost_rest = true;  ///< what becomes of the rest where some are isolated: a ghost, or nothing
  bool svg = false;        ///< writes each view of a frame as SVG as well (2D)
  std::optional<std::uint32_t>
      node_boxes;                     ///< draws the boxes of tree nodes of this depth that the walk came to
  double explode = 0;                 ///< regions are moved outward by this share of their distance
  std::uint32_t montage = 0;          ///< number of panels of the montage, evenly chosen; 0: no montage
  std::uint32_t montage_columns = 0;  ///< 0: nearly square

  static constexpr double kScreenDpi = 96;  ///< of CSS, by definition
  /// Returns the number of pixels per pixel of a screen.
  double scale() const { return dpi > 0 ? dpi / kScreenDpi : 1; }
};
constexpr auto words_of(FrameSpec::At) {
  using At = FrameSpec::At;
  return std::to_array<EnumWord<At>>({{At::none, "none"},
                                      {At::step, "step"},
                                      {At::refinement, "refinement"},
                                      {At::pass, "pass"},
                                      {At::every, "event"}});
}
constexpr auto words_of(FrameSpec::Camera) {
  using Camera = FrameSpec::Camera;
  return std::to_array<EnumWord<Camera>>({{Camera::scene, "scene"},
                                          {Camera::contact, "contact"},
                                          {Camera::fixed, "fixed"},
                                          {Camera::orbit, "orbit"}});
}
constexpr auto words_of(FrameSpec::ColourBy) {
  using ColourBy = FrameSpec::ColourBy;
  return std::to_array<EnumWord<ColourBy>>({{ColourBy::kind, "kind"},
                                            {ColourBy::layer, "layer"},
                                            {ColourBy::region, "region"},
                                            {ColourBy::face_tests, "face_tests"},
                                            {ColourBy::refinements, "refinements"},
                                            {ColourBy::hits, "hits"},
                                            {ColourBy::misses, "misses"},
                                            {ColourBy::expansions, "expansions"},
                                            {ColourBy::box_tests, "box_tests"},
                                            {ColourBy::plane_tests, "plane_tests"}});
}
constexpr auto words_of(FrameSpec::ColourPer) {
  using ColourPer = FrameSpec::ColourPer;
  return std::to_array<EnumWord<ColourPer>>(
      {{ColourPer::face, "face"}, {ColourPer::region, "region"}, {ColourPer::level, "level"}});
}
constexpr auto words_of(FrameSpec::Style) {
  using Style = FrameSpec::Style;
  return std::to_array<EnumWord<Style>>(
      {{Style::screen, "screen"}, {Style::print, "print"}, {Style::dark, "dark"}});
}
/// Returns the events that colours need.
constexpr EventLevel needed_level(FrameSpec::ColourBy by) {
  using ColourBy = FrameSpec::ColourBy;
  if (by == ColourBy::plane_tests) return EventLevel::all;
  return by == ColourBy::expansions || by == ColourBy::box_tests ? EventLevel::nodes : EventLevel::faces;
}

/// Returns the events that frames need.
constexpr EventLevel needed_level(const FrameSpec& frames) {
  const EventLevel colours = needed_level(frames.colour_by);
  return frames.node_boxes && colours == EventLevel::faces ? EventLevel::nodes : colours;
}

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
