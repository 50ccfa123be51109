#pragma once
/// Pictures that commands draw, and counts of their pixels.

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/support/program.hpp"
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::test {

inline std::vector<std::string> joined(std::vector<std::string> words, const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Runs a command, which must succeed.
inline Outcome succeed(const Folder& folder, const std::vector<std::string>& command,
                       const std::vector<std::string>& more = {}) {
  Outcome o = run(folder, joined(command, more));
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  return o;
}

/// A part of a picture, as shares of its width and height.
struct Part {
  double left = 0, top = 0, right = 1, bottom = 1;
};

/// Returns the number of pixels in a part of a picture for which `is` returns true.
template <class Is>
std::size_t count_pixels(const render::Image& image, const Part& part, Is&& is) {
  const auto share = [](double s, int size) { return static_cast<int>(s * size); };
  std::size_t count = 0;
  for (int y = share(part.top, image.height()); y < share(part.bottom, image.height()); ++y)
    for (int x = share(part.left, image.width()); x < share(part.right, image.width()); ++x)
      count += is(image.at(x, y)) ? 1 : 0;
  return count;
}

/// Returns a predicate for pixels of a colour, as it is or shaded: lit faces keep the proportions of its
/// channels.
inline auto like(render::Rgba colour) {
  return [colour](render::Rgba p) {
    const double size = std::hypot(colour.r, colour.g, colour.b), other = std::hypot(p.r, p.g, p.b);
    const double dot = p.r * colour.r + p.g * colour.g + p.b * colour.b;
    return p == colour || (size > 0 && other > 0.5 * size && dot > 0.998 * size * other);
  };
}

}  // namespace lrb::test
