#pragma once
/// Determinants in 64-bit fixed point: exact, almost without branches, and about ten times faster than
/// expansions. They serve points whose coordinates share an exponent range, as those of neighbouring faces
/// nearly always do.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace lrb::exact {

__extension__ using Int128 = __int128;
__extension__ using UInt128 = unsigned __int128;

/// Turns the coordinates of N points along one axis into integers below 2^62 in magnitude, by multiplying
/// them by a common power of two, which changes no sign of a determinant. Returns false if they do not fit:
/// if the highest and the lowest bit set in any of them are 62 or more places apart, or one of them is
/// denormal or almost.
template <std::size_t N>
bool to_fixed_point(const std::array<double, N>& x, std::array<std::int64_t, N>& r) {
  constexpr int kMantissaBits = 52, kExponentBias = 1023, kExponentMask = 2047;
  constexpr int kNone = 4096;
  int highest = 0, lowest = kNone;  // biased exponents of the bits
  for (double v : x) {
    const auto bits = std::bit_cast<std::uint64_t>(v);
    const int exponent = static_cast<int>(bits >> kMantissaBits) & kExponentMask;
    const int low = exponent - kMantissaBits + std::countr_zero(bits | (std::uint64_t{1} << kMantissaBits));
    highest = std::max(highest, exponent);
    lowest = std::min(lowest, v == 0 ? kNone : low);
  }
  // The factor 2^-lowest must be a normal double.
  if (highest - lowest >= 62 || lowest < 1 || lowest >= 2 * kExponentBias) return false;
  const auto scale =
      std::bit_cast<double>(static_cast<std::uint64_t>(2 * kExponentBias - lowest) << kMantissaBits);
  for (std::size_t i = 0; i < N; ++i) r[i] = static_cast<std::int64_t>(x[i] * scale);
  return true;
}

/// Returns the sign of (b - a) x (c - a) in the given coordinates, all below 2^62, so that differences are
/// below 2^63 and products below 2^126.
inline int orient2d_fixed(const std::array<std::int64_t, 3>& x, const std::array<std::int64_t, 3>& y) {
  const Int128 left = Int128{x[1] - x[0]} * (y[2] - y[0]);
  const Int128 right = Int128{y[1] - y[0]} * (x[2] - x[0]);
  return (left > right) - (left < right);
}

/// Returns the sign of det[b - a; c - a; d - a]; p[k] holds the points' coordinates on axis k.
inline int orient3d_fixed(const std::array<std::array<std::int64_t, 4>, 3>& p) {
  std::array<std::int64_t, 3> u, v, w;
  for (std::size_t k = 0; k < 3; ++k) {
    u[k] = p[k][1] - p[k][0];
    v[k] = p[k][2] - p[k][0];
    w[k] = p[k][3] - p[k][0];
  }
  // The determinant is at most twice the volume of the points' box, so it is below 2^190 and can be held as
  // high * 2^64 + low, where high fits 128 bits. Partial sums of high may wrap, hence unsigned.
  UInt128 high = 0, low = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const Int128 minor = Int128{u[i]} * v[j] - Int128{u[j]} * v[i];
    const Int128 upper = Int128{static_cast<std::int64_t>(minor >> 64)} * w[k];
    const Int128 lower = Int128{static_cast<std::uint64_t>(minor)} * w[k];
    high += static_cast<UInt128>(upper) + static_cast<UInt128>(lower >> 64);
    low += static_cast<std::uint64_t>(lower);
  }
  high += low >> 64;
  const auto signed_high = static_cast<Int128>(high);
  if (signed_high != 0) return signed_high < 0 ? -1 : 1;
  return static_cast<std::uint64_t>(low) != 0 ? 1 : 0;
}

}  // namespace lrb::exact
