#pragma once
/// Renders a draw list to an image through a camera. Every run gives the same bytes, with any number of
/// rasterizer threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <lrbscope/render/camera.hpp>
#include <lrbscope/render/draw_list.hpp>
#include <lrbscope/render/image.hpp>

namespace lrb::render {

// Turns a draw list into screen triangles on the CPU in double: projection, clipping, shading, snapping.
// OpenGL receives w = 1, final colours, and corners on a grid of 1/256 pixel, so that rasterizers on other
// processors or with other thread counts give the same result. Does not depend on OpenGL.

/// One step of DrawTriangle::nudge, as a share of the picture's height at that depth. Small enough not to
/// uncover what is visibly behind, and large enough to keep a line on the face that it follows.
inline constexpr double kNudge = 1.2e-4;

/// A corner of a face. Position and edge distances are interpolated linearly over the screen.
struct FaceVertex {
  glm::vec3 x{0};     ///< normalised device coordinates
  glm::vec3 edge{0};  ///< distance from the lines of the three edges, pixels; kNoEdge if not drawn
  ByteColour colour{0}, edge_colour{0};
  float half_width = 0;  ///< of edges, pixels
  std::uint32_t id = kNoId;
};
inline constexpr float kNoEdge = 1e6F;
inline constexpr float kNeverDashed = -1;  ///< Dash length of a line that stays solid even when ghosted.

/// A corner of the rectangle around a line segment, which is drawn as a capsule. A point is a segment of
/// length 0.
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

/// Flat shading of faces from their normal, by lights that move with the camera. Each light is a share of the
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
/// (supersampling); `projection` is in device pixels. `even_edges`: edges fade by style where faces are
/// small, not individually.
ScreenMesh make_screen_mesh(const DrawList& list, const Projection& projection, double scale,
                            const Lighting& lighting = {}, bool even_edges = false);

struct RasterOptions {
  int width = 1280, height = 720;  ///< pixels
  int supersample = 2;             ///< samples per pixel along each axis, 1 to 4; averaged in integers
  std::optional<Rgba> background = kWhite;  ///< nullopt: transparent
  Lighting lighting;
  bool labels = true;       ///< draws the list's labels (needs the font if the list has any)
  double unit = 1;          ///< pixels per unit of the list's widths and radii
  bool even_edges = false;  ///< edges of faces fade by style, not individually: see even_edge_spacing()
};

/// The id of the visible primitive at each pixel, row by row from the top.
struct IdImage {
  int width = 0, height = 0;
  std::vector<std::uint32_t> ids;  ///< kNoId on the background
  std::uint32_t at(int x, int y) const { return ids[static_cast<std::size_t>(y) * width + x]; }
};

/// The visible depth at each pixel, row by row from the top, in [-1, 1] as returned by
/// Projection::to_screen().
struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> depths;  ///< 1 on the background
  float at(int x, int y) const { return depths[static_cast<std::size_t>(y) * width + x]; }
  /// Returns true if nothing hides a point in the world, seen by the projection that drew this image, or
  /// hides it only by up to `heights`: see Projection::nearer(). Outside the image, the closest pixel counts.
  bool shows(const Projection& projection, const Eigen::Vector3d& point, double heights) const;
};

/// Keeps the context, programs and buffers between frames. One thread at a time may use it.
class Rasterizer {
 public:
  /// Throws EnvironmentError if off-screen OpenGL is not available.
  Rasterizer();
  ~Rasterizer();
  Rasterizer(const Rasterizer&) = delete;
  Rasterizer& operator=(const Rasterizer&) = delete;

  /// Draws an image. Throws InputError for sizes out of range, EnvironmentError if OpenGL fails.
  Image draw(const DrawList& list, const Camera& camera, const RasterOptions& options = {});

  /// Returns the ids of fills and opaque triangles, sampled once at the centre of each pixel. With
  /// `translucent`, also of translucent triangles, as if they were opaque.
  IdImage ids(const DrawList& list, const Camera& camera, int width, int height, bool translucent = false);

  /// Returns the depths of opaque triangles, sampled once at the centre of each pixel.
  DepthImage depths(const DrawList& list, const Camera& camera, int width, int height);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Draws the labels of a list over an image of the list that was drawn without them.
void draw_labels(Image& image, const DrawList& list, const Camera& camera);

}  // namespace lrb::render
