#pragma once
// Part of kernel_distances.inl: vectors of doubles, with the functions of kernel_lanes.inl.

#include "engine/tree/kernel_lanes.inl"

namespace lrb {
namespace {

// As many doubles as a vector register has: the results do not depend on their number.
#if defined(__AVX512DQ__)
constexpr int kDoubles = 8;
using Doubles = double __attribute__((vector_size(64)));
using DoubleLanes = std::uint8_t;
constexpr DoubleLanes kAllDoubles = 255;  // for masked forms, because gcc 12 warns about the others

inline DoubleLanes greater(Doubles x, Doubles y) {
  return _mm512_cmp_pd_mask(reinterpret_cast<__m512d>(x), reinterpret_cast<__m512d>(y), _CMP_GT_OQ);
}

inline Doubles select(DoubleLanes which, Doubles x, Doubles y) {
  return reinterpret_cast<Doubles>(
      _mm512_mask_mov_pd(reinterpret_cast<__m512d>(y), which, reinterpret_cast<__m512d>(x)));
}

inline Doubles larger(Doubles x, Doubles y) {
  // maxpd returns its second operand if either is NaN.
  return reinterpret_cast<Doubles>(
      _mm512_maskz_max_pd(kAllDoubles, reinterpret_cast<__m512d>(x), reinterpret_cast<__m512d>(y)));
}

inline Doubles abs8(Doubles x) {
  return reinterpret_cast<Doubles>(_mm512_abs_pd(reinterpret_cast<__m512d>(x)));
}

inline Doubles root8(Doubles x) {
  return reinterpret_cast<Doubles>(_mm512_maskz_sqrt_pd(kAllDoubles, reinterpret_cast<__m512d>(x)));
}
#else
constexpr int kDoubles = 4;
using Doubles = Double4;
using DoubleLanes = std::int64_t __attribute__((vector_size(32)));

inline DoubleLanes greater(Doubles x, Doubles y) {
#if defined(__AVX__)
  return reinterpret_cast<DoubleLanes>(x > y);
#else
  // As for floats: in halves.
  using Double2 = double __attribute__((vector_size(16)));
  using Int2 = std::int64_t __attribute__((vector_size(16)));
  Double2 a[2], b[2];
  __builtin_memcpy(a, &x, sizeof x);
  __builtin_memcpy(b, &y, sizeof y);
  const Int2 half[2] = {a[0] > b[0], a[1] > b[1]};
  DoubleLanes lanes;
  __builtin_memcpy(&lanes, half, sizeof lanes);
  return lanes;
#endif
}

/// Returns a mask whose bit k is set if lane k is true.
inline std::uint32_t bits(DoubleLanes lanes) {
#if defined(__AVX__)
  return static_cast<std::uint32_t>(_mm256_movemask_pd(reinterpret_cast<__m256d>(lanes)));
#else
  std::uint32_t result = 0;
  for (int k = 0; k < kDoubles; ++k) result |= static_cast<std::uint32_t>(lanes[k] & 1) << k;
  return result;
#endif
}

inline DoubleLanes both(DoubleLanes x, DoubleLanes y) {
  return x & y;
}
inline DoubleLanes either(DoubleLanes x, DoubleLanes y) {
  return x | y;
}

inline Doubles select(DoubleLanes which, Doubles x, Doubles y) {
#if defined(__AVX__)
  return reinterpret_cast<Doubles>(_mm256_blendv_pd(
      reinterpret_cast<__m256d>(y), reinterpret_cast<__m256d>(x), reinterpret_cast<__m256d>(which)));
#else
  return reinterpret_cast<Doubles>((reinterpret_cast<DoubleLanes>(x) & which) |
                                   (reinterpret_cast<DoubleLanes>(y) & ~which));
#endif
}

/// Returns x if it is greater than y, otherwise y (also if either is NaN).
inline Doubles larger(Doubles x, Doubles y) {
#if defined(__AVX__)
  return reinterpret_cast<Doubles>(_mm256_max_pd(reinterpret_cast<__m256d>(x), reinterpret_cast<__m256d>(y)));
#else
  return select(greater(x, y), x, y);
#endif
}

inline Doubles abs8(Doubles x) {
  return reinterpret_cast<Doubles>(reinterpret_cast<DoubleLanes>(x) &
                                   (DoubleLanes{} + std::int64_t{0x7fffffffffffffff}));
}

inline Doubles root8(Doubles x) {
#if defined(__AVX__)
  return reinterpret_cast<Doubles>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(x)));
#elif defined(__SSE2__)
  auto* half = reinterpret_cast<__m128d*>(&x);
  half[0] = _mm_sqrt_pd(half[0]);
  half[1] = _mm_sqrt_pd(half[1]);
  return x;
#elif defined(__aarch64__)
  auto* half = reinterpret_cast<float64x2_t*>(&x);
  half[0] = vsqrtq_f64(half[0]);
  half[1] = vsqrtq_f64(half[1]);
  return x;
#else
  for (int k = 0; k < kDoubles; ++k) x[k] = __builtin_sqrt(x[k]);
  return x;
#endif
}
#endif

inline Doubles splat_as(Doubles, double x) {
#if defined(__AVX512DQ__)
  return Doubles{x, x, x, x, x, x, x, x};
#else
  return splat4d(x);
#endif
}

inline Doubles load(const double* x) {
  return *reinterpret_cast<const Doubles*>(x);
}
inline void store(Doubles x, double* to) {
  *reinterpret_cast<Doubles*>(to) = x;
}

}  // namespace
}  // namespace lrb
