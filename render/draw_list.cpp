#include <algorithm>
#include <cstdio>
#include <map>
#include <set>

#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/render/draw_list.hpp>

namespace lrb::render {
namespace {

constexpr std::array<const char*, kLayers> kLayerNames = {"opaque", "translucent", "on top"};

std::string hex(Rgba c) {
  char text[16];
  std::snprintf(text, sizeof text, "#%02x%02x%02x%02x", c.r, c.g, c.b, c.a);
  return text;
}

struct Tally {
  std::size_t count = 0;
  std::map<std::string, std::size_t> colours;
  std::set<std::uint32_t> ids;
};

std::string line(const std::string& kind, const Tally& tally) {
  std::string text = kind + ": " + std::to_string(tally.count);
  if (!tally.ids.empty()) text += ", " + std::to_string(tally.ids.size()) + " ids";
  for (const auto& [colour, count] : tally.colours) text += ", " + colour + " x" + std::to_string(count);
  return text + "\n";
}

void add(Tally& tally, Rgba colour, std::uint32_t id = kNoId) {
  ++tally.count;
  ++tally.colours[hex(colour)];
  if (id != kNoId) tally.ids.insert(id);
}

template <class Items>
std::string lines_by_layer(const std::string& kind, const Items& items) {
  std::array<Tally, kLayers> tallies;
  for (const auto& item : items) {
    std::uint32_t id = kNoId;
    if constexpr (requires { item.id; }) id = item.id;
    add(tallies[static_cast<std::size_t>(item.layer)], item.colour, id);
  }
  std::string text;
  for (std::size_t i = 0; i < tallies.size(); ++i) {
    if (tallies[i].count > 0) text += line(kind + ", " + kLayerNames[i], tallies[i]);
  }
  return text;
}

}  // namespace

std::uint8_t DrawList::edge_style(const EdgeStyle& style) {
  const auto same = [&](const EdgeStyle& s) {
    return s.colour == style.colour && s.width == style.width && s.back == style.back;
  };
  // A linear search: lists have a handful of styles.
  const auto found = std::find_if(edge_styles.begin(), edge_styles.end(), same);
  const auto index = static_cast<std::size_t>(found - edge_styles.begin());
  if (found == edge_styles.end()) {
    if (edge_styles.size() == 256) throw InputError("a draw list has at most 256 edge styles");
    edge_styles.push_back(style);
  }
  return static_cast<std::uint8_t>(index);
}

void DrawList::add_polygon(const std::vector<Eigen::Vector3d>& corners, const DrawTriangle& like,
                           const std::vector<bool>& borders, const std::vector<Eigen::Vector3d>& shape) {
  const std::size_t n = corners.size();
  std::vector<std::array<std::uint32_t, 3>> parts;
  cut_polygon(shape.empty() ? corners : shape, parts);
  for (const auto& part : parts) {
    DrawTriangle t = like;
    t.x = {corners[part[0]], corners[part[1]], corners[part[2]]};
    // Diagonals must not be drawn as edges: only sides of the polygon are.
    if (like.edges != 0) t.edges = t.borders = 0;
    for (std::size_t k = 0; k < 3 && like.edges != 0; ++k) {
      const std::uint32_t from = part[k], to = part[(k + 1) % 3];
      if (to != (from + 1) % n) continue;
      t.edges = static_cast<std::uint8_t>(t.edges | 1u << k);
      if (!borders.empty() && borders[from]) t.borders = static_cast<std::uint8_t>(t.borders | 1u << k);
    }
    triangles.push_back(t);
  }
}

void DrawList::append(const DrawList& other) {
  for (DrawTriangle t : other.triangles) {
    // Styles are indices into the other list: translate them.
    t.edge_style = edge_style(other.edge_styles[t.edge_style]);
    triangles.push_back(t);
  }
  fills.insert(fills.end(), other.fills.begin(), other.fills.end());
  lines.insert(lines.end(), other.lines.begin(), other.lines.end());
  points.insert(points.end(), other.points.begin(), other.points.end());
  labels.insert(labels.end(), other.labels.begin(), other.labels.end());
}

bool DrawList::empty() const {
  return fills.empty() && triangles.empty() && lines.empty() && points.empty() && labels.empty();
}

std::vector<Eigen::Vector3d> extent_points(const DrawList& list) {
  std::vector<Eigen::Vector3d> out;
  out.reserve(list.triangles.size() * 3);
  for (const DrawFill& f : list.fills) {
    for (const auto& s : f.segments) out.insert(out.end(), s.begin(), s.end());
  }
  for (const DrawTriangle& t : list.triangles) out.insert(out.end(), t.x.begin(), t.x.end());
  for (const DrawLine& l : list.lines) out.insert(out.end(), l.points.begin(), l.points.end());
  for (const DrawPoint& p : list.points) out.push_back(p.x);
  return out;
}

Eigen::AlignedBox3d bounds(const DrawList& list) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& x : extent_points(list)) box.extend(x);
  return box;
}

std::string summary(const DrawList& list) {
  Tally fills;
  for (const DrawFill& f : list.fills) add(fills, f.colour, f.id);
  std::string text;
  if (fills.count > 0) text += line("fills", fills);
  text += lines_by_layer("triangles", list.triangles);
  text += lines_by_layer("lines", list.lines);
  text += lines_by_layer("points", list.points);
  for (const DrawLabel& l : list.labels) text += "label: " + l.text + "\n";
  return text;
}

}  // namespace lrb::render
