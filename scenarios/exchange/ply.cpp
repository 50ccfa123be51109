#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "scenarios/exchange/model.hpp"

namespace lrb::exchange {
namespace {

using render::Rgba;

void append_colour(std::string& out, Rgba c) {
  for (const std::uint8_t x : {c.r, c.g, c.b, c.a}) append(out, x);
}

/// For programs that support only vertex colours: the mean over the adjacent cells.
std::vector<Rgba> vertex_colours(const Part& part) {
  std::vector<std::array<std::uint32_t, 5>> sums(part.vertices.size());
  for (std::size_t c = 0; c < part.cell_count(); ++c) {
    const Rgba colour = part.colours[c];
    for (const std::uint32_t v : part.cell(c)) {
      const std::array<std::uint32_t, 5> add = {colour.r, colour.g, colour.b, colour.a, 1};
      for (std::size_t i = 0; i < add.size(); ++i) sums[v][i] += add[i];
    }
  }
  std::vector<Rgba> out;
  for (const auto& sum : sums) {
    const auto mean = [&](std::size_t i) {
      return static_cast<std::uint8_t>((sum[i] + sum[4] / 2) / std::max(1U, sum[4]));
    };
    out.push_back({mean(0), mean(1), mean(2), mean(3)});
  }
  return out;
}

/// The number of cells, lines counted by their segments.
std::size_t count(const Model& model, Shape shape) {
  std::size_t out = 0;
  for (const Part& part : model.parts)
    if (part.shape == shape)
      out += shape == Shape::lines ? part.corners.size() - part.cell_count() : part.cell_count();
  return out;
}

std::size_t max_corners(const Model& model) {
  std::size_t out = 0;
  for (const Part& part : model.parts)
    for (std::size_t c = 0; c < part.cell_count() && part.shape == Shape::polygons; ++c)
      out = std::max(out, part.cell(c).size());
  return out;
}

constexpr std::string_view kColours =
    "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n";

std::string attribute_lines(const Model& model) {
  std::string out(kColours);
  for (const Column& c : model.columns)
    out.append(c.whole ? "property int " : "property double ").append(c.name).append("\n");
  return out + "property float quality\n";
}

std::string header(const Model& model, bool short_lists) {
  std::size_t vertices = 0;
  for (const Part& part : model.parts) vertices += part.vertices.size();
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment " + model.title + "\n";
  out += "comment kind: 0 pseudo face, 1 real face, 2 contact; -1: does not apply; quality: " +
         std::string(model.quality) + "\n";
  out += "element vertex " + std::to_string(vertices) +
         "\nproperty double x\nproperty double y\nproperty double z\n" + std::string(kColours);
  out += "element face " + std::to_string(count(model, Shape::polygons)) + "\nproperty list " +
         (short_lists ? "uchar" : "int") + " int vertex_indices\n" + attribute_lines(model);
  if (const std::size_t edges = count(model, Shape::lines); edges > 0)
    // trimesh takes every property of an edge for a vertex, so the others are in an element of their own.
    out += "element edge " + std::to_string(edges) + "\nproperty int vertex1\nproperty int vertex2\n" +
           "element edge_value " + std::to_string(edges) + "\n" + attribute_lines(model);
  return out + "end_header\n";
}

void write_attributes(std::string& out, const Model& model, const Part& part, std::size_t cell,
                      std::size_t quality) {
  append_colour(out, part.colours[cell]);
  for (std::size_t i = 0; i < model.columns.size(); ++i) {
    const double x = part.values[i][cell];
    if (model.columns[i].whole)
      append(out, static_cast<std::int32_t>(x));
    else
      append(out, x);
  }
  append(out, static_cast<float>(part.values[quality][cell]));
}

}  // namespace

std::string ply_bytes(const Model& model) {
  constexpr std::size_t kMaxShort = 255;
  const bool short_lists = max_corners(model) <= kMaxShort;
  const std::size_t quality = model.column(model.quality);
  std::string out = header(model, short_lists);
  for (const Part& part : model.parts) {
    const std::vector<Rgba> colours = vertex_colours(part);
    for (std::size_t v = 0; v < part.vertices.size(); ++v) {
      for (const double x : part.vertices[v]) append(out, x);
      append_colour(out, colours[v]);
    }
  }
  std::string line_values;
  for (const Shape shape : {Shape::polygons, Shape::lines}) {
    std::int32_t first = 0;
    for (const Part& part : model.parts) {
      for (std::size_t c = 0; c < part.cell_count() && part.shape == shape; ++c) {
        const std::span<const std::uint32_t> cell = part.cell(c);
        const auto corner = [&](std::size_t i) { append(out, first + static_cast<std::int32_t>(cell[i])); };
        if (shape == Shape::polygons) {
          if (short_lists)
            append(out, static_cast<std::uint8_t>(cell.size()));
          else
            append(out, static_cast<std::int32_t>(cell.size()));
          for (std::size_t i = 0; i < cell.size(); ++i) corner(i);
          write_attributes(out, model, part, c, quality);
          continue;
        }
        for (std::size_t i = 0; i + 1 < cell.size(); ++i) {
          corner(i);
          corner(i + 1);
          write_attributes(line_values, model, part, c, quality);
        }
      }
      first += static_cast<std::int32_t>(part.vertices.size());
    }
  }
  return out + line_values;
}

}  // namespace lrb::exchange
