/// A workspace asks for no memory once it has answered such queries before.
#include <vector>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/counted_new.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::test {

TEST_CASE("queries in a workspace allocate no memory after the first ones") {
  const LrbRep a = build_lrb(shapes::bumpy_sphere(3, 4)), b = build_lrb(shapes::torus(40, 20)),
               flat = build_lrb(shapes::ring_2d(40));
  shapes::RandomEngine random(1);
  std::vector<Pose> poses, poses_flat;
  for (int i = 0; i < 100; ++i) {
    poses.push_back(shapes::random_pose(random, a, b, shapes::uniform(random, 0, 1.2)));
    poses_flat.push_back(shapes::random_pose(random, flat, flat, shapes::uniform(random, 0, 1.2)));
  }
  poses.push_back(Pose{});
  for (const Mode mode : {Mode::all_pairs, Mode::first_pair, Mode::any_pair}) {
    CollideRequest request;
    request.mode = mode;
    Workspace workspace, flat_workspace;
    std::size_t met = 0;
    for (int round = 0; round < 2; ++round) {
      const std::uint64_t before = allocations();
      for (const Pose& pose : poses) met += !collide(a, Pose{}, b, pose, request, workspace)->pairs.empty();
      for (const Pose& pose : poses_flat) (void)collide(flat, Pose{}, flat, pose, request, flat_workspace);
      CHECK((round == 0) == (allocations() > before));
    }
    CHECK(met >= 80);
  }
}

}  // namespace lrb::test
