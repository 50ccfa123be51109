// Compiled once per instruction set by tree_kernel_*.cpp, which define LRB_KERNEL_NAME. Only plain loops over
// plain arrays here: an inline function of a library, compiled for a newer processor, could be picked by the
// linker for all.
//
// The floating-point operations are the same for every instruction set and are not contracted, so that
// counters and traces do not depend on the processor.

#include "engine/query/tree_kernel.hpp"
#include "engine/tolerances.hpp"

#if defined(__SSE2__)
#include <immintrin.h>
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

// A truth for each of eight lanes: a bit each where the processor compares into bits, else all or none of a
// lane's bits.
#if defined(__AVX512VL__) && defined(__AVX512DQ__)
using Lanes = std::uint8_t;
constexpr Lanes kAllLanes = 255, kNoLanes = 0;

inline Lanes greater(Float8 x, Float8 y) {
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
  return x > y;
}

/// Bit k: lane k is true.
inline std::uint32_t bits(Lanes lanes) {
#if defined(__AVX__)
  return static_cast<std::uint32_t>(_mm256_movemask_ps(reinterpret_cast<__m256>(lanes)));
#elif defined(__SSE2__)
  const auto* half = reinterpret_cast<const __m128*>(&lanes);
  return static_cast<std::uint32_t>(_mm_movemask_ps(half[0]) | _mm_movemask_ps(half[1]) << 4);
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
/// x where `which`, else y.
inline Lanes select(Lanes which, Lanes x, Lanes y) {
  return static_cast<Lanes>((x & which) | (y & ~which));
}

inline Float8 larger(Float8 x, Float8 y) {
  return select(greater(x, y), x, y);
}

inline Int8 bytes_to_int(const std::uint8_t* q) {
#if defined(__AVX2__)
  return reinterpret_cast<Int8>(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q))));
#elif defined(__SSE2__)
  const __m128i zero = _mm_setzero_si128();
  const __m128i words = _mm_unpacklo_epi8(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q)), zero);
  union {
    __m128i half[2];
    Int8 all;
  } u;
  u.half[0] = _mm_unpacklo_epi16(words, zero);
  u.half[1] = _mm_unpackhi_epi16(words, zero);
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

/// The box of a node in its own frame, query units.
struct Whole {
  float centre[3], half[3];
};

inline Whole whole_of(const TreeNode& n, float ratio) {
  Whole w;
  for (int i = 0; i < 3; ++i) {
    w.half[i] = n.scale[i] * ratio * 127.5f;
    w.centre[i] = n.base[i] * ratio + w.half[i];
  }
  return w;
}

/// The boxes of what a node holds, in its own frame, query units.
struct Boxes {
  Float8 centre[3], half[3];
};

inline Boxes decode(const TreeNode& n, float ratio) {
  Boxes b;
  for (int i = 0; i < 3; ++i) {
    const float base = n.base[i] * ratio, half_scale = n.scale[i] * ratio * 0.5f;
    const Int8 lo = bytes_to_int(n.lo[i]), hi = bytes_to_int(n.hi[i]);
    b.centre[i] = splat(base) + splat(half_scale) * __builtin_convertvector(lo + hi, Float8);
    b.half[i] = splat(half_scale) * __builtin_convertvector(hi - lo, Float8);
  }
  return b;
}

/// How two nodes lie to each other: coordinates in A's node = r * (coordinates in B's node) + t, and back
/// r^T * (coordinates in A's node) + back. The fourth of each four is nothing.
struct Between {
  alignas(16) float r[3][4], abs_r[3][4], t[4], back[4];
  float reach;  ///< bound of every coordinate difference that occurs
  float error;  ///< bound of the error of every transformed coordinate
  float grow;   ///< of boxes: the error, and the margin
};

/// Row i of a node's frame; the fourth is what follows it in the node.
inline Float4 frame_row(const TreeNode& n, int i) {
  static_assert(__builtin_offsetof(TreeNode, base) == sizeof(n.frame));
  Float4 row;
  __builtin_memcpy(&row, reinterpret_cast<const char*>(&n) + static_cast<unsigned>(i) * 3 * sizeof(float),
                   sizeof row);
  return row;
}

struct Columns {
  Float4 c[3];
};

inline Columns columns_of(Float4 row0, Float4 row1, Float4 row2) {
  const Float4 low = __builtin_shufflevector(row0, row1, 0, 4, 1, 5);
  const Float4 high = __builtin_shufflevector(row0, row1, 2, 6, 2, 6);
  return {{__builtin_shufflevector(low, row2, 0, 1, 4, 4), __builtin_shufflevector(low, row2, 2, 3, 5, 5),
           __builtin_shufflevector(high, row2, 0, 1, 6, 6)}};
}

/// x[0] of column 0 + x[1] of column 1 + x[2] of column 2.
inline Float4 combine(const float* x, const Float4* column) {
  return splat4(x[0]) * column[0] + splat4(x[1]) * column[1] + splat4(x[2]) * column[2];
}

/// kMargin: whether k.margin counts. Simplices that come to meet at a point after a motion have points now
/// that are no further apart than it is long: boxes and planes that are, part them.
template <bool kMargin = false>
inline Between between(const TreeKernel& k, const TreeNode& a, const TreeNode& b) {
  Between w;
  const Double4* m = reinterpret_cast<const Double4*>(k.m);
  const Double4 origin_a{a.origin[0], a.origin[1], a.origin[2], 0};
  const Double4 d =
      (((m[0] * splat4d(b.origin[0]) + m[1] * splat4d(b.origin[1])) + m[2] * splat4d(b.origin[2])) *
           splat4d(k.ratio_b) +
       *reinterpret_cast<const Double4*>(k.t)) -
      origin_a * splat4d(k.ratio_a);
  const Float4 offset = __builtin_convertvector(d, Float4);
  const float df[3] = {offset[0], offset[1], offset[2]};
  const Columns b_columns = columns_of(frame_row(b, 0), frame_row(b, 1), frame_row(b, 2));
  const Columns a_columns = columns_of(frame_row(a, 0), frame_row(a, 1), frame_row(a, 2));
  Float4 mb[3], r[3];  // rows of m * (axes of B), and of r
  for (int i = 0; i < 3; ++i) mb[i] = combine(k.m_rows[i], b_columns.c);
  for (int i = 0; i < 3; ++i) {
    r[i] = combine(a.frame[i], mb);
    __builtin_memcpy(w.r[i], &r[i], sizeof r[i]);
    const Float4 size = abs4(r[i]);
    __builtin_memcpy(w.abs_r[i], &size, sizeof size);
  }
  const Float4 t = combine(df, a_columns.c);
  __builtin_memcpy(w.t, &t, sizeof t);
  const float t_parts[3] = {t[0], t[1], t[2]};
  const Float4 back = -combine(t_parts, r);
  __builtin_memcpy(w.back, &back, sizeof back);
  w.reach = k.m_size * (a.radius * k.ratio_a + b.radius * k.ratio_b + __builtin_fabsf(df[0]) +
                        __builtin_fabsf(df[1]) + __builtin_fabsf(df[2]));
  w.error = k.slack + kKernelRounding * w.reach;
  w.grow = kMargin ? w.error + k.margin : w.error;
  return w;
}

/// Boxes of one node in the other's frame: axis-aligned there, grown by the error.
struct Turned {
  Float8 centre[3], half[3];
};

inline Turned turn_b(const Boxes& b, const Between& w) {
  Turned o;
  for (int i = 0; i < 3; ++i) {
    o.centre[i] = splat(w.t[i]) + splat(w.r[i][0]) * b.centre[0] + splat(w.r[i][1]) * b.centre[1] +
                  splat(w.r[i][2]) * b.centre[2];
    o.half[i] = splat(w.grow) + splat(w.abs_r[i][0]) * b.half[0] + splat(w.abs_r[i][1]) * b.half[1] +
                splat(w.abs_r[i][2]) * b.half[2];
  }
  return o;
}

inline Turned turn_a(const Boxes& a, const Between& w) {
  Turned o;
  for (int j = 0; j < 3; ++j) {
    o.centre[j] = splat(w.back[j]) + splat(w.r[0][j]) * a.centre[0] + splat(w.r[1][j]) * a.centre[1] +
                  splat(w.r[2][j]) * a.centre[2];
    o.half[j] = splat(w.grow) + splat(w.abs_r[0][j]) * a.half[0] + splat(w.abs_r[1][j]) * a.half[1] +
                splat(w.abs_r[2][j]) * a.half[2];
  }
  return o;
}

/// Lanes whose boxes are apart on some axis. Written so that NaN (an overflow) counts as "not apart".
inline Lanes apart(const Float8* centre, const Float8* half, const float* other_centre,
                   const float* other_half) {
  Lanes result = kNoLanes;
  for (int i = 0; i < 3; ++i)
    result |= greater(abs8(centre[i] - splat(other_centre[i])), half[i] + splat(other_half[i]));
  return result;
}

inline std::uint32_t present(const TreeNode& n) {
  return (1u << n.count) - 1;
}

/// How far boxes are apart on the axis on which they are furthest apart; negative: by how much they overlap.
inline Float8 gap_between(const Float8* centre, const Float8* half, const float* other_centre,
                          const float* other_half) {
  Float8 gap = abs8(centre[0] - splat(other_centre[0])) - (half[0] + splat(other_half[0]));
  for (int i = 1; i < 3; ++i)
    gap = larger(gap, abs8(centre[i] - splat(other_centre[i])) - (half[i] + splat(other_half[i])));
  return gap;
}

/// Of pairs of boxes: how far apart (see gap_between()) box i of A is from those of B.
struct Gaps {
  Float8 of[8];
};

/// Which of A's boxes meet which of B's: mask[k] has the bits of B's boxes that A's box k may meet. Most
/// pairs of nodes are apart, and most of these show it in the first test.
inline std::uint32_t pair_masks(TreeKernel& k, const TreeNode& na, const TreeNode& nb, const Between& w,
                                std::uint32_t mask[8], Gaps* gaps = nullptr) {
  k.box_tests += na.count + nb.count;
  const Whole whole_a = whole_of(na, k.ratio_a);
  const Boxes b = decode(nb, k.ratio_b);
  const Turned bt = turn_b(b, w);
  const std::uint32_t mask_b = ~bits(apart(bt.centre, bt.half, whole_a.centre, whole_a.half)) & present(nb);
  if (mask_b == 0) return 0;
  const Whole whole_b = whole_of(nb, k.ratio_b);
  const Boxes a = decode(na, k.ratio_a);
  const Turned at = turn_a(a, w);
  const std::uint32_t mask_a = ~bits(apart(at.centre, at.half, whole_b.centre, whole_b.half)) & present(na);
  const auto* a_centre = reinterpret_cast<const float*>(a.centre);
  const auto* a_half = reinterpret_cast<const float*>(a.half);
  const auto* at_centre = reinterpret_cast<const float*>(at.centre);
  const auto* at_half = reinterpret_cast<const float*>(at.half);
  const auto in_mask_b = static_cast<unsigned>(__builtin_popcount(mask_b));
  std::uint32_t rows = 0;
  for (std::uint32_t todo = mask_a; todo != 0; todo &= todo - 1) {
    const int i = __builtin_ctz(todo);
    const float own_centre[3] = {a_centre[i], a_centre[8 + i], a_centre[16 + i]};
    const float own_half[3] = {a_half[i], a_half[8 + i], a_half[16 + i]};
    const float turned_centre[3] = {at_centre[i], at_centre[8 + i], at_centre[16 + i]};
    const float turned_half[3] = {at_half[i], at_half[8 + i], at_half[16 + i]};
    const Lanes gap = either(apart(bt.centre, bt.half, own_centre, own_half),
                             apart(b.centre, b.half, turned_centre, turned_half));
    mask[i] = ~bits(gap) & mask_b;
    rows |= static_cast<std::uint32_t>(mask[i] != 0) << i;
    k.box_tests += in_mask_b;
    if (gaps && mask[i] != 0)
      gaps->of[i] = larger(gap_between(bt.centre, bt.half, own_centre, own_half),
                           gap_between(b.centre, b.half, turned_centre, turned_half));
  }
  return rows;
}

/// All lines of a node.
inline void prefetch(const TreeNode& n) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < sizeof n; at += kLine)
    __builtin_prefetch(reinterpret_cast<const char*>(&n) + at);
}

inline void push(TreeKernel& k, std::uint32_t a, std::uint32_t b) {
  prefetch(k.nodes_a[a]);
  prefetch(k.nodes_b[b]);
  k.stack[k.stack_size++] = {a, b};
}

/// Sorts what was pushed last, the pair with the least gap last; of many only that one is moved.
inline void nearest_last(NodePair* pairs, float* gaps, std::uint32_t size) {
  constexpr std::uint32_t kFew = 8;
  if (size <= kFew) {
    for (std::uint32_t i = 1; i < size; ++i) {
      const NodePair pair = pairs[i];
      const float gap = gaps[i];
      std::uint32_t at = i;
      for (; at > 0 && gaps[at - 1] < gap; --at) {
        gaps[at] = gaps[at - 1];
        pairs[at] = pairs[at - 1];
      }
      gaps[at] = gap;
      pairs[at] = pair;
    }
    return;
  }
  std::uint32_t nearest = 0;
  for (std::uint32_t i = 1; i < size; ++i)
    if (gaps[i] < gaps[nearest]) nearest = i;
  const NodePair last = pairs[size - 1];
  pairs[size - 1] = pairs[nearest];
  pairs[nearest] = last;
}

/// Descends both nodes. kNearest: into the pair first whose boxes overlap most, for where one pair of
/// simplices is enough it is likely to be there.
template <bool kMargin, bool kNearest>
inline void descend_both(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  std::uint32_t mask[8];
  Gaps gaps;
  const std::uint32_t rows =
      pair_masks(k, na, nb, between<kMargin>(k, na, nb), mask, kNearest ? &gaps : nullptr);
  if (rows == 0) return;
  float gap_of[64];
  const std::uint32_t bottom = k.stack_size;
  for (std::uint32_t r = rows; r != 0; r &= r - 1) {
    const std::uint32_t i = static_cast<std::uint32_t>(__builtin_ctz(r));
    for (std::uint32_t c = mask[i]; c != 0; c &= c - 1) {
      const int j = __builtin_ctz(c);
      if constexpr (kNearest) gap_of[k.stack_size - bottom] = gaps.of[i][j];
      push(k, na.first + i, nb.first + static_cast<std::uint32_t>(j));
    }
  }
  if constexpr (kNearest) nearest_last(k.stack + bottom, gap_of, k.stack_size - bottom);
}

/// Descends A's node alone: its boxes against the whole box of B's, in both frames.
template <bool kMargin>
inline void descend_a(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t b_index) {
  const Boxes a = decode(na, k.ratio_a);
  const Whole b = whole_of(nb, k.ratio_b);
  const Between w = between<kMargin>(k, na, nb);
  const Turned at = turn_a(a, w);
  float centre[3], half[3];
  for (int i = 0; i < 3; ++i) {
    centre[i] = w.t[i] + w.r[i][0] * b.centre[0] + w.r[i][1] * b.centre[1] + w.r[i][2] * b.centre[2];
    half[i] = w.grow + w.abs_r[i][0] * b.half[0] + w.abs_r[i][1] * b.half[1] + w.abs_r[i][2] * b.half[2];
  }
  const Lanes gap =
      either(apart(at.centre, at.half, b.centre, b.half), apart(a.centre, a.half, centre, half));
  k.box_tests += na.count;
  for (std::uint32_t c = ~bits(gap) & present(na); c != 0; c &= c - 1)
    push(k, na.first + static_cast<std::uint32_t>(__builtin_ctz(c)), b_index);
}

/// Descends B's node alone.
template <bool kMargin>
inline void descend_b(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t a_index) {
  const Whole a = whole_of(na, k.ratio_a);
  const Boxes b = decode(nb, k.ratio_b);
  const Between w = between<kMargin>(k, na, nb);
  const Turned bt = turn_b(b, w);
  float centre[3], half[3];
  for (int j = 0; j < 3; ++j) {
    centre[j] = w.back[j] + w.r[0][j] * a.centre[0] + w.r[1][j] * a.centre[1] + w.r[2][j] * a.centre[2];
    half[j] = w.grow + w.abs_r[0][j] * a.half[0] + w.abs_r[1][j] * a.half[1] + w.abs_r[2][j] * a.half[2];
  }
  const Lanes gap =
      either(apart(bt.centre, bt.half, a.centre, a.half), apart(b.centre, b.half, centre, half));
  k.box_tests += nb.count;
  for (std::uint32_t c = ~bits(gap) & present(nb); c != 0; c &= c - 1)
    push(k, a_index, nb.first + static_cast<std::uint32_t>(__builtin_ctz(c)));
}

/// Corners of eight simplices in A's leaf frame, query units.
struct Corners {
  Float8 x[3][3];  // [corner][axis]
};

/// What float arithmetic makes of (u x v) . d, lane by lane, and a bound of its error.
///
/// Every corner is off by at most `error` in each coordinate, so an edge by 2 error, and the normal n = u x v
/// of two edges by at most 4 error (E + 2 error) in each component, where E = max|u| + max|v|. A difference d
/// of two corners is at most reach, and off by 2 error, so that n . d is off by at most 2 error |n|_1 + 12
/// error (E + 2 error) (reach + 2 error). Rounding in float is below 10 u E^2 reach, u = 2^-24, for which
/// there is room in the second term: error holds kKernelRounding reach = 64 u reach, of which less than 48 u
/// can occur, and E <= 4 reach.
struct Normal {
  Float8 n[3], size, bound;

  Normal(const Float8* u, const Float8* v, float reach, float error) {
    Float8 u_max{}, v_max{};
    for (int axis = 0; axis < 3; ++axis) {
      u_max = larger(abs8(u[axis]), u_max);
      v_max = larger(abs8(v[axis]), v_max);
    }
    for (int x = 0; x < 3; ++x) {
      const int y = (x + 1) % 3, z = (x + 2) % 3;
      n[x] = u[y] * v[z] - u[z] * v[y];
    }
    size = abs8(n[0]) + abs8(n[1]) + abs8(n[2]);
    bound = splat(2 * error) * size +
            splat(12 * error) * (u_max + v_max + splat(2 * error)) * splat(reach + 2 * error) +
            splat(kKernelTiny);
  }

  Float8 dot(const Float8* d) const { return n[0] * d[0] + n[1] * d[1] + n[2] * d[2]; }
};

inline void subtract(const Float8* x, const Float8* y, Float8* difference) {
  for (int axis = 0; axis < 3; ++axis) difference[axis] = x[axis] - y[axis];
}

/// On which side of other simplices' planes the corners of eight simplices lie, lane by lane.
struct SideLanes {
  Lanes positive[3], negative[3];  ///< certainly in front, or behind, by more than the margin
  Lanes certain;                   ///< each corner certainly in front or behind
  Lanes parted;                    ///< all in front, or all behind

  /// Not certainly on both sides.
  Lanes one_side() const {
    return static_cast<Lanes>(
        ~((positive[0] | positive[1] | positive[2]) & (negative[0] | negative[1] | negative[2])));
  }
};

inline SideLanes sides_of_planes(const Corners& planes, const Corners& points, float reach, float error,
                                 float margin) {
  Float8 e1[3], e2[3];
  subtract(planes.x[1], planes.x[0], e1);
  subtract(planes.x[2], planes.x[0], e2);
  const Normal n(e1, e2, reach, error);
  // The size is more than the normal's length; without a margin it vanishes.
  const Float8 bound = n.bound + splat(margin) * n.size;
  SideLanes sides;
  Lanes above = kAllLanes, below = kAllLanes;
  sides.certain = kAllLanes;
  for (int corner = 0; corner < 3; ++corner) {
    Float8 d[3];
    subtract(points.x[corner], planes.x[0], d);
    const Float8 height = n.dot(d);
    sides.positive[corner] = greater(height, bound);
    sides.negative[corner] = greater(-bound, height);
    above &= sides.positive[corner];
    below &= sides.negative[corner];
    sides.certain = both(sides.certain, either(sides.positive[corner], sides.negative[corner]));
  }
  sides.parted = either(above, below);
  return sides;
}

/// Triangles turned so that corner 0, the tip, is alone on its side of the other's plane.
struct TipFirst {
  Corners t;
  Lanes positive;  ///< the tip's side

  TipFirst(const Corners& from, const SideLanes& s) {
    const Lanes first = equal(s.positive[1], s.positive[2]), second = equal(s.positive[0], s.positive[2]);
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        t.x[corner][axis] =
            select(first, from.x[corner][axis],
                   select(second, from.x[(corner + 1) % 3][axis], from.x[(corner + 2) % 3][axis]));
    positive = select(first, s.positive[0], select(second, s.positive[1], s.positive[2]));
  }
};

/// What is certain of pairs of triangles, lane by lane.
struct Verdict {
  Lanes cross, disjoint;
};

/// Of triangles each of which has corners certainly on both sides of the other's plane: do they overlap on
/// the line in which the planes cross? As engine/exact/planes_cross.hpp decides it, whose orient3d(tip of a,
/// end of a, tip of b, end of b) is -(edge of a x edge of b) . (tip of b - tip of a). A sign that is certain
/// here is that of the world coordinates: a world point, seen in the leaf's frame, is an affine image, which
/// may be mirrored but keeps what meets what, and every corner is within `error` of its own.
inline Verdict overlap(const Corners& a, const SideLanes& a_sides, const Corners& b, const SideLanes& b_sides,
                       float reach, float error) {
  const TipFirst ta(a, a_sides), tb(b, b_sides);
  const Lanes alike = equal(ta.positive, tb.positive);
  Float8 between_tips[3], ua[2][3], ub[2][3];
  subtract(tb.t.x[0], ta.t.x[0], between_tips);
  for (int end = 0; end < 2; ++end) subtract(ta.t.x[1 + end], ta.t.x[0], ua[end]);
  for (int end = 0; end < 2; ++end)
    for (int axis = 0; axis < 3; ++axis)
      ub[end][axis] = select(alike, tb.t.x[1 + end][axis], tb.t.x[2 - end][axis]) - tb.t.x[0][axis];
  Lanes low[2], high[2];
  for (int end = 0; end < 2; ++end) {
    const Normal n(ua[end], ub[end], reach, error);
    const Float8 value = n.dot(between_tips);
    low[end] = greater(-n.bound, value);
    high[end] = greater(value, n.bound);
  }
  const Lanes certain = both(a_sides.certain, b_sides.certain);
  return {both(certain, select(tb.positive, both(high[0], low[1]), both(low[0], high[1]))),
          both(certain, select(tb.positive, either(low[0], high[1]), either(high[0], low[1])))};
}

/// What is certain of eight pairs of triangles; a bit for each.
struct EightCertainties {
  std::uint32_t cross = 0, disjoint = 0, uncertain = 0;
  std::uint32_t one_side[2] = {};   ///< of A's and B's: corners that are certain lie on one side
  std::uint32_t unsure[2][3] = {};  ///< [A's, B's][corner]: may lie in the other's plane

  void tell(int lane, Candidate& c) const {
    const auto is = [lane](std::uint32_t lanes) { return (lanes >> lane & 1) != 0; };
    if (is(cross)) c.certainty = Certainty::cross;
    if (is(disjoint)) c.certainty = Certainty::disjoint;
    if (!is(uncertain)) return;
    // A triangle whose other corners are on one side of a plane meets it in the hull of those that may lie in
    // it: if they are corners of the other triangle, that hull is an edge or a corner of it, or all of it.
    for (int of = 0; of < 2; ++of) {
      if (!is(one_side[of])) continue;
      c.certainty = Certainty::touch_if_shared;
      c.side = static_cast<Side>(of);
      for (int corner = 0; corner < 3; ++corner)
        c.corners |= static_cast<std::uint8_t>(is(unsure[of][corner]) << corner);
      return;
    }
  }
};

inline EightCertainties certainties_of(const Corners& a, const SideLanes& a_sides, const Corners& b,
                                       const SideLanes& b_sides, const Between& w, std::uint32_t which) {
  EightCertainties c;
  const std::uint32_t certain = bits(both(a_sides.certain, b_sides.certain)) & which;
  if (certain != 0) {
    const Verdict v = overlap(a, a_sides, b, b_sides, w.reach, w.error);
    c.cross = bits(v.cross);
    c.disjoint = bits(v.disjoint);
  }
  if (certain == which) return c;
  c.uncertain = which & ~certain;
  const SideLanes* const sides[2] = {&a_sides, &b_sides};
  for (int of = 0; of < 2; ++of) {
    c.one_side[of] = bits(sides[of]->one_side()) & ~bits(sides[of]->certain);
    for (int corner = 0; corner < 3; ++corner)
      c.unsure[of][corner] = ~bits(either(sides[of]->positive[corner], sides[of]->negative[corner]));
  }
  return c;
}

/// Simplices of a block, lane by lane: lane k gets number which[k].
inline Corners pick(const Corners& from, const std::uint8_t* which) {
  Corners to;
#if defined(__AVX2__)
  const __m256i lanes = _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(which)));
  for (int corner = 0; corner < 3; ++corner)
    for (int axis = 0; axis < 3; ++axis)
      to.x[corner][axis] = reinterpret_cast<Float8>(
          _mm256_permutevar8x32_ps(reinterpret_cast<__m256>(from.x[corner][axis]), lanes));
#else
  for (int corner = 0; corner < 3; ++corner)
    for (int axis = 0; axis < 3; ++axis) {
      const auto* own = reinterpret_cast<const float*>(&from.x[corner][axis]);
      for (int lane = 0; lane < 8; ++lane) to.x[corner][axis][lane] = own[which[lane]];
    }
#endif
  return to;
}

/// Pairs of simplices of two blocks, by their numbers there. Room for eight at a time beyond the last.
struct PairList {
  std::uint8_t a[72], b[72];
  std::uint32_t size = 0;
};

inline void list_pairs(std::uint32_t rows, const std::uint32_t mask[8], PairList& list) {
  for (; rows != 0; rows &= rows - 1) {
    const int i = __builtin_ctz(rows);
    for (std::uint32_t c = mask[i]; c != 0; c &= c - 1) {
      list.a[list.size] = static_cast<std::uint8_t>(i);
      list.b[list.size++] = static_cast<std::uint8_t>(__builtin_ctz(c));
    }
  }
  __builtin_memset(list.a + list.size, 0, 8);
  __builtin_memset(list.b + list.size, 0, 8);
}

template <bool kMargin>
inline void leaf_pair(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  const Between w = between<kMargin>(k, na, nb);
  std::uint32_t mask[8];
  const std::uint32_t rows = pair_masks(k, na, nb, w, mask);
  if (rows == 0) return;
  const LeafBlock& block_a = k.blocks_a[na.first];
  const LeafBlock& block_b = k.blocks_b[nb.first];
  PairList list;
  list_pairs(rows, mask, list);
  k.prefilter_tests += list.size;
  Corners a, b;
  for (int corner = 0; corner < 3; ++corner) {
    Float8 own[3];
    for (int axis = 0; axis < 3; ++axis) {
      a.x[corner][axis] = load8(block_a.corner[corner][axis]) * splat(k.ratio_a);
      own[axis] = load8(block_b.corner[corner][axis]) * splat(k.ratio_b);
    }
    for (int i = 0; i < 3; ++i)
      b.x[corner][i] =
          splat(w.t[i]) + splat(w.r[i][0]) * own[0] + splat(w.r[i][1]) * own[1] + splat(w.r[i][2]) * own[2];
  }
  const float margin = kMargin ? k.margin : 0;
  for (std::uint32_t begin = 0; begin < list.size; begin += 8) {
    const Corners some_a = pick(a, list.a + begin), some_b = pick(b, list.b + begin);
    const SideLanes b_sides = sides_of_planes(some_a, some_b, w.reach, w.error, margin);
    const SideLanes a_sides = sides_of_planes(some_b, some_a, w.reach, w.error, margin);
    const std::uint32_t here = list.size - begin < 8 ? (1u << (list.size - begin)) - 1 : 255u;
    const std::uint32_t left = ~bits(either(a_sides.parted, b_sides.parted)) & here;
    if (left == 0) continue;
    EightCertainties certainties;
    if constexpr (!kMargin) certainties = certainties_of(some_a, a_sides, some_b, b_sides, w, left);
    for (std::uint32_t c = left; c != 0; c &= c - 1) {
      const int lane = __builtin_ctz(c);
      const std::uint32_t pair = begin + static_cast<std::uint32_t>(lane);
      Candidate& found = k.out[k.out_size++];
      found = {block_a.simplex[list.a[pair]], block_b.simplex[list.b[pair]], Certainty::none, Side::a, 0};
      if constexpr (!kMargin) certainties.tell(lane, found);
    }
  }
}

/// A node so many times as large as the other is descended alone: all that the other holds would meet the
/// same few of its boxes.
constexpr float kMuchLarger = 3;

template <bool kMargin, bool kNearest>
void run(TreeKernel& k) {
  while (k.stack_size != 0 && k.out_capacity - k.out_size >= 64) {
    const NodePair p = k.stack[--k.stack_size];
    const TreeNode& a = k.nodes_a[p.a];
    const TreeNode& b = k.nodes_b[p.b];
    ++k.node_pairs;
    const float size_a = a.radius * k.ratio_a, size_b = b.radius * k.ratio_b;
    const bool hold_a = a.is_leaf || size_b > kMuchLarger * size_a;
    const bool hold_b = b.is_leaf || size_a > kMuchLarger * size_b;
    if (a.is_leaf && b.is_leaf)
      leaf_pair<kMargin>(k, a, b);
    else if (!a.is_leaf && hold_b)
      descend_a<kMargin>(k, a, b, p.b);
    else if (!b.is_leaf && hold_a)
      descend_b<kMargin>(k, a, b, p.a);
    else
      descend_both<kMargin, kNearest>(k, a, b);
  }
}

}  // namespace

void LRB_KERNEL_NAME(TreeKernel& k) {
  if (k.margin > 0)
    run<true, false>(k);
  else
    k.nearest_first ? run<false, true>(k) : run<false, false>(k);
}

}  // namespace lrb
