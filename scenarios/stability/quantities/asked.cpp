#include "scenarios/stability/quantities/asked.hpp"

#include <cmath>

#include "scenarios/methods/body_parts.hpp"

namespace lrb::stability {
namespace {

using Eigen::Vector3d;

/// Rational brute force takes seconds for more.
constexpr std::uint32_t kMostFaces = 100, kMostFacesForDepth = 20;

/// Returns the vector with 20 bits to a coordinate, so that a quarter and three quarters of it are exact.
Vector3d rounded(const Vector3d& x) {
  Vector3d out;
  for (int k = 0; k < 3; ++k) {
    int exponent = 0;
    const double part = std::frexp(x[k], &exponent);
    out[k] = std::ldexp(std::round(std::ldexp(part, 20)), exponent - 20);
  }
  return out;
}

}  // namespace

std::string why_not_asked(Quantity quantity, const cases::Case& c) {
  if (c.a->dim() == 2) return "2D bodies";
  const std::uint32_t most = quantity == Quantity::depth ? kMostFacesForDepth : kMostFaces;
  for (const auto& [rep, pose] : {std::pair{c.a, c.pose_a}, std::pair{c.b, c.pose_b}}) {
    if (rep->real_simplex_count() > most)
      return "a body of more than " + std::to_string(most) + " triangles, too many for rational arithmetic";
    for (const Vector3d& v : rep->vertices())
      if (!(pose.apply(v).norm() < 1e150)) return "coordinates of which a square is no double";
    if (quantity == Quantity::depth && !rep->closed()) return "a body that is not closed";
  }
  return "";
}

Asked asked(const cases::Case& c) {
  Asked out{methods::at_pose(*c.a, c.pose_a), methods::at_pose(*c.b, c.pose_b)};
  const Eigen::AlignedBox3d box_a = shapes::box_of(out.a), box_b = shapes::box_of(out.b);
  out.size = std::max(box_a.diagonal().norm(), box_b.diagonal().norm());
  // Not quite between the middles: the oracle wants no faces that slide along each other.
  Vector3d direction = box_b.center() - box_a.center();
  direction = direction.norm() > 0 ? direction.normalized() : Vector3d(0, 0, 1);
  direction += Vector3d(0.0312, 0.0487, -0.0256);
  const Vector3d way = rounded(-4 * out.size * direction);
  out.from = -0.75 * way;
  out.to = 0.25 * way;
  return out;
}

}  // namespace lrb::stability
