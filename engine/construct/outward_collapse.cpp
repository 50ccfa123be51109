#include "engine/construct/outward_collapse.hpp"

#include <algorithm>
#include <cmath>

#include "engine/construct/embed_check.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/plane_side.hpp"

namespace lrb::construct {

bool OutwardCollapse::place(const Star& star, Vector3& w) {
  Vector3 centre = Vector3::Zero(), outward = Vector3::Zero();
  for (const auto& r : star.rim) centre += open_.x(r.a);
  centre /= static_cast<double>(star.rim.size());
  double radius_sq = 0;
  for (const auto& r : star.rim) radius_sq = std::max(radius_sq, squared_norm3(open_.x(r.a) - centre));
  const double radius = std::sqrt(radius_sq);
  // The margin keeps the floating-point position strictly in front, so that the exact confirmation succeeds.
  const double margin = kPlacementMargin * radius;
  const auto in_front_of = [&](const OpenFront::Face& f) {
    return HalfSpace{f.n, f.d - dot3(f.n, centre) + margin};
  };
  half_spaces_.resize(star.faces.size());
  std::transform(star.faces.begin(), star.faces.end(), half_spaces_.begin(), [&](auto f) {
    outward += open_[f].n * open_[f].area;
    return in_front_of(open_[f]);
  });
  const double length = norm3(outward);
  if (!(length > 0)) return false;
  // In front of a neighbour at a reflex rim edge, where the fan could intersect it.
  for (const auto& r : star.rim) {
    const auto& own = open_[r.face];
    if (dot3(own.n, open_.x(open_.corner_opposite(r.across, r.a, r.b))) > own.d)
      half_spaces_.push_back(in_front_of(open_[r.across]));
  }
  const Vector3 target = outward * (-depth_ * radius / length);
  const auto solve = [&] {
    const auto p = nearest_point(target, half_spaces_, kPlacementSlack * radius);
    if (p) w = *p;
    return p && p->cwiseAbs().maxCoeff() <= 2 * radius;
  };
  if (!solve()) return false;
  // The bounds are rarely active: add them only if the position violates them.
  if (!bounds_.contains(w + centre)) {
    for (const HalfSpace& h : bounds_.half_spaces()) half_spaces_.push_back({h.n, h.d - dot3(h.n, centre)});
    if (!solve()) return false;
  }
  w += centre;
  return w.allFinite();  // squares of lengths above 1e154 overflow
}

bool OutwardCollapse::is_in_front(const Star& star) const {
  const Vector3& p = open_.x(star.v);
  double radius_sq = 0;
  for (const auto& r : star.rim)
    radius_sq = std::max(radius_sq, squared_norm3(open_.x(r.a) - open_.x(star.u)));
  const double margin = kPlacementMargin * std::sqrt(radius_sq);
  for (std::size_t k = 1; k + 1 < star.faces.size(); ++k) {
    const auto& f = open_[star.faces[k]];
    if (dot3(f.n, p) - f.d < margin) return false;
  }
  return true;
}

bool OutwardCollapse::clears_neighbours(const Star& star) const {
  const Vector3& p = open_.x(star.v);
  return std::all_of(star.rim.begin(), star.rim.end(), [&](const auto& r) {
    const auto &own = open_[r.face], &other = open_[r.across];
    const auto tip = open_.corner_opposite(r.across, r.a, r.b);
    return tip == star.v || !(dot3(own.n, open_.x(tip)) > own.d) || dot3(other.n, p) > other.d;
  });
}

double OutwardCollapse::volume_under(const Star& star, const Vector3& w, double& area) const {
  // Pyramids from w over the star's triangles.
  double volume = 0;
  area = 0;
  for (const auto f : star.faces) {
    volume += (dot3(open_[f].n, w) - open_[f].d) * open_[f].area;
    area += open_[f].area;
  }
  return volume / (3 * open_.unit());
}

double OutwardCollapse::needle_cost(const Star& star, const Vector3& w, double area) const {
  // The shape of the worst triangle: area over the sum of the squared edges.
  const double scale = 1 / open_.unit();
  double worst = kInfinity;
  for (const auto& r : star.rim) {
    const Vector3 a = (open_.x(r.a) - w) * scale, b = (open_.x(r.b) - w) * scale;
    worst = std::min(worst, norm3(a.cross(b)) / (squared_norm3(a) + squared_norm3(b) + squared_norm3(a - b)));
  }
  // Scaled so that an equilateral triangle has the shape 1.
  return needle_weight_ * area * std::sqrt(area) / (worst * (2 * std::sqrt(3.0)));
}

bool OutwardCollapse::folds(const Star& star, const Vector3& w) const {
  constexpr double kFolded = -0.95;  // cosine between the two normals
  return std::any_of(star.rim.begin(), star.rim.end(), [&](const auto& r) {
    const Vector3 &a = open_.x(r.a), &b = open_.x(r.b);
    const Vector3 n = (b - a).cross(w - a);
    if (dot3(n, open_[r.face].n) > 0) return false;
    return dot3(n, open_[r.across].n) < kFolded * norm3(n) ||
           !turns_outward(a, b, open_.x(open_.corner_opposite(r.face, r.a, r.b)), w,
                          open_.x(open_.corner_opposite(r.across, r.a, r.b)));
  });
}

bool OutwardCollapse::is_strictly_in_front(const Star& star, const Vector3& w) const {
  for (std::size_t k = 0; k < star.faces.size(); ++k) {
    if (star.onto_v && (k == 0 || k + 1 == star.faces.size())) continue;
    const auto& v = open_[star.faces[k]].v;
    const exact::PlaneSide plane(open_.x(v[0]).data(), open_.x(v[1]).data(), open_.x(v[2]).data());
    if (plane.side(w.data()) <= 0) return false;
  }
  return true;
}

}  // namespace lrb::construct
