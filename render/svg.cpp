#include "render/svg.hpp"

#include "engine/core/error.hpp"
#include "render/paint_list.hpp"
#include "render/svg_canvas.hpp"

namespace lrb::render {

std::string svg(const DrawList& list, const Camera& camera, const SvgOptions& options) {
  if (!list.triangles.empty()) {
    throw InputError("a 3D scene cannot be written as SVG: draw it as a PNG, at a larger size for print");
  }
  SvgCanvas canvas;
  paint_flat(canvas, list, Projection(camera, options.width, options.height, bounds(list)));
  return svg_file(
      canvas, {options.width, options.height, options.units_per_pixel, options.title, options.background});
}

}  // namespace lrb::render
