#include "render/pictures/panel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <lrbscope/render/overlay.hpp>

namespace lrb::run {
namespace {

void write_title(render::Image& view, const std::string& title, const render::FrameSpec& spec) {
  render::TextStyle style;
  const auto scale = static_cast<float>(spec.scale());
  style.height = std::max(13.0F * scale, static_cast<float>(spec.height) / 42);
  style.colour = style_of(spec).faint;
  style.halo = style_of(spec).paper;
  style.halo_width = 2 * scale;
  render::default_font().draw(view, title, static_cast<int>(style.height / 2),
                              static_cast<int>(style.height / 3), style);
}

}  // namespace

render::StyleName style_name(const render::FrameSpec& spec) {
  switch (spec.style) {
    case render::FrameSpec::Style::print:
      return render::StyleName::print;
    case render::FrameSpec::Style::dark:
      return render::StyleName::dark;
    case render::FrameSpec::Style::screen:
      break;
  }
  return render::StyleName::screen;
}

const render::Style& style_of(const render::FrameSpec& spec) {
  return render::style_of(style_name(spec));
}

std::optional<render::Rgba> paper_of(const render::FrameSpec& spec) {
  return spec.transparent ? std::nullopt : std::optional(style_of(spec).paper);
}

void leave_out_texts(render::Overlay& overlay, const render::FrameSpec& spec) {
  if (!spec.titles) {
    overlay.title.clear();
    overlay.event.clear();
    overlay.event_colour = render::kTransparent;
    overlay.counters.clear();
  }
  if (!spec.legend) {
    overlay.key.clear();
    overlay.scale.reset();
  }
}

render::FrameSpec in_pixels(render::FrameSpec spec) {
  spec.width = static_cast<int>(std::lround(spec.width * spec.scale()));
  spec.height = static_cast<int>(std::lround(spec.height * spec.scale()));
  return spec;
}

std::vector<render::PixelRect> view_places(const render::PixelRect& picture, std::size_t views,
                                           double scale) {
  const int gap = static_cast<int>(std::lround(4 * scale)), n = static_cast<int>(views);
  const bool columns = picture.width >= picture.height;
  const int whole = columns ? picture.width : picture.height, each = (whole - gap * (n - 1)) / n;
  std::vector<render::PixelRect> out;
  for (int i = 0; i < n; ++i) {
    const int at = i * (each + gap), size = i + 1 == n ? whole - at : each;
    out.push_back(columns ? render::PixelRect{at, 0, size, picture.height}
                          : render::PixelRect{0, at, picture.width, size});
  }
  return out;
}

void paint_views(render::Rasterizer& rasterizer, const render::FrameSpec& spec,
                 const std::vector<render::FrameSpec::View>& views,
                 const std::vector<render::PixelRect>& places,
                 const std::function<render::DrawList(const render::FrameSpec::View&)>& list_of,
                 const std::function<render::Camera(std::size_t)>& camera_of, render::Image& picture) {
  picture.pixels().assign(picture.pixels().size(), views.size() > 1 && !spec.transparent
                                                       ? style_of(spec).rule
                                                       : paper_of(spec).value_or(render::kTransparent));
  for (std::size_t i = 0; i < views.size(); ++i) {
    const render::PixelRect& place = places[i];
    render::RasterOptions options;
    options.width = place.width;
    options.height = place.height;
    options.supersample = spec.supersampling;
    options.background = paper_of(spec);
    options.even_edges = true;
    render::Image view = rasterizer.draw(list_of(views[i]), camera_of(i), options);
    if (spec.titles && !views[i].title.empty()) write_title(view, views[i].title, spec);
    for (int y = 0; y < place.height; ++y)
      std::copy_n(&view.at(0, y), place.width, &picture.at(place.x, place.y + y));
  }
}

void merge_key(std::vector<render::LegendItem>& all, const std::vector<render::LegendItem>& some) {
  for (const render::LegendItem& item : some)
    if (std::none_of(all.begin(), all.end(),
                     [&](const render::LegendItem& known) { return known.text == item.text; }))
      all.push_back(item);
}

std::vector<std::size_t> evenly(std::size_t count, std::size_t wanted) {
  std::vector<std::size_t> out;
  wanted = std::min(count, wanted);
  for (std::size_t i = 0; i < wanted; ++i)
    out.push_back(wanted == 1 ? count - 1 : i * (count - 1) / (wanted - 1));
  return out;
}

render::Camera camera_for(const render::FrameSpec::View& view, const Framing& framing, double width,
                          double height, double progress) {
  using Kind = render::FrameSpec::Camera;
  const bool close = view.camera == Kind::contact && !framing.contacts.empty();
  render::Camera camera;
  if (view.camera == Kind::fixed) {
    camera.eye = view.eye;
    camera.target = view.target;
    camera.up = view.up;
    camera.orthographic = view.orthographic;
    camera.half_height = (view.eye - view.target).norm() * std::tan(camera.fov_y / 2);
  } else if (framing.dim == 2) {
    camera = render::fit_top(close ? framing.contacts : framing.points, width, height);
  } else {
    render::FitOptions options;
    options.view = {view.from, view.up};
    options.orthographic = view.orthographic;
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& p : framing.points) box.extend(p);
    constexpr double kRoomAround = 1.6;  // in sizes of the contacts
    camera = close ? render::fit_contact(framing.contacts, box, width, height, options, kRoomAround)
                   : render::fit_camera(framing.points, width, height, options);
    if (view.camera == Kind::orbit)
      camera = render::orbit(camera, view.turn_degrees * progress * std::numbers::pi / 180);
  }
  if (view.look_at) {
    camera.eye += *view.look_at - camera.target;
    camera.target = *view.look_at;
  }
  camera.half_height /= view.zoom;
  if (!camera.orthographic) camera.eye = camera.target + (camera.eye - camera.target) / view.zoom;
  return camera;
}

Eigen::AlignedBox3d box_of(const LrbRep& rep, const Pose& pose) {
  Eigen::AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(pose.apply(rep.vertices()[v]));
  return box;
}

Eigen::AlignedBox3d box_with_lids(const LrbRep& rep, const Pose& pose) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : rep.vertices()) box.extend(pose.apply(v));
  return box;
}

Eigen::Vector3d broadside(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& up) {
  int vertical = 0;
  up.cwiseAbs().maxCoeff(&vertical);
  const int first = (vertical + 1) % 3, second = (vertical + 2) % 3;
  const Eigen::Vector3d size = box.sizes();
  constexpr double kClearly = 1.15;
  Eigen::Vector3d out = 0.42 * up.normalized();
  // Two level sides of about one length are both seen; else most of the longer one.
  out[first] = size[first] > kClearly * size[second]   ? 0.38
               : size[second] > kClearly * size[first] ? 0.84
                                                       : 0.62;
  out[second] = size[first] > kClearly * size[second]   ? -0.84
                : size[second] > kClearly * size[first] ? -0.38
                                                        : -0.68;
  return out;
}

}  // namespace lrb::run
