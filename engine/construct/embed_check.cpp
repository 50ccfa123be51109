#include "engine/construct/embed_check.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "engine/core/geometry.hpp"
#include "engine/exact/predicates.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::construct {
namespace {

using Box = Eigen::AlignedBox3d;
using Vector3 = Eigen::Vector3d;

int side(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  return exact::orient3d(a.data(), b.data(), c.data(), d.data());
}

}  // namespace

bool turns_outward(const Vector3& a, const Vector3& b, const Vector3& p, const Vector3& w, const Vector3& q) {
  // Measure angles about the edge from the old triangle. Three signs order w and q without computing angles.
  const int new_side = side(a, b, p, w), far_side = side(a, b, p, q);
  // w is at less than 180 degrees. q comes later if it is at 180 or more, or in front of the new triangle.
  if (new_side > 0) return far_side <= 0 || side(a, b, w, q) > 0;
  // w is at 180 degrees, so q must be beyond. (At 0 degrees it overlaps the patch, which the overlap test
  // detects.)
  if (new_side == 0) return far_side < 0;
  // w is at more than 180 degrees: q must be as well, and in front of the new triangle.
  return far_side < 0 && side(a, b, w, q) > 0;
}

CheckedTriangle::CheckedTriangle(const FrontMesh::Point& a, const FrontMesh::Point& b,
                                 const FrontMesh::Point& c)
    : x{a.x.data(), b.x.data(), c.x.data()}, id{a.id, b.id, c.id}, box(a.x) {
  box.extend(b.x);
  box.extend(c.x);
}

bool CheckedTriangle::clear_of(const CheckedTriangle& other) const {
  return !box.intersects(other.box) ||
         exact::meet_only_in_shared(x.data(), id.data(), other.x.data(), other.id.data());
}

TriangleReach::TriangleReach(const CheckedTriangle& t)
    : box_(t.box), corner_(t.x[0][0], t.x[0][1], t.x[0][2]) {
  const Vector3 u = Vector3(t.x[1][0], t.x[1][1], t.x[1][2]) - corner_;
  const Vector3 v = Vector3(t.x[2][0], t.x[2][1], t.x[2][2]) - corner_;
  // The normal is not normalised, which saves a square root: all terms of the plane test scale with it.
  normal_ = u.cross(v);
  // The error of the normal is below 2^-50 |u| |v|; the error of a product with it is below this times the
  // other factor. The slack of 2^-40 far exceeds their sum.
  slack_ = 0x1p-40 * norm3(u) * norm3(v);
}

bool TriangleReach::may_meet(const Box& other) const {
  if (!box_.intersects(other)) return false;
  // Plane against box (Ericson 2005): the radius of the box along the normal, plus the rounding slack.
  const Vector3 half = other.sizes() / 2, from_corner = other.center() - corner_;
  const double reach = dot3(normal_.cwiseAbs(), half) + slack_ * (norm3(half) + norm3(from_corner));
  // Written so that NaN and infinity keep the box.
  return !(std::abs(dot3(normal_, from_corner)) > reach);
}

}  // namespace lrb::construct
