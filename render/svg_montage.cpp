#include "render/svg_montage.hpp"

#include "engine/core/error.hpp"
#include "render/markup.hpp"
#include "render/svg_text.hpp"

namespace lrb::render {
namespace {

using namespace svg_text;

/// Returns a whole picture as an element of another one.
std::string nested(const std::string& panel, const PixelRect& r) {
  const std::size_t start = panel.find("viewBox");
  if (start == std::string::npos) throw InputError("a montage of SVG needs panels that are SVG");
  return "<svg" + attribute("x", number(r.x)) + attribute("y", number(r.y)) +
         attribute("width", number(r.width)) + attribute("height", number(r.height)) + " " +
         panel.substr(start);
}

std::string centred(const std::string& line, double x, double y, double height, Rgba ink) {
  return "<text" + attribute("x", number(x)) + attribute("y", number(y)) + font(height) +
         attribute("text-anchor", "middle") + attribute("dominant-baseline", "central") + paint("fill", ink) +
         ">" + escape_markup(line) + "</text>\n";
}

}  // namespace

std::string svg_montage(const std::vector<std::string>& panels, const MontageLayout& layout,
                        const SvgMontageOptions& options) {
  std::string out = svg_open(layout.width, layout.height, options.units_per_pixel);
  if (!options.title.empty()) out += "<title>" + escape_markup(options.title) + "</title>\n";
  if (!options.transparent)
    out += "<rect" + attribute("width", number(layout.width)) + attribute("height", number(layout.height)) +
           paint("fill", style_of(options.style).paper) + "/>\n";
  for (std::size_t i = 0; i < panels.size(); ++i) {
    out += nested(panels[i], layout.panels.at(i));
    const PixelRect& c = layout.captions[i];
    double y = c.y + 0.75 * layout.text_height;  // as montage(): a quarter of a line above them
    for (const std::string& line : layout.lines[i]) {
      out += centred(line, c.x + 0.5 * c.width, y, layout.text_height, style_of(options.style).ink);
      y += layout.text_height;
    }
  }
  return out + "</svg>\n";
}

}  // namespace lrb::render
