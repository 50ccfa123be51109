#include "render/pictures/body_picture.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include <Eigen/Geometry>

#include "render/pictures/panel.hpp"
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>
#include <lrbscope/render/style.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::run {

void draw_body_sheet(const LrbRep& rep, const std::string& path, const render::FrameSpec& given) {
  constexpr std::size_t kMostPanels = 6;
  const render::FrameSpec frames = in_pixels(given);
  Framing framing;
  framing.points = render::body_points(rep, Pose{});
  framing.dim = rep.dim();
  const render::FrameSpec::View view = frames.views.empty() ? render::FrameSpec::View{} : frames.views[0];
  const render::Camera camera = camera_for(view, framing, frames.width, frames.height, 0);
  render::RasterOptions options;
  options.width = frames.width;
  options.height = frames.height;
  options.background = style_of(frames).paper;
  options.even_edges = true;
  render::SceneOptions scene_options;
  scene_options.style = style_name(frames);
  scene_options.scale = static_cast<float>(frames.scale()) * style_of(frames).weight;
  render::Rasterizer rasterizer;
  std::vector<render::Panel> panels;
  // Layers [0, hidden) are included: none is the body itself, all is the outermost wrapper.
  for (const std::size_t hidden : evenly(rep.layer_count() + std::size_t{1}, kMostPanels)) {
    Wrapper wrapper(rep);
    for (RegionId r = 0; r < rep.region_count(); ++r)
      if (rep.layer(r) >= hidden) wrapper.refine(r);
    render::SceneBody body;
    body.rep = &rep;
    body.wrapper = &wrapper;
    const render::Scene scene = render::build_scene(std::vector<render::SceneBody>{body}, {}, scene_options);
    panels.push_back(
        {rasterizer.draw(scene.list, camera, options),
         render::group_digits(wrapper.boundary_size()) +
             (rep.region_count() > 0 ? " faces" : " faces: the body itself, which has no wrappers")});
  }
  render::MontageOptions montage;
  montage.style = style_name(frames);
  montage.background = style_of(frames).paper;
  render::write_png(render::montage(panels, montage), path, {{}, frames.dpi});
}

namespace {

using Eigen::Vector3d;

constexpr double kAround = 1.25;      // of a region's size: what is shown of its surroundings
constexpr double kLeastShown = 0.02;  // of the body's size, however small the region
constexpr double kTilt = 0.45;        // of the usual direction, added to where the lids look

constexpr render::Rgba kLids = render::palette::kOrange;
constexpr double kPseudoPale = 0.55;  // of the body's colour
constexpr std::uint8_t kLidAlpha = 95, kGhostAlpha = 26;

/// How faces are drawn.
struct Drawn {
  std::uint8_t style = 0;
  bool edges = false, veil = false;
};

/// Draws the panels of a sheet.
class RegionSheet {
 public:
  RegionSheet(const LrbRep& rep, const render::FrameSpec& frames)
      : rep_(rep), frames_(frames), style_(style_of(frames)) {
    for (const FaceId f : rep.outermost_faces())
      for (const VertexId v : rep.face(f)) whole_.push_back(rep.vertices()[v]);
    for (const Vector3d& x : whole_) box_.extend(x);
    raster_.width = frames.width;
    raster_.height = frames.height;
    raster_.background = style_.paper;
    scale_ = static_cast<float>(frames.scale()) * style_.weight;
  }

  /// Draws the body by values, on the scale of `overlay`.
  render::Panel whole(std::span<const double> values, const std::string& name,
                      const render::Overlay& overlay) {
    Framing framing;
    framing.dim = rep_.dim();
    render::DrawList list;
    for (FaceId f = 0; f < rep_.real_face_count(); ++f) {
      const std::vector<Vector3d> x = corners(f);
      framing.points.insert(framing.points.end(), x.begin(), x.end());
      add(list, x, render::palette::viridis(render::place_on(*overlay.scale, values[f])));
    }
    render::RasterOptions raster = raster_;
    raster.lighting = {
        .ambient = 0.78, .head = 0.1, .key = 0.16, .fill = 0.05};  // colours stay those of the scale
    const render::Camera camera =
        camera_for(frames_.views.empty() ? render::FrameSpec::View{} : frames_.views[0], framing,
                   raster_.width, raster_.height, 0);
    return {rasterizer_.draw(list, camera, raster), name};
  }

  render::Panel close_up(const ShownRegion& shown) {
    render::DrawList list;
    const auto edges = list.edge_style({with_alpha(render::palette::kInk, 150), 0.9F * scale_});
    const auto rims = list.edge_style({with_alpha(style_.edge_of(kLids), 230), 1.5F * scale_, 0.4F});
    std::vector<bool> of_region(rep_.face_count(), false);
    for (const FaceId f : rep_.collector(shown.region)) of_region[f] = true;
    for (const FaceId f : rep_.floor(shown.region)) {
      const bool real = rep_.is_real(f);
      add(list, corners(f), real ? real_colour() : pseudo_colour(), {.style = edges, .edges = true});
    }
    for (const FaceId f : rep_.lids(shown.region))
      add(list, corners(f), with_alpha(kLids, kLidAlpha), {.style = rims, .edges = true, .veil = true});
    for (FaceId f = 0; f < rep_.real_face_count(); ++f)
      if (!of_region[f]) add(list, corners(f), with_alpha(real_colour(), kGhostAlpha), {.veil = true});
    return {rasterizer_.draw(list, camera_of(shown.region), raster_), shown.caption};
  }

  std::vector<render::LegendItem> key() const {
    using Mark = render::LegendItem::Mark;
    return {{Mark::translucent, kLids, "lids of the region"},
            {Mark::solid, real_colour(), "real faces that it hides"},
            {Mark::solid, pseudo_colour(), "lids that it hides"},
            {Mark::translucent, with_alpha(real_colour(), kGhostAlpha), "the rest of the body"}};
  }

 private:
  render::Rgba real_colour() const { return style_.body(Side::a); }
  render::Rgba pseudo_colour() const { return style_.pale(real_colour(), kPseudoPale); }

  std::vector<Vector3d> corners(FaceId f) const {
    std::vector<Vector3d> x;
    for (const VertexId v : rep_.face(f)) x.push_back(rep_.vertices()[v]);
    return x;
  }

  void add(render::DrawList& list, const std::vector<Vector3d>& x, render::Rgba colour,
           Drawn how = {}) const {
    if (rep_.dim() == 2) {
      render::DrawLine line;
      line.points = x;
      line.colour = colour;
      line.width = (how.veil && !how.edges ? 2.0F : 4.0F) * scale_;
      list.lines.push_back(std::move(line));
      return;
    }
    render::DrawTriangle t;
    t.colour = colour;
    t.edges = how.edges ? 7 : 0;
    t.edge_style = how.style;
    if (how.veil) t.layer = render::Layer::translucent;
    if (how.veil && how.edges) t.nudge = 1;  // in a region without volume a lid lies on what it hides
    list.add_polygon(x, t);
  }

  render::Camera camera_of(RegionId r) const {
    const std::vector<Vector3d> points = points_of(rep_, r);
    if (rep_.dim() == 2) {
      Eigen::AlignedBox3d around;
      for (const Vector3d& x : points) around.extend(x);
      const Vector3d more =
          0.5 * (kAround - 1) * around.sizes() + Vector3d(1, 1, 0) * kLeastShown * box_.sizes().norm();
      return render::fit_top(std::vector<Vector3d>{around.min() - more, around.max() + more}, raster_.width,
                             raster_.height);
    }
    render::FitOptions fit;
    const Vector3d out = outlook(rep_, r);
    if (!frames_.views.empty()) {
      fit.view = {frames_.views[0].from, frames_.views[0].up};
      fit.orthographic = frames_.views[0].orthographic;
    }
    const Vector3d up = fit.view.up.normalized(), usual = fit.view.from.normalized();
    const Vector3d from = out + kTilt * usual;
    if (out.norm() > 0 && from.normalized().cross(up).norm() > 0.1) fit.view.from = from;
    return render::fit_contact(points, box_, raster_.width, raster_.height, fit, kAround, kLeastShown);
  }

  const LrbRep& rep_;
  const render::FrameSpec& frames_;
  const render::Style& style_;
  std::vector<Vector3d> whole_;
  Eigen::AlignedBox3d box_;
  render::RasterOptions raster_;
  float scale_;
  render::Rasterizer rasterizer_;
};

/// Puts a heading above panels, and the scale below them.
render::Image with_overlay(const render::Image& panels, const render::Overlay& overlay, float scale) {
  const int room = static_cast<int>(600 * scale);  // more than the overlay needs; the rest is cut off
  const int width = panels.width();
  const render::OverlayLayout tentative = render::lay_out(overlay, width, panels.height() + room, scale);
  const int height = 2 * panels.height() + room - tentative.picture.height;
  const render::OverlayLayout layout = render::lay_out(overlay, width, height, scale);
  return render::compose_frame(panels, layout.picture, overlay, width, height,
                               render::style_of(overlay.style).paper, scale);
}

}  // namespace

Vector3d outlook(const LrbRep& rep, RegionId r) {
  Vector3d sum = Vector3d::Zero();
  if (rep.dim() == 2) return sum;
  double area = 0;
  for (const FaceId f : rep.lids(r)) {
    const auto c = rep.face(f);
    for (std::size_t i = 1; i + 1 < c.size(); ++i) {
      const Vector3d n = (rep.vertices()[c[i]] - rep.vertices()[c[0]])
                             .cross(rep.vertices()[c[i + 1]] - rep.vertices()[c[0]]);
      sum += n;
      area += n.norm();
    }
  }
  constexpr double kAllRound = 0.2;  // lids that look nearly all ways: their mean says nothing
  return area > 0 && sum.norm() > kAllRound * area ? Vector3d(sum.normalized()) : Vector3d::Zero();
}

std::vector<Vector3d> points_of(const LrbRep& rep, RegionId r) {
  std::vector<Vector3d> points;
  for (const FaceId f : rep.collector(r))
    for (const VertexId v : rep.face(f)) points.push_back(rep.vertices()[v]);
  return points;
}

void draw_region_sheet(const LrbRep& rep, std::span<const double> values, const std::string& name,
                       std::span<const ShownRegion> regions, const std::string& path,
                       const render::FrameSpec& given) {
  const render::FrameSpec frames = in_pixels(given);
  RegionSheet sheet(rep, frames);
  constexpr double kRange = 1000;  // from the least colour to the last one
  const double most = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  render::Overlay overlay;
  overlay.title = rep.name() + ": where its wrappers waste most";
  overlay.event = "(a) the body; then the worst regions, seen from where their lids look";
  overlay.scale = render::ScaleBar{name, most > 0 ? most / kRange : 1e-3, most > 0 ? most : 1, true};
  overlay.key = sheet.key();
  overlay.style = style_name(frames);
  std::vector<render::Panel> panels = {sheet.whole(values, name, overlay)};
  for (const ShownRegion& r : regions) panels.push_back(sheet.close_up(r));
  render::MontageOptions options;
  options.columns = panels.size() > 6 ? 4 : 3;
  options.frame = true;
  options.style = overlay.style;
  options.background = style_of(frames).paper;
  render::write_png(
      with_overlay(render::montage(panels, options), overlay, static_cast<float>(frames.scale())), path,
      {{}, frames.dpi});
}

namespace {

std::string number_and(std::size_t n, const char* what) {
  return render::group_digits(n) + " " + what + (n == 1 ? "" : "s");
}

/// Returns the first few regions of a set, by their numbers.
std::string list_of(const std::set<std::uint32_t>& regions) {
  constexpr std::size_t kMost = 6;
  std::string out;
  std::size_t count = 0;
  for (const std::uint32_t r : regions) {
    if (count++ == kMost) return out + ", ...";
    out += (out.empty() ? "" : ", ") + std::to_string(r);
  }
  return out;
}

std::string words_of_one(const LrbRep& rep, RegionId r, const std::string& owner) {
  std::set<std::uint32_t> outside, inside;
  for (const FaceId f : rep.lids(r))
    if (is_region(rep.outer_cell(f)) && rep.outer_cell(f) != rep.parent(r)) outside.insert(rep.outer_cell(f));
  std::size_t real = 0;
  for (const FaceId f : rep.floor(r)) {
    real += rep.is_real(f);
    if (is_region(rep.inner_cell(f))) inside.insert(rep.inner_cell(f));
  }
  std::string out = "region " + std::to_string(r) + owner + ": layer " + std::to_string(rep.layer(r)) + ", " +
                    number_and(rep.lids(r).size(), "lid") + " over " +
                    number_and(rep.floor(r).size(), "face");
  if (real > 0) out += ", " + render::group_digits(real) + " of them real";
  out += "; parent " + (is_region(rep.parent(r)) ? std::to_string(rep.parent(r)) : "the outside");
  if (!outside.empty()) out += "; also under " + list_of(outside);
  if (!inside.empty()) out += "; hides " + list_of(inside);
  return out;
}

}  // namespace

std::string region_words(const LrbRep& rep, std::span<const RegionId> regions, const std::string& owner) {
  if (regions.size() == 1) return words_of_one(rep, regions[0], owner);
  std::size_t lids = 0, floor = 0;
  std::set<std::uint32_t> layers, numbers;
  for (const RegionId r : regions) {
    lids += rep.lids(r).size();
    floor += rep.floor(r).size();
    layers.insert(rep.layer(r));
    numbers.insert(r);
  }
  return number_and(regions.size(), "region") + owner + " (" + list_of(numbers) + "): layer" +
         (layers.size() == 1 ? " " : "s ") + list_of(layers) + ", " + number_and(lids, "lid") + " over " +
         number_and(floor, "face");
}

}  // namespace lrb::run
