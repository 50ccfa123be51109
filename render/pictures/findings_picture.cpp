#include "render/pictures/findings_picture.hpp"

#include <algorithm>
#include <filesystem>

#include "render/pictures/panel.hpp"
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/render/scene.hpp>

namespace lrb::run {
namespace {

constexpr int kGap = 4, kStrips = 120;    // pixels of a screen: between panels, for title and legend
constexpr double kShape = 0.72;           // a panel's height over its width
constexpr float kPanelText = 0.8F;        // of panels, over the title's
constexpr double kLonely = 0.5;           // of the body's size, about a point without faces
constexpr float kUsualText = 16;          // pixels: lines and points are made for it
constexpr double kCloseUpContext = 1.15;  // of the close-ups' sizes
constexpr double kRimContext = 1.6;       // the same of a rim, which is no use without what it bounds
constexpr double kLeastCloseUp = 1e-6;    // of the body's size, in a close-up of what has none

int columns(std::size_t panels) {
  return panels == 2 || panels == 4 ? 2 : 3;
}

/// A panel to draw: the whole, or a kind of findings close up.
struct FindingsPanel {
  const MeshFault* kind = nullptr;  ///< null: the whole
  char letter = 'a';
  int width = 0, height = 0;
  float text = kUsualText;
};

render::Camera camera_of_whole(const FaultyMesh& faulty, const render::FrameSpec& frames,
                               const FindingsPanel& panel) {
  Framing framing;
  framing.points = render::findings::whole(faulty.mesh, faulty.report);
  framing.dim = faulty.mesh.dim;
  constexpr double kCaptionRoom = 0.92;
  render::FrameSpec::View view = frames.views.empty() ? render::FrameSpec::View{} : frames.views[0];
  view.zoom *= kCaptionRoom;
  return camera_for(view, framing, panel.width, panel.height, 0);
}

render::Camera camera_of(const FaultyMesh& faulty, const render::FrameSpec& frames,
                         const FindingsPanel& panel) {
  if (panel.kind == nullptr) return camera_of_whole(faulty, frames, panel);
  constexpr double kMargin = 0.1;  // for labels and the caption
  const render::findings::CloseUp close =
      render::findings::close_up(faulty.mesh, faulty.report, *panel.kind, faulty.loops);
  render::FitOptions fit;
  fit.margin = kMargin;
  fit.view = close.view;
  Eigen::AlignedBox3d box, part;
  for (const Eigen::Vector3d& x : render::findings::whole(faulty.mesh, faulty.report)) box.extend(x);
  for (const Eigen::Vector3d& x : close.points) part.extend(x);
  const bool lone = !(part.diagonal().norm() > 0);
  if (faulty.mesh.dim == 3) {
    const bool rim = *panel.kind == MeshFault::open_edge && !faulty.loops.empty();
    return render::fit_contact(close.points, box, panel.width, panel.height, fit,
                               rim ? kRimContext : kCloseUpContext, lone ? kLonely : kLeastCloseUp);
  }
  std::vector<Eigen::Vector3d> points = close.points;
  if (lone)
    for (const double side : {-0.05, 0.05}) points.push_back(part.center() + side * box.diagonal());
  return render::fit_top(points, panel.width, panel.height, kMargin);
}

void write_caption(render::Image& panel, const std::string& text, float height, const render::Style& look) {
  render::TextStyle style;
  style.height = height;
  style.colour = look.ink;
  style.halo = look.paper;
  style.halo_width = 3;
  int y = 6;
  std::vector<std::string> lines = render::default_font().wrap(text, panel.width() - 16, style);
  for (const std::string& line : lines) {
    render::default_font().draw(panel, line, 8, y, style);
    y += static_cast<int>(1.25F * height);
  }
}

render::Image draw_panel(render::Rasterizer& rasterizer, const FaultyMesh& faulty,
                         const render::FrameSpec& frames, const FindingsPanel& panel) {
  const render::Camera camera = camera_of(faulty, frames, panel);
  render::RasterOptions raster;
  raster.width = panel.width;
  raster.height = panel.height;
  raster.background = style_of(frames).paper;
  render::findings::Options options;
  options.loops = faulty.loops;
  options.style = style_name(frames);
  if (panel.kind != nullptr) {
    options.focus = *panel.kind;
    for (const Eigen::Vector3d& x :
         render::findings::close_up(faulty.mesh, faulty.report, *panel.kind, faulty.loops).points)
      options.near.extend(x);
  }
  options.scale = panel.text / kUsualText;
  options.width = panel.width;
  options.height = panel.height;
  render::Image image =
      rasterizer.draw(render::findings::list(faulty.mesh, faulty.report, camera, options), camera, raster);
  const std::string what = panel.kind ? render::findings::caption(*panel.kind, faulty.report[*panel.kind],
                                                                  faulty.mesh.dim, faulty.loops)
                                      : "the whole";
  write_caption(image, "(" + std::string(1, panel.letter) + ") " + what, panel.text, style_of(frames));
  image.stroke(image.rect(), style_of(frames).rule);
  return image;
}

/// Draws the panels row by row into a picture of a size.
render::Image draw_panels(const FaultyMesh& faulty, const render::FrameSpec& frames,
                          const std::vector<MeshFault>& kinds, const render::OverlayLayout& layout) {
  const int across = columns(kinds.size() + 1), down = (static_cast<int>(kinds.size()) + across) / across;
  FindingsPanel panel;
  panel.width = (layout.picture.width - kGap * (across - 1)) / across;
  panel.height = (layout.picture.height - kGap * (down - 1)) / down;
  panel.text = std::max(kUsualText * static_cast<float>(frames.scale()), kPanelText * layout.text_height);
  render::Image picture(layout.picture.width, layout.picture.height, style_of(frames).paper);
  render::Rasterizer rasterizer;
  for (std::size_t i = 0; i <= kinds.size(); ++i) {
    panel.kind = i == 0 ? nullptr : &kinds[i - 1];
    panel.letter = static_cast<char>('a' + i);
    picture.paste(draw_panel(rasterizer, faulty, frames, panel),
                  static_cast<int>(i) % across * (panel.width + kGap),
                  static_cast<int>(i) / across * (panel.height + kGap));
  }
  return picture;
}

/// Returns the height that the whole needs.
int height_for(std::size_t kinds, const render::FrameSpec& frames) {
  const int across = columns(kinds + 1), down = (static_cast<int>(kinds) + across) / across;
  const int cell = (frames.width - kGap * (across - 1)) / across;
  return static_cast<int>(kStrips * frames.scale()) + down * static_cast<int>(kShape * cell);
}

}  // namespace

bool draw_findings(const FaultyMesh& given, const std::string& path, const render::FrameSpec& asked) {
  const std::vector<MeshFault> kinds = render::findings::kinds(given.report);
  if (kinds.empty()) return false;
  const Mesh mesh = render::findings::to_unit_size(given.mesh);
  const FaultyMesh faulty{mesh, given.report, given.loops};
  render::FrameSpec frames = in_pixels(asked);
  for (render::FrameSpec::View& view : frames.views)
    if (view.look_at) view.look_at = render::findings::to_unit_size(given.mesh, *view.look_at);
  if (frames.height == 0) frames.height = height_for(kinds.size(), frames);
  render::Overlay overlay;
  overlay.title = std::filesystem::path(given.mesh.name).filename().string() + "  ·  " +
                  std::to_string(kinds.size()) + (kinds.size() == 1 ? " finding" : " findings");
  overlay.event = "Offenders by their numbers, counted from 0 in file order";
  overlay.key = render::findings::legend(given.report, mesh.dim, style_name(frames));
  overlay.style = style_name(frames);
  const auto scale = static_cast<float>(frames.scale());
  const render::OverlayLayout layout = render::lay_out(overlay, frames.width, frames.height, scale);
  const render::Image picture = draw_panels(faulty, frames, kinds, layout);
  render::write_png(render::compose_frame(picture, layout.picture, overlay, frames.width, frames.height,
                                          style_of(frames).paper, scale),
                    path, {{}, frames.dpi});
  return true;
}

}  // namespace lrb::run
