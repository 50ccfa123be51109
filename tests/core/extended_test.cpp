// Arithmetic with significands of 64 bits, in software and by x87, and the functions that are made of it.
#include "engine/core/extended.hpp"

#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <doctest/doctest.h>

#include <lrbscope/core/hash.hpp>
#include <lrbscope/core/random.hpp>

using namespace lrb;

namespace {

constexpr int kNumbers = 200'000;

/// A number of 64 bits near one of several powers of two, in both types.
struct Both {
  SoftExtended soft;
  long double hard = 0;
};

Both both(Random& random, int least_exponent) {
  constexpr std::uint32_t kExponents = 150;
  const std::uint64_t bits = random.bits() | std::uint64_t{1} << 63;
  const int exponent = least_exponent + static_cast<int>(random.below(kExponents));
  const double high = static_cast<double>(bits >> 32), low = static_cast<double>(bits & 0xffffffffu);
  const bool negative = random.below(2) == 1;
  const SoftExtended soft = ldexp(SoftExtended(high), exponent) + ldexp(SoftExtended(low), exponent - 32);
  const long double hard = std::ldexp(static_cast<long double>(high), exponent) +
                           std::ldexp(static_cast<long double>(low), exponent - 32);
  return negative ? Both{-soft, -hard} : Both{soft, hard};
}

bool same(double x, double y) {
  return x == y && std::signbit(x) == std::signbit(y);
}

/// Compares all 64 bits: the leading double and the rest.
bool same(const SoftExtended& x, long double y) {
  const auto high = static_cast<double>(x);
  return same(high, static_cast<double>(y)) &&
         same(static_cast<double>(x - high), static_cast<double>(y - high));
}

using Exact = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<200, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

Exact exact(const Extended& x) {
  const auto high = static_cast<double>(x);
  return Exact(high) + Exact(static_cast<double>(Extended(x - high)));
}

/// Returns the relative error in units of 2^-64.
double error_of(const Extended& x, const Exact& value) {
  return static_cast<double>(abs((exact(x) - value) / value)) * 0x1p64;
}

}  // namespace

#if LDBL_MANT_DIG == 64 && !defined(_WIN32)
TEST_CASE("software computes what x87 computes, with signed zeros and numbers below 2^-1022") {
  Random random(1);
  for (int i = 0; i < kNumbers; ++i) {
    const Both a = both(random, i % 5 == 0 ? -1150 : -75);
    Both b = both(random, -75);
    if (i % 3 == 0) b = {ldexp(a.soft, 1) - a.soft, a.hard};  // cancellation
    CAPTURE(i);
    REQUIRE(same(static_cast<double>(a.soft), static_cast<double>(a.hard)));
    REQUIRE(same(a.soft + b.soft, a.hard + b.hard));
    REQUIRE(same(a.soft - b.soft, a.hard - b.hard));
    REQUIRE(same(a.soft * b.soft, a.hard * b.hard));
    REQUIRE(same(a.soft / b.soft, a.hard / b.hard));
    REQUIRE(same(sqrt(abs(a.soft)), std::sqrt(std::abs(a.hard))));
    REQUIRE((a.soft < b.soft) == (a.hard < b.hard));
  }
  // A tie but for the last bit, which is shifted out.
  CHECK(same(SoftExtended(1) + (SoftExtended(0x1p-64) + SoftExtended(0x1p-127)), 1 + (0x1p-64L + 0x1p-127L)));
  for (const double x : {0.0, -0.0, 1.0, -2.0, 0x1p-1074, -0x1.8p-1073})
    for (const double y : {0.0, -0.0, 1.0, -2.0, 0x1p-1074, -0x1.8p-1073}) {
      const long double hard = x;
      CHECK(same(SoftExtended(x) + y, hard + y));
      CHECK(same(SoftExtended(x) - y, hard - y));
      CHECK(same(SoftExtended(x) * y, hard * y));
      CHECK(same(static_cast<double>(SoftExtended(x) * SoftExtended(y) * SoftExtended(0x1p50)),
                 static_cast<double>(hard * y * 0x1p50L)));
    }
}

TEST_CASE("functions have the same bits in software") {
  Random random(2);
  for (int i = 0; i < 20'000; ++i) {
    const double x = random.in(-10, 10) * (i % 4 == 0 ? 1e12 : 1), y = random.in(-10, 10);
    CAPTURE(x);
    const auto soft = extended::sine_cosine(SoftExtended(x));
    const auto hard = extended::sine_cosine(static_cast<long double>(x));
    REQUIRE(same(soft.sine, hard.sine));
    REQUIRE(same(soft.cosine, hard.cosine));
    REQUIRE(same(extended::arc_tangent(SoftExtended(x), SoftExtended(y)),
                 extended::arc_tangent(static_cast<long double>(x), static_cast<long double>(y))));
  }
}
#endif

TEST_CASE("functions are accurate to 64 bits") {
  Random random(3);
  double sine = 0, cosine = 0, arc = 0;
  for (int i = 0; i < 5'000; ++i) {
    // Also next to multiples of a right angle, where all leading bits cancel.
    const double size = i % 3 == 0 ? 1e-3 : i % 3 == 1 ? 10 : 1e9;
    const double x = i % 7 == 0 ? random.below(1'000'000) * (std::numbers::pi / 2) : random.in(-size, size);
    const auto of = extended::sine_cosine<Extended>(x);
    sine = std::max(sine, error_of(of.sine, sin(Exact(x))));
    cosine = std::max(cosine, error_of(of.cosine, cos(Exact(x))));
    const double y = random.in(-1, 1);
    arc = std::max(arc, error_of(extended::arc_tangent<Extended>(y, x), atan2(Exact(y), Exact(x))));
  }
  MESSAGE("errors in 2^-64: sine ", sine, ", cosine ", cosine, ", arc tangent ", arc);
  CHECK(sine <= 2);
  CHECK(cosine <= 2);
  CHECK(arc <= 4);
}

TEST_CASE("powers are correctly rounded with few exceptions, and exact where the result is a double") {
  Random random(4);
  int misrounded = 0;
  for (int i = 0; i < 5'000; ++i) {
    const double x = random.in(-17, 17);
    misrounded += deterministic::exp(x) != static_cast<double>(exp(Exact(x)));
    misrounded += deterministic::exp2(x) != static_cast<double>(exp2(Exact(x)));
    misrounded += deterministic::pow10(x) != static_cast<double>(pow(Exact(10), Exact(x)));
  }
  CHECK(misrounded <= 15);  // 1 in 1000
  for (int k = -22; k <= 22; ++k) {
    CHECK(deterministic::pow10(k) == std::stod("1e" + std::to_string(k)));
    CHECK(deterministic::exp2(k) == std::ldexp(1.0, k));
  }
  CHECK(deterministic::exp(800) == std::numeric_limits<double>::infinity());
  CHECK(deterministic::pow10(-400) == 0);
}

TEST_CASE("arguments that are not finite result in NaN") {
  for (const double x : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    CHECK(std::isnan(deterministic::sin(x)));
    CHECK(std::isnan(deterministic::tan(-x)));
    CHECK(std::isnan(deterministic::acos(x)));
    CHECK(std::isnan(deterministic::rotation({0, 0, 1}, x)(0, 0)));
  }
}

TEST_CASE("functions have the bits of every processor and compiler") {
  Random random(5);
  Fnv64 h;
  for (int i = 0; i < 2'000; ++i) {
    const double x = random.in(-20, 20), y = random.in(-1, 1);
    for (const double value : {deterministic::sin(x), deterministic::cos(x), deterministic::tan(x),
                               deterministic::atan(x), deterministic::acos(y), deterministic::atan2(x, y),
                               deterministic::exp(x), deterministic::exp2(x), deterministic::pow10(x)})
      h.add_value(value);
    const Eigen::Matrix3d r = deterministic::rotation_between({0, 0.6, 0.8}, x, {1, 0, 0}, y, 0.3);
    for (int k = 0; k < 9; ++k) h.add_value(r(k / 3, k % 3));
  }
  CHECK(h.value() == 5860228868551785521u);
}
