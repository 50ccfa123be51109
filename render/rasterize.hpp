#pragma once
/// Draws a draw list as a camera sees it into an image. Every run gives the same bytes, with any number of
/// rasterizer threads.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render/camera.hpp"
#include "render/draw_list.hpp"
#include "render/image.hpp"
#include "render/screen_mesh.hpp"

namespace lrb::render {

struct RasterOptions {
  int width = 1280, height = 720;  ///< pixels
  int supersample = 2;             ///< samples per pixel along each axis, 1 to 4; averaged in integers
  std::optional<Rgba> background = kWhite;  ///< nothing: transparent
  Lighting lighting;
  bool labels = true;       ///< draws the list's labels (needs the font if there are any)
  double unit = 1;          ///< pixels in a unit of the list's widths and radii
  bool even_edges = false;  ///< edges of faces fade by style, not place by place: see even_edge_room()
};

/// The id of what is seen at each pixel, row by row from the top.
struct IdImage {
  int width = 0, height = 0;
  std::vector<std::uint32_t> ids;  ///< kNoId where there is nothing
  std::uint32_t at(int x, int y) const { return ids[static_cast<std::size_t>(y) * width + x]; }
};

/// The depth of what is seen at each pixel, row by row from the top, in [-1, 1] as Projection::to_screen()
/// has it.
struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> depths;  ///< 1 where there is nothing
  float at(int x, int y) const { return depths[static_cast<std::size_t>(y) * width + x]; }
};

/// Holds the context, programs and buffers from one frame to the next. Use it on the thread that made it.
class Rasterizer {
 public:
  /// Throws EnvironmentError if there is no off-screen OpenGL.
  Rasterizer();
  ~Rasterizer();
  Rasterizer(const Rasterizer&) = delete;
  Rasterizer& operator=(const Rasterizer&) = delete;

  /// Draws an image. Throws InputError for sizes out of range, EnvironmentError if the library fails.
  Image draw(const DrawList& list, const Camera& camera, const RasterOptions& options = {});

  /// Returns the ids of fills and of opaque triangles (with `translucent`: of translucent ones too, as if
  /// they were opaque), from one sample in the middle of each pixel.
  IdImage ids(const DrawList& list, const Camera& camera, int width, int height, bool translucent = false);

  /// Returns the depths of opaque triangles, from one sample in the middle of each pixel.
  DepthImage depths(const DrawList& list, const Camera& camera, int width, int height);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Draws the labels of a list over a picture of it that was drawn without them.
void draw_labels(Image& image, const DrawList& list, const Camera& camera);

}  // namespace lrb::render
