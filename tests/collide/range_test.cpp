// Coordinates at the ends of what doubles hold, and poses that are far from rotations.
#include <cmath>

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>

using namespace lrb;
using shapes::RandomEngine;

namespace {

using test::closed;

std::string complaint(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b) {
  try {
    collide(a, pose_a, b, pose_b);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

// Both bodies scaled by 100 or more: the kernel's inverse by transposition is then off by the fourth power,
// of which the bound once covered the third. 23 pairs of 192 were missed.
TEST_CASE("two scaling matrices miss no pair") {
  RandomEngine random(3);
  const LrbRep a = closed(shapes::icosphere(1)), b = closed(shapes::bumpy_sphere(1, 2));
  int in_contact = 0;
  for (int i = 0; i < 300; ++i) {
    Pose pose_a, pose_b;
    const double scale = std::pow(10, shapes::uniform(random, -3, 3));
    pose_a.r = scale * shapes::random_rotation(random);
    pose_b.r = scale * shapes::random_rotation(random);
    pose_b.t = shapes::uniform(random, 0, 2.2) * scale * shapes::random_direction(random);
    const BruteForceResult expected = brute_force(a, pose_a, b, pose_b);
    CHECK(collide(a, pose_a, b, pose_b).pairs == expected.pairs);
    in_contact += !expected.pairs.empty();
  }
  CHECK(in_contact > 100);
}

TEST_CASE("bodies with denormal coordinates miss no pair") {
  RandomEngine random(4);
  int in_contact = 0;
  for (int i = 0; i < 300; ++i) {
    const double scale = std::ldexp(1.0, shapes::uniform(random) < 0.5 ? -1060 : -1040);
    const LrbRep a = closed(shapes::scaled(shapes::icosphere(1), scale));
    const LrbRep b = closed(shapes::scaled(shapes::bumpy_sphere(1, 2), scale));
    Pose pose_a, pose_b;
    pose_a.r = shapes::random_rotation(random);
    pose_b.r = shapes::random_rotation(random);
    pose_b.t = shapes::uniform(random, 0, 2.2) * scale * shapes::random_direction(random);
    const BruteForceResult expected = brute_force(a, pose_a, b, pose_b);
    CHECK(collide(a, pose_a, b, pose_b).pairs == expected.pairs);
    in_contact += !expected.pairs.empty();
  }
  CHECK(in_contact > 100);
}

TEST_CASE("world coordinates that overflow are rejected with the body's name") {
  const LrbRep box = closed(shapes::box());
  Pose far;
  far.r *= 1.5e308;
  far.t.y() = 1e308;
  CHECK(complaint(box, Pose{}, box, far) ==
        "body B, vertex 1: its world y exceeds 1.8e308; scale down the bodies and the pose");
  far.t.y() = 0;
  CHECK(complaint(box, far, box, Pose{}).empty());
  CHECK(collide(box, far, box, Pose{}).relation == Relation::touching);
}

// Areas times coordinates of bodies of size 1e120 are no doubles: centroids were not numbers, and at 1e-120
// normals vanished.
TEST_CASE("a power of two scales contact regions exactly") {
  RandomEngine random(5);
  CollideRequest request;
  request.contacts = true;
  const Mesh mesh_a = shapes::l_shape(), mesh_b = shapes::box();
  for (int i = 0; i < 100; ++i) {
    Pose pose;
    if (i % 2) pose.r = shapes::random_rotation(random);
    pose.t = {shapes::uniform(random, -1, 1), shapes::uniform(random, -1, 1), i % 3 ? 1 : 0.5};
    const CollideResult plain = collide(closed(mesh_a), Pose{}, closed(mesh_b), pose, request);
    for (const int exponent : {-400, 400}) {
      const double by = std::ldexp(1.0, exponent);
      Pose scaled_pose = pose;
      scaled_pose.t *= by;
      const CollideResult scaled = collide(closed(shapes::scaled(mesh_a, by)), Pose{},
                                           closed(shapes::scaled(mesh_b, by)), scaled_pose, request);
      REQUIRE(scaled.pairs == plain.pairs);
      REQUIRE(scaled.regions.size() == plain.regions.size());
      for (std::size_t r = 0; r < plain.regions.size(); ++r) {
        const ContactRegion &p = plain.regions[r], &s = scaled.regions[r];
        CHECK(s.length / by == doctest::Approx(p.length));
        CHECK(s.area / by / by == doctest::Approx(p.area));
        CHECK(s.depth_estimate / by == doctest::Approx(p.depth_estimate));
        CHECK((s.centroid / by - p.centroid).norm() < 1e-12);
        CHECK((s.normal - p.normal).norm() < 1e-12);
      }
    }
  }
}

// At 1e16 doubles are 2 apart: a plate of thickness 1 becomes a sheet with two faces, one of which faces as
// the box behind it does. That was taken for solids that lie on the same side.
TEST_CASE("a plate flattened by rounding has no interior") {
  CollideRequest request;
  request.interiors_overlap = true;
  const LrbRep plate = closed(shapes::box({0, 0, 0}, {1, 4, 4})),
               box = closed(shapes::box({-4, 1, 1}, {0, 2, 2}));
  const Pose far = Pose::translation({1e16, 0, 0});
  const CollideResult r = collide(plate, far, box, far, request);
  CHECK(r.relation == Relation::touching);
  CHECK(r.interiors_overlap != Answer::yes);
  CHECK(collide(plate, Pose{}, box, Pose{}, request).interiors_overlap == Answer::no);
  CHECK(collide(plate, Pose{}, box, Pose::translation({1, 0, 0}), request).interiors_overlap == Answer::yes);
}

// The same plate, pierced by a rod: its two flat faces cross the rod's, yet there is nothing between them.
TEST_CASE("a crossing proves overlapping interiors only for bodies with volume") {
  CollideRequest request;
  request.interiors_overlap = true;
  const LrbRep plate = closed(shapes::box({0, 0, 0}, {1, 4, 4})),
               rod = closed(shapes::box({-4, 1, 1}, {4, 2, 2})), ball = closed(shapes::icosphere(1, 2));
  const Pose far = Pose::translation({1e16, 0, 0});
  const CollideResult r = collide(plate, far, rod, far, request);
  CHECK(r.relation == Relation::crossing);
  CHECK(r.interiors_overlap == Answer::unknown);
  CHECK(collide(plate, Pose{}, rod, Pose{}, request).interiors_overlap == Answer::yes);
  CHECK(collide(ball, Pose{}, rod, Pose{}, request).interiors_overlap == Answer::yes);
  const LrbRep flat = closed(shapes::gear(5)),
               bar = closed(shapes::polygon({{-3, -0.5}, {3, -0.5}, {3, 0.5}, {-3, 0.5}}));
  CHECK(collide(flat, Pose{}, bar, Pose{}, request).interiors_overlap == Answer::yes);
  const Pose far_2d = Pose::translation({0, 1e17, 0});
  const CollideResult thin = collide(bar, far_2d, bar, Pose{far_2d.r, {1, 1e17, 0}}, request);
  CHECK(thin.interiors_overlap != Answer::yes);
}

TEST_CASE("all crossings of ordinary bodies prove overlapping interiors") {
  CollideRequest request;
  request.interiors_overlap = true;
  const LrbRep bodies[] = {closed(shapes::bumpy_sphere(2, 3, 0.5)), closed(shapes::torus(12, 8)),
                           closed(shapes::comb(4)), closed(shapes::bowl(12, 6))};
  shapes::RandomEngine random(3);
  int crossings = 0;
  for (int i = 0; i < 300; ++i) {
    const LrbRep &a = bodies[i % 4], &b = bodies[random() % 4];
    const Pose pose = shapes::random_pose(random, a, b, shapes::uniform(random, 0, 1));
    const CollideResult r = collide(a, Pose{}, b, pose, request);
    if (r.relation != Relation::crossing) continue;
    ++crossings;
    CHECK(r.interiors_overlap == Answer::yes);
  }
  CHECK(crossings > 100);
}

TEST_CASE("boxes that overlap by one ulp overlap") {
  CollideRequest request;
  request.interiors_overlap = true;
  const LrbRep a = closed(shapes::box()),
               b = closed(shapes::box({std::nextafter(1.0, 0.0), 0, 0}, {2, 1, 1}));
  const CollideResult r = collide(a, Pose{}, b, Pose{}, request);
  CHECK(r.relation == Relation::touching);
  CHECK(r.interiors_overlap == Answer::yes);
}
