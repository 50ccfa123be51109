#pragma once
/// Paints draw lists on a canvas: flat lists completely, lists with depth only the lines and labels over the
/// faces.

#include "render/canvas.hpp"
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::render {

/// Paints the picture that Rasterizer::draw() gives of a scene without depth: fills, then lines and points
/// layer by layer in list order, then labels. The projection's pixels are the canvas's units, relative to
/// `origin`. Throws InputError if the list has triangles or reaches behind the camera.
void paint_flat(Canvas& canvas, const DrawList& list, const Projection& projection,
                const Eigen::Vector2d& origin = {0, 0});

/// Returns the part of the list that paint_over() does not paint, to be rasterised.
DrawList under_lines(DrawList list);

/// Paints the visible parts of the lines and points of the other layers, over faces that were painted as
/// vector graphics. Arguments as in paint_over().
void paint_visible_lines(Canvas& canvas, const DrawList& list, const Projection& projection,
                         const DepthImage& depths, const Eigen::Vector2d& origin = {0, 0});

/// Paints the lines and points of Layer::on_top and the labels over a picture of the rest. Parts hidden by
/// faces, according to `depths`, are painted as in Rasterizer::draw(): lines thinner and dashed, points as
/// rings. `depths` must be of the same list and camera.
void paint_over(Canvas& canvas, const DrawList& list, const Projection& projection, const DepthImage& depths,
                const Eigen::Vector2d& origin = {0, 0});

}  // namespace lrb::render
