#include "scenarios/run/parting_square.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "scenarios/run/view_camera.hpp"

namespace lrb::run {
namespace {

/// Returns a square round a point that is carried into the plane n.x = at.
Square square(const Eigen::Vector3d& n, double at, Eigen::Vector3d middle, double half, int dim) {
  middle += n * (at - n.dot(middle));
  if (dim == 2) {
    const Eigen::Vector3d u = half * Eigen::Vector3d(-n.y(), n.x(), 0);
    return {middle + u, middle - u, middle - u, middle + u};
  }
  const Eigen::Vector3d u = half * n.unitOrthogonal(), v = n.cross(u);
  return {middle + u, middle + v, middle - u, middle - v};
}

}  // namespace

Square parting_square(const PartingPlane& plane, const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                      const Pose& pose_b) {
  constexpr double kShare = 0.35;  // of the smaller body's diagonal, from the middle to a corner
  const Eigen::AlignedBox3d of_a = box_with_lids(a, pose_a), of_b = box_with_lids(b, pose_b);
  const Eigen::AlignedBox3d& smaller = of_a.diagonal().norm() < of_b.diagonal().norm() ? of_a : of_b;
  return square(plane.normal, (plane.of_a + plane.of_b) / 2, smaller.center(),
                kShare * smaller.diagonal().norm(), a.dim());
}

Square parting_square(const PartedBoxes& parted, int dim) {
  const auto axis = static_cast<std::size_t>(parted.pair.axis);
  const auto& [a, b] = parted.boxes;
  Eigen::Vector3d normal = axis < 3 ? a.across[axis] : b.across[axis - 3];
  if (normal.dot(b.centre - a.centre) < 0) normal = -normal;
  double end_of_a = normal.dot(a.centre);
  for (const Eigen::Vector3d& h : a.half) end_of_a += std::abs(normal.dot(h));
  const auto size = [](const WorldBox& box) { return (box.half[0] + box.half[1] + box.half[2]).norm(); };
  return square(normal, end_of_a + parted.pair.gap / 2, (a.centre + b.centre) / 2, std::min(size(a), size(b)),
                dim);
}

std::optional<Square> parting_square(const WalkExplanation& walk, const LrbRep& a, const Pose& pose_a,
                                     const LrbRep& b, const Pose& pose_b) {
  if (walk.plane) return parting_square(*walk.plane, a, pose_a, b, pose_b);
  if (walk.nearest_boxes) return parting_square(*walk.nearest_boxes, a.dim());
  return {};
}

}  // namespace lrb::run
