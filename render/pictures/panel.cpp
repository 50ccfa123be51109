#include "render/pictures/panel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "render/pictures/marks.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/core/file.hpp>

namespace lrb::pictures {

using namespace render;
using Eigen::Vector3d;

Image draw_panel(Rasterizer& rasterizer, const Panel& panel, const Look& look, int width, int height) {
  RasterOptions options;
  options.width = width;
  options.height = height;
  options.supersample = look.supersampling;
  options.background = look.paper();
  options.even_edges = panel.even_edges;
  options.lighting = panel.lighting;
  const Camera camera = panel.camera(width, height);
  if (panel.list.labels.empty()) return rasterizer.draw(panel.list, camera, options);
  const Projection projection(camera, width, height, bounds(panel.list));
  const Eigen::AlignedBox2d frame(Eigen::Vector2d(0, 0), Eigen::Vector2d(width, height));
  return rasterizer.draw(with_leaders(panel.list, projection, frame), camera, options);
}

std::vector<PixelRect> panel_places(const PixelRect& picture, std::size_t panels, double scale) {
  // A hairline: the views of one state are nearer to each other than the states of a montage.
  const int gap = std::max(1, static_cast<int>(std::lround(scale))), n = static_cast<int>(panels);
  const bool columns = picture.width >= picture.height;
  const int whole = columns ? picture.width : picture.height, each = (whole - gap * (n - 1)) / n;
  std::vector<PixelRect> out;
  for (int i = 0; i < n; ++i) {
    const int at = i * (each + gap), size = i + 1 == n ? whole - at : each;
    out.push_back(columns ? PixelRect{at, 0, size, picture.height} : PixelRect{0, at, picture.width, size});
  }
  return out;
}

Image draw_row(Rasterizer& rasterizer, std::span<const Panel> panels, const Look& look,
               const PixelRect& picture) {
  const Style& style = style_of(look.style);
  const auto scale = static_cast<float>(look.scale());
  TextStyle text;
  text.height = std::max(13.0F * scale, static_cast<float>(look.height) / 42);
  text.colour = style.faint;
  text.halo = style.paper;
  text.halo_width = 2 * scale;
  Image out(picture.width, picture.height,
            panels.size() > 1 && !look.transparent ? style.rule : look.background());
  const std::vector<PixelRect> places = panel_places(picture, panels.size(), look.scale());
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const PixelRect& place = places[i];
    Image panel = draw_panel(rasterizer, panels[i], look, place.width, place.height);
    if (look.titles && !panels[i].title.empty())
      default_font().draw(panel, panels[i].title, static_cast<int>(text.height / 2),
                          static_cast<int>(text.height / 3), text);
    // Copied, not blended, so that a transparent panel keeps its alpha.
    for (int y = 0; y < place.height; ++y)
      std::copy_n(&panel.at(0, y), place.width, &out.at(place.x, place.y + y));
  }
  return out;
}

Image draw_panels(std::span<const Panel> panels, const Overlay& overlay, const Look& look) {
  const auto scale = static_cast<float>(look.scale());
  const PixelRect place = lay_out(overlay, look.width, look.height, scale).picture;
  Rasterizer rasterizer;
  return compose_frame(draw_row(rasterizer, panels, look, place), place, overlay, look.width, look.height,
                       look.background(), scale);
}

Image draw_sheet(std::span<const Panel> panels, const Look& look, MontageOptions options) {
  Rasterizer rasterizer;
  std::vector<render::Panel> images;
  for (const Panel& panel : panels)
    images.push_back({draw_panel(rasterizer, panel, look, look.width, look.height), panel.title});
  options.style = look.style;
  options.background = look.background();
  return montage(images, options);
}

Image with_overlay(const Image& picture, const Overlay& overlay, double scale) {
  const auto s = static_cast<float>(scale);
  const int room = static_cast<int>(600 * s);  // more than the overlay needs; the rest is cropped
  const int width = picture.width();
  const OverlayLayout tentative = lay_out(overlay, width, picture.height() + room, s);
  const int height = 2 * picture.height() + room - tentative.picture.height;
  return compose_frame(picture, lay_out(overlay, width, height, s).picture, overlay, width, height,
                       style_of(overlay.style).paper, s);
}

void leave_out_texts(Overlay& overlay, const Look& look) {
  if (!look.titles) {
    overlay.title.clear();
    overlay.event.clear();
    overlay.event_colour = kTransparent;
    overlay.counters.clear();
  }
  if (!look.legend) {
    overlay.key.clear();
    overlay.scale.reset();
  }
}

void to_pixels(Look& look) {
  for (int* side : {&look.width, &look.height}) *side = static_cast<int>(std::lround(*side * look.scale()));
}

void write_picture(const Image& picture, const std::string& path, double dpi) {
  make_folder_of(path);
  write_png(picture, path, {{}, dpi});
}

void merge_key(std::vector<LegendItem>& all, const std::vector<LegendItem>& some) {
  for (const LegendItem& item : some)
    if (std::none_of(all.begin(), all.end(),
                     [&](const LegendItem& known) { return known.text == item.text; }))
      all.push_back(item);
}

std::vector<std::size_t> evenly(std::size_t count, std::size_t wanted) {
  std::vector<std::size_t> out;
  wanted = std::min(count, wanted);
  for (std::size_t i = 0; i < wanted; ++i)
    out.push_back(wanted == 1 ? count - 1 : i * (count - 1) / (wanted - 1));
  return out;
}

CameraFit fit_points(std::vector<Vector3d> points, int dim, const FitOptions& options) {
  return [points = std::move(points), dim, options](double width, double height) {
    return dim == 2 ? fit_top(points, width, height) : fit_camera(points, width, height, options);
  };
}

Camera camera_for(const Look::View& view, const Framing& framing, double width, double height,
                  double progress) {
  using Kind = Look::Camera;
  const bool close = view.camera == Kind::contact && !framing.contacts.empty();
  Camera camera;
  if (view.camera == Kind::fixed) {
    camera.eye = view.eye;
    camera.target = view.target;
    camera.up = view.up;
    camera.orthographic = view.orthographic;
    camera.half_height = (view.eye - view.target).norm() * std::tan(camera.fov_y / 2);
  } else if (framing.dim == 2) {
    camera = fit_top(close ? framing.contacts : framing.points, width, height);
  } else {
    FitOptions options;
    options.view = {view.from, view.up};
    options.orthographic = view.orthographic;
    constexpr double kRoomAround = 1.6;  // relative to the contacts
    camera = close
                 ? fit_contact(framing.contacts, bounds(framing.points), width, height, options, kRoomAround)
                 : fit_camera(framing.points, width, height, options);
    if (view.camera == Kind::orbit)
      camera = orbit(camera, view.turn_degrees * progress * std::numbers::pi / 180);
  }
  if (view.look_at) {
    camera.eye += *view.look_at - camera.target;
    camera.target = *view.look_at;
  }
  camera.half_height /= view.zoom;
  if (!camera.orthographic) camera.eye = camera.target + (camera.eye - camera.target) / view.zoom;
  return camera;
}

std::vector<SceneBody> PosedBodies::in_scene() const {
  std::vector<SceneBody> out(2);
  out[0].rep = &a;
  out[0].pose = pose_a;
  out[0].name = "A " + a.name();
  out[1].rep = &b;
  out[1].pose = pose_b;
  out[1].name = "B " + b.name();
  return out;
}

std::vector<Vector3d> PosedBodies::points() const {
  std::vector<Vector3d> out = body_points(a, pose_a);
  for (const Vector3d& x : body_points(b, pose_b)) out.push_back(x);
  return out;
}

std::vector<Vector3d> real_corners(const LrbRep& rep, const Pose& pose) {
  std::vector<Vector3d> out;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) out.push_back(pose.apply(rep.vertices()[v]));
  return out;
}

std::vector<Vector3d> region_corners(const LrbRep& rep, RegionId region) {
  std::vector<Vector3d> out;
  for (const FaceId f : rep.collector(region))
    for (const VertexId v : rep.face(f)) out.push_back(rep.vertices()[v]);
  return out;
}

Eigen::AlignedBox3d box_of(const LrbRep& rep, const Pose& pose) {
  return bounds(real_corners(rep, pose));
}

namespace {

/// Returns the centre of mass of the solid, or of the vertices if it has no volume.
Vector3d centre_of_mass(const LrbRep& rep) {
  const std::vector<Vector3d> corners = real_corners(rep);
  const Vector3d origin = bounds(corners).center();
  Vector3d sum = Vector3d::Zero();
  double volume = 0;
  // Tetrahedra from the origin to the triangles of each face.
  for (FaceId f = 0; f < rep.real_face_count(); ++f) {
    const std::vector<Vector3d> x = corners_of(rep, f, {});
    for (std::size_t i = 1; i + 1 < x.size(); ++i) {
      const Vector3d a = x[0] - origin, b = x[i] - origin, c = x[i + 1] - origin;
      const double part = a.cross(b).dot(c);
      volume += part;
      sum += part * (a + b + c) / 4;
    }
  }
  if (volume > 0) return origin + sum / volume;
  return std::accumulate(corners.begin(), corners.end(), Vector3d(Vector3d::Zero())) /
         static_cast<double>(corners.size());
}

}  // namespace

std::optional<int> likely_up(const LrbRep& rep) {
  constexpr double kBase = 0.02;    // of the height: points below are on the ground
  constexpr double kClearly = 1.1;  // factor by which an axis must be better than one before it
  const std::vector<Vector3d> corners = real_corners(rep);
  const Eigen::AlignedBox3d box = bounds(corners);
  const Vector3d centre = centre_of_mass(rep), size = box.sizes();
  std::optional<int> best;
  double most = 0;
  for (const int axis : {2, 1, 0}) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<Vector3d> ground;  // relative to the point below the centre of mass
    for (const Vector3d& x : corners)
      if (x[axis] - box.min()[axis] <= kBase * size[axis])
        ground.emplace_back(x[u] - centre[u], x[v] - centre[v], 0);
    const std::vector<std::uint32_t> hull = convex_outline(ground);
    double area = 0;
    bool stable = hull.size() > 2;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const double part = ground[hull[i]].cross(ground[hull[(i + 1) % hull.size()]]).z() / 2;
      area += part;
      stable = stable && part > 0;
    }
    const double share = area / (size[u] * size[v]);
    if (!stable || !(share > kClearly * most)) continue;
    best = axis;
    most = share;
  }
  return best;
}

Vector3d broadside(const Eigen::AlignedBox3d& box, const Vector3d& up) {
  int vertical = 0;
  up.cwiseAbs().maxCoeff(&vertical);
  const int first = (vertical + 1) % 3, second = (vertical + 2) % 3;
  const Vector3d size = box.sizes();
  constexpr double kClearly = 1.15;
  Vector3d out = 0.42 * up.normalized();
  // Of two horizontal sides of similar length both are shown; otherwise mainly the longer one.
  out[first] = size[first] > kClearly * size[second]   ? 0.38
               : size[second] > kClearly * size[first] ? 0.84
                                                       : 0.62;
  out[second] = size[first] > kClearly * size[second]   ? -0.84
                : size[second] > kClearly * size[first] ? -0.38
                                                        : -0.68;
  return out;
}

}  // namespace lrb::pictures
