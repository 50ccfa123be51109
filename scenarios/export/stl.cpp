#include <array>
#include <cmath>
#include <limits>
#include <span>

#include <Eigen/Geometry>

#include "scenarios/export/model.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::exchange {
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
