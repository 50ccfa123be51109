#include "render/page_palette.hpp"

#include <cstdio>
#include <vector>

namespace lrb::render {
namespace {

using Colours = std::vector<PageColour>;

Colours operator+(Colours colours, std::span<const PageColour> more) {
  colours.insert(colours.end(), more.begin(), more.end());
  return colours;
}

}  // namespace

std::string css(Rgba c) {
  std::array<char, 8> hex{};
  std::snprintf(hex.data(), hex.size(), "#%02x%02x%02x", c.r, c.g, c.b);
  return hex.data();
}

std::string root_css(std::span<const PageColour> colours) {
  std::string light, dark;
  for (const PageColour& c : colours) {
    const std::string name = " --" + std::string(c.name) + ": ";
    light += name + css(c.light) + ";";
    dark += name + css(c.dark) + ";";
  }
  return ":root {" + light + " }\n@media (prefers-color-scheme: dark) {\n  :root {" + dark + " }\n}\n";
}

std::string page_root_css() {
  using namespace page;
  return root_css(Colours{kPaper, kCard, kInk, kSoft, kLine, kAccent, kGrid, kBad, kGood} + kSeries);
}

std::string grid_root_css() {
  using namespace page;
  return root_css(Colours{kWrong, kCrashed, kTimedOut, kRejected, kOnlyRejected} + kLevels +
                  Colours{kOnLevel4});
}

}  // namespace lrb::render
