#include "render/pictures/body_picture.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include <Eigen/Geometry>

#include <lrbscope/wrapper.hpp>

namespace lrb::pictures {

using namespace render;
using Eigen::Vector3d;

namespace {

/// Returns the camera of the look's first view.
CameraFit first_camera(const Look& look, std::vector<Vector3d> points, int dim) {
  return [view = look.first_view(), framing = Framing{std::move(points), {}, dim}](
             double width, double height) { return camera_for(view, framing, width, height); };
}

}  // namespace

Image body_sheet(const LrbRep& rep, const Look& look) {
  constexpr std::size_t kMaxPanels = 6;
  const CameraFit camera = first_camera(look, body_points(rep, Pose{}), rep.dim());
  SceneOptions options;
  options.style = look.style;
  options.scale = static_cast<float>(look.scale()) * style_of(look.style).weight;
  std::vector<Panel> panels;
  // Includes layers [0, hidden): no layer is the body itself, all layers are the outermost wrapper.
  for (const std::size_t hidden : evenly(rep.layer_count() + std::size_t{1}, kMaxPanels)) {
    Wrapper wrapper(rep);
    for (RegionId r = 0; r < rep.region_count(); ++r)
      if (rep.layer(r) >= hidden) wrapper.refine(r);
    SceneBody body;
    body.rep = &rep;
    body.wrapper = &wrapper;
    panels.push_back(
        {build_scene({&body, 1}, {}, options).list, camera,
         group_digits(wrapper.boundary_size()) +
             (rep.region_count() > 0 ? " faces" : " faces: the body itself, which has no wrappers")});
  }
  return draw_sheet(panels, look);
}

namespace {

constexpr double kAround = 1.25;    // extent of a close-up, relative to the region
constexpr double kMinShown = 0.02;  // minimum extent of a close-up, relative to the body
constexpr double kTilt = 0.45;      // weight of the usual direction, added to the outlook of the lids

constexpr Rgba kLids = palette::kOrange;
constexpr double kPseudoPale = 0.55;  // of the body's colour
constexpr std::uint8_t kLidAlpha = 95, kGhostAlpha = 26;

/// Draws the panels of a contact sheet of regions.
class RegionSheet {
 public:
  RegionSheet(const LrbRep& rep, const Look& look) : rep_(rep), look_(look), style_(style_of(look.style)) {
    for (const FaceId f : rep.outermost_faces())
      for (const Vector3d& x : corners_of(rep, f)) box_.extend(x);
    scale_ = static_cast<float>(look.scale()) * style_.weight;
  }

  /// Returns the panel of the body, coloured by the values on a scale.
  Panel whole(std::span<const double> values, const ScaleBar& scale) const {
    DrawList list;
    for (FaceId f = 0; f < rep_.real_face_count(); ++f) {
      DrawTriangle like;
      like.colour = style_.value(place_on(scale, values[f]));
      add(list, f, like, 4);
    }
    return {list, first_camera(look_, real_corners(rep_), rep_.dim()), scale.text, false, kScaleLighting};
  }

  Panel close_up(const ShownRegion& shown) const {
    DrawList list;
    DrawTriangle floor, lid, rest;
    floor.edges = lid.edges = 7;
    floor.edge_style = list.edge_style({with_alpha(palette::kInk, 150), 0.9F * scale_});
    lid.edge_style = list.edge_style({with_alpha(style_.edge_of(kLids), 230), 1.5F * scale_, 0.4F});
    lid.layer = rest.layer = Layer::translucent;
    lid.nudge = 1;  // in a region without volume a lid lies on its floor
    lid.colour = with_alpha(kLids, kLidAlpha);
    rest.colour = with_alpha(real_colour(), kGhostAlpha);
    std::vector<bool> of_region(rep_.face_count(), false);
    for (const FaceId f : rep_.collector(shown.region)) of_region[f] = true;
    for (const FaceId f : rep_.floor(shown.region)) {
      floor.colour = rep_.is_real(f) ? real_colour() : pseudo_colour();
      add(list, f, floor, 4);
    }
    for (const FaceId f : rep_.lids(shown.region)) add(list, f, lid, 4);
    for (FaceId f = 0; f < rep_.real_face_count(); ++f)
      if (!of_region[f]) add(list, f, rest, 2);
    return {list, camera_of(shown.region), shown.caption, false};
  }

  std::vector<LegendItem> key() const {
    return {{Mark::translucent, kLids, "lids of the region"},
            {Mark::solid, real_colour(), "real faces that it hides"},
            {Mark::solid, pseudo_colour(), "lids that it hides"},
            {Mark::translucent, with_alpha(real_colour(), kGhostAlpha), "the rest of the body"}};
  }

 private:
  Rgba real_colour() const { return style_.body(Side::a); }
  Rgba pseudo_colour() const { return style_.pale(real_colour(), kPseudoPale); }

  /// Adds a face; in 2D as a line of this width in screen pixels.
  void add(DrawList& list, FaceId f, const DrawTriangle& like, float width) const {
    if (rep_.dim() == 3) return list.add_polygon(corners_of(rep_, f), like);
    DrawLine line;
    line.points = corners_of(rep_, f);
    line.colour = like.colour;
    line.width = width * scale_;
    list.lines.push_back(std::move(line));
  }

  CameraFit camera_of(RegionId r) const {
    const std::vector<Vector3d> points = region_corners(rep_, r);
    if (rep_.dim() == 2) {
      const Eigen::AlignedBox3d around = bounds(points);
      const Vector3d more =
          0.5 * (kAround - 1) * around.sizes() + Vector3d(1, 1, 0) * kMinShown * box_.sizes().norm();
      return fit_points({around.min() - more, around.max() + more}, 2);
    }
    const Look::View view = look_.first_view();
    FitOptions fit;
    fit.view = {view.from, view.up};
    fit.orthographic = view.orthographic;
    const Vector3d out = outlook(rep_, r), from = out + kTilt * view.from.normalized();
    if (out.norm() > 0 && from.normalized().cross(view.up.normalized()).norm() > 0.1) fit.view.from = from;
    return [points, box = box_, fit](double width, double height) {
      return fit_contact(points, box, width, height, fit, kAround, kMinShown);
    };
  }

  const LrbRep& rep_;
  const Look& look_;
  const Style& style_;
  Eigen::AlignedBox3d box_;
  float scale_;
};

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
  constexpr double kAllRound = 0.2;  // of the lids' area; below it the lids face nearly all directions
  return area > 0 && sum.norm() > kAllRound * area ? Vector3d(sum.normalized()) : Vector3d::Zero();
}

Image region_sheet(const LrbRep& rep, std::span<const double> values, const std::string& name,
                   std::span<const ShownRegion> regions, const Look& look) {
  const RegionSheet sheet(rep, look);
  constexpr double kRange = 1000;  // ratio of the ends of the scale
  const double most = values.empty() ? 0 : *std::max_element(values.begin(), values.end());
  Overlay overlay;
  overlay.title = rep.name() + ": where its wrappers waste most";
  overlay.event = "(a) the body; then the worst regions, seen from where their lids look";
  overlay.scale = ScaleBar{name, most > 0 ? most / kRange : 1e-3, most > 0 ? most : 1, true};
  overlay.key = sheet.key();
  overlay.style = look.style;
  std::vector<Panel> panels = {sheet.whole(values, *overlay.scale)};
  for (const ShownRegion& r : regions) panels.push_back(sheet.close_up(r));
  MontageOptions options;
  options.columns = panels.size() > 6 ? 4 : 3;
  options.frame = true;
  return with_overlay(draw_sheet(panels, look, options), overlay, look.scale());
}

namespace {

/// Returns the numbers of the first few regions of a set.
std::string list_of(const std::set<std::uint32_t>& regions) {
  constexpr std::size_t kMax = 6;
  std::string out;
  std::size_t count = 0;
  for (const std::uint32_t r : regions) {
    if (count++ == kMax) return out + ", ...";
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
                    counted(rep.lids(r).size(), "lid", "lids") + " over " +
                    counted(rep.floor(r).size(), "face", "faces");
  if (real > 0) out += ", " + group_digits(real) + " of them real";
  out += "; parent " + (is_region(rep.parent(r)) ? std::to_string(rep.parent(r)) : "the outside");
  if (!outside.empty()) out += "; also under " + list_of(outside);
  if (!inside.empty()) out += "; hides " + list_of(inside);
  return out;
}

}  // namespace

std::string region_text(const LrbRep& rep, std::span<const RegionId> regions, const std::string& owner) {
  if (regions.size() == 1) return words_of_one(rep, regions[0], owner);
  std::size_t lids = 0, floor = 0;
  std::set<std::uint32_t> layers, numbers;
  for (const RegionId r : regions) {
    lids += rep.lids(r).size();
    floor += rep.floor(r).size();
    layers.insert(rep.layer(r));
    numbers.insert(r);
  }
  return counted(regions.size(), "region", "regions") + owner + " (" + list_of(numbers) + "): layer" +
         (layers.size() == 1 ? " " : "s ") + list_of(layers) + ", " + counted(lids, "lid", "lids") +
         " over " + counted(floor, "face", "faces");
}

// Findings.

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

/// The grid of panels: the whole mesh, then one panel per kind, then further loops of open edges.
struct Grid {
  explicit Grid(std::size_t kinds)
      : panels(static_cast<int>(kinds) + 1),
        across(panels == 2 || panels == 4 ? 2 : 3),
        down((panels + across - 1) / across) {}
  int width_of(int whole) const { return (whole - kGap * (across - 1)) / across; }
  int height_of(int whole) const { return (whole - kGap * (down - 1)) / down; }
  int panels, across, down;
};

/// Draws the whole mesh or, if there is a `kind`, a close-up of its first finding, or of a later loop.
Image draw_one(Rasterizer& rasterizer, const FaultyMesh& faulty, const Look& look, const MeshFault* kind,
               std::size_t loop, const PixelRect& place, float text) {
  findings::Options options;
  options.loops = faulty.loops;
  options.crossings = faulty.crossings;
  options.style = look.style;
  options.scale = text / kUsualText;
  options.width = place.width;
  options.height = place.height;
  CameraFit fit = whole_camera(faulty, look);
  if (kind != nullptr) {
    const findings::CloseUp close =
        findings::close_up(faulty.mesh, faulty.report, *kind, std::span(faulty.loops).subspan(loop));
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
  FaultyMesh faulty{mesh, given.report, given.loops, given.crossings};
  for (auto& ends : faulty.crossings)
    for (Eigen::Vector3d& x : ends) x = findings::to_unit_size(given.mesh, x);
  constexpr std::size_t kMaxLoops = 4;
  std::vector<MeshFault> shown = kinds;
  for (std::size_t loop = 1; loop < std::min(faulty.loops.size(), kMaxLoops); ++loop)
    shown.push_back(MeshFault::open_edge);
  const Grid grid(shown.size());
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
    const auto panel_number = static_cast<std::size_t>(i);
    const MeshFault* kind = i == 0 ? nullptr : &shown[panel_number - 1];
    const std::size_t loop = panel_number > kinds.size() ? panel_number - kinds.size() : 0;
    Image panel = draw_one(rasterizer, faulty, look, kind, loop, place, text);
    const std::string what = kind == nullptr ? "the whole"
                             : loop > 0
                                 ? "loop " + std::to_string(loop) + ", of " +
                                       counted(faulty.loops[loop].edges(), "open edge", "open edges")
                                 : findings::caption(*kind, faulty.report[*kind], mesh.dim, faulty.loops);
    write_caption(panel, panel_letter(panel_number) + " " + what, text, style);
    panel.stroke(panel.rect(), style.rule);
    picture.paste(panel, place.x, place.y);
  }
  return compose_frame(picture, layout.picture, overlay, look.width, look.height, style.paper, scale);
}

}  // namespace lrb::pictures
