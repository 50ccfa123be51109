#include "render/image.hpp"

#include <algorithm>
#include <string>

#include "engine/core/error.hpp"
#include "engine/core/fnv.hpp"

namespace lrb::render {

Image::Image(int width, int height, Rgba fill) : width_(width), height_(height) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    throw InputError("image size " + std::to_string(width) + "x" + std::to_string(height) +
                     ": each side must be 1 to " + std::to_string(kMaxSide) + " pixels");
  }
  pixels_.assign(static_cast<std::size_t>(width) * height, fill);
}

bool Image::opaque() const {
  return std::all_of(pixels_.begin(), pixels_.end(), [](Rgba p) { return p.a == 255; });
}

void Image::blend(int x, int y, Rgba colour, int coverage) {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return;
  Rgba& p = at(x, y);
  p = over(colour, p, coverage);
}

void Image::fill(const PixelRect& r, Rgba colour) {
  const int x1 = std::min(r.right(), width_), y1 = std::min(r.bottom(), height_);
  for (int y = std::max(r.y, 0); y < y1; ++y) {
    for (int x = std::max(r.x, 0); x < x1; ++x) at(x, y) = over(colour, at(x, y));
  }
}

void Image::stroke(const PixelRect& r, Rgba colour, int thickness) {
  const int t = std::min({thickness, (r.width + 1) / 2, (r.height + 1) / 2});
  fill({r.x, r.y, r.width, t}, colour);
  fill({r.x, r.bottom() - t, r.width, t}, colour);
  fill({r.x, r.y + t, t, r.height - 2 * t}, colour);
  fill({r.right() - t, r.y + t, t, r.height - 2 * t}, colour);
}

void Image::paste(const Image& image, int x, int y) {
  for (int j = 0; j < image.height(); ++j) {
    for (int i = 0; i < image.width(); ++i) blend(x + i, y + j, image.at(i, j));
  }
}

std::uint64_t hash(const Image& image) {
  static_assert(sizeof(Rgba) == 4);
  Fnv64 h;
  h.add_value(image.width());
  h.add_value(image.height());
  h.add_bytes(image.pixels().data(), image.pixels().size() * sizeof(Rgba));
  return h.value();
}

}  // namespace lrb::render
