#include "engine/exact/expansion.hpp"

#include <array>
#include <cmath>

#include <doctest/doctest.h>

#include "engine/exact/predicates.hpp"
#include "tests/support/hull_oracle.hpp"
#include "tests/support/random_simplices.hpp"
#include "tests/support/rational_oracle.hpp"

using namespace lrb;
using exact::Expansion;
using oracle::cpp_rational;

namespace {

/// Doubles with exponents far apart, so that sums cancel partly and products have long tails.
double wide_double(test::Rng& rng) {
  if (test::random_int(rng, 0, 7) == 0) return 0;
  const double m = test::random_int(rng, 0, 1) == 0 ? test::random_unit(rng) : test::random_int(rng, 1, 4);
  return std::ldexp(test::random_int(rng, 0, 1) == 0 ? m : -m, test::random_int(rng, -60, 3));
}

template <int N>
cpp_rational value_of(const Expansion<N>& e) {
  cpp_rational sum = 0;
  for (int i = 0; i < e.size; ++i) sum += cpp_rational(e[i]);
  return sum;
}

/// Components are not zero, grow, and do not overlap: each is smaller than the lowest bit of the next.
template <int N>
bool is_proper(const Expansion<N>& e) {
  for (int i = 0; i < e.size; ++i) {
    if (e[i] == 0) return false;
    if (i + 1 < e.size) {
      double lowest = std::ldexp(1.0, std::ilogb(e[i + 1]) - 52);
      while (std::fmod(e[i + 1], lowest * 2) == 0) lowest *= 2;
      if (std::fabs(e[i]) >= lowest) return false;
    }
  }
  return true;
}

}  // namespace

TEST_CASE("sums and products of doubles are exact") {
  test::Rng rng(51);
  for (int i = 0; i < 3000; ++i) {
    const double a = wide_double(rng), b = wide_double(rng);
    double x, y;
    exact::two_sum(a, b, x, y);
    CHECK(cpp_rational(x) + cpp_rational(y) == cpp_rational(a) + cpp_rational(b));
    exact::two_product(a, b, x, y);
    CHECK(cpp_rational(x) + cpp_rational(y) == cpp_rational(a) * cpp_rational(b));
  }
}

TEST_CASE("expansions add, scale and multiply exactly and keep their form") {
  test::Rng rng(52);
  for (int i = 0; i < 3000; ++i) {
    const auto e = exact::difference(wide_double(rng), wide_double(rng));
    const auto f = exact::difference(wide_double(rng), wide_double(rng));
    const auto g = exact::difference(wide_double(rng), wide_double(rng));
    const double b = wide_double(rng);
    const auto ef = exact::product(e, f);
    const auto all = exact::sum(exact::product(ef, g), exact::scale(-e, b));
    CHECK(value_of(ef) == value_of(e) * value_of(f));
    CHECK(value_of(all) == value_of(e) * value_of(f) * value_of(g) - value_of(e) * cpp_rational(b));
    CHECK(is_proper(ef));
    CHECK(is_proper(all));
    CHECK(all.sign() == value_of(all).sign());
  }
}

TEST_CASE("fixed point, expansions and integers give the oracle's orientation wherever they apply") {
  int fixed_point_used = 0;
  test::for_each_kind(53, 500, 1, [&](test::Rng&, const test::SimplexPair& s, test::Kind kind) {
    exact::Coordinates4 p;
    for (std::size_t axis = 0; axis < 3; ++axis)
      p[axis] = {s.p[0][axis], s.p[1][axis], s.p[2][axis], s.p[3][axis]};
    const int expected = oracle::orientation({s.p[0].data(), s.p[1].data(), s.p[2].data(), s.p[3].data()});
    std::array<std::array<std::int64_t, 4>, 3> f;
    const bool fits = exact::to_fixed_point(p[0], f[0]) && exact::to_fixed_point(p[1], f[1]) &&
                      exact::to_fixed_point(p[2], f[2]);
    fixed_point_used += fits && kind == test::Kind::grid;
    return (!fits || exact::orient3d_fixed(f) == expected) && exact::orient3d_integer(p) == expected &&
           (!exact::expansions_apply(p) || exact::orient3d_expansion(p) == expected);
  });
  CHECK(fixed_point_used > 0);
}
