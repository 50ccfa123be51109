#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include <Eigen/Geometry>

#include "scenarios/export/model.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::exchange {
namespace {

/// Appends a part as an object; `first` is the number of its first vertex, from 1.
void write_part(std::string& out, const Part& part, std::size_t first) {
  out += "o " + part.name + "\n";
  for (const Eigen::Vector3d& x : part.vertices)
    out += "v " + io::exact_text(x.x()) + " " + io::exact_text(x.y()) + " " + io::exact_text(x.z()) + "\n";
  constexpr char kWord[] = {'p', 'l', 'f'};
  for (std::size_t c = 0; c < part.cell_count(); ++c) {
    out += kWord[static_cast<std::size_t>(part.shape)];
    for (const std::uint32_t v : part.cell(c)) out += " " + std::to_string(first + v);
    out += "\n";
  }
}

}  // namespace

std::string obj_bytes(const Model& model, const FileOptions& options) {
  std::string out = "# " + model.title + "\n";
  std::size_t first = 1;
  const std::vector<Part> split = options.regions ? split_by_region(model) : std::vector<Part>();
  for (const Part& part : options.regions ? split : model.parts) {
    write_part(out, part, first);
    first += part.vertices.size();
  }
  return out;
}

namespace {

using render::Rgba;

/// Writes numbers in sequence, as text with a line per element, or as bytes.
class PlyOut {
 public:
  explicit PlyOut(bool ascii) : ascii_(ascii) {}

  template <class T>
  void number(T value) {
    if (!ascii_) return append(text, value);
    if (!at_begin_) text += ' ';
    at_begin_ = false;
    if constexpr (std::is_floating_point_v<T>)
      text += io::exact_text(value);
    else
      text += std::to_string(value);
  }
  void colour(Rgba c) {
    for (const std::uint8_t x : {c.r, c.g, c.b, c.a}) number(x);
  }
  void end_element() {
    if (ascii_) text += '\n';
    at_begin_ = true;
  }

  std::string text;

 private:
  bool ascii_, at_begin_ = true;
};

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

std::string header(const Model& model, bool ascii, bool short_lists) {
  std::size_t vertices = 0;
  for (const Part& part : model.parts) vertices += part.vertices.size();
  std::string out = ascii ? "ply\nformat ascii 1.0\n" : "ply\nformat binary_little_endian 1.0\n";
  out += "comment " + model.title + "\n";
  out += "comment kind: 0 pseudo face, 1 real face, 2 contact; -1: does not apply; quality: " +
         std::string(model.quality) + "\n";
  out += "element vertex " + std::to_string(vertices) +
         "\nproperty double x\nproperty double y\nproperty double z\n" + std::string(kColours);
  out += "element face " + std::to_string(count(model, Shape::polygons)) + "\nproperty list " +
         (short_lists ? "uchar" : "int") + " int vertex_indices\n" + attribute_lines(model);
  if (const std::size_t edges = count(model, Shape::lines); edges > 0)
    out += "element edge " + std::to_string(edges) + "\nproperty int vertex1\nproperty int vertex2\n" +
           attribute_lines(model);
  return out + "end_header\n";
}

void write_attributes(PlyOut& out, const Model& model, const Part& part, std::size_t cell,
                      std::size_t quality) {
  out.colour(part.colours[cell]);
  for (std::size_t i = 0; i < model.columns.size(); ++i) {
    const double x = part.values[i][cell];
    if (model.columns[i].whole)
      out.number(static_cast<std::int32_t>(x));
    else
      out.number(x);
  }
  out.number(static_cast<float>(part.values[quality][cell]));
  out.end_element();
}

}  // namespace

std::string ply_bytes(const Model& model, const FileOptions& options) {
  constexpr std::size_t kMaxShort = 255;
  const bool short_lists = max_corners(model) <= kMaxShort;
  const std::size_t quality = model.column(model.quality);
  PlyOut out(options.ascii);
  out.text = header(model, options.ascii, short_lists);
  for (const Part& part : model.parts) {
    const std::vector<Rgba> colours = vertex_colours(part);
    for (std::size_t v = 0; v < part.vertices.size(); ++v) {
      for (const double x : part.vertices[v]) out.number(x);
      out.colour(colours[v]);
      out.end_element();
    }
  }
  for (const Shape shape : {Shape::polygons, Shape::lines}) {
    std::int32_t first = 0;
    for (const Part& part : model.parts) {
      for (std::size_t c = 0; c < part.cell_count() && part.shape == shape; ++c) {
        const std::span<const std::uint32_t> cell = part.cell(c);
        const auto corner = [&](std::size_t i) { out.number(first + static_cast<std::int32_t>(cell[i])); };
        if (shape == Shape::polygons) {
          if (short_lists)
            out.number(static_cast<std::uint8_t>(cell.size()));
          else
            out.number(static_cast<std::int32_t>(cell.size()));
          for (std::size_t i = 0; i < cell.size(); ++i) corner(i);
          write_attributes(out, model, part, c, quality);
          continue;
        }
        for (std::size_t i = 0; i + 1 < cell.size(); ++i) {
          corner(i);
          corner(i + 1);
          write_attributes(out, model, part, c, quality);
        }
      }
      first += static_cast<std::int32_t>(part.vertices.size());
    }
  }
  return std::move(out.text);
}

namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

/// Returns the triangles of all faces: fans from the first corners.
std::vector<Triangle> triangles_of(const Model& model) {
  std::vector<Triangle> out;
  for (const Part& part : model.parts) {
    if (part.shape != Shape::polygons)
      throw InputError(
          part.name + ": expected faces, found " + (part.shape == Shape::points ? "points" : "lines") +
          ", which STL cannot store; choose --what body or wrapper of 3D bodies, or another format");
    for (std::size_t c = 0; c < part.cell_count(); ++c) {
      const std::span<const std::uint32_t> cell = part.cell(c);
      for (std::size_t i = 2; i < cell.size(); ++i)
        out.push_back({part.vertices[cell[0]], part.vertices[cell[i - 1]], part.vertices[cell[i]]});
    }
  }
  return out;
}

/// Returns the unit normal; zero for a triangle without area, as is common in STL.
Eigen::Vector3d normal_of(const Triangle& t) {
  const Eigen::Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  return n.allFinite() ? n.stableNormalized() : Eigen::Vector3d(0, 0, 0);
}

std::string text_of(const Eigen::Vector3d& x) {
  return io::exact_text(x.x()) + " " + io::exact_text(x.y()) + " " + io::exact_text(x.z());
}

std::string ascii_stl(const std::vector<Triangle>& triangles) {
  std::string out = "solid lrbscope\n";
  for (const Triangle& t : triangles) {
    out += "facet normal " + text_of(normal_of(t)) + "\nouter loop\n";
    for (const Eigen::Vector3d& x : t) out += "vertex " + text_of(x) + "\n";
    out += "endloop\nendfacet\n";
  }
  return out + "endsolid lrbscope\n";
}

std::string binary_stl(const Model& model, const std::vector<Triangle>& triangles) {
  constexpr std::size_t kHeader = 80;
  if (triangles.size() > std::numeric_limits<std::uint32_t>::max())
    throw InputError("expected at most 4294967295 triangles in binary STL, found " +
                     std::to_string(triangles.size()) + "; use PLY");
  std::string out = model.title.substr(0, kHeader);
  out.resize(kHeader, ' ');
  append(out, static_cast<std::uint32_t>(triangles.size()));
  const auto number = [&](double x) {
    if (!(std::abs(x) <= std::numeric_limits<float>::max()))
      throw InputError("coordinate " + io::exact_text(x) +
                       ": expected one in the range of floats, which binary STL stores; use --ascii or PLY");
    append(out, static_cast<float>(x));
  };
  for (const Triangle& t : triangles) {
    for (const double x : normal_of(t)) number(x);
    for (const Eigen::Vector3d& p : t)
      for (const double x : p) number(x);
    append(out, std::uint16_t{0});  // attributes
  }
  return out;
}

}  // namespace

std::string stl_bytes(const Model& model, const FileOptions& options) {
  const std::vector<Triangle> triangles = triangles_of(model);
  return options.ascii ? ascii_stl(triangles) : binary_stl(model, triangles);
}

}  // namespace lrb::exchange
