#include "scenarios/paper/heat_map.hpp"

#include <algorithm>

#include "render/montage.hpp"
#include "render/overlay.hpp"
#include "render/rasterize.hpp"
#include "render/scene.hpp"
#include "scenarios/play/moments.hpp"
#include "trace/counters.hpp"
#include "trace/cursor.hpp"

namespace lrb {
namespace {

constexpr int kPanelWidth = 560, kPanelHeight = 500;
constexpr double kAside = 0.45;  ///< how far from the other body's place one looks, over the distance
constexpr float kThin = 0.6F;    ///< lines: bodies of tens of thousands of faces are small here

/// What one panel shows.
struct Sitter {
  Side side;
  const CloseUp* collision;
  const char* which;  ///< easiest or hardest
  bool near;          ///< where the tests are, else the whole body
};

std::vector<double> tests_of(const PaperPair& pair, const Sitter& s) {
  const trace::FaceCounts counts = trace::count_faces(pair.rep(s.side), s.side, s.collision->trace.events);
  return {counts.tests.begin(), counts.tests.end()};
}

Pose pose_of(const Sitter& s) {
  const ContactStep& last = s.collision->steps.back();
  return s.side == Side::a ? last.pose_a : last.pose_x;
}

Eigen::AlignedBox3d box_of(const LrbRep& rep, const Pose& pose) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& p : body_points(rep, pose)) box.extend(p);
  return box;
}

/// From where the other body is, a little aside: onto the faces that it met.
ViewDirection view_of(const PaperPair& pair, const Sitter& s) {
  const ContactStep& last = s.collision->steps.back();
  const Eigen::Vector3d way =
      box_of(pair.x.rep, last.pose_x).center() - box_of(pair.a.rep, last.pose_a).center();
  const Eigen::Vector3d from = (s.side == Side::a ? way : -way).normalized();
  int flat = 0;  // the axis that the direction leans to least
  from.cwiseAbs().minCoeff(&flat);
  const Eigen::Vector3d up = Eigen::Vector3d::Unit(flat), aside = from.cross(up).normalized();
  return {from + kAside * (aside + 0.7 * up), up};
}

/// Corners of the real faces that were tested; of all faces tested if no real one was.
std::vector<Eigen::Vector3d> tested_points(const LrbRep& rep, const Pose& pose,
                                           const std::vector<double>& tests) {
  std::vector<Eigen::Vector3d> out;
  for (const FaceId end : {rep.real_face_count(), rep.face_count()}) {
    for (FaceId f = 0; f < end; ++f)
      if (tests[f] > 0)
        for (const VertexId v : rep.face(f)) out.push_back(pose.apply(rep.vertices()[v]));
    if (!out.empty()) break;
  }
  return out;
}

Camera camera_of(const PaperPair& pair, const Sitter& s, const std::vector<double>& tests) {
  const LrbRep& rep = pair.rep(s.side);
  const Pose pose = pose_of(s);
  FitOptions fit;
  fit.view = view_of(pair, s);
  constexpr double kAround = 1.1, kLeast = 0.05;  // of the tested faces' size, of the body's
  return s.near ? fit_contact(tested_points(rep, pose, tests), box_of(rep, pose), kPanelWidth, kPanelHeight,
                              fit, kAround, kLeast)
                : fit_camera(body_points(rep, pose), kPanelWidth, kPanelHeight, fit);
}

Panel draw_panel(Rasterizer& rasterizer, const PaperPair& pair, const Sitter& s, double most, Scene& legend) {
  const std::vector<double> tests = tests_of(pair, s);
  trace::Cursor cursor(s.collision->trace, pair.a.rep, pair.x.rep);
  cursor.seek(static_cast<trace::EventId>(s.collision->trace.events.size() - 1));
  SceneBody body;
  body.rep = &pair.rep(s.side);
  body.wrapper = &cursor.wrapper(s.side);
  body.pose = pose_of(s);
  body.face_values = tests;
  body.name = pair.name(s.side);
  SceneOptions options;
  options.colour_by = ColourBy::value;
  options.value_name = "face tests of a face";
  options.value_range = {0, most};
  options.scale = kThin;
  options.real_edges = s.near;
  const Scene scene = build_scene(std::span(&body, 1), {}, options);
  legend.scale = scene.scale;
  for (const LegendItem& item : scene.key) legend.key.push_back(item);
  RasterOptions raster;
  raster.width = kPanelWidth;
  raster.height = kPanelHeight;
  const std::string what = s.near ? ", close up"
                                  : ", " + std::string(s.which) + " collision (" +
                                        group_digits(s.collision->comparisons) + " face tests)";
  return {rasterizer.draw(scene.list, camera_of(pair, s, tests), raster), pair.name(s.side) + what};
}

/// Key items that are there once.
std::vector<LegendItem> without_repeats(const std::vector<LegendItem>& items) {
  std::vector<LegendItem> out;
  for (const LegendItem& item : items)
    if (std::none_of(out.begin(), out.end(), [&](const LegendItem& o) { return o.text == item.text; }))
      out.push_back(item);
  return out;
}

}  // namespace

Image draw_heat_maps(const PaperPair& pair, const CloseUp& easiest, const CloseUp& hardest) {
  std::vector<Sitter> sitters;
  for (const auto& [collision, which] : {std::pair{&easiest, "easiest"}, {&hardest, "hardest"}})
    for (const Side side : {Side::a, Side::b})
      for (const bool near : {false, true}) sitters.push_back({side, collision, which, near});
  double most = 0;
  for (const Sitter& s : sitters) {
    const std::vector<double> tests = tests_of(pair, s);
    most = std::max(most, *std::max_element(tests.begin(), tests.end()));
  }
  Rasterizer rasterizer;
  std::vector<Panel> panels;
  Scene legend;
  for (const Sitter& s : sitters) panels.push_back(draw_panel(rasterizer, pair, s, most, legend));
  MontageOptions options;
  options.columns = 4;
  options.text_height = 22;
  const Image all = montage(panels, options);

  Overlay overlay;
  overlay.key = without_repeats(legend.key);
  overlay.scale = legend.scale;
  constexpr int kRoom = 400;  // more than the legend needs; what it does not need is not drawn
  const OverlayLayout tentative = lay_out(overlay, all.width(), all.height() + kRoom);
  const int height = all.height() + (all.height() + kRoom - tentative.picture.height);
  const PixelRect place{0, 0, all.width(), all.height()};
  return compose_frame(all, place, overlay, all.width(), height);
}

}  // namespace lrb
