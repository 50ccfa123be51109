#pragma once
/// How much room the edges of triangles have on the screen: where it is scarce they have to fade, or dense
/// meshes turn black.

#include <vector>

#include "render/camera.hpp"
#include "render/draw_list.hpp"

namespace lrb::render {

/// For every triangle of the list the altitude on the screen (pixels of the projection, of the lowest one) of
/// itself and of the triangles round about it: the mean over its corners of the mean over the triangles that
/// share the corner and the edge style. A triangle's own altitude jumps from each to the next, and edges that
/// fade by it look patchy; this changes little by little. 0 for triangles without edges.
std::vector<double> edge_room(const DrawList& list, const Projection& projection);

/// The smooth step from 0 at `gone` to 1 at `full`.
double fade_between(double x, double gone, double full);

}  // namespace lrb::render
