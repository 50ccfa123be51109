// Bodies made of fans: their long narrow triangles are told apart on directions of their own, and the answer
// is that of brute force.

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/support/bodies.hpp"
#include "tests/support/hard_bodies.hpp"
#include <lrbscope/collide.hpp>

namespace lrb::test {
namespace {

using test::closed;

TEST_CASE("queries of bodies full of needles agree with brute force") {
  constexpr std::uint32_t kMany = 700;
  const std::vector<LrbRep> bodies = {closed(hard::cone(kMany)), closed(hard::bipyramid(kMany)),
                                      closed(hard::crown(kMany)), closed(hard::frustum(kMany)),
                                      closed(hard::fine_box(kMany))};
  shapes::RandomEngine random(11);
  std::size_t in_contact = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    CAPTURE(i);
    for (int pose = 0; pose < 4; ++pose) {
      const LrbRep& b = bodies[(i + static_cast<std::size_t>(pose)) % bodies.size()];
      Pose at;
      if (pose > 0) {
        at.r = shapes::random_rotation(random);
        at.t = 0.4 * at.r.row(0).transpose();
      }
      const BruteForceResult expected = brute_force(bodies[i], Pose{}, b, at);
      const CollideResult got = collide(bodies[i], Pose{}, b, at, {});
      CHECK((got.pairs == expected.pairs));
      CHECK((got.meets == expected.meets));
      CHECK((got.relation == expected.relation));
      in_contact += !expected.pairs.empty();
    }
  }
  CHECK(in_contact > 10);
}

TEST_CASE("queries of a fan of thousands of needles agree with brute force") {
  const LrbRep cone = closed(hard::cone(3400));
  shapes::RandomEngine random(12);
  Pose at;
  at.r = shapes::random_rotation(random);
  at.t = 0.4 * at.r.row(0).transpose();
  const BruteForceResult expected = brute_force(cone, Pose{}, cone, at);
  CHECK(!expected.pairs.empty());
  CHECK((collide(cone, Pose{}, cone, at, {}).pairs == expected.pairs));
}

TEST_CASE("needles that share one point are not missed" * doctest::test_suite("long")) {
  const LrbRep cone = closed(hard::cone(2000)), other = closed(hard::bipyramid(2000));
  for (const VertexId v : std::initializer_list<VertexId>{
           0, 17, 1000, 2000}) {  // corners of the ring, and the apex, on each other
    for (const double angle : {0.0, 0.3, 1.1}) {
      Pose at;
      at.r = Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
      at.t = cone.vertices()[v] - at.r * other.vertices()[v];
      const BruteForceResult expected = brute_force(cone, Pose{}, other, at);
      CHECK((collide(cone, Pose{}, other, at, {}).pairs == expected.pairs));
    }
  }
}

TEST_CASE("the work grows with the number of needles, not of their pairs") {
  Pose at = Pose::translation({0.3, 0.2, 0.4});
  at.r = Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto tests = [&](std::uint32_t n) {
    const LrbRep body = closed(hard::frustum(n));
    return static_cast<double>(collide(body, Pose{}, body, at, {}).counters.face_tests);
  };
  CHECK(tests(16000) < 5 * tests(4000));
}

}  // namespace
}  // namespace lrb::test
