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

inline Float8 splat(float x) {
  return Float8{x, x, x, x, x, x, x, x};
}

inline Float8 abs8(Float8 x) {
  const Int8 mask = Int8{} + 0x7fffffff;
  return reinterpret_cast<Float8>(reinterpret_cast<Int8>(x) & mask);
}

/// Bit k: lane k is true (all ones).
inline std::uint32_t bits(Int8 lanes) {
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

inline Float8 bytes_to_float(const std::uint8_t* q) {
#if defined(__AVX2__)
  return reinterpret_cast<Float8>(
      _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q)))));
#elif defined(__SSE2__)
  const __m128i zero = _mm_setzero_si128();
  const __m128i words = _mm_unpacklo_epi8(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(q)), zero);
  union {
    __m128 half[2];
    Float8 all;
  } u;
  u.half[0] = _mm_cvtepi32_ps(_mm_unpacklo_epi16(words, zero));
  u.half[1] = _mm_cvtepi32_ps(_mm_unpackhi_epi16(words, zero));
  return u.all;
#else
  Float8 x;
  for (int k = 0; k < 8; ++k) x[k] = static_cast<float>(q[k]);
  return x;
#endif
}

inline Float8 load8(const float* x) {
  return *reinterpret_cast<const Float8*>(x);
}

/// The boxes of a node in its own frame, query units: centres and half sizes, and the box around them all.
struct Boxes {
  Float8 centre[3], half[3];
  float whole_centre[3], whole_half[3];
};

inline Boxes decode(const TreeNode& n, float ratio) {
  Boxes b;
  for (int i = 0; i < 3; ++i) {
    const float base = n.base[i] * ratio, scale = n.scale[i] * ratio;
    const Float8 lo = splat(base) + splat(scale) * bytes_to_float(n.lo[i]);
    const Float8 hi = splat(base) + splat(scale) * bytes_to_float(n.hi[i]);
    b.centre[i] = (lo + hi) * splat(0.5f);
    b.half[i] = (hi - lo) * splat(0.5f);
    b.whole_half[i] = scale * 127.5f;
    b.whole_centre[i] = base + b.whole_half[i];
  }
  return b;
}

/// How two nodes lie to each other: coordinates in A's node = r * (coordinates in B's node) + t, and back
/// r^T * (coordinates in A's node) + back.
struct Between {
  float r[3][3], abs_r[3][3], t[3], back[3];
  float reach;  ///< bound of every coordinate difference that occurs
  float error;  ///< bound of the error of every transformed coordinate
  float grow;   ///< of boxes: the error, and the margin
};

/// kMargin: whether k.margin counts. Simplices that come to meet at a point after a motion have points now
/// that are no further apart than it is long: boxes and planes that are, part them.
template <bool kMargin = false>
inline Between between(const TreeKernel& k, const TreeNode& a, const TreeNode& b) {
  Between w;
  double d[3];
  for (int i = 0; i < 3; ++i)
    d[i] = (((k.m[i][0] * b.origin[0] + k.m[i][1] * b.origin[1]) + k.m[i][2] * b.origin[2]) * k.ratio_b +
            k.t[i]) -
           a.origin[i] * k.ratio_a;
  const float df[3] = {static_cast<float>(d[0]), static_cast<float>(d[1]), static_cast<float>(d[2])};
  float mb[3][3];  // m * (axes of B)
  for (int i = 0; i < 3; ++i) {
    const float m0 = static_cast<float>(k.m[i][0]), m1 = static_cast<float>(k.m[i][1]),
                m2 = static_cast<float>(k.m[i][2]);
    for (int j = 0; j < 3; ++j) mb[i][j] = m0 * b.frame[j][0] + m1 * b.frame[j][1] + m2 * b.frame[j][2];
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      w.r[i][j] = a.frame[i][0] * mb[0][j] + a.frame[i][1] * mb[1][j] + a.frame[i][2] * mb[2][j];
      w.abs_r[i][j] = __builtin_fabsf(w.r[i][j]);
    }
    w.t[i] = a.frame[i][0] * df[0] + a.frame[i][1] * df[1] + a.frame[i][2] * df[2];
  }
  for (int j = 0; j < 3; ++j) w.back[j] = -(w.r[0][j] * w.t[0] + w.r[1][j] * w.t[1] + w.r[2][j] * w.t[2]);
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
inline Int8 apart(const Float8* centre, const Float8* half, const float* other_centre,
                  const float* other_half) {
  Int8 result{};
  for (int i = 0; i < 3; ++i)
    result |= abs8(centre[i] - splat(other_centre[i])) > half[i] + splat(other_half[i]);
  return result;
}

inline std::uint32_t present(const TreeNode& n) {
  return (1u << n.count) - 1;
}

/// Which of A's boxes meet which of B's: mask[k] has the bits of B's boxes that A's box k may meet.
inline std::uint32_t pair_masks(TreeKernel& k, const TreeNode& na, const TreeNode& nb, const Boxes& a,
                                const Boxes& b, const Between& w, std::uint32_t mask[8]) {
  const Turned bt = turn_b(b, w), at = turn_a(a, w);
  const std::uint32_t mask_b = ~bits(apart(bt.centre, bt.half, a.whole_centre, a.whole_half)) & present(nb);
  const std::uint32_t mask_a = ~bits(apart(at.centre, at.half, b.whole_centre, b.whole_half)) & present(na);
  k.box_tests += na.count + nb.count;
  if (mask_a == 0 || mask_b == 0) return 0;
  const auto* a_centre = reinterpret_cast<const float*>(a.centre);
  const auto* a_half = reinterpret_cast<const float*>(a.half);
  const auto* at_centre = reinterpret_cast<const float*>(at.centre);
  const auto* at_half = reinterpret_cast<const float*>(at.half);
  std::uint32_t rows = 0;
  for (std::uint32_t todo = mask_a; todo != 0; todo &= todo - 1) {
    const int i = __builtin_ctz(todo);
    const float own_centre[3] = {a_centre[i], a_centre[8 + i], a_centre[16 + i]};
    const float own_half[3] = {a_half[i], a_half[8 + i], a_half[16 + i]};
    const float turned_centre[3] = {at_centre[i], at_centre[8 + i], at_centre[16 + i]};
    const float turned_half[3] = {at_half[i], at_half[8 + i], at_half[16 + i]};
    const Int8 gap =
        apart(bt.centre, bt.half, own_centre, own_half) | apart(b.centre, b.half, turned_centre, turned_half);
    mask[i] = ~bits(gap) & mask_b;
    rows |= static_cast<std::uint32_t>(mask[i] != 0) << i;
    k.box_tests += static_cast<unsigned>(__builtin_popcount(mask_b));
  }
  return rows;
}

inline void push(TreeKernel& k, std::uint32_t a, std::uint32_t b) {
  __builtin_prefetch(&k.nodes_a[a]);
  __builtin_prefetch(&k.nodes_b[b]);
  k.stack[k.stack_size++] = {a, b};
}

/// Both inner: descend both.
template <bool kMargin>
inline void inner_pair(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  std::uint32_t mask[8];
  const std::uint32_t rows =
      pair_masks(k, na, nb, decode(na, k.ratio_a), decode(nb, k.ratio_b), between<kMargin>(k, na, nb), mask);
  for (std::uint32_t r = rows; r != 0; r &= r - 1) {
    const std::uint32_t i = static_cast<std::uint32_t>(__builtin_ctz(r));
    for (std::uint32_t c = mask[i]; c != 0; c &= c - 1)
      push(k, na.first + i, nb.first + static_cast<std::uint32_t>(__builtin_ctz(c)));
  }
}

/// One inner (its boxes against the leaf's whole box), in both frames.
template <bool kMargin>
inline void inner_a_leaf_b(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t b_index) {
  const Boxes a = decode(na, k.ratio_a), b = decode(nb, k.ratio_b);
  const Between w = between<kMargin>(k, na, nb);
  const Turned at = turn_a(a, w);
  float centre[3], half[3];
  for (int i = 0; i < 3; ++i) {
    centre[i] = w.t[i] + w.r[i][0] * b.whole_centre[0] + w.r[i][1] * b.whole_centre[1] +
                w.r[i][2] * b.whole_centre[2];
    half[i] = w.grow + w.abs_r[i][0] * b.whole_half[0] + w.abs_r[i][1] * b.whole_half[1] +
              w.abs_r[i][2] * b.whole_half[2];
  }
  const Int8 gap =
      apart(at.centre, at.half, b.whole_centre, b.whole_half) | apart(a.centre, a.half, centre, half);
  k.box_tests += na.count;
  for (std::uint32_t c = ~bits(gap) & present(na); c != 0; c &= c - 1)
    push(k, na.first + static_cast<std::uint32_t>(__builtin_ctz(c)), b_index);
}

template <bool kMargin>
inline void leaf_a_inner_b(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t a_index) {
  const Boxes a = decode(na, k.ratio_a), b = decode(nb, k.ratio_b);
  const Between w = between<kMargin>(k, na, nb);
  const Turned bt = turn_b(b, w);
  float centre[3], half[3];
  for (int j = 0; j < 3; ++j) {
    centre[j] = w.back[j] + w.r[0][j] * a.whole_centre[0] + w.r[1][j] * a.whole_centre[1] +
                w.r[2][j] * a.whole_centre[2];
    half[j] = w.grow + w.abs_r[0][j] * a.whole_half[0] + w.abs_r[1][j] * a.whole_half[1] +
              w.abs_r[2][j] * a.whole_half[2];
  }
  const Int8 gap =
      apart(bt.centre, bt.half, a.whole_centre, a.whole_half) | apart(b.centre, b.half, centre, half);
  k.box_tests += nb.count;
  for (std::uint32_t c = ~bits(gap) & present(nb); c != 0; c &= c - 1)
    push(k, a_index, nb.first + static_cast<std::uint32_t>(__builtin_ctz(c)));
}

/// Corners of eight simplices in A's leaf frame, query units.
struct Corners {
  Float8 x[3][3];  // [corner][axis]
};

/// Which of eight simplices lie strictly on one side of the plane of simplex i of `planes`.
///
/// Every corner is off by at most `error` in each coordinate, so an edge by 2 error, and the normal n = e1 x
/// e2 by at most 4 error (E + 2 error) in each component, where E = max|e1| + max|e2|. A difference p - v0 is
/// at most reach, and off by 2 error, so that n . (p - v0) is off by at most 2 error |n|_1 + 12 error (E + 2
/// error) (reach + 2 error). Rounding in float is below 10 u E^2 reach, u = 2^-24, for which there is room in
/// the second term: error holds kKernelRounding reach = 64 u reach, of which less than 48 u can occur, and E
/// <= 4 reach.
inline std::uint32_t on_one_side(const Corners& planes, int i, const Corners& points, float reach,
                                 float error, float margin = 0) {
  float v0[3], e1[3], e2[3];
  float e1_max = 0, e2_max = 0;
  for (int axis = 0; axis < 3; ++axis) {
    v0[axis] = planes.x[0][axis][i];
    e1[axis] = planes.x[1][axis][i] - v0[axis];
    e2[axis] = planes.x[2][axis][i] - v0[axis];
    e1_max = __builtin_fabsf(e1[axis]) > e1_max ? __builtin_fabsf(e1[axis]) : e1_max;
    e2_max = __builtin_fabsf(e2[axis]) > e2_max ? __builtin_fabsf(e2[axis]) : e2_max;
  }
  const float n[3] = {e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2],
                      e1[0] * e2[1] - e1[1] * e2[0]};
  const float n_size = __builtin_fabsf(n[0]) + __builtin_fabsf(n[1]) + __builtin_fabsf(n[2]);
  const float rounding =
      2 * error * n_size + 12 * error * (e1_max + e2_max + 2 * error) * (reach + 2 * error) + kKernelTiny;
  const float bound =
      rounding + margin * n_size;  // which is more than n's length; without margin it vanishes
  Int8 above = Int8{} - 1, below = Int8{} - 1;
  for (int corner = 0; corner < 3; ++corner) {
    const Float8 height = splat(n[0]) * (points.x[corner][0] - splat(v0[0])) +
                          splat(n[1]) * (points.x[corner][1] - splat(v0[1])) +
                          splat(n[2]) * (points.x[corner][2] - splat(v0[2]));
    above &= height > splat(bound);
    below &= height < splat(-bound);
  }
  return bits(above | below);
}

template <bool kMargin>
inline void leaf_pair(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  const Between w = between<kMargin>(k, na, nb);
  std::uint32_t mask[8];
  std::uint32_t rows = pair_masks(k, na, nb, decode(na, k.ratio_a), decode(nb, k.ratio_b), w, mask);
  if (rows == 0) return;
  const LeafBlock& block_a = k.blocks_a[na.first];
  const LeafBlock& block_b = k.blocks_b[nb.first];
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
  std::uint32_t columns = 0;
  for (std::uint32_t r = rows; r != 0; r &= r - 1) {
    const int i = __builtin_ctz(r);
    k.prefilter_tests += static_cast<unsigned>(__builtin_popcount(mask[i]));
    mask[i] &= ~on_one_side(a, i, b, w.reach, w.error, kMargin ? k.margin : 0);
    columns |= mask[i];
  }
  std::uint32_t apart_rows[8] = {};
  for (std::uint32_t c = columns; c != 0; c &= c - 1) {
    const int j = __builtin_ctz(c);
    const std::uint32_t off = on_one_side(b, j, a, w.reach, w.error, kMargin ? k.margin : 0);
    for (int i = 0; i < 8; ++i) apart_rows[i] |= (off >> i & 1u) << j;
  }
  for (; rows != 0; rows &= rows - 1) {
    const int i = __builtin_ctz(rows);
    for (std::uint32_t c = mask[i] & ~apart_rows[i]; c != 0; c &= c - 1)
      k.out[k.out_size++] = {block_a.simplex[i], block_b.simplex[__builtin_ctz(c)]};
  }
}

template <bool kMargin>
void run(TreeKernel& k) {
  while (k.stack_size != 0 && k.out_capacity - k.out_size >= 64) {
    const NodePair p = k.stack[--k.stack_size];
    const TreeNode& a = k.nodes_a[p.a];
    const TreeNode& b = k.nodes_b[p.b];
    ++k.node_pairs;
    if (a.is_leaf)
      b.is_leaf ? leaf_pair<kMargin>(k, a, b) : leaf_a_inner_b<kMargin>(k, a, b, p.a);
    else
      b.is_leaf ? inner_a_leaf_b<kMargin>(k, a, b, p.b) : inner_pair<kMargin>(k, a, b);
  }
}

}  // namespace

void LRB_KERNEL_NAME(TreeKernel& k) {
  k.margin > 0 ? run<true>(k) : run<false>(k);
}

}  // namespace lrb
