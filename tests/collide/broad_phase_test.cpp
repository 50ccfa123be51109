// Boxes against all vertices, bit for bit; sort and sweep against all pairs of boxes.
#include <cmath>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/broad_phase.hpp>
#include <lrbscope/build.hpp>
#include <lrbscope/world_box.hpp>

using namespace lrb;
using Eigen::AlignedBox3d;
using shapes::RandomEngine;

namespace {

AlignedBox3d box_of_all_vertices(const LrbRep& rep, const Pose& pose) {
  AlignedBox3d box;
  for (FaceId f = 0; f < rep.real_face_count(); ++f)
    for (const VertexId v : rep.face(f)) box.extend(pose.apply(rep.vertices()[v]));
  return box;
}

void check_box(const LrbRep& rep, const Pose& pose, ExtremeVertices* last = nullptr) {
  const AlignedBox3d slow = box_of_all_vertices(rep, pose), fast = world_box(rep, pose, last);
  CHECK(slow.min() == fast.min());
  CHECK(slow.max() == fast.max());
  const AlignedBox3d either = BodyExtent(rep).in_world(pose, last);
  CHECK(slow.min() == either.min());
  CHECK(slow.max() == either.max());
}

std::vector<BodyPair> all_pairs(const std::vector<AlignedBox3d>& boxes) {
  std::vector<BodyPair> out;
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
      bool meet = !boxes[i].isEmpty() && !boxes[j].isEmpty();
      for (int k = 0; k < 3; ++k)
        meet = meet && boxes[i].min()[k] <= boxes[j].max()[k] && boxes[j].min()[k] <= boxes[i].max()[k];
      if (meet) out.push_back({i, j});
    }
  return out;
}

}  // namespace

TEST_CASE("a world box is exactly the box of all vertices") {
  RandomEngine random(1);
  const Mesh meshes[] = {shapes::tetrahedron(),
                         shapes::box(),
                         shapes::bumpy_sphere(4, 3),
                         shapes::torus(40, 20),
                         shapes::bowl(20, 8),
                         shapes::comb(9),
                         shapes::gear(12),
                         shapes::open_cylinder(30),
                         shapes::ring_2d(40),
                         shapes::scaled(shapes::bumpy_sphere(3, 2), 1e-200),
                         shapes::quad_torus(20, 9),
                         shapes::scaled(shapes::bumpy_sphere(3, 2), 1e200),
                         shapes::translated(shapes::bumpy_sphere(3, 2), {1e9, -1e9, 1e9})};
  for (const Mesh& mesh : meshes) {
    const LrbRep rep = LrbRep::without_regions(mesh, true, false);
    CAPTURE(mesh.vertices.size());
    const double size = rep.tree().extent();
    check_box(rep, Pose{});
    for (int i = 0; i < 60; ++i) {
      Pose pose;
      pose.r = shapes::random_rotation(random, rep.dim());
      const double far = i % 3 == 0 ? 0 : i % 3 == 1 ? 3 * size : 1e12 * size;
      pose.t = far * shapes::random_direction(random);
      if (rep.dim() == 2) pose.t.z() = 0;
      check_box(rep, pose);
      pose.r *= i % 2 == 0 ? 1e3 : 1e-3;  // not a rotation: the box holds for any matrix
      check_box(rep, pose);
    }
  }
}

TEST_CASE("pseudo faces and the previous step do not change a world box") {
  const LrbRep rep = build_lrb(shapes::bumpy_sphere(3, 5));
  REQUIRE(rep.region_count() > 0);
  ExtremeVertices last;
  for (int i = 0; i < 100; ++i)
    check_box(rep, Pose::rotation({1, 2, 3}, i < 90 ? 0.02 * i : 1.9 * i, {0.01 * i, 0, 0}), &last);
}

TEST_CASE("the box of a body that may leave the range of doubles intersects every box") {
  const LrbRep rep = LrbRep::without_regions(shapes::box(), true, false);
  Pose pose;
  pose.r *= 1e308;
  pose.t.setConstant(1.5e308);
  const std::vector<AlignedBox3d> boxes = {AlignedBox3d(Eigen::Vector3d(5, 5, 5), Eigen::Vector3d(6, 6, 6)),
                                           world_box(rep, pose)};
  CHECK(SweepAndPrune().update(boxes) == all_pairs(boxes));
  CHECK(all_pairs(boxes).size() == 1);
}

TEST_CASE("incremental updates find the pairs of boxes of brute force, and compare only moved boxes") {
  RandomEngine random(5);
  for (int round = 0; round < 20; ++round) {
    SweepAndPrune sweep;
    const double room = round % 2 == 0 ? 12 : 40;
    const auto random_box = [&] {
      Eigen::Vector3d low, size;
      for (int k = 0; k < 3; ++k) {
        low[k] = std::floor(shapes::uniform(random, 0, room));
        size[k] = std::floor(shapes::uniform(random, 0, 4));
      }
      return AlignedBox3d(low, low + size);
    };
    std::vector<AlignedBox3d> boxes(100);
    for (AlignedBox3d& box : boxes) box = random_box();
    sweep.update(boxes, {});
    for (int step = 0; step < 60; ++step) {
      // Most steps move few boxes, some move many, some none.
      const std::uint64_t share = step % 10 == 9 ? 2 : step % 10 == 8 ? 1000 : 15;
      std::vector<std::uint32_t> moved;
      for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        if (random() % share != 0) continue;
        moved.push_back(i);
        boxes[i] = random_box();
        if (random() % 8 == 0) boxes[i] = AlignedBox3d();  // empty
        if (random() % 16 == 0)
          boxes[i] = AlignedBox3d(Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1e300, 1, 1));
        if (random() % 16 == 0) boxes[i].min().setConstant(-HUGE_VAL);
      }
      CAPTURE(step);
      const bool has_list = step % 4 != 0;  // which boxes moved
      CHECK((has_list ? sweep.update(boxes, moved) : sweep.update(boxes)) == all_pairs(boxes));
      if (has_list && moved.empty()) CHECK(sweep.work().box_tests == 0);
    }
  }
}
