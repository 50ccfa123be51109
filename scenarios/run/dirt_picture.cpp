#include "scenarios/run/dirt_picture.hpp"

#include <algorithm>
#include <filesystem>

#include "render/dirt.hpp"
#include "render/palette.hpp"
#include "render/png.hpp"
#include "render/rasterize.hpp"
#include "render/text.hpp"

namespace lrb::run {
namespace {

constexpr int kSheetWidth = 1600, kGap = 4,
              kStrips = 120;         // pixels: of the picture, between panels, for title and legend
constexpr double kShape = 0.72;      // a panel's height over its width
constexpr float kTextHeight = 0.8F;  // of panels, over the title's
constexpr double kLonely = 0.5;      // of the body's size, about a point without faces
constexpr float kUsualText = 16;     // pixels: lines and points are made for it
constexpr double kContext = 1.15;    // of the close-ups' sizes
constexpr double kLeast = 1e-6;      // of the body's size, in a close-up of what has none

int columns(std::size_t panels) {
  return panels == 2 || panels == 4 ? 2 : 3;
}

render::Camera camera_of(const Mesh& mesh, const MeshReport& report, const MeshFault* kind, int width,
                         int height) {
  const std::vector<Eigen::Vector3d> all = render::dirt::whole(mesh, report);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : all) box.extend(x);
  const render::dirt::CloseUp close =
      kind ? render::dirt::close_up(mesh, report, *kind) : render::dirt::CloseUp{all, {}};
  constexpr double kMargin = 0.1;  // for labels and the caption
  render::FitOptions fit;
  fit.margin = kMargin;
  fit.view = close.view;
  if (!kind)
    return mesh.dim == 2 ? render::fit_top(all, width, height, kMargin)
                         : render::fit_camera(all, width, height, fit);
  Eigen::AlignedBox3d part;
  for (const Eigen::Vector3d& x : close.points) part.extend(x);
  if (mesh.dim == 3) {
    const bool lone = !(part.diagonal().norm() > 0);
    return render::fit_contact(close.points, box, width, height, fit, kContext, lone ? kLonely : kLeast);
  }
  std::vector<Eigen::Vector3d> points = close.points;
  if (!(part.diagonal().norm() > 0))
    for (const double side : {-0.05, 0.05}) points.push_back(part.center() + side * box.diagonal());
  return render::fit_top(points, width, height, kMargin);
}

void write_caption(render::Image& panel, const std::string& text, float height) {
  render::TextStyle style;
  style.height = height;
  style.colour = render::palette::kInk;
  style.halo = render::kWhite;
  style.halo_width = 3;
  int y = 6;
  std::vector<std::string> lines = render::default_font().wrap(text, panel.width() - 16, style);
  for (const std::string& line : lines) {
    render::default_font().draw(panel, line, 8, y, style);
    y += static_cast<int>(1.25F * height);
  }
}

render::Image draw_panel(render::Rasterizer& rasterizer, const Mesh& mesh, const MeshReport& report,
                         const MeshFault* kind, char letter, int width, int height, float text) {
  const render::Camera camera = camera_of(mesh, report, kind, width, height);
  render::RasterOptions raster;
  raster.width = width;
  raster.height = height;
  render::dirt::Options options;
  if (kind != nullptr) options.focus = *kind;
  if (kind != nullptr)
    for (const Eigen::Vector3d& x : render::dirt::close_up(mesh, report, *kind).points)
      options.near.extend(x);
  options.scale = text / kUsualText;
  options.width = width;
  options.height = height;
  render::Image panel = rasterizer.draw(render::dirt::list(mesh, report, camera, options), camera, raster);
  const std::string what = kind ? render::dirt::caption(*kind, report[*kind], mesh.dim) : "the whole";
  write_caption(panel, "(" + std::string(1, letter) + ") " + what, text);
  panel.stroke(panel.rect(), render::palette::kRule);
  return panel;
}

}  // namespace

bool draw_dirt(const Mesh& given, const MeshReport& report, const std::string& path) {
  const std::vector<MeshFault> kinds = render::dirt::kinds(report);
  if (kinds.empty()) return false;
  const Mesh mesh = render::dirt::to_unit_size(given);
  const int across = columns(kinds.size() + 1), down = (static_cast<int>(kinds.size()) + across) / across;
  const int cell = (kSheetWidth - kGap * (across - 1)) / across;
  const int height = kStrips + down * static_cast<int>(kShape * cell);
  render::Overlay overlay;
  overlay.title = std::filesystem::path(given.name).filename().string() + "  ·  " +
                  std::to_string(kinds.size()) + (kinds.size() == 1 ? " finding" : " findings");
  overlay.event = "Offenders by their numbers, counted from 0 in file order";
  overlay.key = render::dirt::legend(report, mesh.dim);
  const render::OverlayLayout layout = render::lay_out(overlay, kSheetWidth, height);
  const int cell_height = (layout.picture.height - kGap * (down - 1)) / down;
  render::Image picture(layout.picture.width, layout.picture.height);
  const float text = std::max(kUsualText, kTextHeight * layout.text_height);
  render::Rasterizer rasterizer;
  for (std::size_t i = 0; i <= kinds.size(); ++i) {
    const MeshFault* kind = i == 0 ? nullptr : &kinds[i - 1];  // null: the whole
    const int x = static_cast<int>(i) % across * (cell + kGap),
              y = static_cast<int>(i) / across * (cell_height + kGap);
    picture.paste(
        draw_panel(rasterizer, mesh, report, kind, static_cast<char>('a' + i), cell, cell_height, text), x,
        y);
  }
  render::write_png(render::compose_frame(picture, layout.picture, overlay, kSheetWidth, height), path);
  return true;
}

}  // namespace lrb::run
