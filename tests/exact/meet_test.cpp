// Ten million pairs of triangles, about five minutes: LRB_EXACT_EFFORT=60 exact_tests -tc='triangles meet*'
#include <cstdint>

#include <doctest/doctest.h>

#include "engine/exact/predicates.hpp"
#include "tests/support/meet_roles.hpp"
#include "tests/support/random_simplices.hpp"
#include "tests/support/rational_oracle.hpp"
#include <lrbscope/contact.hpp>

using namespace lrb;
using lrb::test::Kind;

namespace {

/// Calls check(pair) for `rounds` random pairs of each kind; grids, whose oracle is fast, get `grid_factor`
/// more.
template <class Check>
void for_each_kind(std::uint64_t seed, int rounds, int grid_factor, Check check) {
  for (int k = 0; k < static_cast<int>(Kind::count); ++k) {
    const Kind kind = static_cast<Kind>(k);
    const bool is_grid = kind == Kind::grid || kind == Kind::tiny_grid || kind == Kind::collinear;
    test::Rng rng(seed + static_cast<std::uint64_t>(k));
    const int n = test::rounds_for(kind, rounds) * (is_grid ? grid_factor : 1);
    int wrong = 0;
    for (int i = 0; i < n; ++i) wrong += check(test::random_pair(rng, kind)) ? 0 : 1;
    CHECK_MESSAGE(wrong == 0, test::name_of(kind) << ": " << wrong << " of " << n << " disagree");
  }
}

}  // namespace

TEST_CASE("intersections of triangles agree with the rational oracle") {
  for_each_kind(11, 1500, 30, [](const test::SimplexPair& s) {
    return test::triangles_meet_as(s, oracle::meet_of_simplices(s.a().data(), s.b().data(), 3));
  });
}

TEST_CASE("intersections of 2D segments agree with the rational oracle") {
  for_each_kind(12, 1500, 20, [](const test::SimplexPair& s) {
    return test::segments_meet_as(s, oracle::meet_of_simplices(s.a().data(), s.b().data(), 2));
  });
}

TEST_CASE("orientations have the sign of the rational determinant") {
  for_each_kind(13, 1500, 3, [](const test::SimplexPair& s) {
    const double *a = s.p[0].data(), *b = s.p[1].data(), *c = s.p[2].data(), *d = s.p[3].data();
    const int in_space = oracle::orientation({a, b, c, d});
    const int in_plane = oracle::orientation({a, b, c});
    const bool line = oracle::affine_dimension_of({a, b, c}, 3) < 2;
    return exact::orient3d(a, b, c, d) == in_space && exact::orient3d(b, a, c, d) == -in_space &&
           exact::orient2d(a, b, c) == in_plane && exact::orient2d(a, c, b) == -in_plane &&
           exact::collinear3d(a, b, c) == line;
  });
}

TEST_CASE("orientation follows the convention") {
  const double o[3] = {0, 0, 0}, x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
  CHECK(exact::orient2d(o, x, y) == 1);
  CHECK(exact::orient3d(o, x, y, z) == 1);
}

TEST_CASE("the counter of exact fallbacks counts undecided predicates") {
  const double a[2] = {0, 0}, b[2] = {0.1, 0.1}, c[2] = {0.3, 0.3}, d[2] = {0.3, 0.7};
  const auto before = exact::exact_fallbacks();
  CHECK(exact::orient2d(a, b, d) == 1);
  CHECK(exact::exact_fallbacks() == before);
  CHECK(exact::orient2d(a, b, c) == 0);
  CHECK(exact::exact_fallbacks() == before + 1);
}
