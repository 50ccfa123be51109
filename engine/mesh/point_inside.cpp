#include "engine/mesh/point_inside.hpp"

#include "engine/exact/locate.hpp"

namespace lrb {
namespace {

/// Calls visit(hit) for each triangle of the face's fan (2D: for the segment) until it returns false.
template <class Visit>
bool cast_at_face(const Mesh& mesh, FaceId f, const Eigen::Vector3d& p, Visit visit) {
  const auto corners = mesh.face(f);
  const auto point = [&](std::size_t i) { return mesh.vertices[corners[i]].data(); };
  if (mesh.dim == 2) {
    const double* const segment[2] = {point(0), point(1)};
    return visit(exact::ray_crosses_2d(p.data(), segment));
  }
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const double* const triangle[3] = {point(0), point(i), point(i + 1)};
    if (!visit(exact::ray_crosses(p.data(), triangle))) return false;
  }
  return true;
}

}  // namespace

PointSide point_side(const Mesh& mesh, std::span<const FaceId> faces, const Eigen::Vector3d& p) {
  bool inside = false;
  const auto count = [&](exact::RayHit hit) {
    inside ^= hit == exact::RayHit::crosses;
    return hit != exact::RayHit::on_face;
  };
  for (const FaceId f : faces)
    if (!cast_at_face(mesh, f, p, count)) return PointSide::on_surface;
  return inside ? PointSide::inside : PointSide::outside;
}

}  // namespace lrb
