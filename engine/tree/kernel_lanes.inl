#pragma once
// Part of tree_kernel.inl and pair_kernel.inl: vectors of eight floats, and masks of eight lanes.

#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace lrb {
namespace {

using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Double4 = double __attribute__((vector_size(32)));

inline Float8 splat(float x) {
  return Float8{x, x, x, x, x, x, x, x};
}

inline Float4 splat4(float x) {
  return Float4{x, x, x, x};
}

inline Double4 splat4d(double x) {
  return Double4{x, x, x, x};
}

inline Float4 abs4(Float4 x) {
  return reinterpret_cast<Float4>(reinterpret_cast<Int4>(x) & (Int4{} + 0x7fffffff));
}

inline Float8 abs8(Float8 x) {
  const Int8 mask = Int8{} + 0x7fffffff;
  return reinterpret_cast<Float8>(reinterpret_cast<Int8>(x) & mask);
}

// A truth value for each of eight lanes: one bit each if the processor has mask registers, otherwise all or
// none of a lane's bits.
#if defined(__AVX512VL__) && defined(__AVX512DQ__)
using Lanes = std::uint8_t;
constexpr Lanes kAllLanes = 255, kNoLanes = 0;

inline Lanes greater(Float8 x, Float8 y) {
  // OQ: ordered and quiet. A comparison with NaN is false, as with the operator > below.
  return _mm256_cmp_ps_mask(reinterpret_cast<__m256>(x), reinterpret_cast<__m256>(y), _CMP_GT_OQ);
}

inline std::uint32_t bits(Lanes lanes) {
  return lanes;
}

inline Float8 select(Lanes which, Float8 x, Float8 y) {
  return reinterpret_cast<Float8>(
      _mm256_mask_mov_ps(reinterpret_cast<__m256>(y), which, reinterpret_cast<__m256>(x)));
}
#else
using Lanes = Int8;
constexpr Lanes kAllLanes = {-1, -1, -1, -1, -1, -1, -1, -1}, kNoLanes = {};

inline Lanes greater(Float8 x, Float8 y) {
#if defined(__AVX__)
  return x > y;
#else
  // GCC compares vectors that are wider than the registers number by number.
  Float4 a[2], b[2];
  __builtin_memcpy(a, &x, sizeof x);
  __builtin_memcpy(b, &y, sizeof y);
  const Int4 half[2] = {a[0] > b[0], a[1] > b[1]};
  Lanes lanes;
  __builtin_memcpy(&lanes, half, sizeof lanes);
  return lanes;
#endif
}

/// Returns a mask whose bit k is set if lane k is true.
inline std::uint32_t bits(Lanes lanes) {
#if defined(__AVX__)
  // The sign bit of each lane. A lane is all ones or all zeros.
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(lanes)));
#elif defined(__SSE2__)
  const auto* half = reinterpret_cast<const __m128*>(&lanes);
  return static_cast<std::uint32_t>(_mm_movemask_ps(half[0]) | _mm_movemask_ps(half[1]) << 4);
#elif defined(__aarch64__)
  // A bit of each lane; the sum of four lanes is a single instruction.
  constexpr Int8 kBit = {1, 2, 4, 8, 16, 32, 64, 128};
  const Int8 bit = lanes & kBit;
  const auto* half = reinterpret_cast<const int32x4_t*>(&bit);
  return static_cast<std::uint32_t>(vaddvq_s32(half[0] | half[1]));
#else
  std::uint32_t result = 0;
  for (int k = 0; k < 8; ++k) result |= static_cast<std::uint32_t>(lanes[k] & 1) << k;
  return result;
#endif
}

inline Float8 select(Lanes which, Float8 x, Float8 y) {
#if defined(__AVX__)
  return reinterpret_cast<Float8>(_mm256_blendv_ps(reinterpret_cast<__m256>(y), reinterpret_cast<__m256>(x),
                                                   reinterpret_cast<__m256>(which)));
#else
  return reinterpret_cast<Float8>((reinterpret_cast<Int8>(x) & which) | (reinterpret_cast<Int8>(y) & ~which));
#endif
}
#endif

inline Lanes both(Lanes x, Lanes y) {
  return static_cast<Lanes>(x & y);
}
inline Lanes either(Lanes x, Lanes y) {
  return static_cast<Lanes>(x | y);
}
inline Lanes equal(Lanes x, Lanes y) {
  return static_cast<Lanes>(~(x ^ y));
}
/// Returns x in the lanes of `which`, y in the others.
inline Lanes select(Lanes which, Lanes x, Lanes y) {
  return static_cast<Lanes>((x & which) | (y & ~which));
}

/// Returns x if it is greater than y, otherwise y (also if either is NaN).
inline Float8 larger(Float8 x, Float8 y) {
#if defined(__AVX__)
  // maxps returns its second operand if either is NaN, like the other branch.
  return reinterpret_cast<Float8>(_mm256_max_ps(reinterpret_cast<__m256>(x), reinterpret_cast<__m256>(y)));
#else
  return select(greater(x, y), x, y);
#endif
}

/// Returns y if x is greater than it, otherwise x (also if either is NaN).
inline Float8 smaller(Float8 x, Float8 y) {
#if defined(__AVX__)
  return reinterpret_cast<Float8>(_mm256_min_ps(reinterpret_cast<__m256>(y), reinterpret_cast<__m256>(x)));
#else
  return select(greater(x, y), y, x);
#endif
}

inline float largest_of(Float8 x) {
  const auto larger4 = [](Float4 a, Float4 b) {
    const Int4 which = a > b;
    return reinterpret_cast<Float4>((reinterpret_cast<Int4>(a) & which) |
                                    (reinterpret_cast<Int4>(b) & ~which));
  };
  // Horizontal maximum: of the halves, then of pairs, then of neighbours.
  Float4 m = larger4(__builtin_shufflevector(x, x, 0, 1, 2, 3), __builtin_shufflevector(x, x, 4, 5, 6, 7));
  m = larger4(m, __builtin_shufflevector(m, m, 2, 3, 0, 1));
  m = larger4(m, __builtin_shufflevector(m, m, 1, 0, 3, 2));
  return m[0];
}

inline Float8 root8(Float8 x) {
#if defined(__AVX__)
  return reinterpret_cast<Float8>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x)));
#elif defined(__SSE2__)
  auto* half = reinterpret_cast<__m128*>(&x);
  half[0] = _mm_sqrt_ps(half[0]);
  half[1] = _mm_sqrt_ps(half[1]);
  return x;
#elif defined(__aarch64__)
  auto* half = reinterpret_cast<float32x4_t*>(&x);
  half[0] = vsqrtq_f32(half[0]);
  half[1] = vsqrtq_f32(half[1]);
  return x;
#else
  for (int k = 0; k < 8; ++k) x[k] = __builtin_sqrtf(x[k]);
  return x;
#endif
}

inline Int8 bytes_to_int(const std::uint8_t* q) {
#if defined(__AVX2__)
  return reinterpret_cast<Int8>(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q))));
#elif defined(__SSE2__)
  // Interleave with zero bytes twice: 8 to 16 to 32 bits.
  const __m128i zero = _mm_setzero_si128();
  const __m128i words = _mm_unpacklo_epi8(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q)), zero);
  union {
    __m128i half[2];
    Int8 all;
  } u;
  u.half[0] = _mm_unpacklo_epi16(words, zero);
  u.half[1] = _mm_unpackhi_epi16(words, zero);
  return u.all;
#elif defined(__aarch64__)
  const uint16x8_t words = vmovl_u8(vld1_u8(q));
  union {
    uint32x4_t half[2];
    Int8 all;
  } u;
  u.half[0] = vmovl_u16(vget_low_u16(words));
  u.half[1] = vmovl_high_u16(words);
  return u.all;
#else
  Int8 x;
  for (int k = 0; k < 8; ++k) x[k] = q[k];
  return x;
#endif
}

inline Float8 load8(const float* x) {
  return *reinterpret_cast<const Float8*>(x);
}

inline Float8 join(Float4 low, Float4 high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// Transposes eight rows of four.
inline void transpose(const Float4* row, Float8* column) {
  Float8 pair[4];  // rows 0 and 4, 1 and 5, 2 and 6, 3 and 7
  for (int i = 0; i < 4; ++i) pair[i] = join(row[i], row[4 + i]);
  // Interleave rows in pairs within each half of a vector, then pairs of pairs. The halves never mix.
  const Float8 low01 = __builtin_shufflevector(pair[0], pair[1], 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 low23 = __builtin_shufflevector(pair[2], pair[3], 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 high01 = __builtin_shufflevector(pair[0], pair[1], 2, 10, 3, 11, 6, 14, 7, 15);
  const Float8 high23 = __builtin_shufflevector(pair[2], pair[3], 2, 10, 3, 11, 6, 14, 7, 15);
  column[0] = __builtin_shufflevector(low01, low23, 0, 1, 8, 9, 4, 5, 12, 13);
  column[1] = __builtin_shufflevector(low01, low23, 2, 3, 10, 11, 6, 7, 14, 15);
  column[2] = __builtin_shufflevector(high01, high23, 0, 1, 8, 9, 4, 5, 12, 13);
  column[3] = __builtin_shufflevector(high01, high23, 2, 3, 10, 11, 6, 7, 14, 15);
}

}  // namespace
}  // namespace lrb
