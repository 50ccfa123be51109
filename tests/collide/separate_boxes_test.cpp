// B5: bodies whose boxes in the world are apart are separate, whatever they are.
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/coherent.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/first_contact.hpp>

using namespace lrb;

namespace {

LrbRep open_body(Mesh mesh) {
  return LrbRep::without_regions(mesh, false, false);
}

Mesh triangle(const Eigen::Vector3d& at, double size = 1) {
  Mesh mesh;
  mesh.vertices = {at, at + Eigen::Vector3d(size, 0, 0), at + Eigen::Vector3d(0, size, 0)};
  mesh.add_face(std::array<VertexId, 3>{0, 1, 2});
  return mesh;
}

Mesh without_last_face(const Mesh& mesh) {
  Mesh out = mesh;
  out.face_vertices.resize(out.face_offsets[mesh.face_count() - 1]);
  out.face_offsets.pop_back();
  return out;
}

Relation relation_of(const LrbRep& a, const LrbRep& b, const Pose& pose_b = {}) {
  return collide(a, Pose{}, b, pose_b).relation;
}

/// The boxes of the faces' corners only.
bool boxes_are_disjoint(const LrbRep& a, const LrbRep& b, const Pose& pose_b) {
  Eigen::AlignedBox3d of_a, of_b;
  for (const VertexId v : a.data().face_vertices) of_a.extend(Pose{}.apply(a.vertices()[v]));
  for (const VertexId v : b.data().face_vertices) of_b.extend(pose_b.apply(b.vertices()[v]));
  for (int k = 0; k < 3; ++k)
    if (of_a.max()[k] < of_b.min()[k] || of_b.max()[k] < of_a.min()[k]) return true;
  return false;
}

/// Checks every variant of the query against brute force and the boxes. Returns the relation.
Relation check_all(const LrbRep& a, const LrbRep& b, const Pose& pose) {
  const BruteForceResult expected = brute_force(a, Pose{}, b, pose);
  if (expected.pairs.empty())
    CHECK(expected.relation == (boxes_are_disjoint(a, b, pose) ? Relation::separate : Relation::undefined));
  for (const Mode mode : {Mode::all_pairs, Mode::first_pair, Mode::any_pair})
    for (const Recursion recursion : {Recursion::complete, Recursion::paper}) {
      CollideRequest request;
      request.mode = mode;
      request.recursion = recursion;
      const CollideResult found = collide(a, Pose{}, b, pose, request);
      if (!expected.pairs.empty() && mode == Mode::any_pair) continue;  // may stop at one that touches
      CHECK(found.relation == expected.relation);
      if (expected.pairs.empty())
        CHECK(found.interiors_overlap ==
              (expected.relation == Relation::separate ? Answer::no : Answer::unknown));
    }
  CollideRequest coarse;
  coarse.tolerance = 0.1;
  CHECK(collide(a, Pose{}, b, pose, coarse).relation == expected.relation);
  coarse.max_tests = 1'000'000;
  CHECK(collide(a, Pose{}, b, pose, coarse).relation == expected.relation);
  if (!expected.pairs.empty()) return expected.relation;
  CHECK(collide(b, pose, a, Pose{}).relation == expected.relation);
  CHECK(distance(a, Pose{}, b, pose).relation == expected.relation);
  return expected.relation;
}

}  // namespace

TEST_CASE("B5: an open body with a disjoint box is separate, in every query") {
  shapes::RandomEngine random(5);
  const Mesh meshes[] = {shapes::open_cylinder(9), without_last_face(shapes::icosphere(1)),
                         triangle({0, 0, 0})};
  const LrbRep solid = test::closed(shapes::icosphere(1, 0.3));
  int separate = 0, undefined = 0;
  for (const Mesh& mesh : meshes) {
    const LrbRep open = open_body(mesh);
    for (const LrbRep* other : {&solid, &open})
      for (int i = 0; i < 60; ++i) {
        const Pose pose{shapes::random_rotation(random, 3),
                        shapes::uniform(random, 0, 2.5) * shapes::random_direction(random)};
        const Relation found = check_all(open, *other, pose);
        separate += found == Relation::separate;
        undefined += found == Relation::undefined;
      }
  }
  CHECK(separate > 50);
  CHECK(undefined > 20);
}

TEST_CASE("B5: an open 2D body with a disjoint box is separate") {
  shapes::RandomEngine random(6);
  const LrbRep open = open_body(without_last_face(shapes::circle(12))),
               solid = test::closed(shapes::circle(7, 0.3));
  int separate = 0, undefined = 0;
  for (int i = 0; i < 100; ++i) {
    Pose pose{shapes::random_rotation(random, 2),
              shapes::uniform(random, 0, 2.5) * shapes::random_direction(random)};
    pose.t.z() = 0;
    const Relation found = check_all(open, solid, pose);
    separate += found == Relation::separate;
    undefined += found == Relation::undefined;
  }
  CHECK(separate > 10);
  CHECK(undefined > 5);
}

TEST_CASE("B5: touching boxes are not disjoint, boxes one ulp apart are") {
  const LrbRep a = open_body(triangle({0, 0, 0}));
  CHECK(relation_of(a, open_body(triangle({1, 1, 0}))) == Relation::undefined);
  CHECK(relation_of(a, open_body(triangle({std::nextafter(1, 2), 1, 0}))) == Relation::separate);
  CHECK(relation_of(a, open_body(triangle({1, 1, 5e-324}))) == Relation::separate);
  CHECK(relation_of(a, open_body(triangle({0, 0, 5e-324}))) == Relation::separate);
}

TEST_CASE("B5: vertices without a face do not count, nor does the size of coordinates") {
  Mesh mesh = triangle({0, 0, 0});
  mesh.vertices.emplace_back(9, 9, 9);
  mesh.vertices.emplace_back(-9, -9, -9);
  CHECK(relation_of(open_body(mesh), open_body(triangle({2, 0, 0}))) == Relation::separate);
  const LrbRep low = open_body(triangle({-1.7e308, 0, 0}, 1e307)),
               high = open_body(triangle({1.6e308, 0, 0}, 1e307));
  CHECK(relation_of(low, high) == Relation::separate);
  CHECK(relation_of(low, open_body(triangle({-1.6e308, 1e307, 0}, 1e307))) == Relation::undefined);
}

TEST_CASE("B5: bodies of many faces, with boxes computed from their trees") {
  const Mesh ball = without_last_face(shapes::icosphere(4));
  const LrbRep open = open_body(ball), other = test::closed(shapes::bumpy_sphere(4, 3));
  for (int i = 0; i < 40; ++i) {
    const Pose pose = Pose::rotation({1, 2, 3}, 0.3 * i, {1.4 + 0.02 * i, 1.2, 0.9});
    const CollideResult found = collide(open, Pose{}, other, pose);
    if (found.pairs.empty())
      CHECK(found.relation ==
            (boxes_are_disjoint(open, other, pose) ? Relation::separate : Relation::undefined));
  }
}

TEST_CASE("B5: coherent queries and distances detect disjoint boxes in every step") {
  const LrbRep open = open_body(without_last_face(shapes::icosphere(1))),
               solid = test::closed(shapes::icosphere(1, 0.3));
  CoherentQuery query(open, solid, {}, CoherentQuery::CacheUse::always);
  CoherentDistance apart(open, solid);
  int changes = 0;
  Relation before = Relation::unresolved;
  for (int i = 0; i < 400; ++i) {
    const Pose pose = Pose::translation({1.0 + 0.35 * std::sin(0.05 * i), 1.0 + 0.0002 * i, 0.9});
    const Relation expected = brute_force(open, Pose{}, solid, pose).relation;
    CHECK(query.collide(Pose{}, pose).relation == expected);
    CHECK(apart.distance(Pose{}, pose).relation == expected);
    changes += i > 0 && expected != before;
    before = expected;
  }
  CHECK(query.statistics().from_cache > 100);
  CHECK(changes > 2);
}

TEST_CASE("B5: a first contact search reports the relation at the start") {
  const LrbRep open = open_body(without_last_face(shapes::icosphere(1))),
               solid = test::closed(shapes::icosphere(0, 0.3));
  const Motion still = Motion::still({}), far = Motion::linear(Pose::translation({5, 0, 0}), {3, 0, 0}),
               within = Motion::linear({}, {0.1, 0, 0});
  CHECK(first_contact(open, still, solid, far).at_begin == Relation::separate);
  CHECK(first_contact(open, still, solid, within).at_begin == Relation::undefined);
}
