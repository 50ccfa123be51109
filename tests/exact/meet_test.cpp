// Ten million pairs of triangles, about five minutes: LRB_EXACT_EFFORT=60 exact_tests -tc='triangles meet*'
#include <doctest/doctest.h>

#include "engine/exact/predicates.hpp"
#include "tests/support/random_simplices.hpp"
#include "tests/support/rational_oracle.hpp"
#include <lrbscope/contact.hpp>

using namespace lrb;
using lrb::test::Kind;

namespace {

/// One rotation, one reflection, one exchange. `expected`: an exact::Meet.
bool triangles_meet_as(const test::SimplexPair& s, int expected) {
  const auto a = s.a(), b = s.b();
  const double* const turned[3] = {a[1], a[2], a[0]};
  const double* const reflected[3] = {b[0], b[2], b[1]};
  return static_cast<int>(exact::meet_triangles(a.data(), b.data())) == expected &&
         static_cast<int>(exact::meet_triangles(b.data(), turned)) == expected &&
         static_cast<int>(exact::meet_triangles(turned, reflected)) == expected;
}

bool segments_meet_as(const test::SimplexPair& s, int expected) {
  const auto a = s.a(), b = s.b();
  const double* const flipped[2] = {a[1], a[0]};
  return static_cast<int>(exact::meet_segments(a.data(), b.data())) == expected &&
         static_cast<int>(exact::meet_segments(b.data(), flipped)) == expected;
}

}  // namespace

TEST_CASE("intersections of triangles agree with the rational oracle") {
  test::for_each_kind(11, 1500, 30, [](test::Rng&, const test::SimplexPair& s, Kind) {
    return triangles_meet_as(s, oracle::meet_of_simplices(s.a().data(), s.b().data(), 3));
  });
}

TEST_CASE("intersections of 2D segments agree with the rational oracle") {
  test::for_each_kind(12, 1500, 20, [](test::Rng&, const test::SimplexPair& s, Kind) {
    return segments_meet_as(s, oracle::meet_of_simplices(s.a().data(), s.b().data(), 2));
  });
}

TEST_CASE("orientations have the sign of the rational determinant") {
  test::for_each_kind(13, 1500, 3, [](test::Rng&, const test::SimplexPair& s, Kind) {
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
