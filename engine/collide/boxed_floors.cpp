#include "engine/collide/boxed_floors.hpp"

#include <algorithm>

#include "engine/core/geometry.hpp"

namespace lrb {

BoxedFloors::BoxedFloors(QueryBody& body, const UnitCube& cube)
    : body_(body), cube_(cube), number_(body.rep().region_count(), 0) {
  add(body.rep().outermost_faces());
}

std::uint32_t BoxedFloors::number_of(RegionId r) {
  if (number_[r] == 0) {
    add(body_.rep().floor(r));
    number_[r] = static_cast<std::uint32_t>(floors_.size() - 1);
  }
  return number_[r];
}

void BoxedFloors::load(std::span<const FaceId> faces) {
  points_.clear();
  for (const FaceId f : faces)
    for (const VertexId v : body_.rep().face(f))
      points_.push_back(cube_(Eigen::Map<const Eigen::Vector3d>(body_.world(v))));
}

void BoxedFloors::add(std::span<const FaceId> faces) {
  load(faces);
  floors_.push_back({faces, points_.empty() ? OrientedBox() : OrientedBox::about(points_)});
}

/// Tests the three axes of the box and the normal of the face. Any direction along which the intervals of
/// the two are apart proves them disjoint, so only sums are rounded; the box has a margin for that.
bool BoxedFloors::may_reach(FaceId f, const OrientedBox& box) {
  load({&f, 1});
  const auto apart = [&](const Eigen::Vector3d& along, double reach) {
    const double centre = dot3(along, box.centre);
    double low = kInfinity, high = -kInfinity;
    for (const Eigen::Vector3d& p : points_) {
      const double x = dot3(along, p) - centre;
      low = std::min(low, x);
      high = std::max(high, x);
    }
    return low > reach || high < -reach;
  };
  for (int i = 0; i < 3; ++i)
    if (apart(box.axes.row(i), box.half[i])) return false;
  if (points_.size() < 3) return true;  // a segment
  const Eigen::Vector3d n = normalized3((points_[1] - points_[0]).cross(points_[2] - points_[0]));
  return !apart(n, dot3(product3(box.axes, n).cwiseAbs(), box.half));
}

UnitCube cube_around(QueryContext& context) {
  Eigen::AlignedBox3d world;
  for (const Side side : {Side::a, Side::b})
    for (const FaceId f : context[side].rep().outermost_faces())
      for (const VertexId v : context[side].rep().face(f))
        world.extend(Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(context[side].world(v))));
  return UnitCube(world);
}

}  // namespace lrb
