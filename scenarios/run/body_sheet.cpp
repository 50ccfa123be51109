#include "scenarios/run/body_sheet.hpp"

#include <vector>

#include "engine/lrb/wrapper.hpp"
#include "render/montage.hpp"
#include "render/overlay.hpp"
#include "render/png.hpp"
#include "render/rasterize.hpp"
#include "render/scene.hpp"
#include "scenarios/run/moments.hpp"

namespace lrb::run {

void draw_body_sheet(const LrbRep& rep, const std::string& path) {
  constexpr int kWidth = 640, kHeight = 520;
  constexpr std::size_t kMostPanels = 6;
  const std::vector<Eigen::Vector3d> points = render::body_points(rep, Pose{});
  const render::Camera camera =
      rep.dim() == 2 ? render::fit_top(points, kWidth, kHeight) : render::fit_camera(points, kWidth, kHeight);
  render::RasterOptions options;
  options.width = kWidth;
  options.height = kHeight;
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
    const render::Scene scene = render::build_scene(std::vector<render::SceneBody>{body});
    panels.push_back({rasterizer.draw(scene.list, camera, options),
                      render::group_digits(wrapper.boundary_size()) + " faces"});
  }
  render::write_png(render::montage(panels), path);
}

}  // namespace lrb::run
