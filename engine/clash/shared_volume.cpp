/// Volume of the intersection of two closed bodies as a sum over pairs of triangles.
/// Steps:
/// 1. Project all triangles along x, and find the pairs whose boxes overlap.
/// 2. Clip one triangle of a pair by the other (Sutherland and Hodgman 1974).
/// 3. Integrate the lower of both heights over the polygon, and add it with the sign of both orientations.
/// 4. Sum up with compensation (Neumaier 1974) and a bound on all errors.
///
/// Errors, with u = 2^-53; coordinates are at most 1/2, and heights above the base at most 1. Let D be the
/// diameter of the projected triangle that is clipped, and E the diameter of the clipping triangle.
///
/// Clipping. The distance of a point p from the line through a and b is a difference of two products of
/// differences, each with a relative error of u, divided by the length of b - a. Its error is at most 8 u |p
/// - a| <= 8 u (D + E). The computed intersection point of an edge with the line is within 4 u D + u of the
/// edge (the error of the parameter is at most 4 u, and the sum is rounded), and is farther from the line by
/// as much, because the distance is linear on the edge. So the computed polygon differs from the exact one by
/// strips along the line, 8 u (D + E) + 4 u D + u wide and at most D long, and along the edges, 4 u D + u
/// wide and at most 6 D long. Their area is less than u D (7 + 36 D + 8 E). There are three clipping lines,
/// and the line where one triangle passes through the other adds its strips along the edges: in total less
/// than u D (27 + 132 D + 24 E). The height above the base is at most 1.
///
/// Heights. Over the triangle a, b, c with doubled projected area F, the height is the lowest corner's height
/// plus the other corners' heights above it, weighted by areas over F. The error of each area, and of F, is
/// at most 8 u E^2, so the error of the height is at most 32 u E^2 / F times the range of heights. It counts
/// over an area of at most F / 2, and of at most the polygon's area. Where the lower of two triangles is
/// ambiguous, they differ by at most these errors, which therefore count twice.
///
/// Sums. A polygon's integral is a sum over fewer than 16 triangles of area at most D^2 / 2, each with a few
/// roundings: less than 100 u D^2.
///
/// Parallel triangles. A triangle that is so nearly parallel to x that the sign of F is ambiguous (F < 16 u
/// D^2) contributes only an error: its area is less than 16 u D^2.
///
/// Corners. The error of a corner is at most e = u in each coordinate, 2 e in length. The volume that a
/// triangle sweeps when its corners move by 2 e is at most 2 e times its area, plus 2 e for its perimeter.
///
/// Bodies of different sizes. The common volume is in the intersection of the bodies' boxes. If that is
/// small, all triangles are cut to its shadow along x, their heights are limited to its heights, and it
/// becomes the unit, so that the errors are those of the overlap. Below and above it the common volume of the
/// limited bodies is 0. Each of the six cuts moves a corner by at most 16 u from the exact triangle: the
/// parameter has an error of 4 u, edges are at most sqrt 3 long, and the sum is rounded.

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "engine/clash/clash_parts.hpp"
#include <lrbscope/core/polygon.hpp>

namespace lrb {
namespace {

using Eigen::Vector2d;

constexpr double kRounding = 0x1p-53;
constexpr double kSideError = 16 * kRounding;
constexpr double kHeightError = 96 * kRounding;

/// Bound on the errors of clipping and of sums.
double clip_error(double clipped, double clipping) {
  return kRounding * clipped * (32 + 256 * (clipped + clipping));
}

/// A triangle projected along x, oriented counter-clockwise.
struct Seen {
  Vector2d p[3];
  double height[3];
  double area2 = 0;     ///< doubled
  double diameter = 0;  ///< rounded up
  int sign = 0;         ///< 1: faces up (+x); -1: down; 0: ambiguous
  Eigen::AlignedBox2d box;

  double range() const { return std::max({height[0], height[1], height[2]}) - min_height(); }
  double min_height() const { return std::min({height[0], height[1], height[2]}); }

  double height_at(const Vector2d& x) const {
    // The lowest corner's height plus weighted differences: errors scale only with the range of heights.
    const double least = min_height();
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      const Vector2d a = p[(k + 1) % 3] - x, b = p[(k + 2) % 3] - x;
      sum += (a.x() * b.y() - a.y() * b.x()) / area2 * (height[k] - least);
    }
    return least + sum;
  }
};

Seen project_triangle(const UnitBody& body, const std::array<std::uint32_t, 3>& t) {
  Seen s;
  for (int k = 0; k < 3; ++k) {
    // Project to the plane of y and z; heights are measured from the base x = -1/2.
    const Vector3d& x = body.points[t[static_cast<std::size_t>(k)]];
    s.p[k] = {x.y(), x.z()};
    s.height[k] = x.x() + 0.5;
    s.box.extend(s.p[k]);
  }
  const Vector2d u = s.p[1] - s.p[0], v = s.p[2] - s.p[0];
  s.diameter = s.box.diagonal().norm() * (1 + 8 * kRounding);
  s.area2 = u.x() * v.y() - u.y() * v.x();
  // Outside this error bound the sign of the area is certain.
  if (std::abs(s.area2) > kSideError * s.diameter * s.diameter) s.sign = s.area2 > 0 ? 1 : -1;
  // Counter-clockwise from now on; `sign` stores the orientation.
  if (s.area2 < 0) {
    std::swap(s.p[1], s.p[2]);
    std::swap(s.height[1], s.height[2]);
    s.area2 = -s.area2;
  }
  return s;
}

/// A polygon: a triangle clipped by up to four lines. It is convex up to rounding, so a line may cut its
/// boundary more than twice: it has at most 4, 6, 9, 13 corners.
struct Polygon {
  Vector2d p[16];
  int size = 0;
  void add(const Vector2d& x) { p[size++] = x; }
};

/// Clips a polygon to value(x) >= 0.
template <class Value>
Polygon clipped(const Polygon& in, const Value& value) {
  Polygon out;
  clip_polygon(std::span(in.p, static_cast<std::size_t>(in.size)), value,
               [&](const Vector2d& x, std::size_t, bool, bool) { out.add(x); });
  return out;
}

double area_of(const Polygon& polygon) {
  double sum = 0;
  // Triangle fan; relative coordinates keep the products small.
  for (int i = 1; i + 1 < polygon.size; ++i) {
    const Vector2d u = polygon.p[i] - polygon.p[0], v = polygon.p[i + 1] - polygon.p[0];
    sum += 0.5 * (u.x() * v.y() - u.y() * v.x());
  }
  return sum;
}

/// Integrates the height of a triangle over a polygon.
double integral(const Polygon& polygon, const Seen& t) {
  double sum = 0, h[16];
  for (int i = 0; i < polygon.size; ++i) h[i] = t.height_at(polygon.p[i]);
  // Exact for linear functions: area times the mean of the corners' heights.
  for (int i = 1; i + 1 < polygon.size; ++i) {
    const Vector2d u = polygon.p[i] - polygon.p[0], v = polygon.p[i + 1] - polygon.p[0];
    sum += (u.x() * v.y() - u.y() * v.x()) * (h[0] + h[i] + h[i + 1]) / 6;
  }
  return sum;
}

/// A compensated sum with an error bound (Neumaier 1974). Its error is a few roundings of the sum, plus u^2
/// times the number of terms, relative to the sum of the terms' magnitudes.
class Sum {
 public:
  void add(double value, double error) {
    // The rounding error of the addition, exactly (Fast2Sum, Dekker 1971).
    const double next = sum_ + value;
    rest_ += std::abs(sum_) >= std::abs(value) ? (sum_ - next) + value : (value - next) + sum_;
    sum_ = next;
    error_ += error;
    size_ += std::abs(value);
  }
  ProvedInterval interval(double more) const {
    // Volumes are not negative.
    const double value = sum_ + rest_;
    const double error = (error_ + more) * (1 + 0x1p-20) + 4 * kRounding * std::abs(value) + 0x1p-80 * size_;
    return {std::max(0.0, value - error), std::max(0.0, value + error)};
  }

 private:
  double sum_ = 0, rest_ = 0, error_ = 0, size_ = 0;
};

void add_pair(const Seen& a, const Seen& b, Sum& sum) {
  // Clip the smaller triangle: the error is proportional to its diameter.
  const bool a_is_less = a.diameter <= b.diameter;
  const Seen &small = a_is_less ? a : b, &large = a_is_less ? b : a;
  // An ambiguous orientation: the area is so small that it counts only as an error.
  for (const Seen* s : {&a, &b})
    if (s->sign == 0) {
      sum.add(0, kSideError * s->diameter * s->diameter);
      return;
    }
  // Clip to the left of the three edges of the larger triangle.
  Polygon polygon;
  for (const Vector2d& x : small.p) polygon.add(x);
  for (int k = 0; k < 3 && polygon.size > 0; ++k) {
    const Vector2d from = large.p[k], along = large.p[(k + 1) % 3] - from;
    polygon = clipped(polygon, [&](const Vector2d& x) {
      const Vector2d direction = x - from;
      return along.x() * direction.y() - along.y() * direction.x();
    });
  }
  double error = clip_error(small.diameter, large.diameter);
  // The projections intersect by less than the error, or not at all.
  if (polygon.size < 3) {
    sum.add(0, error);
    return;
  }
  // The area over which the error of the heights counts, rounded up.
  const double area = std::max(0.0, area_of(polygon)) + 128 * kRounding * small.diameter * small.diameter;
  for (const Seen* s : {&a, &b})
    error += kHeightError * s->diameter * s->diameter * s->range() * std::min(0.5, area / s->area2) *
             (1 + 0x1p-20);
  // Integrate the lower height: a's everywhere, corrected to b's where b is lower. Where both are equal, the
  // correction is 0.
  const Polygon under = clipped(polygon, [&](const Vector2d& x) { return a.height_at(x) - b.height_at(x); });
  const double value = integral(polygon, a) + (integral(under, b) - integral(under, a));
  sum.add(a.sign * b.sign * value, error);
}

std::vector<Seen> seen_of(const UnitBody& body) {
  std::vector<Seen> out;
  for (const auto& t : body.triangles) out.push_back(project_triangle(body, t));
  return out;
}

/// Returns an upper bound on the change of the volume by an error of corners in each coordinate.
double rounding_of_corners(const UnitBody& body, double error) {
  double sum = 0;
  for (const auto& t : body.triangles) {
    const Vector3d u = body.points[t[1]] - body.points[t[0]], v = body.points[t[2]] - body.points[t[0]];
    const double edges = u.norm() + v.norm() + (v - u).norm();
    // Doubled area and perimeter, plus their own rounding.
    sum += u.cross(v).norm() + 0x1p-40 * edges + 0x1p-80;
  }
  return 4 * error * sum;
}

/// Returns an upper bound on a body's volume, by tetrahedra from one of its corners. Each is a determinant
/// with a relative error of 9 u of its permanent, which is at most sqrt 3 times the product of the lengths.
double volume_at_most(const UnitBody& body) {
  double sum = 0, size = 0;
  for (const auto& t : body.triangles) {
    const Vector3d a = body.points[t[0]] - body.points[body.triangles[0][0]],
                   u = body.points[t[1]] - body.points[t[0]], v = body.points[t[2]] - body.points[t[0]];
    sum += a.dot(u.cross(v));
    size += a.norm() * u.norm() * v.norm();
  }
  const double rounding = kRounding * (32 + 2 * static_cast<double>(body.triangles.size())) * size;
  return (std::abs(sum) + rounding) / 6 * (1 + 0x1p-50) + rounding_of_corners(body, kRounding);
}

/// Returns the number of a strip across y, of `count`. Clamped, so that rounding at the border is harmless.
std::size_t strip_of(const Seen& t, std::size_t count) {
  const double share = std::clamp(t.box.min().x() + 0.5, 0.0, 1.0) * static_cast<double>(count);
  return std::min(static_cast<std::size_t>(share), count - 1);
}

/// Returns a projected box as one of space, without extent along x.
Box in_space(const Eigen::AlignedBox2d& box) {
  return {Vector3d(0, box.min().x(), box.min().y()), Vector3d(0, box.max().x(), box.max().y())};
}

/// The intersection of the bodies' boxes, grown by `more`.
Eigen::AlignedBox3d box_of_overlap(const UnitBodies& bodies, double more) {
  Eigen::AlignedBox3d box[2];
  for (int side = 0; side < 2; ++side)
    for (const auto& t : bodies.body[side].triangles)
      for (const std::uint32_t v : t) box[side].extend(bodies.body[side].points[v]);
  const Vector3d by = Vector3d::Constant(more);
  return {box[0].min().cwiseMax(box[1].min()) - by, box[0].max().cwiseMin(box[1].max()) + by};
}

using Outline = std::vector<Vector3d>;

/// Returns the part of a polygon in { x : sign (x[axis] - at) >= 0 }.
Outline part_of(const Outline& in, int axis, double at, double sign) {
  Outline out;
  const auto ahead = [&](const Vector3d& x) { return sign * (x[axis] - at); };
  clip_polygon(in, ahead, [&](const Vector3d& x, std::size_t, bool is_new, bool) {
    out.push_back(x);
    if (is_new) out.back()[axis] = at;
  });
  return out;
}

/// Returns a body cut and limited to a box, in a frame in which the box is centred and 2^zoom times as large.
UnitBody limited(const UnitBody& body, const Eigen::AlignedBox3d& box, int zoom) {
  UnitBody out;
  const auto add = [&](const Outline& corners) {
    const auto first = static_cast<std::uint32_t>(out.points.size());
    for (const Vector3d& x : corners) {
      Vector3d y = x;
      y.x() = std::clamp(y.x(), box.min().x(), box.max().x());
      out.points.emplace_back((y - box.center()) * std::ldexp(1.0, zoom));
    }
    for (std::uint32_t i = 2; i < corners.size(); ++i)
      out.triangles.push_back({first, first + i - 1, first + i});
  };
  for (const auto& t : body.triangles) {
    Outline inside = {body.points[t[0]], body.points[t[1]], body.points[t[2]]};
    for (int axis = 1; axis < 3; ++axis) {
      inside = part_of(inside, axis, box.min()[axis], 1);
      inside = part_of(inside, axis, box.max()[axis], -1);
    }
    add(part_of(inside, 0, box.min().x(), -1));
    add(part_of(inside, 0, box.max().x(), 1));
    add(part_of(part_of(inside, 0, box.min().x(), 1), 0, box.max().x(), -1));
  }
  return out;
}

ProvedInterval volume_of(const UnitBodies& bodies, double error_of_corners) {
  const std::vector<Seen> a = seen_of(bodies.body[0]), b = seen_of(bodies.body[1]);
  std::vector<Box> boxes;
  for (const Seen& t : b) boxes.push_back(in_space(t.box));
  const BoxTree tree(boxes);
  // A sum's last bits depend on the order of its terms: that of the first strip that both reach, then of b.
  const auto strips = static_cast<std::size_t>(std::sqrt(static_cast<double>(b.size()))) + 1;
  Sum sum;
  std::vector<std::pair<std::size_t, std::uint32_t>> near;
  for (const Seen& t : a) {
    near.clear();
    const std::size_t own = strip_of(t, strips);
    tree.for_each_in(in_space(t.box),
                     [&](std::uint32_t i) { near.emplace_back(std::max(own, strip_of(b[i], strips)), i); });
    std::sort(near.begin(), near.end());
    for (const auto& [strip, i] : near) add_pair(t, b[i], sum);
  }
  // The error from the rounding of all corners is added once, at the end.
  return sum.interval(rounding_of_corners(bodies.body[0], error_of_corners) +
                      rounding_of_corners(bodies.body[1], error_of_corners));
}

}  // namespace

ProvedInterval shared_volume(const UnitBodies& bodies) {
  // Larger than the rounding of corners and of the volume of the box.
  const Eigen::AlignedBox3d box = box_of_overlap(bodies, 0x1p-40);
  if (box.isEmpty()) return volume_of(bodies, kRounding);
  // 2^zoom times the box has a size from 1/2 to 1. Bodies of similar sizes stay as they are.
  constexpr int kMinZoom = 4, kMaxZoom = 28;
  const int zoom = std::min(-std::ilogb(box.sizes().maxCoeff()) - 1, kMaxZoom);
  ProvedInterval volume;
  if (zoom < kMinZoom) {
    volume = volume_of(bodies, kRounding);
  } else {
    const UnitBodies part{{}, {limited(bodies.body[0], box, zoom), limited(bodies.body[1], box, zoom)}};
    constexpr double kCutError = 128 * kRounding;
    volume = volume_of(part, std::ldexp(kCutError, zoom));
    volume.lower = std::ldexp(volume.lower, -3 * zoom);
    volume.upper = std::ldexp(volume.upper, -3 * zoom);
  }
  volume.upper = std::min({volume.upper, box.volume() * (1 + 0x1p-40), volume_at_most(bodies.body[0]),
                           volume_at_most(bodies.body[1])});
  volume.lower = std::min(volume.lower, volume.upper);
  return volume;
}

}  // namespace lrb
