#include "scenarios/profile/waste_picture.hpp"

#include <algorithm>
#include <filesystem>

#include "render/pictures/panel.hpp"
#include "scenarios/profile/captured_run.hpp"
#include <lrbscope/render/overlay.hpp>

namespace lrb::profile {
namespace {

/// Ratio of the ends of the scale: triangles with less than a thousandth of the maximum are pale.
constexpr double kRange = 1000;

run::Panel panel_of(const LrbRep& rep, const WasteMap& map, const render::ScaleBar& scale, bool from_behind) {
  run::Panel panel;
  panel.list.edge_styles[0] = {render::with_alpha(render::kWhite, 110), 0.8F};
  for (FaceId f = 0; f < rep.real_face_count(); ++f) {
    const double share = render::place_on(scale, map.waste[f]);
    render::DrawTriangle t;
    t.colour = share > 0 ? render::palette::viridis(share) : render::palette::kPaleFront;
    t.edges = 7;
    panel.list.add_polygon(run::corners_of(rep, f), t);
  }
  render::FitOptions fit;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ(), from = run::broadside(run::box_of(rep), up);
  fit.view = {from_behind ? Eigen::Vector3d(-from.x(), -from.y(), from.z()) : from, up};
  panel.camera = run::fit_points(run::real_corners(rep), rep.dim(), fit);
  const std::string name = std::filesystem::path(map.mesh.name).filename().string();
  panel.title = (name.empty() ? "mesh" : name) + (from_behind ? ", from behind" : "");
  panel.lighting = run::kScaleLighting;
  return panel;
}

}  // namespace

render::Image draw_waste(std::span<const WasteMap> maps) {
  double most = 0;
  for (const WasteMap& map : maps)
    most = std::max(most, *std::max_element(map.waste.begin(), map.waste.end()));
  const render::ScaleBar scale{"wasted visits per triangle (log scale)", most / kRange, most, true};
  std::vector<run::Panel> panels;
  for (const WasteMap& map : maps) {
    const bodies::LoadedBody body = captured_body(map.mesh);
    for (const bool from_behind : {false, true})
      panels.push_back(panel_of(body.rep, map, scale, from_behind));
  }
  render::Look look;
  look.width = 560;
  look.height = 460;
  render::MontageOptions options;
  options.columns = 2;
  render::Overlay overlay;
  overlay.scale = scale;
  return run::with_overlay(run::draw_sheet(panels, look, options), overlay);
}

}  // namespace lrb::profile
