// Bounds of the exact predicates' filters, against rational arithmetic.
#include "tests/support/margins.hpp"

#include <array>

#include <boost/multiprecision/cpp_int.hpp>
#include <doctest/doctest.h>

#include "engine/exact/plane_side.hpp"

using namespace lrb;

namespace {

using Rational = boost::multiprecision::cpp_rational;

double share_of_determinant(std::span<const double> genes) {
  double p[4][3];
  for (std::size_t i = 0; i < 12; ++i) p[i / 3][i % 3] = 2 * genes[i] - 1;
  const auto found = exact::PlaneSide(p[0], p[1], p[2]).determinant(p[3]);
  Rational d[3][3], det = 0;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) d[i][k] = Rational(p[i + 1][k]) - Rational(p[0][k]);
  for (int k = 0; k < 3; ++k)
    det += d[2][k] * (d[0][(k + 1) % 3] * d[1][(k + 2) % 3] - d[0][(k + 2) % 3] * d[1][(k + 1) % 3]);
  return static_cast<double>(Rational(abs(Rational(found.value) - det) / Rational(found.error)));
}

}  // namespace

TEST_CASE("margins of filters are needed, and suffice") {
  const test::Margin rows[] = {{"determinant of four points", 12, share_of_determinant}};
  test::check_margins(rows);
}
