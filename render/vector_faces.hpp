#pragma once
/// Draws the faces of a scene with depth as vector graphics, with hidden surfaces removed exactly.
///
/// Method: faces that are hidden entirely are removed by a depth image. The others are painted from back to
/// front. The order is a topological sort of the pairs that overlap on the screen (Newell, Newell and Sancha
/// 1972); faces that intersect, or overlap cyclically, are split. Each face is painted with its edges, so
/// that nearer faces cover them.

#include <cstdint>
#include <optional>
#include <vector>

#include "render/canvas.hpp"
#include "render/face_look.hpp"
#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/rasterize.hpp>

namespace lrb::render {

/// Returns the indices of the triangles that are visible somewhere, ascending: those that no opaque triangle
/// hides entirely. `depths` is of the same list and camera; a triangle that is visible only between the
/// centres of its pixels may be missing. Returns nullopt if a triangle is on top of others or reaches behind
/// the camera: such scenes cannot be painted by painting_order().
std::optional<std::vector<std::uint32_t>> visible_faces(const DrawList& list, const Projection& projection,
                                                        const DepthImage& depths);

/// A convex part of a visible face. Lengths are in pixels of the projection, x to the right, y down.
struct ScreenFace {
  std::uint32_t triangle = 0;  ///< index in the list
  std::vector<Eigen::Vector2d> corners;
  std::vector<std::int8_t> edges;  ///< (corners) edge of the triangle from each corner to the next; -1: a cut
  Eigen::Vector3d depth{0, 0, 0};  ///< depth at (x, y): depth . (x, y, 1)
  double depth_at(const Eigen::Vector2d& x) const {
    return depth.x() * x.x() + depth.y() * x.y() + depth.z();
  }
};

/// Returns the triangles or their parts in painting order, farthest first. Triangles seen edge-on are
/// omitted. `looks` must be of the same list and projection. Returns nullopt if the triangles intersect so
/// often that they would have more than 10,000 parts, and more than eight on average, or if more than 4
/// million pairs overlap on the screen.
std::optional<std::vector<ScreenFace>> painting_order(const DrawList& list, const Projection& projection,
                                                      const FaceLooks& looks,
                                                      const std::vector<std::uint32_t>& triangles);

/// Paints faces in order, each with its edges.
void paint_faces(Canvas& canvas, const DrawList& list, const std::vector<ScreenFace>& faces,
                 const FaceLooks& looks, const Eigen::Vector2d& origin);

}  // namespace lrb::render
