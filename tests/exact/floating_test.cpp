
#include <doctest/doctest.h>

#include "bench/cases/families.hpp"
#include "engine/exact/predicates.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/collide.hpp>

using namespace lrb;

namespace {

/// The classroom example (Kettner, Mehlhorn, Pion, Schirra, Yap 2008): a point near (0.5, 0.5), ulps off in x
/// and y, against a line through (12, 12) and (24, 24). Which side it lies on is the sign of i - j.
int wrong_sides() {
  const double p[2] = {12, 12}, q[2] = {24, 24};
  int wrong = 0;
  for (int i = 0; i < 64; ++i)
    for (int j = 0; j < 64; ++j) {
      const double r[2] = {0.5 + i * 0x1p-53, 0.5 + j * 0x1p-53};
      const int side = (r[1] > r[0]) - (r[1] < r[0]);
      wrong += exact::orient2d(p, q, r) != side;
    }
  return wrong;
}

}  // namespace

TEST_CASE("floating predicates are wrong where doubles cannot decide, within the scope of the guard") {
  CHECK(wrong_sides() == 0);
  {
    const exact::FloatingPredicates floating;
    CHECK(wrong_sides() > 0);
    {
      const exact::FloatingPredicates within(false);
      CHECK(wrong_sides() == 0);
    }
    CHECK(wrong_sides() > 0);
  }
  CHECK(wrong_sides() == 0);
}

TEST_CASE("a query with floating predicates misjudges near contacts; the next query is exact") {
  shapes::RandomEngine random(5);
  CollideRequest floating;
  floating.predicates = Predicates::floating;
  const cases::Family* family = cases::find_family("coplanar");
  REQUIRE(family != nullptr);
  int wrong = 0;
  for (int i = 0; i < 300; ++i) {
    const cases::Case c = family->make(random, 0.8);
    const auto brute = brute_force(*c.a, c.pose_a, *c.b, c.pose_b);
    wrong += collide(*c.a, c.pose_a, *c.b, c.pose_b, floating).pairs != brute.pairs;
    CHECK(collide(*c.a, c.pose_a, *c.b, c.pose_b).pairs == brute.pairs);
  }
  CHECK(wrong > 0);
}
