#pragma once
/// Measures how much room the edges of triangles have on the screen. Where there is little of it edges have
/// to fade, or dense meshes turn black.

#include <vector>

#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>

namespace lrb::render {

/// Returns for every triangle the altitude on the screen, in the projection's pixels, that it and the
/// triangles around it have: the mean over its corners of the mean over the triangles that share the corner
/// and the edge style. (A triangle's altitude is its lowest one.) Altitudes of single triangles jump from
/// each to the next, and edges that fade by them look patchy; these means change little by little. 0 for
/// triangles without edges.
std::vector<double> edge_room(const DrawList& list, const Projection& projection);

/// Returns, for each triangle with edges, the median room of its style, weighted by area on the screen. Edges
/// of a style then fade together: a mesh shows all of them, or none.
std::vector<double> even_edge_room(const DrawList& list, const Projection& projection);

/// Rises smoothly from 0 at `gone` to 1 at `full`.
double fade_between(double x, double gone, double full);

}  // namespace lrb::render
