#pragma once
/// Ambient occlusion: faces in creases and gaps get less light from the sky.

#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::render {

/// Darkens each opaque lit triangle by the share of directions, weighted by the cosine to its normal, in
/// which opaque triangles hide the sky from its centroid. The result does not depend on a camera.
void add_ambient_occlusion(DrawList& list, Rasterizer& rasterizer);

}  // namespace lrb::render
