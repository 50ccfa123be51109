#pragma once
/// Turns a draw list into triangles on the screen, all on the CPU in double: projection, clipping, shading,
/// snapping. What reaches the graphics library has w = 1, final colours, and corners on a grid of 1/256
/// pixel, so that rasterizers with other processors or thread counts have nothing left to disagree about.
/// Uses no graphics library.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "render/camera.hpp"
#include "render/convert.hpp"
#include "render/draw_list.hpp"

namespace lrb::render {

/// One step of DrawTriangle::nudge, as a share of the picture's height at that depth. It is small enough not
/// to uncover what visibly lies behind, and large enough to keep a line on the face it runs along.
inline constexpr double kNudge = 1.2e-4;

/// A corner of a face. Position and edge distances are interpolated linearly over the screen.
struct FaceVertex {
  glm::vec3 x{0};     ///< normalised device coordinates
  glm::vec3 edge{0};  ///< distance from the lines of the three edges, pixels; kNoEdge where not drawn
  ByteColour colour{0}, edge_colour{0};
  float half_width = 0;  ///< of edges, pixels
  std::uint32_t id = kNoId;
};
inline constexpr float kNoEdge = 1e6F;
inline constexpr float kNeverDashed = -1;  ///< As dash length: solid even where the line is ghosted.

/// A corner of the rectangle around a line segment, which is drawn as a capsule. A point is a segment of no
/// length.
struct LineVertex {
  glm::vec3 x{0};   ///< normalised device coordinates
  glm::vec2 at{0};  ///< from the segment's start, along it and to its left, pixels
  float length = 0, half_width = 0;
  float dash = 0,
        dash_start = 0;  ///< length of dashes (0: solid) and of the line before this segment, pixels
  ByteColour colour{0};
};

struct VertexRange {
  std::size_t first = 0, count = 0;
};

/// A fill by the even-odd rule: `fan` flips a stencil bit, `cover` paints where it is set.
struct FillRange {
  VertexRange fan, cover;
};

struct ScreenMesh {
  std::vector<FaceVertex> faces;
  std::vector<LineVertex> lines;
  std::vector<FillRange> fills;
  std::array<VertexRange, kLayers> face_layers, line_layers;
};

/// How faces are shaded: flat, from their normal, by lights that move with the camera, each a share of the
/// face's colour. Directions are in the camera's frame (right, up, towards the viewer) and need not be unit.
struct Lighting {
  double ambient = 0.52;
  double head = 0.18;  ///< from the viewer
  double key = 0.42;   ///< from above, left
  double fill = 0.10;  ///< from the right, below
  Eigen::Vector3d key_from{-0.45, 0.75, 0.48};
  Eigen::Vector3d fill_from{0.80, -0.35, 0.49};
};

/// Returns the colour of a face with the given unit normal; both sides are lit alike. `axes` is
/// Projection::axes().
Rgba shade(Rgba colour, const Eigen::Vector3d& normal, const Eigen::Matrix3d& axes, const Lighting& lighting);

/// Makes the screen mesh. `scale` is the number of device pixels per pixel of the final image
/// (supersampling); `projection` is in device pixels. `even_edges`: edges fade where faces are small by
/// style, not place by place.
ScreenMesh make_screen_mesh(const DrawList& list, const Projection& projection, double scale,
                            const Lighting& lighting = {}, bool even_edges = false);

}  // namespace lrb::render
