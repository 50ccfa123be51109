// Exact painting order by binary space partitioning (Fuchs, Kedem and Naylor 1980). Large sets are halved by
// planes perpendicular to an axis, small ones are split by the planes of their own polygons.

#include "render/depth_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lrb::render {
namespace {

using Eigen::Vector3d;

/// Maximum number of polygons that are split by their own planes.
constexpr std::size_t kLeaf = 24;
/// A corner closer to a plane than this share of the scene's size counts as on it. The error is invisible.
constexpr double kOnPlane = 1e-9;
/// Axis-perpendicular planes are used while neither side keeps more than this share of the polygons.
constexpr double kWorthIt = 0.75;
/// Maximum recursion depth, for sets that splitting does not reduce (many polygons through one point).
constexpr int kMaxDepth = 64;

struct Plane {
  Vector3d normal;
  double offset;
  double height(const Vector3d& x) const { return normal.dot(x) - offset; }
};

struct Sides {
  std::vector<EyePolygon> front, on, back;
};

class Sorter {
 public:
  Sorter(bool orthographic, double tolerance, std::vector<EyePolygon>& out)
      : orthographic_(orthographic), tolerance_(tolerance), out_(out) {}

  void sort(std::vector<EyePolygon> polygons, int depth) {
    if (polygons.size() <= 1 || depth == kMaxDepth) {
      for (EyePolygon& p : polygons) out_.push_back(std::move(p));
      return;
    }
    Plane plane;
    // Axis planes keep the tree balanced; a polygon's own plane always makes progress, as it removes that
    // polygon.
    const bool by_axis = polygons.size() > kLeaf && median_plane(polygons, plane);
    if (!by_axis) plane = best_own_plane(polygons);
    Sides sides;
    for (EyePolygon& p : polygons) split(std::move(p), plane, sides);
    polygons.clear();
    // Everything on the far side of the plane is painted first. The eye is at the origin, or infinitely far
    // away along -z.
    const bool viewer_in_front = orthographic_ ? plane.normal.z() < 0 : plane.offset < 0;
    sort(std::move(viewer_in_front ? sides.back : sides.front), depth + 1);
    for (EyePolygon& p : sides.on) out_.push_back(std::move(p));
    sort(std::move(viewer_in_front ? sides.front : sides.back), depth + 1);
  }

 private:
  static Vector3d centre(const EyePolygon& p) {
    Vector3d sum = Vector3d::Zero();
    for (const Vector3d& x : p.x) sum += x;
    return sum / static_cast<double>(p.x.size());
  }

  /// Returns false if the plane would split too many polygons.
  bool median_plane(const std::vector<EyePolygon>& polygons, Plane& plane) const {
    Vector3d lo = Vector3d::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
    for (const EyePolygon& p : polygons) {
      const Vector3d c = centre(p);
      lo = lo.cwiseMin(c), hi = hi.cwiseMax(c);
    }
    int axis = 0;
    (hi - lo).maxCoeff(&axis);
    std::vector<double> at;
    for (const EyePolygon& p : polygons) at.push_back(centre(p)[axis]);
    const auto median = at.begin() + static_cast<std::ptrdiff_t>(at.size() / 2);
    // The median centre along the longest axis.
    std::nth_element(at.begin(), median, at.end());
    plane = {Vector3d::Unit(axis), *median};
    const Count n = count(polygons, plane);
    return static_cast<double>(std::max(n.front, n.back) + n.cut) <=
           kWorthIt * static_cast<double>(polygons.size());
  }

  /// Picks, among the first few polygons, the one whose plane splits the fewest others; on a tie, the one
  /// that divides them most evenly.
  Plane best_own_plane(const std::vector<EyePolygon>& polygons) const {
    Plane best{};
    std::size_t least = std::numeric_limits<std::size_t>::max();
    // A bounded number of candidates: each costs one pass over the polygons.
    for (std::size_t i = 0; i < std::min(polygons.size(), kLeaf); ++i) {
      Plane plane{polygons[i].normal.normalized(), 0};
      plane.offset = plane.normal.dot(centre(polygons[i]));
      const Count n = count(polygons, plane);
      const std::size_t cost =
          n.cut * polygons.size() + (n.front > n.back ? n.front - n.back : n.back - n.front);
      if (cost < least) least = cost, best = plane;
    }
    return best;
  }

  struct Count {
    std::size_t front = 0, back = 0, cut = 0;
  };
  Count count(const std::vector<EyePolygon>& polygons, const Plane& plane) const {
    Count n;
    for (const EyePolygon& p : polygons) {
      // Within the tolerance a corner counts as on the plane, so rounding makes no slivers.
      const auto [low, high] = heights(p, plane);
      if (low < -tolerance_ && high > tolerance_)
        ++n.cut;
      else if (high > tolerance_)
        ++n.front;
      else if (low < -tolerance_)
        ++n.back;
    }
    return n;
  }

  static std::pair<double, double> heights(const EyePolygon& p, const Plane& plane) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Vector3d& x : p.x) {
      const double h = plane.height(x);
      low = std::min(low, h), high = std::max(high, h);
    }
    return {low, high};
  }

  void split(EyePolygon p, const Plane& plane, Sides& sides) const {
    const auto [low, high] = heights(p, plane);
    if (low >= -tolerance_ && high <= tolerance_) {
      sides.on.push_back(std::move(p));
    } else if (low >= -tolerance_) {
      sides.front.push_back(std::move(p));
    } else if (high <= tolerance_) {
      sides.back.push_back(std::move(p));
    } else {
      EyePolygon front{{}, p.normal, p.source}, back{{}, p.normal, p.source};
      for (std::size_t i = 0; i < p.x.size(); ++i) {
        const Vector3d &a = p.x[i], &b = p.x[(i + 1) % p.x.size()];
        const double ha = plane.height(a), hb = plane.height(b);
        if (ha >= -tolerance_) front.x.push_back(a);
        if (ha <= tolerance_) back.x.push_back(a);
        if ((ha > tolerance_ && hb < -tolerance_) || (ha < -tolerance_ && hb > tolerance_)) {
          const Vector3d cut = a + (b - a) * (ha / (ha - hb));
          front.x.push_back(cut);
          back.x.push_back(cut);
        }
      }
      sides.front.push_back(std::move(front));
      sides.back.push_back(std::move(back));
    }
  }

  bool orthographic_;
  double tolerance_;
  std::vector<EyePolygon>& out_;
};

}  // namespace

std::vector<EyePolygon> back_to_front(std::vector<EyePolygon> polygons, bool orthographic) {
  std::erase_if(polygons, [](const EyePolygon& p) { return !(p.normal.squaredNorm() > 0); });
  double size = 0;
  for (const EyePolygon& p : polygons) {
    // The tolerance is relative to the largest coordinate.
    for (const Vector3d& x : p.x) size = std::max(size, x.cwiseAbs().maxCoeff());
  }
  std::vector<EyePolygon> out;
  out.reserve(polygons.size() * 2);
  Sorter(orthographic, kOnPlane * size, out).sort(std::move(polygons), 0);
  return out;
}

}  // namespace lrb::render
