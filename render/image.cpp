#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>

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

namespace {

int channel_difference(Rgba a, Rgba b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
}

double share(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

bool ImageDifference::within(const ImageTolerance& tolerance) const {
  return same_size && share(large, pixels) <= tolerance.large_share &&
         share(small + medium, pixels) <= tolerance.small_share;
}

std::string ImageDifference::text(const ImageTolerance& tolerance) const {
  if (!same_size) return "the images differ in size";
  if (largest == 0) return "the images are identical";
  const double large_share = share(large, pixels), small_share = share(small + medium, pixels);
  const char* verdict = "within tolerance";
  if (large_share > tolerance.large_share) {
    verdict = "too many pixels differ strongly";
  } else if (small_share > tolerance.small_share) {
    verdict = "too many pixels differ slightly";
  }
  char line[256];
  std::snprintf(
      line, sizeof line,
      "%s: %.4f %% of pixels differ by more than %d (allowed %.4f %%), %.2f %% by less (allowed %.2f %%), "
      "largest %d",
      verdict, 100 * large_share, tolerance.large, 100 * tolerance.large_share, 100 * small_share,
      100 * tolerance.small_share, largest);
  return line;
}

ImageDifference compare(const Image& expected, const Image& actual, const ImageTolerance& tolerance) {
  ImageDifference d;
  d.same_size = expected.width() == actual.width() && expected.height() == actual.height();
  if (!d.same_size) return d;
  d.pixels = expected.pixels().size();
  for (std::size_t i = 0; i < expected.pixels().size(); ++i) {
    const int by = channel_difference(expected.pixels()[i], actual.pixels()[i]);
    d.largest = std::max(d.largest, by);
    ++(by == 0 ? d.equal : by <= tolerance.small ? d.small : by <= tolerance.large ? d.medium : d.large);
  }
  return d;
}

Image difference_image(const Image& expected, const Image& actual, int gain) {
  const int width = std::max(expected.width(), actual.width());
  const int height = std::max(expected.height(), actual.height());
  Image out(width, height, kWhite);
  const auto channel = [gain](int a, int b) {
    return static_cast<std::uint8_t>(std::min(255, std::abs(a - b) * gain));
  };
  for (int y = 0; y < std::min(expected.height(), actual.height()); ++y) {
    for (int x = 0; x < std::min(expected.width(), actual.width()); ++x) {
      const Rgba e = expected.at(x, y), a = actual.at(x, y);
      const std::uint8_t alpha = channel(e.a, a.a);
      out.at(x, y) = {std::max(channel(e.r, a.r), alpha), std::max(channel(e.g, a.g), alpha),
                      std::max(channel(e.b, a.b), alpha)};
    }
  }
  return out;
}

}  // namespace lrb::render
