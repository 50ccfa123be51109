#include "render/edge_room.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

namespace lrb::render {
namespace {

using Eigen::Vector3d;

/// Returns a triangle's lowest altitude on the screen; nothing if it reaches behind the eye.
std::optional<double> altitude(const DrawTriangle& t, const Projection& projection) {
  std::array<Eigen::Vector2d, 3> at;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto pixel = projection.to_pixel(t.x[i]);
    if (!pixel) return std::nullopt;
    at[i] = *pixel;
  }
  const Eigen::Vector2d u = at[1] - at[0], v = at[2] - at[0];
  const double twice_area = std::abs(u.x() * v.y() - u.y() * v.x());
  const double longest = std::max({u.norm(), v.norm(), (v - u).norm()});
  return longest > 0 ? twice_area / longest : 0;
}

struct Corner {
  Vector3d x;
  std::uint32_t triangle;
  std::uint8_t style;
};

/// Sorts by place, then by style, so that equal ones come together.
bool before(const Corner& a, const Corner& b) {
  for (int i = 0; i < 3; ++i) {
    if (a.x[i] != b.x[i]) return a.x[i] < b.x[i];
  }
  return a.style < b.style;
}

}  // namespace

std::vector<double> edge_room(const DrawList& list, const Projection& projection) {
  std::vector<double> own(list.triangles.size(), 0), room(list.triangles.size(), 0);
  std::vector<Corner> corners;
  for (std::uint32_t i = 0; i < list.triangles.size(); ++i) {
    const DrawTriangle& t = list.triangles[i];
    if (t.edges == 0) continue;
    // A triangle that comes right up to the eye is large.
    own[i] = altitude(t, projection).value_or(projection.height());
    for (const Vector3d& x : t.x) corners.push_back({x, i, t.edge_style});
  }
  std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
    return before(a, b) ||
           (!before(b, a) && a.triangle < b.triangle);  // so that sums are taken in one order everywhere
  });
  for (std::size_t first = 0, end = 0; first < corners.size(); first = end) {
    double sum = 0;
    for (end = first; end < corners.size() && !before(corners[first], corners[end]); ++end) {
      sum += own[corners[end].triangle];
    }
    const double share = sum / static_cast<double>(end - first) / 3;
    for (std::size_t i = first; i < end; ++i) room[corners[i].triangle] += share;
  }
  return room;
}

double fade_between(double x, double gone, double full) {
  const double t = std::clamp((x - gone) / (full - gone), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace lrb::render
