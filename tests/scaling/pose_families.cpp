// One query of two bodies under poses other than rotations: it grows with the answer and the nearby faces,
// as under a rotation. Where boxes culled nothing it would grow with the product of both bodies' faces.

#include <cmath>
#include <memory>

#include <Eigen/Geometry>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/scaling/scaling.hpp"
#include <lrbscope/collide.hpp>

namespace lrb::scaling {
namespace {

/// The pose that puts the maps of two balls of radius 1 across each other.
Pose across(const Eigen::Matrix3d& map) {
  Pose pose;
  pose.r = map * Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  pose.t = map * Eigen::Vector3d(0.5, 0.4, 0.3);
  return pose;
}

/// The query alone, of balls of about n faces each.
Task ask(std::uint32_t n, const Eigen::Matrix3d& map_a, const Eigen::Matrix3d& map_b) {
  const auto stacks = static_cast<int>(std::sqrt(n / 2.0));
  const auto body =
      std::make_shared<LrbRep>(LrbRep::without_regions(shapes::uv_sphere(stacks, stacks + 1), true, false));
  const auto context = std::make_shared<QueryContext>();
  const Pose a{map_a, {0, 0, 0}}, b = across(map_b);
  const auto work = [=] {
    NullProbe probe;
    return collide(*body, a, *body, b, CollideRequest{}, *context, probe).pairs.size();
  };
  return {static_cast<double>(n + work()), work};
}

bool add_pose(const std::string& name, const Eigen::Matrix3d& map_a, const Eigen::Matrix3d& map_b) {
  return add({name,
              "query at a pose",
              "faces and pairs",
              {4000, 16000, 64000},
              {256000, 1024000},
              [=](std::uint32_t n) { return ask(n, map_a, map_b); }});
}

Eigen::Matrix3d diagonal(double x, double y, double z) {
  return Eigen::Vector3d(x, y, z).asDiagonal();
}

Eigen::Matrix3d shear() {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  m(0, 1) = 0.5;
  return m;
}

const Eigen::Matrix3d kOne = Eigen::Matrix3d::Identity();

const bool poses_added[] = {
    add_pose("scaled by 1.01", kOne, 1.01 * kOne),
    add_pose("scaled by 1.5", kOne, 1.5 * kOne),
    add_pose("both scaled by 1e-150", 1e-150 * kOne, 1e-150 * kOne),
    add_pose("stretched", kOne, diagonal(1, 2, 0.5)),
    add_pose("sheared", shear(), kOne),
    add_pose("mirrored", diagonal(-1, 1, 1), kOne),
    add_pose("thin", diagonal(1, 1, 0.001), kOne),
    add_pose("flat", kOne, diagonal(1, 1, 0)),
};

}  // namespace
}  // namespace lrb::scaling
