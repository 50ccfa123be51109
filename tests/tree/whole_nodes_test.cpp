// Nodes that the walk parts as wholes, against the same boxes in double arithmetic, and the room that pairs
// of nodes take while they wait for each other.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/hard_bodies.hpp"
#include <lrbscope/explain.hpp>

namespace lrb::test {
namespace {

struct Visits : NullProbe {
  static constexpr bool kEnabled = true;
  std::vector<NodeVisit> list;

  EventLevel level() const { return EventLevel::nodes; }
  std::uint32_t node_pair(const NodeVisit& visit) {
    list.push_back(visit);
    return static_cast<std::uint32_t>(list.size() - 1);
  }
};

/// Returns how far two boxes are apart along a direction of length 1; negative where they overlap.
double gap_along(const Eigen::Vector3d& n, const WorldBox& a, const WorldBox& b) {
  double gap = std::abs(n.dot(b.centre - a.centre));
  for (const WorldBox* box : {&a, &b})
    for (const Eigen::Vector3d& half : box->half) gap -= std::abs(n.dot(half));
  return gap;
}

/// Returns how far two boxes are apart along an axis of either or a direction across an axis of each, where
/// that is furthest.
double widest_gap(const WorldBox& a, const WorldBox& b) {
  double widest = -std::numeric_limits<double>::infinity();
  const auto try_along = [&](const Eigen::Vector3d& n) {
    if (n.norm() > 1e-6) widest = std::max(widest, gap_along(n.normalized(), a, b));
  };
  for (const Eigen::Vector3d& x : a.across) try_along(x);
  for (const Eigen::Vector3d& y : b.across) try_along(y);
  for (const Eigen::Vector3d& x : a.across)
    for (const Eigen::Vector3d& y : b.across) try_along(x.cross(y));
  return widest;
}

struct Met {
  LrbRep a, b;
};

/// Bodies of unlike sizes, far from their own origins, full of needles, and in the plane.
std::vector<Met> bodies() {
  std::vector<Met> out;
  out.push_back({closed(shapes::bumpy_sphere(4, 3)), closed(shapes::torus(48, 24))});
  out.push_back({closed(shapes::bumpy_sphere(4, 5)), closed(shapes::bumpy_sphere(2, 6))});
  out.push_back({closed(shapes::translated(shapes::torus(40, 20), {900, -500, 300})),
                 closed(shapes::translated(shapes::bumpy_sphere(3, 9), {-700, 200, 80}))});
  out.push_back({closed(hard::cone(700)), closed(hard::crown(700))});
  out.push_back({closed(shapes::gear(60)), closed(shapes::gear(40))});
  return out;
}

/// Returns a pose of B in which the bodies are near each other, or meet.
Pose near_pose(shapes::RandomEngine& random, const Met& m) {
  const auto box_a = shapes::box_of(m.a), box_b = shapes::box_of(m.b);
  Pose pose;
  const bool flat = m.a.dim() == 2;
  pose.r = flat
               ? Eigen::AngleAxisd(shapes::uniform(random, 0, 6), Eigen::Vector3d::UnitZ()).toRotationMatrix()
               : shapes::random_rotation(random);
  Eigen::Vector3d way = shapes::random_direction(random);
  if (flat) way.z() = 0;
  const double size = std::max(box_a.diagonal().norm(), box_b.diagonal().norm());
  pose.t = box_a.center() - pose.r * box_b.center() + shapes::uniform(random, 0, 0.6) * size * way;
  return pose;
}

TEST_CASE("node OBB tests reject only disjoint nodes, and all clearly disjoint ones") {
  shapes::RandomEngine random(21);
  std::size_t rejected = 0, across = 0, opened = 0, flat = 0;
  for (const Met& m : bodies()) {
    flat += m.a.dim() == 2;
    const double size = std::max(m.a.tree().extent(), m.b.tree().extent());
    for (int i = 0; i < 12; ++i) {
      const Pose pose = near_pose(random, m);
      Visits visits;
      QueryContext context;
      collide(m.a, Pose{}, m.b, pose, {}, context, visits);
      for (const NodeVisit& v : visits.list) {
        const WorldBox a = box_of(m.a.tree(), v.a, kWhole, Pose{}), b = box_of(m.b.tree(), v.b, kWhole, pose);
        const double gap = widest_gap(a, b);
        if (v.step == NodeStep::whole) {
          CHECK(v.met == 0);
          CHECK(gap > 0);
          BoxPair sides;
          compare_boxes(a, b, sides);
          across += sides.gap <= 0;
          ++rejected;
        } else {
          CHECK(gap < 1e-3 * size);
          ++opened;
        }
      }
    }
  }
  CHECK(flat == 1);
  CHECK(rejected > 1000);
  CHECK(across > 100);
  CHECK(opened > 1000);
}

TEST_CASE("pending node pairs fit the fixed space") {
  const LrbRep ball = closed(shapes::bumpy_sphere(5, 1));
  QueryContext context;
  NullProbe probe;
  collide(ball, Pose{}, ball, Pose{}, {}, context, probe);
  shapes::RandomEngine random(22);
  for (int i = 0; i < 6; ++i) {
    Pose pose;
    if (i > 0) pose.r = shapes::random_rotation(random);
    context[Side::a].begin(ball, Pose{}, WrapperMode::regularised);
    context[Side::b].begin(ball, pose, WrapperMode::regularised);
    TreeKernel k = start_kernel(context, 64);
    std::uint32_t most = 0;
    while (!is_done(k)) {
      k.out_size = 0;
      k.max_node_pairs = k.node_pairs + 1;
      run_tree_kernel(k);
      most = std::max({most, k.stack_size, k.tested_size});
    }
    CHECK(most > 64);
    CHECK(most <= stack_room(ball.tree().height(), ball.tree().height()) / 2);
  }
}

}  // namespace
}  // namespace lrb::test
