#include "render/svg_canvas.hpp"

#include "render/base64.hpp"
#include "render/markup.hpp"
#include "render/png.hpp"
#include "render/svg_text.hpp"

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

void SvgCanvas::fill(const std::vector<Loop>& loops, Rgba colour) {
  std::string d;
  for (const Loop& loop : loops) d += path(loop, true);
  if (d.empty()) return;
  out_ += "<path" + attribute("d", d) + paint("fill", colour) + attribute("fill-rule", "evenodd") + "/>\n";
}

void SvgCanvas::stroke(const Loop& points, bool closed, const Pen& pen) {
  out_ += "<path" + attribute("d", path(points, closed)) + attribute("fill", "none") +
          paint("stroke", pen.colour) + attribute("stroke-width", number(pen.width)) +
          attribute("stroke-linejoin", "round");
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
  // A base line, not dominant-baseline: editors and printers of SVG do not all know that.
  out_ += "<text" + attribute("x", number(t.at.x())) +
          attribute("y", number(t.at.y() + kBaseline * t.height)) + font(t.height);
  if (t.bold) out_ += attribute("font-weight", "bold");
  if (t.align != Align::left) out_ += attribute("text-anchor", t.align == Align::centre ? "middle" : "end");
  out_ += paint("fill", t.colour);
  // paint-order draws the stroke beneath the fill, so the glyphs keep their shape.
  if (t.halo.a > 0)
    out_ += paint("stroke", t.halo) + attribute("stroke-width", number(2 * kTextHalo * t.height)) +
            attribute("stroke-linejoin", "round") + attribute("paint-order", "stroke");
  out_ += ">" + escape_markup(t.text) + "</text>\n";
}

void SvgCanvas::picture(const Image& image, const Eigen::AlignedBox2d& place) {
  const std::vector<std::uint8_t> png = encode_png(image);
  // Inkscape 1.2 shows no picture whose href is not of XLink's namespace.
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
  std::string out = svg_open(page.width, page.height, page.units_per_pixel);
  if (!page.title.empty()) out += "<title>" + escape_markup(page.title) + "</title>\n";
  if (page.background)
    out += "<rect" + attribute("width", number(page.width)) + attribute("height", number(page.height)) +
           paint("fill", *page.background) + "/>\n";
  return out + canvas.elements() + "</svg>\n";
}

}  // namespace lrb::render
