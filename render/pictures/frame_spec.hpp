#pragma once
/// The appearance of pictures: events that they show, cameras, colours, sizes.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_words.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::render {

/// The appearance of pictures: their size, style, views and texts.
struct Look {
  enum class Camera : std::uint8_t { scene, contact, fixed, orbit };
  struct View {
    Camera camera = Camera::scene;
    bool orthographic = false;
    Eigen::Vector3d eye{0, 0, 0};             ///< fixed: position of the eye, world frame
    Eigen::Vector3d target{0, 0, 0};          ///< fixed: point that it looks at
    Eigen::Vector3d from{0.62, -0.68, 0.42};  ///< scene, contact, orbit: direction from target to viewer
    Eigen::Vector3d up{0, 0, 1};
    std::optional<Eigen::Vector3d> look_at;  ///< centre of the picture, at the same scale; nullopt: fitted
    double turn_degrees = 0;                 ///< orbit: over all frames
    double zoom = 1;                         ///< above 1: closer
    bool wrapper = true;                     ///< false: the bodies alone, without the lids of their wrappers
    std::string title;
    bool directed = false;  ///< a call sets direction or projection: not for 2D bodies
  };
  int width = 1280, height = 720;  ///< pixels of a screen, 1/96 inch each
  double dpi = 0;  ///< pixels per inch of what is printed; 0: as on a screen, and not written into the file
  int supersampling = 2;
  std::vector<View> views;  ///< side by side; none: one of the whole scene
  bool transparent = false;
  StyleName style = StyleName::screen;
  bool titles = true;  ///< above and below a picture: its title, the event, counters, and titles of views
  bool legend = true;  ///< colour key and scale

  static constexpr double kScreenDpi = 96;  ///< of CSS, by definition
  /// Returns the number of pixels per pixel of a screen.
  double scale() const { return dpi > 0 ? dpi / kScreenDpi : 1; }
  View first_view() const { return views.empty() ? View{} : views[0]; }
  /// Returns the background; nullopt if pictures are transparent.
  std::optional<Rgba> paper() const {
    return transparent ? std::nullopt : std::optional(style_of(style).paper);
  }
  Rgba background() const { return paper().value_or(kTransparent); }
};

/// The events that become pictures, and their appearance.
struct FrameSpec : Look {
  enum class At : std::uint8_t {
    none,
    step,
    refinement,
    pass,   ///< of a construction: the body itself, and the end of each pass that made regions
    every,  ///< event
    events  ///< given as a list, so the file has no word for it
  };
  /// The meaning of the colours of faces. From face_tests on: numbers of the time step so far
  /// (trace/include/lrbscope/trace/counters.hpp); some need more events than face tests: needed_level().
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
  /// Whose numbers colour a face: its own, or the sum over the faces of its region or of its level.
  enum class ColourPer : std::uint8_t { face, region, level };
  At at = At::step;
  std::uint32_t every = 1;            ///< steps, refinements or events between two frames
  std::vector<std::uint32_t> events;  ///< events: event numbers
  std::uint32_t most = 120;  ///< largest number of frames; if there are more, evenly chosen ones are drawn
  ColourBy colour_by = ColourBy::kind;
  ColourPer colour_per = ColourPer::face;
  std::array<std::vector<RegionId>, 2> isolate;  ///< regions of A and B to show alone; none: everything
  bool ghost_rest = true;  ///< draws the rest as a ghost if some regions are isolated; else leaves it out
  bool svg = false;        ///< writes each view of a frame as SVG as well (2D)
  std::optional<std::uint32_t> node_boxes;  ///< draws the boxes of visited tree nodes of this depth
  double explode = 0;                       ///< regions are moved outward by this share of their distance
  std::uint32_t montage = 0;                ///< number of panels of the montage, evenly chosen; 0: no montage
  std::uint32_t montage_columns = 0;        ///< 0: nearly square
};
constexpr auto words_of(FrameSpec::At) {
  using Word = FrameSpec::At;
  return std::to_array<EnumWord<Word>>({{Word::none, "none"},
                                        {Word::step, "step"},
                                        {Word::refinement, "refinement"},
                                        {Word::pass, "pass"},
                                        {Word::every, "event"}});
}
constexpr auto words_of(FrameSpec::Camera) {
  using Word = FrameSpec::Camera;
  return std::to_array<EnumWord<Word>>(
      {{Word::scene, "scene"}, {Word::contact, "contact"}, {Word::fixed, "fixed"}, {Word::orbit, "orbit"}});
}
constexpr auto words_of(FrameSpec::ColourBy) {
  using Word = FrameSpec::ColourBy;
  return std::to_array<EnumWord<Word>>({{Word::kind, "kind"},
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
constexpr auto words_of(FrameSpec::ColourPer) {
  using Word = FrameSpec::ColourPer;
  return std::to_array<EnumWord<Word>>(
      {{Word::face, "face"}, {Word::region, "region"}, {Word::level, "level"}});
}
constexpr auto words_of(StyleName) {
  using Word = StyleName;
  return std::to_array<EnumWord<Word>>(
      {{Word::screen, "screen"}, {Word::print, "print"}, {Word::dark, "dark"}});
}
/// Returns the events that colours need.
constexpr EventLevel needed_level(FrameSpec::ColourBy by) {
  using Word = FrameSpec::ColourBy;
  if (by == Word::plane_tests) return EventLevel::all;
  return by == Word::expansions || by == Word::box_tests ? EventLevel::nodes : EventLevel::faces;
}

/// Returns the events that frames need.
constexpr EventLevel needed_level(const FrameSpec& frames) {
  const EventLevel colours = needed_level(frames.colour_by);
  return frames.node_boxes && colours == EventLevel::faces ? EventLevel::nodes : colours;
}

}  // namespace lrb::render
