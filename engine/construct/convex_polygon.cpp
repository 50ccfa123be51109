// Convex polygons in 2D.
// convex_outline(): monotone chains (Andrew 1979). Sort the points, then build the lower and the upper chain.
// enclosing_polygon(): the hull of the points, moved outward; then sides are removed greedily, always the one
// whose removal adds the least area; at last the result is confirmed exactly, with a box as the fallback.

#include "engine/construct/convex_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include "engine/core/cross_2d.hpp"
#include "engine/exact/predicates.hpp"

namespace lrb::construct {
namespace {

using Vector3 = Eigen::Vector3d;

/// The point in which two sides p0 -> p1 and q0 -> q1 meet when they are extended, and the area that this
/// adds beyond p1, q0; the area is infinite if they do not converge.
struct MeetingPoint {
  Vector3 x;
  double area;
};

MeetingPoint meet(const Vector3& p0, const Vector3& p1, const Vector3& q0, const Vector3& q1) {
  const Vector3 p = p1 - p0, q = q1 - q0;
  // Extended beyond p1 and q0, the sides converge exactly if they turn left by less than 180 degrees.
  const double turn = cross_2d(p, q);
  if (!(turn > 0)) return {p1, std::numeric_limits<double>::infinity()};
  // Cramer's rule. The area is twice that of the triangle q0, p1, x; it is only compared.
  const Vector3 x = p1 + p * (cross_2d(q0 - p1, q) / turn);
  return {x, cross_2d(p1 - q0, x - q0)};
}

}  // namespace

std::vector<std::uint32_t> convex_outline(std::span<const Vector3> points) {
  // Step 1: sort by x, then y, then index. Equal points become neighbours, and the lowest index remains.
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto before = [&](std::uint32_t i, std::uint32_t j) {
    const Vector3 &a = points[i], &b = points[j];
    return a.x() != b.x() ? a.x() < b.x() : a.y() != b.y() ? a.y() < b.y() : i < j;
  };
  std::sort(order.begin(), order.end(), before);
  order.erase(std::unique(order.begin(), order.end(),
                          [&](std::uint32_t i, std::uint32_t j) {
                            return points[i].x() == points[j].x() && points[i].y() == points[j].y();
                          }),
              order.end());
  // Step 2: scan in order and remove the last point while it turns right. Straight angles stay: callers need
  // the points in the middle of sides. Amortised O(1) per point.
  const auto chain = [&](auto first, auto last) {
    std::vector<std::uint32_t> out;
    for (auto i = first; i != last; ++i) {
      while (out.size() >= 2 && exact::orient2d(points[out[out.size() - 2]].data(), points[out.back()].data(),
                                                points[*i].data()) < 0)
        out.pop_back();
      out.push_back(*i);
    }
    return out;
  };
  // Step 3: the lower chain from left to right, the upper one from right to left: counter-clockwise together.
  std::vector<std::uint32_t> outline = chain(order.begin(), order.end());
  const std::vector<std::uint32_t> upper = chain(order.rbegin(), order.rend());
  // Collinear points never turn right, so both chains contain all of them.
  const bool flat = outline.size() == order.size() && upper.size() == order.size();
  if (flat || upper.size() < 2) return {};
  // The chains share their end points.
  outline.insert(outline.end(), upper.begin() + 1, upper.end() - 1);
  return outline;
}

std::vector<Vector3> enclosing_polygon(std::span<const Vector3> points, std::uint32_t max_sides,
                                       double distance) {
  // The fallback: the bounding box, grown by the distance. Reject coordinates whose products would overflow.
  Eigen::AlignedBox3d box;
  for (const Vector3& p : points) box.extend(p);
  distance *= box.sizes().maxCoeff();
  const Vector3 low = box.min().array() - distance, high = box.max().array() + distance;
  const double width = high.x() - low.x(), height = high.y() - low.y();
  if (!std::isfinite(width * height * width * height)) return {};
  // Minkowski sum with a square of four points on the axes: its inradius is distance / sqrt(2), so every
  // point keeps half of the distance even after rounding.
  std::vector<Vector3> around;
  for (const Vector3& p : points)
    for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}, std::pair{-1, 0}, std::pair{0, -1}})
      around.emplace_back(p.x() + distance * dx, p.y() + distance * dy, 0);
  std::vector<Vector3> polygon;
  for (const std::uint32_t i : convex_outline(around)) polygon.push_back(around[i]);
  // Remove one side per round: O(n^2) for n sides of the hull, which is small against the mesh.
  while (polygon.size() > std::max(max_sides, 4u)) {
    const std::size_t n = polygon.size();
    std::size_t best = 0;
    MeetingPoint least{Eigen::Vector3d::Zero(), std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < n; ++i) {  // the side from i + 1 to i + 2 goes
      // Its neighbours are extended to their intersection, which replaces both of its ends.
      const MeetingPoint c =
          meet(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n], polygon[(i + 3) % n]);
      if (c.area < least.area) {
        least = c;
        best = i;
      }
    }
    // No two sides converge any more, as in a parallelogram.
    if (!std::isfinite(least.area)) break;
    // The new corner takes the place of the side's first end; its second end is erased.
    polygon[(best + 1) % n] = least.x;
    polygon.erase(polygon.begin() + static_cast<std::ptrdiff_t>((best + 2) % n));
  }
  // The intersections are rounded. Confirm exactly that all points are strictly inside, else use the box.
  const auto is_good = [&] {
    return polygon.size() <= std::max(max_sides, 4u) &&
           std::all_of(points.begin(), points.end(), [&](const Vector3& p) { return holds_2d(polygon, p); });
  };
  if (!is_good())
    polygon = {
        {low.x(), low.y(), 0}, {high.x(), low.y(), 0}, {high.x(), high.y(), 0}, {low.x(), high.y(), 0}};
  return polygon;
}

bool holds_2d(std::span<const Vector3> polygon, const Vector3& point) {
  // Strictly to the left of every side. Linear: the polygons have few sides.
  for (std::size_t i = 0; i < polygon.size(); ++i)
    if (exact::orient2d(polygon[i].data(), polygon[(i + 1) % polygon.size()].data(), point.data()) <= 0)
      return false;
  return true;
}

}  // namespace lrb::construct
