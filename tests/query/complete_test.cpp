// The complete query against brute force: the same pairs, the same classification, the same relation.
#include <doctest/doctest.h>

#include "engine/query/brute_force.hpp"
#include "engine/query/collide_impl.hpp"
#include "tests/support/hand_made.hpp"
#include "tests/support/random_pose.hpp"
#include "tests/support/shapes.hpp"

using namespace lrb;
using test::Random;

namespace {

struct Tally {
  int poses = 0, in_contact = 0, inside = 0, apart = 0, touching = 0;
};

void compare(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b, QueryContext& context,
             Tally& t) {
  const BruteForceResult expected = brute_force(a, pose_a, b, pose_b);
  NullProbe probe;
  const CollideResult all = collide(a, pose_a, b, pose_b, {}, context, probe);
  REQUIRE(all.pairs == expected.pairs);
  REQUIRE(all.meets == expected.meets);
  REQUIRE(std::string(to_string(all.relation)) == to_string(expected.relation));
  CollideRequest first;
  first.mode = Mode::first_pair;
  const CollideResult one = collide(a, pose_a, b, pose_b, first, context, probe);
  REQUIRE(one.relation == expected.relation);
  REQUIRE(one.pairs.size() == std::min<std::size_t>(1, expected.pairs.size()));
  if (!one.pairs.empty())
    REQUIRE(std::binary_search(expected.pairs.begin(), expected.pairs.end(), one.pairs[0]));
  ++t.poses;
  t.in_contact += !expected.pairs.empty();
  t.touching += expected.relation == Relation::touching;
  t.apart += expected.relation == Relation::separate;
  t.inside += expected.relation == Relation::a_inside_b || expected.relation == Relation::b_inside_a;
}

struct Bodies {
  const char* name;
  LrbRep a, b;
};

LrbRep closed(const Mesh& mesh) {
  return LrbRep::without_regions(mesh, true, false);
}

std::vector<Bodies> bodies() {
  std::vector<Bodies> list;
  list.push_back({"spheres", closed(test::icosphere(1)), closed(test::icosphere(1, 0.7))});
  list.push_back({"bumps", closed(test::bumpy_sphere(2, 7, 0.3)), closed(test::bumpy_sphere(1, 8, 0.3))});
  list.push_back({"ball in bowl", closed(test::bowl(12, 6)), closed(test::icosphere(1, 0.5))});
  list.push_back({"void", closed(test::box_with_void()), closed(test::icosphere(1, 0.3))});
  list.push_back({"tori", closed(test::torus(12, 8)), closed(test::torus(10, 6, 1, 0.3))});
  list.push_back({"combs", closed(test::comb(5)), closed(test::comb(4))});
  list.push_back({"quads", closed(test::quad_box()), closed(test::quad_torus(8, 6))});
  list.push_back(
      {"tiny in large", closed(test::bumpy_sphere(2, 9)), closed(test::scaled(test::tetrahedron(), 1e-3))});
  list.push_back({"far and small", closed(test::translated(test::icosphere(1), {1e7, -2e7, 3e6})),
                  closed(test::icosphere(1, 0.6))});
  list.push_back({"gears 2D", closed(test::gear(9)), closed(test::gear(7, 0.9, 0.6))});
  list.push_back({"ring 2D", closed(test::ring_2d(30)), closed(test::star(5, 0.3, 0.1))});
  list.push_back({"regions 2D", test::stairs_2d(), test::stairs_2d()});
  list.push_back({"regions", test::dented_box(), closed(test::icosphere(1, 0.7))});
  return list;
}

}  // namespace

TEST_CASE("complete equals brute force on random poses, from deep inside to near misses") {
  Random random(20240607);
  QueryContext context;
  Tally total;
  for (const Bodies& pair : bodies()) {
    CAPTURE(pair.name);
    for (int i = 0; i < 800; ++i) {
      CAPTURE(i);
      compare(pair.a, Pose{}, pair.b,
              test::random_pose(random, pair.a, pair.b, test::uniform(random, 0, 1.1)), context, total);
    }
  }
  MESSAGE(total.poses << " poses: " << total.in_contact << " in contact, " << total.inside << " inside, "
                      << total.apart << " apart");
  CHECK(total.poses >= 10000);
  CHECK(total.in_contact > 2000);
  CHECK(total.inside > 100);
  CHECK(total.apart > 500);
}

TEST_CASE("complete equals brute force when both bodies move") {
  Random random(5);
  QueryContext context;
  Tally total;
  const LrbRep a = closed(test::bumpy_sphere(1, 3)), b = closed(test::torus(9, 6));
  for (int i = 0; i < 200; ++i) {
    Pose frame;
    frame.r = test::random_rotation(random);
    frame.t = 1e3 * test::random_direction(random);
    const Pose relative = test::random_pose(random, a, b, test::uniform(random, 0, 1.1));
    const Pose pose_b{frame.r * relative.r, frame.r * relative.t + frame.t};
    compare(a, frame, b, pose_b, context, total);
  }
  CHECK(total.in_contact > 50);
}

TEST_CASE("complete equals brute force on identical bodies and grid-aligned contact") {
  Random random(6);
  QueryContext context;
  Tally total;
  const std::vector<LrbRep> list = {closed(test::box()),          closed(test::comb(4)),
                                    closed(test::l_shape()),      closed(test::icosphere(1)),
                                    closed(test::quad_box()),     closed(test::box_with_void()),
                                    closed(test::tetrahedron(1)), test::dented_box()};
  const double quarter_turns[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
  for (const LrbRep& a : list)
    for (const LrbRep& b : list)
      for (int i = 0; i < 30; ++i) {
        Pose p;
        const double* turn = quarter_turns[random() % 4];
        p.r << turn[0], -turn[1], 0, turn[1], turn[0], 0, 0, 0, 1;
        for (int k = 0; k < 3; ++k) p.t[k] = i == 0 ? 0 : static_cast<double>(random() % 9) / 2 - 2;
        compare(a, Pose{}, b, p, context, total);
      }
  CHECK(total.touching > 200);
  CHECK(total.poses == 30 * 64);
}

TEST_CASE("any matrix is answered exactly, rotation or not") {
  Random random(8);
  QueryContext context;
  Tally total;
  const LrbRep a = closed(test::icosphere(1)), b = closed(test::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  for (int i = 0; i < 100; ++i) {
    Pose p = test::random_pose(random, a, b, test::uniform(random, 0, 1));
    p.r *= test::uniform(random, 0.5, 2);
    p.r(0, 1) += test::uniform(random, -0.5, 0.5);
    compare(a, Pose{}, b, p, context, total);
  }
  CHECK(total.in_contact > 20);
}

TEST_CASE("an open body has no inside: without contact the relation is undefined") {
  const LrbRep open = LrbRep::without_regions(test::open_cylinder(12), false, false);
  const LrbRep ball = closed(test::icosphere(0, 0.1));
  CHECK(collide(open, Pose{}, ball, Pose{}).relation == Relation::undefined);
  CHECK(collide(ball, Pose{}, open, Pose::translation({50, 0, 0})).relation == Relation::undefined);
  const CollideResult through = collide(open, Pose{}, ball, Pose::translation({1, 0, 0.5}));
  CHECK(through.relation == Relation::crossing);
  CHECK(through.interiors_overlap == Answer::unknown);
}

TEST_CASE("swapping the bodies transposes the pairs") {
  Random random(11);
  const LrbRep a = closed(test::bumpy_sphere(2, 1)), b = closed(test::comb(3));
  for (int i = 0; i < 50; ++i) {
    const Pose p = test::random_pose(random, a, b, test::uniform(random, 0, 0.8));
    const CollideResult ab = collide(a, Pose{}, b, p), ba = collide(b, p, a, Pose{});
    std::vector<SimplexPair> transposed;
    for (const SimplexPair& q : ba.pairs) transposed.push_back({q.b, q.a});
    std::sort(transposed.begin(), transposed.end());
    CHECK(ab.pairs == transposed);
  }
}

TEST_CASE("fingerprints are FNV-1a 64 of the pairs") {
  CHECK(fingerprint({}) == 0xcbf29ce484222325u);
  CHECK(fingerprint({{1, 2}, {3, 4}}) == 0x84c39a079fc08121u);
}
