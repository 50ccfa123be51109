// The complete query against brute force: the same pairs, the same classification, the same relation.
#include <doctest/doctest.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/workspace.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

struct RelationTally {
  int poses = 0, in_contact = 0, inside = 0, apart = 0, touching = 0;
};

void compare(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b, QueryContext& context,
             RelationTally& t) {
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
  first.mode = Mode::any_pair;
  const CollideResult any = collide(a, pose_a, b, pose_b, first, context, probe);
  REQUIRE(any.pairs.size() == one.pairs.size());
  if (any.pairs.empty())
    REQUIRE(any.relation == expected.relation);
  else
    REQUIRE(std::binary_search(expected.pairs.begin(), expected.pairs.end(), any.pairs[0]));
  ++t.poses;
  t.in_contact += !expected.pairs.empty();
  t.touching += expected.relation == Relation::touching;
  t.apart += expected.relation == Relation::separate;
  t.inside += expected.relation == Relation::a_inside_b || expected.relation == Relation::b_inside_a;
}

struct AnyBodies {
  const char* name;
  LrbRep a, b;
};

using test::closed;

std::vector<AnyBodies> any_bodies() {
  std::vector<AnyBodies> list;
  list.push_back({"spheres", closed(shapes::icosphere(1)), closed(shapes::icosphere(1, 0.7))});
  list.push_back({"bumps", closed(shapes::bumpy_sphere(2, 7, 0.3)), closed(shapes::bumpy_sphere(1, 8, 0.3))});
  list.push_back({"ball in bowl", closed(shapes::bowl(12, 6)), closed(shapes::icosphere(1, 0.5))});
  list.push_back({"void", closed(shapes::box_with_void()), closed(shapes::icosphere(1, 0.3))});
  list.push_back({"tori", closed(shapes::torus(12, 8)), closed(shapes::torus(10, 6, 1, 0.3))});
  list.push_back({"combs", closed(shapes::comb(5)), closed(shapes::comb(4))});
  list.push_back({"quads", closed(shapes::quad_box()), closed(shapes::quad_torus(8, 6))});
  list.push_back({"tiny in large", closed(shapes::bumpy_sphere(2, 9)),
                  closed(shapes::scaled(shapes::tetrahedron(), 1e-3))});
  list.push_back({"far and small", closed(shapes::translated(shapes::icosphere(1), {1e7, -2e7, 3e6})),
                  closed(shapes::icosphere(1, 0.6))});
  list.push_back({"gears 2D", closed(shapes::gear(9)), closed(shapes::gear(7, 0.9, 0.6))});
  list.push_back({"ring 2D", closed(shapes::ring_2d(30)), closed(shapes::star(5, 0.3, 0.1))});
  list.push_back({"regions 2D", shapes::stairs_2d(), shapes::stairs_2d()});
  list.push_back({"regions", shapes::dented_box(), closed(shapes::icosphere(1, 0.7))});
  return list;
}

}  // namespace

TEST_CASE("complete equals brute force on random poses, from deep inside to near misses") {
  RandomEngine random(20240607);
  QueryContext context;
  RelationTally total;
  for (const AnyBodies& pair : any_bodies()) {
    CAPTURE(pair.name);
    for (int i = 0; i < 800; ++i) {
      CAPTURE(i);
      compare(pair.a, Pose{}, pair.b,
              shapes::random_pose(random, pair.a, pair.b, shapes::uniform(random, 0, 1.1)), context, total);
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
  RandomEngine random(5);
  QueryContext context;
  RelationTally total;
  const LrbRep a = closed(shapes::bumpy_sphere(1, 3)), b = closed(shapes::torus(9, 6));
  for (int i = 0; i < 200; ++i) {
    Pose frame;
    frame.r = shapes::random_rotation(random);
    frame.t = 1e3 * shapes::random_direction(random);
    const Pose relative = shapes::random_pose(random, a, b, shapes::uniform(random, 0, 1.1));
    const Pose pose_b{frame.r * relative.r, frame.r * relative.t + frame.t};
    compare(a, frame, b, pose_b, context, total);
  }
  CHECK(total.in_contact > 50);
}

TEST_CASE("complete equals brute force on identical bodies and grid-aligned contact") {
  RandomEngine random(6);
  QueryContext context;
  RelationTally total;
  const std::vector<LrbRep> list = {closed(shapes::box()),          closed(shapes::comb(4)),
                                    closed(shapes::l_shape()),      closed(shapes::icosphere(1)),
                                    closed(shapes::quad_box()),     closed(shapes::box_with_void()),
                                    closed(shapes::tetrahedron(1)), shapes::dented_box()};
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

TEST_CASE("queries are exact for any matrix, rotation or not") {
  RandomEngine random(8);
  QueryContext context;
  RelationTally total;
  const LrbRep a = closed(shapes::icosphere(1)), b = closed(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}));
  for (int i = 0; i < 100; ++i) {
    Pose p = shapes::random_pose(random, a, b, shapes::uniform(random, 0, 1));
    p.r *= shapes::uniform(random, 0.5, 2);
    p.r(0, 1) += shapes::uniform(random, -0.5, 0.5);
    compare(a, Pose{}, b, p, context, total);
  }
  CHECK(total.in_contact > 20);
}

TEST_CASE("a query that ends at the roots equals brute force, and one with a probe") {
  RandomEngine random(31);
  QueryContext context;
  int ends = 0, goes_on = 0;
  std::vector<AnyBodies> list = any_bodies();
  // Squares of such lengths underflow.
  const Mesh tiny = shapes::scaled(shapes::icosphere(1), 1e-170);
  list.push_back({"tiny", closed(tiny), closed(tiny)});
  for (const AnyBodies& bodies : list) {
    CAPTURE(bodies.name);
    const ObbTree &tree_a = bodies.a.tree(), &tree_b = bodies.b.tree();
    const bool flat = bodies.a.dim() == 2;
    const double reach = tree_a.extent() + tree_b.extent();
    for (int i = 0; i < 60; ++i) {
      // From contact to far away; every fourth map is not a rotation.
      const Pose pose_a;
      Pose pose_b = Pose::rotation({0, 0, 1}, shapes::uniform(random, 0, 6),
                                   shapes::uniform(random, 0, 3) * reach * shapes::random_direction(random));
      if (flat) pose_b.t.z() = 0;
      if (i % 4 == 3) pose_b.r *= shapes::uniform(random, 0.5, 2);
      const BruteForceResult expected = brute_force(bodies.a, pose_a, bodies.b, pose_b);
      for (const Mode mode : {Mode::all_pairs, Mode::any_pair}) {
        CollideRequest request;
        request.mode = mode;
        NullProbe none;
        CollideProbe silent;
        ProbeAdapter watched(silent);
        const CollideResult found = collide(bodies.a, pose_a, bodies.b, pose_b, request, context, none);
        const CollideResult seen = collide(bodies.a, pose_a, bodies.b, pose_b, request, context, watched);
        REQUIRE(found.relation == expected.relation);
        REQUIRE(seen.relation == expected.relation);
        REQUIRE(found.interiors_overlap == seen.interiors_overlap);
        REQUIRE(found.pairs == seen.pairs);
        REQUIRE(found.opened == seen.opened);
        REQUIRE(found.counters == seen.counters);
      }
      if (roots_are_apart(tree_a, pose_a, tree_b, pose_b)) {
        ++ends;
        REQUIRE(expected.relation == Relation::separate);
      } else {
        ++goes_on;
      }
    }
  }
  CHECK(ends > 100);
  CHECK(goes_on > 100);
}

TEST_CASE("any_pair ends at the first intersecting pair, first_pair at the first crossing one") {
  const LrbRep ball = closed(shapes::icosphere(3));
  CollideRequest request;
  request.mode = Mode::first_pair;
  const CollideResult first = collide(ball, Pose{}, ball, Pose{}, request);
  request.mode = Mode::any_pair;
  const CollideResult any = collide(ball, Pose{}, ball, Pose{}, request);
  CHECK(first.relation == Relation::touching);
  CHECK(any.relation == Relation::touching);
  CHECK(first.counters.face_tests > ball.real_face_count());
  CHECK(any.counters.face_tests < 100);
}

TEST_CASE(
    "an open body has no interior: without contact the relation is undefined unless boxes are disjoint") {
  const LrbRep open = LrbRep::without_regions(shapes::open_cylinder(12), false, false);
  const LrbRep ball = closed(shapes::icosphere(0, 0.1));
  CHECK(collide(open, Pose{}, ball, Pose{}).relation == Relation::undefined);
  CHECK(collide(ball, Pose{}, open, Pose::translation({0, 0, -0.2})).relation == Relation::undefined);
  CHECK(collide(ball, Pose{}, open, Pose::translation({0, 0, 0.2})).relation == Relation::separate);
  const CollideResult through = collide(open, Pose{}, ball, Pose::translation({1, 0, 0.5}));
  CHECK(through.relation == Relation::crossing);
  CHECK(through.interiors_overlap == Answer::unknown);
}

TEST_CASE("swapping the bodies transposes the pairs") {
  RandomEngine random(11);
  const LrbRep a = closed(shapes::bumpy_sphere(2, 1)), b = closed(shapes::comb(3));
  for (int i = 0; i < 50; ++i) {
    const Pose p = shapes::random_pose(random, a, b, shapes::uniform(random, 0, 0.8));
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

TEST_CASE("a query in deep contact has the same result on any number of threads, and with a probe") {
  std::vector<AnyBodies> list;
  const auto add_twice = [&](const char* name, const LrbRep& rep) { list.push_back({name, rep, rep}); };
  add_twice("regions", build_lrb(shapes::bumpy_sphere(4, 7, 0.3)));
  add_twice("quads", build_lrb(shapes::quad_torus(90, 60)));
  add_twice(
      "void",
      closed(shapes::several({shapes::icosphere(4), shapes::turned_inside_out(shapes::icosphere(4, 0.5))})));
  add_twice("crosses itself",
            build_lrb(shapes::several(
                {shapes::torus(80, 40), shapes::translated(shapes::torus(80, 40), {1, 0, 0})})));
  add_twice("open", LrbRep::without_regions(shapes::open_cylinder(12000), false, false));
  add_twice("2D", closed(shapes::ring_2d(20000)));
  Pose turned, skewed;
  turned.r = Eigen::AngleAxisd(1e-3, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  skewed.r << 1, 1e-3, 0, 0, 1.001, 0, 0, 0, 1;
  Workspace two(2), five(5);
  for (const AnyBodies& pair : list) {
    std::uint64_t most = 0;
    for (const Pose& pose : {Pose{}, turned, skewed})
      for (const Predicates predicates : {Predicates::exact, Predicates::floating}) {
        CAPTURE(pair.name);
        CollideRequest request;
        request.predicates = predicates;
        const CollideResult alone = collide(pair.a, Pose{}, pair.b, pose, request);
        most = std::max(most, alone.counters.node_pairs);
        CollideProbe probe;
        for (const CollideResult& other : {collide(pair.a, Pose{}, pair.b, pose, request, two).value(),
                                           collide(pair.a, Pose{}, pair.b, pose, request, five).value(),
                                           collide(pair.a, Pose{}, pair.b, pose, request, probe)}) {
          REQUIRE(other.pairs == alone.pairs);
          REQUIRE(other.meets == alone.meets);
          REQUIRE(other.relation == alone.relation);
          REQUIRE(other.opened == alone.opened);
          REQUIRE(other.counters == alone.counters);
        }
        request.max_pairs = alone.pairs.size();
        CHECK(collide(pair.a, Pose{}, pair.b, pose, request, two).has_value());
        --request.max_pairs;
        const auto refused = collide(pair.a, Pose{}, pair.b, pose, request, two);
        REQUIRE_FALSE(refused.has_value());
        CHECK(refused.error().reason.find("more than " + std::to_string(request.max_pairs) + " pairs") == 0);
      }
    CHECK(most > 2 * kNodePairsBeforeSplit);  // several parts
  }
}
