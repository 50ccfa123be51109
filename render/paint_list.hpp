#pragma once
/// Paints draw lists on a canvas: flat ones wholly, of those with depth what lies over the faces.

#include "render/canvas.hpp"
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::render {

/// Paints what Rasterizer::draw() gives of a scene without depth: fills, then lines and points layer by layer
/// in the order of the list, then labels. The projection's pixels are the canvas's units, from `origin` on.
/// Throws InputError if the list has triangles, or reaches behind the camera.
void paint_flat(Canvas& canvas, const DrawList& list, const Projection& projection,
                const Eigen::Vector2d& origin = {0, 0});

/// Returns the list without what paint_over() paints: to be drawn as pixels.
DrawList under_lines(DrawList list);

/// Paints the lines and points of Layer::on_top and the labels over a picture of the rest. What the faces
/// hide, by their depths, is painted as Rasterizer::draw() does: lines thinner and dashed, points as rings.
/// `depths` are of the same list and camera.
void paint_over(Canvas& canvas, const DrawList& list, const Projection& projection, const DepthImage& depths,
                const Eigen::Vector2d& origin = {0, 0});

}  // namespace lrb::render
