#include "engine/construct/surface_walk.hpp"

#include <algorithm>
#include <cmath>

namespace lrb::construct {
namespace {

using Point = SurfaceWalk::Point;

Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Point operator*(float s, const Point& a) {
  return {s * a.x, s * a.y, s * a.z};
}
float dot(const Point& a, const Point& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

}  // namespace

SurfaceWalk::SurfaceWalk(const FrontMesh& front, const AabbTree& tree, double unit)
    : tree_(tree), unit_(unit), scale_(1 / unit) {
  Eigen::AlignedBox3d box;
  for (FrontMesh::Corner v = 0; v < front.point_count(); ++v) box.extend(front.x(v));
  centre_ = box.min() / 2 + box.max() / 2;
  triangles_.resize(front.slot_count());
  for (Slot s = 0; s < front.slot_count(); ++s) {
    const FrontMesh::Triangle& t = front[s];
    const Point a = local(front.x(t.v[0]));
    triangles_[s] = {a, local(front.x(t.v[1])) - a, local(front.x(t.v[2])) - a, t.v, t.across};
  }
}

/// Ericson, Real-Time Collision Detection, 5.1.5, with the interior tested first.
SurfaceWalk::Nearest SurfaceWalk::nearest(const Triangle& t, const Point& p) {
  const Point ap = p - t.a;
  const float d1 = dot(t.ab, ap), d2 = dot(t.ac, ap);
  const float bb = dot(t.ab, t.ab), bc = dot(t.ab, t.ac), cc = dot(t.ac, t.ac);
  const float vb = cc * d1 - bc * d2, vc = bb * d2 - bc * d1, all = bb * cc - bc * bc;
  const auto from = [&](const Point& q, Feature feature) { return Nearest{dot(q, q), feature}; };
  if (vb >= 0 && vc >= 0 && vb + vc <= all && all > 0)
    return from(ap - (vb / all) * t.ab - (vc / all) * t.ac, Feature::inside);
  const float d3 = d1 - bb, d4 = d2 - bc, d5 = d1 - bc, d6 = d2 - cc;
  if (d1 <= 0 && d2 <= 0) return from(ap, Feature::corner_a);
  if (d3 >= 0 && d4 <= d3) return from(ap - t.ab, Feature::corner_b);
  if (d6 >= 0 && d5 <= d6) return from(ap - t.ac, Feature::corner_c);
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return from(ap - (d1 / bb) * t.ab, Feature::edge_ab);
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return from(ap - (d2 / cc) * t.ac, Feature::edge_ca);
  const float length = (d4 - d3) + (d5 - d6);
  const float share = length > 0 ? std::clamp((d4 - d3) / length, 0.0f, 1.0f) : 0.0f;
  return from(ap - t.ab - share * (t.ac - t.ab), Feature::edge_bc);
}

float SurfaceWalk::walk(const Point& p, Slot& hint, float enough) const {
  Nearest best = nearest(triangles_[hint], p);
  while (best.distance_sq > enough && best.feature != Feature::inside) {
    const Slot from = hint;
    const float before = best.distance_sq;
    const auto look_at = [&](Slot s) {
      const Nearest n = nearest(triangles_[s], p);
      if (n.distance_sq < best.distance_sq) best = n, hint = s;
    };
    if (best.feature < Feature::corner_a) {
      // Over the edge that is nearest.
      look_at(triangles_[from].across[static_cast<int>(best.feature) - 1]);
    } else {
      // Around the corner that is nearest.
      constexpr int kMaxTurns = 40;
      const std::uint32_t corner = triangles_[from].v[static_cast<int>(best.feature) - 4];
      Slot s = from;
      for (int turn = 0; turn < kMaxTurns && best.distance_sq > enough; ++turn) {
        const Triangle& t = triangles_[s];
        const int i = t.v[0] == corner ? 0 : t.v[1] == corner ? 1 : 2;
        s = t.across[(i + 2) % 3];
        if (s == from) break;
        look_at(s);
      }
    }
    // Stop at a local minimum; less progress than this is rounding.
    constexpr float kMinProgress = 1e-6f;
    if (!(best.distance_sq < before * (1 - kMinProgress))) break;
  }
  return best.distance_sq;
}

bool SurfaceWalk::find_within(const Point& p, Slot& hint, float enough) const {
  const Eigen::Vector3d centre = centre_ + unit_ * Eigen::Vector3d(p.x, p.y, p.z);
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(unit_ * std::sqrt(static_cast<double>(enough)));
  bool found = false;
  tree_.for_each_near(
      Eigen::AlignedBox3d(centre - reach, centre + reach), [&](const Eigen::AlignedBox3d&) { return !found; },
      [&](Slot s) {
        if (found || nearest(triangles_[s], p).distance_sq > enough) return;
        found = true;
        hint = s;
      });
  return found;
}

}  // namespace lrb::construct
