#include "render/svg.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <map>
#include <vector>

#include "engine/core/error.hpp"
#include "render/markup.hpp"
#include "render/svg_text.hpp"

namespace lrb::render {
namespace {

using namespace svg_text;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kLabelHalo = 0.14;  ///< on each side, as a share of the label's height; as in draw_labels()

struct Less {
  bool operator()(const Vector3d& a, const Vector3d& b) const {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  }
};

/// Joins segments, in any order and direction, where they share an end exactly.
std::vector<std::vector<Vector3d>> loops(const std::vector<std::array<Vector3d, 2>>& segments) {
  std::multimap<Vector3d, std::size_t, Less> at;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    at.emplace(segments[i][0], i);
    at.emplace(segments[i][1], i);
  }
  std::vector<bool> used(segments.size(), false);
  std::vector<std::vector<Vector3d>> out;
  for (std::size_t start = 0; start < segments.size(); ++start) {
    if (used[start]) continue;
    std::vector<Vector3d> loop{segments[start][0]};
    for (std::size_t i = start; i < segments.size();) {
      used[i] = true;
      const Vector3d end = segments[i][0] == loop.back() ? segments[i][1] : segments[i][0];
      if (end == loop.front()) break;
      loop.push_back(end);
      i = segments.size();
      const auto [first, last] = at.equal_range(end);
      for (auto it = first; it != last; ++it) {
        if (!used[it->second]) i = it->second;
      }
    }
    out.push_back(std::move(loop));
  }
  return out;
}

class Writer {
 public:
  Writer(const DrawList& list, const Camera& camera, const SvgOptions& options)
      : list_(list), options_(options), projection_(camera, options.width, options.height, bounds(list)) {}

  std::string write() {
    const std::string w = number(options_.width), h = number(options_.height);
    out_ = svg_open(options_.width, options_.height, options_.units_per_pixel);
    if (!options_.title.empty()) out_ += "<title>" + escape_markup(options_.title) + "</title>\n";
    if (options_.background) {
      out_ += "<rect" + attribute("width", w) + attribute("height", h) + paint("fill", *options_.background) +
              "/>\n";
    }
    for (const DrawFill& f : list_.fills) fill(f);
    for (int layer = 0; layer < kLayers; ++layer) {
      for (const DrawLine& l : list_.lines) {
        if (l.layer == static_cast<Layer>(layer)) line(l);
      }
      for (const DrawPoint& p : list_.points) {
        if (p.layer == static_cast<Layer>(layer)) point(p);
      }
    }
    for (const DrawLabel& l : list_.labels) label(l);
    return std::move(out_) + "</svg>\n";
  }

 private:
  std::string path(const std::vector<Vector3d>& points, bool closed) const {
    std::string d;
    for (const Vector3d& x : points) {
      const auto at = projection_.to_pixel(x);
      if (!at) throw InputError("a scene that reaches behind its camera cannot be written as SVG");
      d += (d.empty() ? "M" : "L") + number(at->x()) + " " + number(at->y());
    }
    return closed ? d + "Z" : d;
  }

  void fill(const DrawFill& f) {
    std::string d;
    for (const auto& loop : loops(f.segments)) d += path(loop, true);
    if (d.empty()) return;
    out_ +=
        "<path" + attribute("d", d) + paint("fill", f.colour) + attribute("fill-rule", "evenodd") + "/>\n";
  }

  void line(const DrawLine& l) {
    if (l.points.empty()) return;
    const std::string d = path(l.points, l.closed);
    if (l.halo.a > 0 && l.halo_width > 0) stroke(d, l.halo, l.width + 2 * l.halo_width, 0);
    stroke(d, l.colour, l.width, l.dash);
  }

  void stroke(const std::string& d, Rgba colour, float width, float dash) {
    out_ += "<path" + attribute("d", d) + attribute("fill", "none") + paint("stroke", colour) +
            attribute("stroke-width", number(width)) + attribute("stroke-linejoin", "round");
    // Round ends would fill the gaps between dashes.
    out_ += dash > 0 ? attribute("stroke-dasharray", number(dash)) : attribute("stroke-linecap", "round");
    out_ += "/>\n";
  }

  void point(const DrawPoint& p) {
    if (p.halo.a > 0 && p.halo_width > 0) circle(p.x, p.radius + p.halo_width, p.halo);
    circle(p.x, p.radius, p.colour);
  }

  void circle(const Vector3d& x, float radius, Rgba colour) {
    const auto at = projection_.to_pixel(x);
    if (!at) return;
    out_ += "<circle" + attribute("cx", number(at->x())) + attribute("cy", number(at->y())) +
            attribute("r", number(radius)) + paint("fill", colour) + "/>\n";
  }

  void label(const DrawLabel& l) {
    const auto at = projection_.to_pixel(l.x);
    if (!at) return;
    out_ += "<text" + attribute("x", number(at->x() + l.dx)) + attribute("y", number(at->y() + l.dy)) +
            font(l.height) + attribute("text-anchor", "middle") + attribute("dominant-baseline", "central") +
            paint("fill", l.colour);
    if (l.halo.a > 0) {
      out_ += paint("stroke", l.halo) + attribute("stroke-width", number(2 * kLabelHalo * l.height)) +
              attribute("stroke-linejoin", "round") + attribute("paint-order", "stroke");
    }
    out_ += ">" + escape_markup(l.text) + "</text>\n";
  }

  const DrawList& list_;
  const SvgOptions& options_;
  Projection projection_;
  std::string out_;
};

}  // namespace

std::string svg(const DrawList& list, const Camera& camera, const SvgOptions& options) {
  if (!list.triangles.empty()) {
    throw InputError("a 3D scene cannot be written as SVG: draw it as a PNG, at a larger size for print");
  }
  return Writer(list, camera, options).write();
}

}  // namespace lrb::render
