// Distances of two simplices, in doubles and in integers, against rational arithmetic.
#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "bench/stability/rational_oracles.hpp"
#include "engine/distance/near_kernel.hpp"
#include "engine/distance/pair_bounds.hpp"
#include "tests/support/random_simplices.hpp"
#include <lrbscope/pair_distance.hpp>

using namespace lrb;
using oracle::Rational;
using test::Kind;
using test::Rng;

namespace {

/// Returns corners for the oracle; in 2D without z.
oracle::Corners corners_of(const double* const* x, int n) {
  oracle::Corners out;
  for (int k = 0; k < n; ++k) out.push_back({x[k][0], x[k][1], n == 3 ? x[k][2] : 0});
  return out;
}

struct PairTally {
  int pairs = 0, meet = 0, proved_apart = 0, narrow = 0, eight_apart = 0, eight_narrow = 0;
};

/// Compares with a distance beside the exact one.
void check_comparison(const double* const* a, const double* const* b, int n, double distance,
                      const Rational& sq) {
  if (!std::isfinite(distance)) return;
  const Rational given = oracle::square(distance);
  CHECK(exact::compare_distance(a, b, n, distance) == (sq > given) - (sq < given));
}

/// Measures the pair eight at a time, in all places of the eight, of which the others have another pair.
/// Checks that the intervals contain the distance.
void check_eight(const double* const* a, const double* const* b, int n, const Rational& sq, PairTally& t) {
  EightPairsMeasured eight;
  PairBoundsKernel kernel{};
  for (int side = 0; side < 2; ++side)
    for (int axis = 0; axis < n; ++axis) kernel.r[side][axis][axis] = 1;
  kernel.within = INFINITY;
  kernel.pairs = &eight;
  kernel.block_count = 1;
  for (int at = 0; at < 8; ++at) {
    for (int lane = 0; lane < 8; ++lane)
      for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis) {
          // A segment repeats its second corner.
          const int k = std::min(corner, n - 1);
          const bool here = axis < n && (lane == at || axis == 0);
          eight.corner[0][corner][axis][lane] = here ? a[k][axis] : lane;
          eight.corner[1][corner][axis][lane] = here ? b[k][axis] : corner;
        }
    run_pair_bounds_kernel(kernel);
    REQUIRE(eight.lower[at] <= eight.upper[at]);
    REQUIRE(oracle::square(eight.lower[at]) <= sq);
    if (!std::isfinite(eight.upper[at])) continue;
    REQUIRE(oracle::square(eight.upper[at]) >= sq);
    if (at != 0) continue;
    t.eight_apart += eight.lower[0] > 0;
    t.eight_narrow += eight.upper[0] - eight.lower[0] <= 1e-12 * std::max(1.0, eight.upper[0]);
  }
}

void check_pair(const test::SimplexPair& pair, int n, PairTally& t) {
  const auto a3 = pair.a(), b3 = pair.b();
  const double *const *a = a3.data(), *const *b = b3.data();
  const Rational sq = oracle::distance_sq(corners_of(a, n), corners_of(b, n));
  ++t.pairs;
  const PairBounds bounds = bound_distance(a, b, n);
  REQUIRE(bounds.lower <= bounds.upper);
  REQUIRE(oracle::square(bounds.lower) <= sq);
  if (std::isfinite(bounds.upper)) {
    // Where simplices cross, the upper end is that of boundaries: it holds, but not narrowly.
    REQUIRE(oracle::square(bounds.upper) >= sq);
    t.proved_apart += bounds.lower > 0;
    t.narrow += bounds.upper - bounds.lower <= 1e-12 * std::max(1.0, bounds.upper);
  }
  check_eight(a, b, n, sq, t);
  if (sq == 0) {
    ++t.meet;
    return;
  }
  const exact::PairDistance exact = exact::distance_of_simplices(a, b, n);
  REQUIRE(oracle::square(exact.lower) <= sq);
  if (std::isfinite(exact.upper)) REQUIRE(oracle::square(exact.upper) >= sq);
  const bool is_tight = exact.lower == exact.upper || std::nextafter(exact.lower, INFINITY) == exact.upper;
  if (exact.lower > 0x1p-1000) REQUIRE(is_tight);
  for (const double d : {exact.lower, exact.upper, 0.5 * exact.lower, 0.0}) check_comparison(a, b, n, d, sq);
}

}  // namespace

TEST_CASE("distances of triangles and of segments contain the rational one, degenerate or not") {
  for (int k = 0; k < static_cast<int>(Kind::count); ++k) {
    const Kind kind = static_cast<Kind>(k);
    CAPTURE(test::name_of(kind));
    Rng rng(700 + static_cast<std::uint64_t>(k));
    PairTally t;
    const int rounds = test::rounds_for(kind, 12);
    for (int i = 0; i < rounds; ++i) {
      CAPTURE(i);
      const test::SimplexPair pair = test::random_pair(rng, kind);
      check_pair(pair, 3, t);
      check_pair(pair, 2, t);
    }
    if (kind == Kind::real) {
      CHECK(t.proved_apart + t.meet > t.pairs * 9 / 10);
      CHECK(t.narrow + t.meet > t.pairs * 9 / 10);
      CHECK(t.eight_apart + t.meet > t.pairs * 9 / 10);
      CHECK(t.eight_narrow + t.meet > t.pairs * 9 / 10);
    }
    if (kind == Kind::grid) CHECK(t.meet > 3);
  }
}

TEST_CASE("distances of pairs that are parallel, coplanar, 1e-12 apart or 1e12 away") {
  Rng rng(31);
  PairTally t;
  for (int i = 0; i < test::effort(240); ++i) {
    CAPTURE(i);
    test::SimplexPair pair = test::random_pair(rng, i % 2 == 0 ? Kind::real : Kind::grid);
    const double apart = std::array{1e-12, 1e-9, 1.0, 1e12}[static_cast<std::size_t>(i / 2 % 4)];
    const int shape = i / 8 % 4;
    for (std::size_t c = 0; c < 3; ++c) {
      pair.p[c][2] = 0;
      if (shape == 0) pair.p[3 + c] = pair.p[c];                                      // the same triangle
      if (shape == 1) pair.p[3 + c] = pair.p[(c + 1) % 3], pair.p[3 + c][0] += 0.25;  // parallel edges
      if (shape == 2) pair.p[3 + c][2] = 0, pair.p[3 + c][0] += 4;                    // coplanar
      pair.p[3 + c][shape == 2 ? 0 : 2] += apart;
    }
    check_pair(pair, 3, t);
    check_pair(pair, 2, t);
  }
  CHECK(t.narrow > t.pairs / 2);
  CHECK(t.eight_narrow > t.pairs / 2);
}

TEST_CASE("closest features, and points on them") {
  const double a[3][3] = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  const auto ask = [&](std::array<std::array<double, 3>, 3> b, bool in_integers) {
    const double* const of_a[3] = {a[0], a[1], a[2]};
    const double* const of_b[3] = {b[0].data(), b[1].data(), b[2].data()};
    if (!in_integers) return bound_distance(of_a, of_b, 3);
    const exact::PairDistance d = exact::distance_of_simplices(of_a, of_b, 3);
    return PairBounds{d.lower, d.upper, {d.point[0], d.point[1]}, {d.on[0], d.on[1]}};
  };
  for (const bool in_integers : {false, true}) {
    const PairBounds over_face = ask({{{1, 1, 2}, {1, 2, 5}, {2, 1, 5}}}, in_integers);
    CHECK(over_face.upper == doctest::Approx(2).epsilon(1e-13));
    CHECK(over_face.on[0] == exact::Feature{2, 0});
    CHECK(over_face.on[1] == exact::Feature{0, 0});
    CHECK((over_face.point[0] - Eigen::Vector3d(1, 1, 0)).norm() < 1e-15);
    const PairBounds edges = ask({{{2, -1, -1}, {2, -1, 3}, {2, -5, 0}}}, in_integers);
    CHECK(edges.upper == doctest::Approx(1).epsilon(1e-13));
    CHECK(edges.on[0] == exact::Feature{1, 0});
    CHECK(edges.on[1] == exact::Feature{1, 0});
    const PairBounds corners = ask({{{7, -4, 0}, {9, -9, 1}, {9, -9, -1}}}, in_integers);
    CHECK(corners.upper == doctest::Approx(5).epsilon(1e-13));
    CHECK(corners.on[0] == exact::Feature{0, 1});
    CHECK(corners.on[1] == exact::Feature{0, 0});
    CHECK(corners.point[1] == Eigen::Vector3d(7, -4, 0));
  }
}
