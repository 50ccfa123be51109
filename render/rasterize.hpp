#pragma once
/// Draw list + camera + size -> pixels. The same bytes from every run and for every number of rasterizer
/// threads.

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
  bool labels = true;  ///< draws the list's labels (needs the font if there are any)
};

/// The id of what is seen at each pixel; rows from the top.
struct IdImage {
  int width = 0, height = 0;
  std::vector<std::uint32_t> ids;  ///< kNoId where there is nothing
  std::uint32_t at(int x, int y) const { return ids[static_cast<std::size_t>(y) * width + x]; }
};

/// Holds the context, programs and buffers, so that frame follows frame. Use it on the thread that made it.
class Rasterizer {
 public:
  /// Throws EnvironmentError if there is no off-screen OpenGL.
  Rasterizer();
  ~Rasterizer();
  Rasterizer(const Rasterizer&) = delete;
  Rasterizer& operator=(const Rasterizer&) = delete;

  /// Throws InputError for sizes out of range, EnvironmentError if the library fails.
  Image draw(const DrawList& list, const Camera& camera, const RasterOptions& options = {});

  /// Ids of fills and of triangles of the opaque layer (with `translucent`: of those too, as if opaque), one
  /// sample in the middle of each pixel.
  IdImage ids(const DrawList& list, const Camera& camera, int width, int height, bool translucent = false);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Draws the labels of a list over a picture that was taken of it without.
void draw_labels(Image& image, const DrawList& list, const Camera& camera);

}  // namespace lrb::render
