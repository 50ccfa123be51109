#include "render/pictures/findings_picture.hpp"

#include <algorithm>
#include <filesystem>

namespace lrb::run {

using namespace render;
using Eigen::Vector3d;

namespace {

constexpr int kGap = 4, kStrips = 120;    // screen pixels: between panels, for title and legend
constexpr double kShape = 0.72;           // height / width of a panel
constexpr float kPanelText = 0.8F;        // text size of panels / of the title
constexpr double kLonely = 0.5;           // around a point without faces, relative to the body
constexpr float kUsualText = 16;          // pixels: text height at which lines and points have scale 1
constexpr double kCloseUpContext = 1.15;  // relative to the detail
constexpr double kLoopContext = 1.6;      // relative to a boundary loop, to show its surroundings
constexpr double kMinCloseUp = 1e-6;      // in a close-up of a point, relative to the body

/// Returns the camera of a close-up. `close`: of the kind.
CameraFit close_camera(const FaultyMesh& faulty, MeshFault kind, const findings::CloseUp& close) {
  FitOptions fit;
  fit.margin = 0.1;  // for labels and the caption
  fit.view = close.view;
  const Eigen::AlignedBox3d box = bounds(findings::whole(faulty.mesh, faulty.report));
  const Eigen::AlignedBox3d part = bounds(close.points);
  const bool lone = !(part.diagonal().norm() > 0);
  std::vector<Vector3d> points = close.points;
  if (faulty.mesh.dim == 3) {
    const bool loop = kind == MeshFault::open_edge && !faulty.loops.empty();
    return [=](double width, double height) {
      return fit_contact(points, box, width, height, fit, loop ? kLoopContext : kCloseUpContext,
                         lone ? kLonely : kMinCloseUp);
    };
  }
  if (lone)
    for (const double side : {-0.05, 0.05}) points.push_back(part.center() + side * box.diagonal());
  return [=](double width, double height) { return fit_top(points, width, height, fit.margin); };
}

/// Returns the camera of the whole, with room for the caption.
CameraFit whole_camera(const FaultyMesh& faulty, const Look& look) {
  constexpr double kCaptionRoom = 0.92;
  Look::View view = look.first_view();
  view.zoom *= kCaptionRoom;
  const Framing framing{findings::whole(faulty.mesh, faulty.report), {}, faulty.mesh.dim};
  return [view, framing](double width, double height) { return camera_for(view, framing, width, height); };
}

void write_caption(Image& panel, const std::string& text, float height, const Style& style) {
  TextStyle caption;
  caption.height = height;
  caption.colour = style.ink;
  caption.halo = style.paper;
  caption.halo_width = 3;
  int y = 6;
  for (const std::string& line : default_font().wrap(text, panel.width() - 16, caption)) {
    default_font().draw(panel, line, 8, y, caption);
    y += static_cast<int>(1.25F * height);
  }
}

/// The grid of panels: the whole mesh, then one panel per kind.
struct Grid {
  explicit Grid(std::size_t kinds)
      : panels(static_cast<int>(kinds) + 1),
        across(panels == 2 || panels == 4 ? 2 : 3),
        down((panels + across - 1) / across) {}
  int width_of(int whole) const { return (whole - kGap * (across - 1)) / across; }
  int height_of(int whole) const { return (whole - kGap * (down - 1)) / down; }
  int panels, across, down;
};

/// Draws the whole mesh or, if there is a `kind`, a close-up of its first finding.
Image draw_one(Rasterizer& rasterizer, const FaultyMesh& faulty, const Look& look, const MeshFault* kind,
               const PixelRect& place, float text) {
  findings::Options options;
  options.loops = faulty.loops;
  options.style = look.style;
  options.scale = text / kUsualText;
  options.width = place.width;
  options.height = place.height;
  CameraFit fit = whole_camera(faulty, look);
  if (kind != nullptr) {
    const findings::CloseUp close = findings::close_up(faulty.mesh, faulty.report, *kind, faulty.loops);
    options.focus = *kind;
    options.near = bounds(close.points);
    fit = close_camera(faulty, *kind, close);
  }
  const DrawList list = findings::list(faulty.mesh, faulty.report, fit(place.width, place.height), options);
  return draw_panel(rasterizer, {list, fit, "", false}, look, place.width, place.height);
}

}  // namespace

std::optional<Image> picture_of(const FaultyMesh& given, const Look& requested) {
  const std::vector<MeshFault> kinds = findings::kinds(given.report);
  if (kinds.empty()) return std::nullopt;
  const Mesh mesh = findings::to_unit_size(given.mesh);
  const FaultyMesh faulty{mesh, given.report, given.loops};
  const Grid grid(kinds.size());
  Look look = requested;
  for (Look::View& view : look.views)
    if (view.look_at) view.look_at = findings::to_unit_size(given.mesh, *view.look_at);
  if (look.height == 0)
    look.height = static_cast<int>(kStrips * look.scale()) +
                  grid.down * static_cast<int>(kShape * grid.width_of(look.width));
  Overlay overlay;
  overlay.title = std::filesystem::path(given.mesh.name).filename().string() + "  ·  " +
                  counted(kinds.size(), "finding", "findings");
  overlay.event = "Labels: numbers of the affected elements, counted from 0 in file order";
  overlay.key = findings::legend(given.report, mesh.dim, look.style);
  overlay.style = look.style;
  const auto scale = static_cast<float>(look.scale());
  const Style& style = style_of(look.style);
  const OverlayLayout layout = lay_out(overlay, look.width, look.height, scale);
  const float text = std::max(kUsualText * scale, kPanelText * layout.text_height);
  Image picture(layout.picture.width, layout.picture.height, style.paper);
  Rasterizer rasterizer;
  for (int i = 0; i < grid.panels; ++i) {
    PixelRect place{0, 0, grid.width_of(picture.width()), grid.height_of(picture.height())};
    place.x = i % grid.across * (place.width + kGap);
    place.y = i / grid.across * (place.height + kGap);
    const MeshFault* kind = i == 0 ? nullptr : &kinds[static_cast<std::size_t>(i) - 1];
    Image panel = draw_one(rasterizer, faulty, look, kind, place, text);
    write_caption(
        panel,
        panel_letter(static_cast<std::size_t>(i)) + " " +
            (kind == nullptr ? "the whole"
                             : findings::caption(*kind, faulty.report[*kind], mesh.dim, faulty.loops)),
        text, style);
    panel.stroke(panel.rect(), style.rule);
    picture.paste(panel, place.x, place.y);
  }
  return compose_frame(picture, layout.picture, overlay, look.width, look.height, style.paper, scale);
}

}  // namespace lrb::run
