/// Copies the triangles of both bodies into a common frame: centred on the box of both, scaled by a power of
/// two so that coordinates are at most 1/2. Scaling is exact, so each coordinate is rounded once, by the
/// subtraction.

#include "engine/query/clash/unit_bodies.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "engine/query/contact/reflection.hpp"

namespace lrb::parting {
namespace {

Vector3d as_vector(const double* x) {
  return {x[0], x[1], x[2]};
}

/// Copies the real triangles, in the world's coordinates.
UnitBody copy_body(QueryBody& body) {
  UnitBody out;
  const LrbRep& rep = body.rep();
  // Compact numbers, in the order of first use.
  std::vector<VertexId> number(rep.vertices().size(), kNull);
  const bool mirrored = is_reflection(body.world.pose(), 3);
  for (SimplexId s = 0; s < rep.real_simplex_count(); ++s) {
    VertexId v[3];
    rep.simplex(s, v);
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      VertexId& known = number[v[k]];
      if (known == kNull) {
        known = VertexId(out.points.size());
        out.points.push_back(as_vector(body.world(v[k])));
      }
      triangle[k] = known.value();
    }
    // A reflection turns triangles over: restore the outward orientation.
    if (mirrored) std::swap(triangle[1], triangle[2]);
    out.triangles.push_back(triangle);
  }
  return out;
}

}  // namespace

Vector3d UnitFrame::to_unit(const Vector3d& world) const {
  Vector3d x = world - origin;
  for (int k = 0; k < 3; ++k) x[k] = std::ldexp(x[k], -exponent);
  return x;
}

Vector3d UnitFrame::to_world(const Vector3d& unit) const {
  Vector3d x;
  for (int k = 0; k < 3; ++k) x[k] = std::ldexp(unit[k], exponent) + origin[k];
  return x;
}

double UnitFrame::length_to_world(double x) const {
  return std::ldexp(x, exponent);
}

UnitBodies unit_bodies(QueryContext& context) {
  UnitBodies out;
  Eigen::AlignedBox3d box;
  for (int side = 0; side < 2; ++side) {
    out.body[side] = copy_body(context.body[side]);
    for (const Vector3d& x : out.body[side].points) box.extend(x);
  }
  // Halved first, because the sum or the difference may leave the range of doubles.
  out.frame.origin = 0.5 * box.min() + 0.5 * box.max();
  const double reach = (0.5 * box.max() - 0.5 * box.min()).maxCoeff();
  // 2^(ilogb + 1) exceeds the half extent, so that coordinates stay below 1/2.
  out.frame.exponent = reach > 0 ? std::ilogb(reach) + 2 : 0;
  for (UnitBody& body : out.body)
    for (Vector3d& x : body.points) x = out.frame.to_unit(x);
  return out;
}

}  // namespace lrb::parting
