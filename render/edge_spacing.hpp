#pragma once
/// Measures the space that the edges of triangles have on the screen. Where there is little, edges must fade:
/// otherwise dense meshes would turn black.

#include <vector>

#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>

namespace lrb::render {

/// Returns for every triangle the smoothed altitude on the screen, in the projection's pixels: the mean over
/// its corners of the mean over the triangles that share the corner and the edge style. (A triangle's
/// altitude is its smallest.) Altitudes of single triangles vary abruptly, and edges that fade by them look
/// patchy; these means vary gradually. 0 for triangles without edges.
std::vector<double> edge_spacing(const DrawList& list, const Projection& projection);

/// The spacing of the edges of one style, in pixels.
struct StyleSpacing {
  double all = 0;  ///< median altitude of the triangles, weighted by area on the screen
  /// Mean spacing of borders alone: the altitude of equilateral triangles with as much edge length in the
  /// same area. Infinite: the style has none.
  double borders = 0;
};

/// Returns the spacing of each style, so that all edges of a style fade together.
std::vector<StyleSpacing> even_edge_spacing(const DrawList& list, const Projection& projection);

/// Rises smoothly from 0 at `gone` to 1 at `full`.
double fade_between(double x, double gone, double full);

}  // namespace lrb::render
