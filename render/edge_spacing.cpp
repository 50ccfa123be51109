#include "render/edge_spacing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace lrb::render {
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

}  // namespace lrb::render
