// Proofs that two bodies still overlap after a translation.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "engine/clash/clash_parts.hpp"
#include "engine/collide/collide_into.hpp"
#include "engine/collide/relation.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"

using namespace lrb;
using shapes::RandomEngine;

namespace {

using test::closed;

/// Divides each triangle into four.
UnitBody divided(const UnitBody& body) {
  UnitBody out;
  for (const auto& t : body.triangles) {
    const auto first = static_cast<std::uint32_t>(out.points.size());
    for (std::size_t k = 0; k < 3; ++k) out.points.push_back(body.points[t[k]]);
    for (std::size_t k = 0; k < 3; ++k)
      out.points.emplace_back(0.5 * (body.points[t[k]] + body.points[t[(k + 1) % 3]]));
    for (const auto& [i, j, k] : {std::array{0u, 3u, 5u}, {3u, 1u, 4u}, {5u, 4u, 2u}, {3u, 4u, 5u}})
      out.triangles.push_back({first + i, first + j, first + k});
  }
  return out;
}

BoxNorm random_norm(RandomEngine& random) {
  const Eigen::Matrix3d axes = shapes::random_rotation(random);
  Vector3d half;
  for (double& h : half) h = std::exp2(shapes::uniform(random, -6, 0));
  return {axes * half.asDiagonal(), half.cwiseInverse().asDiagonal() * axes.transpose(), half.minCoeff()};
}

/// Two bodies as the proof sees them.
struct Pair {
  QueryContext query;
  UnitBodies bodies;

  Pair(const LrbRep& a, const LrbRep& b, const Pose& pose_b) {
    query.body[0].begin(a, Pose{}, WrapperMode::regularised);
    query.body[1].begin(b, pose_b, WrapperMode::regularised);
    bodies = unit_bodies(query);
  }
  OverlapProof::IsInside inside() {
    return [this](Side side, const Vector3d& x) {
      const Vector3d world = bodies.frame.to_world(x);
      return locate(query[side], world.data()) == Where::inside;
    };
  }
};

bool overlap_after(const LrbRep& a, const LrbRep& b, const Pose& pose_b, const Vector3d& by) {
  CollideRequest request;
  request.interiors_overlap = true;
  return collide(a, Pose{}, b, Pose{pose_b.r, pose_b.t + by}, request).interiors_overlap == Answer::yes;
}

}  // namespace

TEST_CASE("the clearance of a point is at most its distance to all triangles") {
  RandomEngine random(41);
  for (const Mesh& mesh : {shapes::bumpy_sphere(2, 7, 0.3), shapes::torus(12, 8), shapes::comb(3),
                           shapes::scaled(shapes::box(), 1e-3)}) {
    const LrbRep a = closed(mesh);
    Pair pair(a, a, Pose::translation({1e-4, 0, 0}));
    const UnitBody &body = pair.bodies.body[0], once = divided(body), fine = divided(divided(once));
    const SurfaceDistance surface(body), of_once(once);
    for (int i = 0; i < 50; ++i) {
      const Vector3d x = shapes::uniform(random, 0, 1) * shapes::random_direction(random);
      const BoxNorm norm = i == 0 ? BoxNorm{} : random_norm(random);
      const double proved = surface.at(x, norm);
      double nearest = INFINITY;
      for (const Vector3d& p : fine.points) nearest = std::min(nearest, norm(p - x));
      REQUIRE(proved <= nearest);
      REQUIRE(std::abs(proved - of_once.at(x, norm)) < 1e-10);  // whatever the triangles
    }
    CHECK(surface.at(body.points[0], {}) == 0);
  }
}

TEST_CASE("all translations shorter than the proven depth leave an overlap, slightly longer ones need not") {
  RandomEngine random(42);
  // A cube with two faces normal to (1, 1, 1).
  constexpr double kNearCorner = 0.83 * 0.25 * 1.7320508075688772;
  const auto turn = Eigen::Quaterniond::FromTwoVectors(Vector3d(1, 0, 0), Vector3d(1, 1, 1));
  Mesh turned = shapes::box();
  for (Vector3d& v : turned.vertices) v = turn * v;
  const struct {
    LrbRep a, b;
    Pose pose_b;
    double depth;     // about
    Vector3d common;  // inside both
  } pairs[] = {
      // Balls of radius 1: the depth is what is missing to 2, but for the faces' flatness.
      {closed(shapes::icosphere(3)),
       closed(shapes::icosphere(3)),
       Pose::translation({1.4, 0.2, 0.1}),
       0.58,
       {0.7, 0.1, 0.05}},
      // As deep as the corner of the one reaches into the other.
      {closed(shapes::box()),
       closed(shapes::box()),
       Pose::translation({0.75, 0.25, 0.5}),
       0.25,
       {0.87, 0.6, 0.7}},
      // The separating translation is just inside the corner of a cube of the proof.
      {closed(turned), closed(turned), Pose::translation(turn * Vector3d(1 - kNearCorner, 0, 0)), kNearCorner,
       turn * Vector3d(1 - kNearCorner / 2, 0.5, 0.5)},
  };
  for (const auto& pair : pairs) {
    Pair seen(pair.a, pair.b, pair.pose_b);
    const SurfaceDistance a(seen.bodies.body[0]), b(seen.bodies.body[1]);
    OverlapProof proof(a, b, seen.inside());
    const double most = 1.05 * std::ldexp(pair.depth, -seen.bodies.frame.exponent);
    REQUIRE(proof.begin({seen.bodies.frame.to_unit(pair.common), Vector3d(0.9, 0.9, 0.9)}, most));
    double before = 0;
    for (int i = 0; i < 60; ++i) {
      proof.grow(500);
      CHECK(proof.lower() >= before);
      before = proof.lower();
    }
    const double lower = seen.bodies.frame.length_to_world(proof.lower());
    CHECK(lower > 0.95 * pair.depth);
    CHECK(lower < 1.001 * pair.depth);
    for (int i = 0; i < 50; ++i)
      CHECK(overlap_after(pair.a, pair.b, pair.pose_b, 0.999999 * lower * shapes::random_direction(random)));
    // The rest is where the separation vector is.
    const Vector3d out = proof.undecided().normalized();
    CHECK_FALSE(overlap_after(pair.a, pair.b, pair.pose_b, 1.1 * pair.depth * out));
  }
}

TEST_CASE("no depth is proven without a point inside both bodies") {
  const LrbRep box = closed(shapes::box());
  Pair seen(box, box, Pose::translation({0.5, 0, 0}));
  const SurfaceDistance a(seen.bodies.body[0]), b(seen.bodies.body[1]);
  OverlapProof proof(a, b, seen.inside());
  CHECK_FALSE(proof.begin({seen.bodies.frame.to_unit({0.25, 0.5, 0.5})}, 0.9));  // of A alone
  CHECK_FALSE(proof.begin({}, 0.9));
  CHECK(proof.lower() == 0);
}
