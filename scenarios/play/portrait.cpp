#include "scenarios/play/portrait.hpp"

#include <vector>

#include "engine/lrb/wrapper.hpp"
#include "render/montage.hpp"
#include "render/overlay.hpp"
#include "render/png.hpp"
#include "render/rasterize.hpp"
#include "render/scene.hpp"
#include "scenarios/play/moments.hpp"

namespace lrb {

void draw_portrait(const LrbRep& rep, const std::string& path) {
  constexpr int kWidth = 640, kHeight = 520;
  constexpr std::size_t kMostPanels = 6;
  const std::vector<Eigen::Vector3d> points = body_points(rep, Pose{});
  const Camera camera =
      rep.dim() == 2 ? fit_top(points, kWidth, kHeight) : fit_camera(points, kWidth, kHeight);
  RasterOptions options;
  options.width = kWidth;
  options.height = kHeight;
  Rasterizer rasterizer;
  std::vector<Panel> panels;
  // Layers [0, hidden) are included: none is the body itself, all is the outermost wrapper.
  for (const std::size_t hidden : evenly(rep.layer_count() + std::size_t{1}, kMostPanels)) {
    Wrapper wrapper(rep);
    for (RegionId r = 0; r < rep.region_count(); ++r)
      if (rep.layer(r) >= hidden) wrapper.refine(r);
    SceneBody body;
    body.rep = &rep;
    body.wrapper = &wrapper;
    const Scene scene = build_scene(std::vector<SceneBody>{body});
    panels.push_back(
        {rasterizer.draw(scene.list, camera, options), group_digits(wrapper.boundary_size()) + " faces"});
  }
  write_png(montage(panels), path);
}

}  // namespace lrb
