#include "scenarios/run/body_sheet.hpp"

#include <vector>

#include "engine/lrb/wrapper.hpp"
#include "render/montage.hpp"
#include "render/overlay.hpp"
#include "render/png.hpp"
#include "render/rasterize.hpp"
#include "render/scene.hpp"
#include "scenarios/run/frame_files.hpp"
#include "scenarios/run/view_camera.hpp"

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

}  // namespace lrb::run
