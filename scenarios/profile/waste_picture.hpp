#pragma once
/// Where on a mesh the visits of an engine's traversal are wasted.

#include <span>
#include <string>
#include <vector>

#include <lrbscope/render/image.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

struct WasteMap {
  capture::Mesh mesh;
  std::vector<double> waste;  ///< (|triangles|) wasted visits: PriceBook::waste_by_triangle()
};

/// Draws each mesh from two opposite sides, with its triangles coloured by their waste on one logarithmic
/// scale. Throws EnvironmentError if this machine cannot render.
render::Image draw_waste(std::span<const WasteMap> maps);

}  // namespace lrb::profile
