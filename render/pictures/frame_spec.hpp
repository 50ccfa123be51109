#pragma once
/// The appearance of pictures: their events, cameras, colours and sizes.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::pictures {

/// The appearance of pictures: their size, style, views and texts.
struct Look {
  enum class Camera : std::uint8_t { scene, contact, fixed, orbit };
  struct View {
    Camera camera = Camera::scene;
    bool orthographic = false;
    Eigen::Vector3d eye{0, 0, 0};             ///< fixed: position of the eye, world frame
    Eigen::Vector3d target{0, 0, 0};          ///< fixed: target point of the camera
    Eigen::Vector3d from{0.62, -0.68, 0.42};  ///< scene, contact, orbit: direction from target to viewer
    Eigen::Vector3d up{0, 0, 1};
    std::optional<Eigen::Vector3d>
        look_at;              ///< centre of the picture, which does not change the scale; nullopt: fitted
    double turn_degrees = 0;  ///< orbit: rotation over all frames
    double zoom = 1;          ///< above 1: closer
    bool wrapper = true;      ///< false: the bodies alone, without the lids of their wrappers
    std::string title;
    bool directed = false;  ///< the caller set a direction or projection, which 2D bodies do not accept
  };
  int width = 1280, height = 720;  ///< screen pixels, 1/96 inch each
  double dpi = 0;                  ///< pixels per inch in print; 0: as on a screen, not written to the file
  int supersampling = 2;
  std::vector<View> views;  ///< side by side; empty: one of the whole scene
  bool transparent = false;
  render::StyleName style = render::StyleName::screen;
  bool titles = true;  ///< above and below a picture: its title, the event, counters, and titles of views
  bool legend = true;  ///< colour key and scale

  static constexpr double kScreenDpi = 96;  ///< by definition of CSS
  /// Returns the number of pixels per screen pixel.
  double scale() const { return dpi > 0 ? dpi / kScreenDpi : 1; }
  View first_view() const { return views.empty() ? View{} : views[0]; }
  /// Returns the background; nullopt if pictures are transparent.
  std::optional<render::Rgba> paper() const {
    return transparent ? std::nullopt : std::optional(render::style_of(style).paper);
  }
  render::Rgba background() const { return paper().value_or(render::kTransparent); }
};

/// The events that become pictures, and their appearance.
struct FrameSpec : Look {
  enum class At : std::uint8_t {
    none,
    step,
    refinement,
    pass,   ///< of a construction: the body itself, and the end of each pass that created regions
    every,  ///< event
    events  ///< given as a list; not a keyword in files
  };
  /// The meaning of face colours. From face_tests on: counters of the time step so far
  /// (trace/include/lrbscope/trace/counters.hpp). Some need more events than face tests: needed_level().
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
  /// Source of the number that colours a face: the face, or the sum over its region or its region depth.
  enum class ColourPer : std::uint8_t { face, region, level };
  At at = At::step;
  std::uint32_t every = 1;            ///< steps, refinements or events between two frames
  std::vector<std::uint32_t> events;  ///< events: event numbers
  std::uint32_t most = 120;           ///< maximum number of frames; evenly chosen if there are more
  ColourBy colour_by = ColourBy::kind;
  ColourPer colour_per = ColourPer::face;
  std::array<std::vector<RegionId>, 2> isolate;  ///< regions of A and B to show alone; none: everything
  bool ghost_rest = true;  ///< draws the rest as a ghost if some regions are isolated; else leaves it out
  bool svg = false;        ///< writes each view of a frame as SVG as well (2D)
  std::optional<std::uint32_t> node_boxes;  ///< draws the boxes of visited tree nodes of this depth
  double explode = 0;                       ///< share of the layers whose lids are moved outward
  std::uint32_t montage = 0;                ///< number of evenly chosen panels in the montage; 0: no montage
  std::uint32_t montage_columns = 0;        ///< 0: nearly square
};
constexpr auto enum_names(FrameSpec::At) {
  using Word = FrameSpec::At;
  return std::to_array<EnumName<Word>>({{Word::none, "none"},
                                        {Word::step, "step"},
                                        {Word::refinement, "refinement"},
                                        {Word::pass, "pass"},
                                        {Word::every, "event"}});
}
constexpr auto enum_names(FrameSpec::Camera) {
  using Word = FrameSpec::Camera;
  return std::to_array<EnumName<Word>>(
      {{Word::scene, "scene"}, {Word::contact, "contact"}, {Word::fixed, "fixed"}, {Word::orbit, "orbit"}});
}
constexpr auto enum_names(FrameSpec::ColourBy) {
  using Word = FrameSpec::ColourBy;
  return std::to_array<EnumName<Word>>({{Word::kind, "kind"},
                                        {Word::layer, "layer"},
                                        {Word::region, "region"},
                                        {Word::face_tests, "face_tests"},
                                        {Word::refinements, "refinements"},
                                        {Word::hits, "hits"},
                                        {Word::misses, "misses"},
                                        {Word::expansions, "expansions"},
                                        {Word::box_tests, "box_tests"},
                                        {Word::plane_tests, "plane_tests"}});
}
constexpr auto enum_names(FrameSpec::ColourPer) {
  using Word = FrameSpec::ColourPer;
  return std::to_array<EnumName<Word>>(
      {{Word::face, "face"}, {Word::region, "region"}, {Word::level, "level"}});
}
/// Returns true if a colouring shows numbers, by a colour scale.
constexpr bool is_value(FrameSpec::ColourBy by) {
  using Word = FrameSpec::ColourBy;
  return by != Word::kind && by != Word::layer && by != Word::region;
}
/// Returns the event detail that a colouring requires.
constexpr EventLevel needed_level(FrameSpec::ColourBy by) {
  using Word = FrameSpec::ColourBy;
  if (by == Word::plane_tests) return EventLevel::all;
  return by == Word::expansions || by == Word::box_tests ? EventLevel::nodes : EventLevel::faces;
}

/// Returns the event detail that frames require.
constexpr EventLevel needed_level(const FrameSpec& frames) {
  const EventLevel colours = needed_level(frames.colour_by);
  return frames.node_boxes && colours == EventLevel::faces ? EventLevel::nodes : colours;
}

}  // namespace lrb::pictures
