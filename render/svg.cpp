#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "render/canvas.hpp"
#include "render/page_palette.hpp"
#include "render/paint_list.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/svg.hpp>

namespace lrb::render {

std::string base64(const std::uint8_t* bytes, std::size_t size) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const std::size_t have = std::min<std::size_t>(3, size - i);
    std::uint32_t word = 0;
    for (std::size_t j = 0; j < 3; ++j) word = word << 8 | (j < have ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j) out += j <= have ? kDigits[word >> (18 - 6 * j) & 63] : '=';
  }
  return out;
}

std::string escape_markup(std::string_view text) {
  std::string out;
  for (const char c : io::valid_utf8(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\t':
      case '\n':
        out += c;
        break;
      default:
        // Other control characters are not allowed in XML: as in messages, \xhh.
        if (const auto byte = static_cast<unsigned char>(c); byte < 0x20 || byte == 0x7f)
          out += printable_name({&c, 1});
        else
          out += c;
    }
  }
  return out;
}

}  // namespace lrb::render

namespace lrb::render::svg_text {

std::string number(double x) {
  std::array<char, 64> text{};
  const double hundredths = std::round(x * 100);
  const auto end = std::to_chars(text.data(), text.data() + text.size(), hundredths / 100 + 0.0,
                                 std::chars_format::fixed, 2);
  std::string out(text.data(), end.ptr);
  out.erase(out.find_last_not_of('0') + 1);
  if (out.back() == '.') out.pop_back();
  return out == "-0" ? "0" : out;
}

std::string attribute(const std::string& name, const std::string& value) {
  return " " + name + "=\"" + value + "\"";
}

std::string paint(const std::string& what, Rgba c) {
  std::string out = attribute(what, css(c));
  if (c.a < 255) out += attribute(what + "-opacity", number(c.a / 255.0));
  return out;
}

std::string font(double height) {
  return attribute("font-family", "DejaVu Sans, sans-serif") +
         attribute("font-size", number(height / kHeightOfFont));
}

std::string svg_open(double width, double height, double units_per_pixel, bool millimetres) {
  constexpr double kMmPerPixel = 25.4 / 96;  // by definition of CSS
  const auto size = [&](double x) {
    return millimetres ? number(x / units_per_pixel * kMmPerPixel) + "mm" : number(x / units_per_pixel);
  };
  return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + attribute("width", size(width)) +
         attribute("height", size(height)) +
         attribute("viewBox", "0 0 " + number(width) + " " + number(height)) + ">\n";
}

}  // namespace lrb::render::svg_text

namespace lrb::render {
namespace {

using namespace svg_text;

std::string path(const Canvas::Loop& points, bool closed) {
  std::string d;
  for (const Eigen::Vector2d& x : points) d += (d.empty() ? "M" : "L") + number(x.x()) + " " + number(x.y());
  return closed ? d + "Z" : d;
}

std::string box_attributes(const Eigen::AlignedBox2d& box) {
  return attribute("x", number(box.min().x())) + attribute("y", number(box.min().y())) +
         attribute("width", number(box.sizes().x())) + attribute("height", number(box.sizes().y()));
}

}  // namespace

void SvgCanvas::fill(const std::vector<Loop>& loops, Rgba colour, double spread) {
  std::string d;
  for (const Loop& loop : loops) d += path(loop, true);
  if (d.empty()) return;
  out_ += "<path" + attribute("d", d) + paint("fill", colour) + attribute("fill-rule", "evenodd");
  if (spread > 0)
    out_ += paint("stroke", colour) + attribute("stroke-width", number(2 * spread)) +
            attribute("stroke-linejoin", "round");
  out_ += "/>\n";
}

void SvgCanvas::stroke(const Loop& points, bool closed, const Pen& pen) {
  stroke_path(path(points, closed), pen);
}

void SvgCanvas::strokes(const std::vector<Loop>& lines, const Pen& pen) {
  std::string d;
  for (const Loop& line : lines) d += path(line, false);
  stroke_path(d, pen);
}

void SvgCanvas::stroke_path(const std::string& d, const Pen& pen) {
  out_ += "<path" + attribute("d", d) + attribute("fill", "none") + paint("stroke", pen.colour) +
          attribute("stroke-width", number(pen.width)) + attribute("stroke-linejoin", "round");
  // Round ends would fill the gaps between dashes.
  out_ +=
      pen.dash > 0 ? attribute("stroke-dasharray", number(pen.dash)) : attribute("stroke-linecap", "round");
  out_ += "/>\n";
}

void SvgCanvas::disc(const Eigen::Vector2d& at, double radius, Rgba colour) {
  out_ += "<circle" + attribute("cx", number(at.x())) + attribute("cy", number(at.y())) +
          attribute("r", number(radius)) + paint("fill", colour) + "/>\n";
}

void SvgCanvas::text(const PaperText& t) {
  if (texts_ == Texts::outlines) {
    const std::string d = attribute("d", text_outlines(t));
    if (t.halo.a > 0)
      out_ += "<path" + d + attribute("fill", "none") + paint("stroke", t.halo) +
              attribute("stroke-width", number(2 * kTextHalo * t.height)) +
              attribute("stroke-linejoin", "round") + "/>\n";
    out_ += "<path" + attribute("aria-label", escape_markup(t.text)) + d + paint("fill", t.colour) + "/>\n";
    return;
  }
  // A baseline instead of dominant-baseline, which not all SVG editors and printers support.
  out_ += "<text" + attribute("x", number(t.at.x())) +
          attribute("y", number(t.at.y() + kBaseline * t.height)) + font(t.height);
  if (t.bold) out_ += attribute("font-weight", "bold");
  if (t.align != Align::left) out_ += attribute("text-anchor", t.align == Align::centre ? "middle" : "end");
  out_ += paint("fill", t.colour);
  // paint-order draws the stroke under the fill, so the glyphs keep their shape.
  if (t.halo.a > 0)
    out_ += paint("stroke", t.halo) + attribute("stroke-width", number(2 * kTextHalo * t.height)) +
            attribute("stroke-linejoin", "round") + attribute("paint-order", "stroke");
  out_ += ">" + escape_markup(t.text) + "</text>\n";
}

void SvgCanvas::picture(const Image& image, const Eigen::AlignedBox2d& place) {
  const std::vector<std::uint8_t> png = encode_png(image);
  // Inkscape 1.2 shows pictures only if their href is in the XLink namespace.
  out_ += "<image" + box_attributes(place) + attribute("preserveAspectRatio", "none") +
          attribute("xmlns:xlink", "http://www.w3.org/1999/xlink") +
          attribute("xlink:href", "data:image/png;base64," + base64(png.data(), png.size())) + "/>\n";
}

void SvgCanvas::begin_clip(const Eigen::AlignedBox2d& box) {
  const std::string id = "clip" + std::to_string(++clips_);
  out_ += "<clipPath" + attribute("id", id) + "><rect" + box_attributes(box) + "/></clipPath>\n<g" +
          attribute("clip-path", "url(#" + id + ")") + ">\n";
}

void SvgCanvas::end_clip() {
  out_ += "</g>\n";
}

std::string svg_file(const SvgCanvas& canvas, const SvgPage& page) {
  std::string out = svg_open(page.width, page.height, page.units_per_pixel, page.millimetres);
  if (!page.title.empty()) out += "<title>" + escape_markup(page.title) + "</title>\n";
  if (page.background)
    out += "<rect" + attribute("width", number(page.width)) + attribute("height", number(page.height)) +
           paint("fill", *page.background) + "/>\n";
  return out + canvas.elements() + "</svg>\n";
}

std::string svg(const DrawList& list, const Camera& camera, const SvgOptions& options) {
  if (!list.triangles.empty()) {
    throw InputError("cannot write a 3D scene as SVG; draw it as a PNG, at a larger size for print");
  }
  SvgCanvas canvas;
  paint_flat(canvas, list, Projection(camera, options.width, options.height, bounds(list)));
  return svg_file(
      canvas, {options.width, options.height, options.units_per_pixel, options.title, options.background});
}

namespace {

using namespace svg_text;

/// Returns a complete picture as an element of another one.
std::string nested(const std::string& panel, const PixelRect& r) {
  const std::size_t start = panel.find("viewBox");
  if (start == std::string::npos) throw InputError("an SVG montage needs SVG panels");
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
    double y = c.y + 0.75 * layout.text_height;  // as in montage(): a quarter of a line above them
    for (const std::string& line : layout.lines[i]) {
      out += centred(line, c.x + 0.5 * c.width, y, layout.text_height, style_of(options.style).ink);
      y += layout.text_height;
    }
  }
  return out + "</svg>\n";
}

}  // namespace lrb::render
