#include "render/face_look.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace lrb::render {
namespace {

using Eigen::Vector3d;

/// Edges fade where faces are too small for them (see edge_spacing.hpp): they are full if the altitude is at
/// least the first number of edge widths, and invisible at the second, ...
constexpr double kEdgesFull = 9, kEdgesGone = 1.5;
/// ... where their width is reduced to this share.
constexpr double kMinWidth = 0.6;
/// Edges that fade by style: below this share only borders are drawn, because they would be lost among the
/// other edges.
constexpr double kBordersAlone = 0.3;
/// Factor by which translucent faces are shaded more weakly than opaque ones.
constexpr double kSoften = 0.6;

Vector3d normal_of(const DrawTriangle& t) {
  return (t.x[1] - t.x[0]).cross(t.x[2] - t.x[0]);
}

}  // namespace

FaceLooks::FaceLooks(const DrawList& list, const Projection& projection, double scale,
                     const Lighting& lighting, bool even_edges)
    : list_(list), projection_(projection), scale_(scale), lighting_(lighting), soft_(lighting) {
  if (even_edges)
    even_spacing_ = even_edge_spacing(list, projection);
  else
    spacing_ = edge_spacing(list, projection);
  // Softer lighting: part of each directional light moves to the ambient one.
  soft_.ambient = lighting.ambient + kSoften * (1 - lighting.ambient);
  for (double* share : {&soft_.head, &soft_.key, &soft_.fill}) *share *= 1 - kSoften;
}

FaceLook FaceLooks::of(const DrawTriangle& t) const {
  // Flat shading, from the normal in world coordinates.
  const Vector3d normal = normal_of(t);
  const double length = normal.norm();
  FaceLook look;
  look.colour = t.layer == Layer::opaque ? with_alpha(t.colour, 255) : t.colour;
  if (t.lit && length > 0) {
    const Lighting& lighting = t.layer == Layer::opaque ? lighting_ : soft_;
    look.colour = shade(look.colour, normal / length, projection_.axes(), lighting);
  }
  if (t.edges != 0) add_edges(t, look);
  return look;
}

void FaceLooks::add_edges(const DrawTriangle& t, FaceLook& look) const {
  const EdgeStyle& style = list_.edge_styles[t.edge_style];
  const auto fade_at = [&](double spacing) {
    return fade_between(spacing / (style.width * scale_), kEdgesGone, kEdgesFull);
  };
  look.edges = t.edges;
  double fade = 0;
  if (even_spacing_.empty()) {
    fade = fade_at(spacing_[static_cast<std::size_t>(&t - list_.triangles.data())]);
  } else {
    const StyleSpacing& spacing = even_spacing_[t.edge_style];
    fade = fade_at(spacing.all);
    if (fade < kBordersAlone && std::isfinite(spacing.borders)) {
      look.edges &= t.borders;
      fade = fade_at(spacing.borders);
    }
  }
  const double back = shows_back(t) ? style.back : 1;
  look.edge_width = style.width * (kMinWidth + (1 - kMinWidth) * fade) * (0.5 + 0.5 * back) * scale_;
  look.edge_colour = with_alpha(style.colour, static_cast<std::uint8_t>(style.colour.a * fade * back + 0.5));
}

bool FaceLooks::shows_back(const DrawTriangle& t) const {
  return normal_of(t).dot(projection_.towards_viewer(t.x[0])) < 0;
}

Rgba shade(Rgba colour, const Vector3d& normal, const Eigen::Matrix3d& axes, const Lighting& lighting) {
  // Eye coordinates with z towards the viewer. Both sides of a face are lit.
  Vector3d n(axes.row(0).dot(normal), axes.row(1).dot(normal), -axes.row(2).dot(normal));
  if (n.z() < 0) n = -n;
  const auto from = [&](const Vector3d& light) { return std::max(0.0, n.dot(light.normalized())); };
  const double light = lighting.ambient + lighting.head * n.z() + lighting.key * from(lighting.key_from) +
                       lighting.fill * from(lighting.fill_from);
  const Rgba dark{0, 0, 0, colour.a}, bright{255, 255, 255, colour.a};
  // Above one, the colour is mixed towards white, so that bright faces keep their differences.
  return light <= 1 ? mix(dark, colour, light) : mix(colour, bright, std::min(1.0, light - 1));
}

}  // namespace lrb::render
