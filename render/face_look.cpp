#include "render/face_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>

namespace lrb::render {

// The space that edges have.

namespace {

using Eigen::Vector3d;

/// The screen size of a triangle, and the length of its borders.
struct OnScreen {
  double altitude, area, borders;
};

/// Returns a triangle's size on the screen, with its smallest altitude, or nullopt if it reaches behind the
/// eye.
std::optional<OnScreen> on_screen(const DrawTriangle& t, const Projection& projection) {
  std::array<Eigen::Vector2d, 3> at;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto pixel = projection.to_pixel(t.x[i]);
    if (!pixel) return std::nullopt;
    at[i] = *pixel;
  }
  const Eigen::Vector2d u = at[1] - at[0], v = at[2] - at[0];
  const double twice_area = std::abs(u.x() * v.y() - u.y() * v.x());
  // The altitude on the longest edge is the smallest.
  const double longest = std::max({u.norm(), v.norm(), (v - u).norm()});
  double borders = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if ((t.borders >> i & 1) != 0) borders += (at[(i + 1) % 3] - at[i]).norm();
  return OnScreen{longest > 0 ? twice_area / longest : 0, twice_area / 2, borders};
}

struct Corner {
  Vector3d x;
  std::uint32_t triangle;
  std::uint8_t style;
};

/// Sorts by position, then by style, so that equal corners are adjacent.
bool before(const Corner& a, const Corner& b) {
  for (int i = 0; i < 3; ++i) {
    if (a.x[i] != b.x[i]) return a.x[i] < b.x[i];
  }
  return a.style < b.style;
}

}  // namespace

std::vector<double> edge_spacing(const DrawList& list, const Projection& projection) {
  std::vector<double> own(list.triangles.size(), 0), spacing(list.triangles.size(), 0);
  // Step 1: the altitude of each triangle, and its corners with their exact coordinates.
  std::vector<Corner> corners;
  for (std::uint32_t i = 0; i < list.triangles.size(); ++i) {
    const DrawTriangle& t = list.triangles[i];
    if (t.edges == 0) continue;
    // A triangle that reaches the eye is large.
    const std::optional<OnScreen> seen = on_screen(t, projection);
    own[i] = seen ? seen->altitude : projection.height();
    for (const Vector3d& x : t.x) corners.push_back({x, i, t.edge_style});
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return before(a, b) ||
           (!before(b, a) && a.triangle < b.triangle);  // a fixed order of summation on every machine
  });
  // Step 2: average over the triangles at each vertex, and give each of them a third: neighbours fade alike.
  for (std::size_t first = 0, end = 0; first < corners.size(); first = end) {
    double sum = 0;
    for (end = first; end < corners.size() && !before(corners[first], corners[end]); ++end) {
      sum += own[corners[end].triangle];
    }
    const double share = sum / static_cast<double>(end - first) / 3;
    for (std::size_t i = first; i < end; ++i) spacing[corners[i].triangle] += share;
  }
  return spacing;
}

std::vector<StyleSpacing> even_edge_spacing(const DrawList& list, const Projection& projection) {
  // Step 1: the visible triangles of each style.
  std::vector<std::vector<OnScreen>> styles(list.edge_styles.size());
  for (const DrawTriangle& t : list.triangles) {
    if (t.edges == 0) continue;
    if (const std::optional<OnScreen> seen = on_screen(t, projection)) styles[t.edge_style].push_back(*seen);
  }
  std::vector<StyleSpacing> spacing;
  for (std::vector<OnScreen>& parts : styles) {
    std::sort(parts.begin(), parts.end(),
              [](const OnScreen& x, const OnScreen& y) { return x.altitude > y.altitude; });
    // Step 2: the area-weighted median of the altitudes.
    double all = 0, borders = 0, sum = 0, half = projection.height();
    for (const OnScreen& p : parts) all += p.area, borders += p.borders;
    for (const OnScreen& p : parts) {
      half = p.altitude;
      if ((sum += p.area) >= 0.5 * all) break;
    }
    // Equilateral triangles of altitude h have edges of length 6 / h per area, counted once for each
    // triangle.
    spacing.push_back({half, borders > 0 ? 6 * all / borders : std::numeric_limits<double>::infinity()});
  }
  return spacing;
}

double fade_between(double x, double gone, double full) {
  // Smoothstep: no visible kink at either end.
  const double t = std::clamp((x - gone) / (full - gone), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// Looks.

namespace {

/// Edges fade where faces are too small for them (see edge_spacing()): they are full if the altitude is at
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

// Ambient occlusion.

namespace {

constexpr int kDirections = 64;  ///< evenly spread over the sphere
constexpr int kSide = 512;       ///< of the pictures in which visibility is looked up, pixels
/// Smaller cosines count as 0: there the depth of a pixel varies by more than the bias.
constexpr double kGrazing = 0.15;
/// Bias towards the viewer at perpendicular incidence, in pixels.
constexpr double kBias = 1.5;
constexpr double kStrength = 0.75;  ///< share of the light that a completely hidden face loses

/// Returns points evenly spread over the unit sphere, along a spiral.
std::vector<Vector3d> directions() {
  std::vector<Vector3d> out;
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double z = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - z * z);
    out.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  return out;
}

struct Receiver {
  std::size_t triangle;
  Vector3d centre, normal;
  double light = 0, all = 0;
};

}  // namespace

void add_ambient_occlusion(DrawList& list, Rasterizer& rasterizer) {
  // Step 1: the opaque triangles, which both receive and hide light.
  DrawList opaque;
  std::vector<Receiver> receivers;
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < list.triangles.size(); ++i) {
    const DrawTriangle& t = list.triangles[i];
    if (t.layer != Layer::opaque) continue;
    DrawTriangle plain = t;
    plain.edges = 0;
    opaque.triangles.push_back(plain);
    points.insert(points.end(), t.x.begin(), t.x.end());
    const Vector3d normal = (t.x[1] - t.x[0]).cross(t.x[2] - t.x[0]);
    if (t.lit && normal.norm() > 0)
      receivers.push_back({i, (t.x[0] + t.x[1] + t.x[2]) / 3, normal.normalized()});
  }
  if (receivers.empty()) return;
  // Step 2: from each direction, a picture of depths shows which centroids see the sky there.
  const Eigen::AlignedBox3d box = bounds(opaque);
  for (const Vector3d& direction : directions()) {
    FitOptions fit;
    fit.view = {direction, direction.unitOrthogonal()};
    fit.orthographic = true;
    const Camera camera = fit_camera(points, kSide, kSide, fit);
    const DepthImage depths = rasterizer.depths(opaque, camera, kSide, kSide);
    const Projection projection(camera, kSide, kSide, box);
    for (Receiver& r : receivers) {
      const double cosine = r.normal.dot(direction);
      if (cosine < kGrazing) continue;
      r.all += cosine;
      if (depths.shows(projection, r.centre, kBias / (cosine * kSide))) r.light += cosine;
    }
  }
  // Step 3: the colours.
  for (const Receiver& r : receivers) {
    Rgba& colour = list.triangles[r.triangle].colour;
    const double hidden = r.all > 0 ? 1 - r.light / r.all : 0;
    colour = mix(colour, {0, 0, 0, colour.a}, kStrength * hidden);
  }
}

}  // namespace lrb::render
