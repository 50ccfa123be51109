// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_NEAR_KERNEL_NAME. See
// tree_kernel.inl.
//
// The traversal for near pairs: finds the pairs of simplices that may be at most TreeKernel::margin apart.
// Boxes of nodes are dropped by their distance on the axes of both nodes, pairs of leaves by a slab, pairs of
// triangles by their boxes and slabs.
//
// Errors. On the axes of either node, the error of the difference of two points of both bodies is at most
// Between::error in each coordinate. The margin includes the deviations of the poses from rotations
// (aim_at()). A computed length has a relative error of up to kDistanceRounding, which covers the axes'
// deviation from orthonormality and rounding: see distance_kernel.inl. `NearBetween::square` allows for twice
// that, and for underflow. NaN (an overflow) compares false and keeps a pair.

#include "engine/distance/kernel_distances.inl"
#include "engine/tree/kernel_walk.inl"

namespace lrb {
namespace {

/// Two nodes, and the squared distance above which parts of them are dropped.
struct NearBetween : Between {
  float square;
};

/// Number of slabs of Gilbert's method that are tried for each pair of triangles. With three, and those
/// normal to the triangles, the candidates within 0.1, 1 and 5 % of the diagonal are 1.9, 1.3 and 1.05 times
/// the near pairs, on the classes of `bench`. Fewer: more pairs are measured in doubles. More: each pair
/// takes longer.
constexpr int kSlabs = 3;

/// Returns the lanes in which a slab normal to p is proven to be wider than allowed. `width`: its width times
/// |p|. The errors of the corners include the rounding of the products, as in Normal.
inline Lanes is_too_wide(Float8 width, const Float8* p, const NearBetween& w) {
  const Float8 errors = splat(2 * w.error) * (abs8(p[0]) + abs8(p[1]) + abs8(p[2])) + splat(kKernelTiny);
  const Float8 sure = width - errors;
  return both(greater(sure, Float8{}), greater(sure * sure, splat(w.square) * dot(p, p)));
}

/// Returns the lanes in which a slab normal to the triangles of `t`, which are those of a or of b, separates
/// them by more than allowed.
inline Lanes far_along_normal(const Corners& t, const Corners& a, const Corners& b, const NearBetween& w) {
  Float8 e[3], f[3], n[3];
  subtract(t.x[1], t.x[0], e);
  subtract(t.x[2], t.x[0], f);
  cross(e, f, n);
  // Scaled to about 1, because squares of the normals of small triangles underflow. A triangle without area
  // gives NaN, which keeps the pair.
  const Float8 scale = splat(1) / larger(abs8(n[0]), larger(abs8(n[1]), abs8(n[2])));
  for (Float8& x : n) x *= scale;
  Float8 low[2], high[2];
  for (int side = 0; side < 2; ++side) {
    const Corners& u = side == 0 ? a : b;
    const Float8 x = dot(n, u.x[0]), y = dot(n, u.x[1]), z = dot(n, u.x[2]);
    low[side] = smaller(x, smaller(y, z));
    high[side] = larger(x, larger(y, z));
  }
  return is_too_wide(larger(low[1] - high[0], low[0] - high[1]), n, w);
}

/// Returns the lanes whose triangles are proven to be farther apart than allowed. Lanes that are not in
/// `current` do not matter. The first slabs are normal to the triangles: often the nearest points are a
/// corner and a point of a face. The direction of another slab runs from the origin to a point p of the
/// Minkowski difference B - A; p approaches the point of least length (Gilbert, "An Iterative Procedure for
/// Computing the Minimum of a Quadratic Form on a Convex Set", 1966):
/// 1. p: the difference of the centroids.
/// 2. v: the corner of B - A that is least along p. The slab normal to p is p . v / |p| wide.
/// 3. Replace p by the point of least length between p and v, and continue with 2.
inline Lanes proven_far(const Corners& a, const Corners& b, std::uint32_t current, const NearBetween& w) {
  Lanes far = far_along_normal(a, a, b, w);
  if ((~bits(far) & current) == 0) return far;
  far = either(far, far_along_normal(b, a, b, w));
  if ((~bits(far) & current) == 0) return far;
  Float8 p[3];
  for (int x = 0; x < 3; ++x)
    p[x] = ((b.x[0][x] + b.x[1][x] + b.x[2][x]) - (a.x[0][x] + a.x[1][x] + a.x[2][x])) * splat(1.0F / 3);
  for (int i = 0;; ++i) {
    Float8 v[3], ends[2];
    for (int side = 0; side < 2; ++side) {
      const Corners& t = side == 0 ? a : b;
      // The corner of A that is farthest along p, and the corner of B that is least far.
      Float8 end = dot(p, t.x[0]), corner[3] = {t.x[0][0], t.x[0][1], t.x[0][2]};
      for (int c = 1; c < 3; ++c) {
        const Float8 along = dot(p, t.x[c]);
        const Lanes beyond = side == 0 ? greater(along, end) : greater(end, along);
        end = select(beyond, along, end);
        for (int x = 0; x < 3; ++x) corner[x] = select(beyond, t.x[c][x], corner[x]);
      }
      ends[side] = end;
      for (int x = 0; x < 3; ++x) v[x] = side == 0 ? corner[x] : corner[x] - v[x];
    }
    far = either(far, is_too_wide(ends[1] - ends[0], p, w));
    if (i == kSlabs - 1 || (~bits(far) & current) == 0) return far;
    // The point of least length between p and v.
    Float8 towards[3];
    subtract(v, p, towards);
    const Float8 share = clamp_share(-dot(p, towards) / dot(towards, towards));
    for (int x = 0; x < 3; ++x) p[x] += share * towards[x];
  }
}

/// Returns the pairs of simplices of two leaves that are not separated by more than allowed by a slab normal
/// to the line between the leaves' origins, which are near their centres: bit 8 i + j for simplex i of A's
/// leaf and j of B's. Drops all pairs of 0.4 to 0.6 of the pairs of leaves, on the classes of `bench`, at
/// little cost: B's corners are not turned to A's axes, but the normal to B's.
inline std::uint64_t near_along_offset(const TreeKernel& k, const TreeNode& na, const TreeNode& nb,
                                       const NearBetween& w) {
  const float* t = w.t;
  const float square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  // As in is_too_wide(), but relative to |t|, and rounded up. The product under the root may underflow, which
  // has an absolute error of 2^-149, and 2^-74.5 after the root: kKernelTiny would not cover it.
  // (is_too_wide() compares two squares, whose order rounding does not reverse.)
  constexpr float kRootTiny = 0x1p-74F;
  const float errors =
      2 * w.error * (__builtin_fabsf(t[0]) + __builtin_fabsf(t[1]) + __builtin_fabsf(t[2])) + kRootTiny;
  const float allowed = (__builtin_sqrtf(w.square * square) + errors) * (1 + kDistanceRounding);
  // All pairs of simplices that are present.
  const std::uint64_t all = (present(nb) * 0x0101010101010101U) & (~std::uint64_t{0} >> (64 - 8 * na.count));
  if (!(allowed < __builtin_inff())) return all;  // overflow
  Float8 on_a[3], on_b[3], normal[2][3];
  for (int x = 0; x < 3; ++x) {
    normal[0][x] = splat(t[x] * k.ratio_a);
    normal[1][x] = splat(-w.back[x] * k.ratio_b);
  }
  for (int corner = 0; corner < 3; ++corner) {
    const auto& a = k.blocks_a[na.first].corner[corner];
    const auto& b = k.blocks_b[nb.first].corner[corner];
    on_a[corner] = normal[0][0] * load8(a[0]) + normal[0][1] * load8(a[1]) + normal[0][2] * load8(a[2]);
    on_b[corner] = normal[1][0] * load8(b[0]) + normal[1][1] * load8(b[1]) + normal[1][2] * load8(b[2]);
  }
  // The upper ends of A's triangles; the lower ends of B's, less the allowed width.
  const Float8 ends = larger(on_a[0], larger(on_a[1], on_a[2])),
               begins = smaller(on_b[0], smaller(on_b[1], on_b[2])) + splat(square - allowed);
  const auto* end = reinterpret_cast<const float*>(&ends);
  std::uint64_t pairs = 0;
  for (int i = 7; i >= 0; --i) pairs = pairs << 8 | (~bits(greater(begins, splat(end[i]))) & 255U);
  return pairs & all;
}

/// The boxes of some simplices.
struct BoxesOf {
  Float8 low[3], high[3];

  explicit BoxesOf(const Corners& t) {
    for (int x = 0; x < 3; ++x) {
      low[x] = smaller(t.x[0][x], smaller(t.x[1][x], t.x[2][x]));
      high[x] = larger(t.x[0][x], larger(t.x[1][x], t.x[2][x]));
    }
  }
};

/// Returns those of the pairs whose boxes are not proven to be farther apart than allowed: see
/// NearWalk::apart(). The errors of a gap are those of two corners, as in is_too_wide().
inline std::uint64_t near_boxes(const Corners& a, const Corners& b, std::uint64_t pairs,
                                const NearBetween& w) {
  const BoxesOf of_a(a);
  const auto *low = reinterpret_cast<const float*>(of_a.low),
             *high = reinterpret_cast<const float*>(of_a.high);
  const BoxesOf of_b(b);
  const Float8 error = splat(2 * w.error);
  std::uint64_t near = 0;
  for (std::uint64_t todo = pairs; todo != 0;) {
    const int i = __builtin_ctzll(todo) / 8;
    const std::uint64_t row = std::uint64_t{255} << (8 * i);
    todo &= ~row;
    Float8 square{};
    for (int x = 0; x < 3; ++x) {
      const Float8 gap = larger(of_b.low[x] - splat(high[8 * x + i]), splat(low[8 * x + i]) - of_b.high[x]);
      const Float8 ahead = larger(gap - error, Float8{});
      square += ahead * ahead;
    }
    near |= static_cast<std::uint64_t>(~bits(greater(square, splat(w.square)))) << (8 * i) & row & pairs;
  }
  return near;
}

struct NearWalk {
  static constexpr bool kMargin = false;  // boxes are not grown

  static NearBetween between(const TreeKernel& k, const TreeNode& a, const TreeNode& b) {
    const float length = k.margin * (1 + 2 * kDistanceRounding);
    return {lrb::between<false>(k, a, b), length * length * (1 + 2 * kDistanceRounding) + kKernelTiny};
  }

  static float size(const TreeKernel& k, const TreeNode& n, Side side) {
    return n.radius * (side == Side::a ? k.ratio_a : k.ratio_b);
  }

  /// Compares the squared distance of boxes on the same axes: the sum of the squares of the positive gaps.
  static Lanes apart(const Float8* centre, const Float8* half, const float* other_centre,
                     const float* other_half, const NearBetween& w) {
    Float8 square{};
    for (int i = 0; i < 3; ++i) {
      const Float8 gap =
          larger(abs8(centre[i] - splat(other_centre[i])) - (half[i] + splat(other_half[i])), Float8{});
      square += gap * gap;
    }
    return greater(square, splat(w.square));
  }

  /// Writes the pairs of simplices of two leaves that may be near.
  static void leaves(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
    const NearBetween w = between(k, na, nb);
    // Pass 1: a slab, which often separates all pairs, then boxes.
    std::uint64_t pairs = near_along_offset(k, na, nb, w);
    if (pairs == 0) return;
    k.box_tests += static_cast<std::uint32_t>(__builtin_popcountll(pairs));
    Corners a, b;
    corners_of(k, na, nb, w, a, b);
    pairs = near_boxes(a, b, pairs, w);
    if (pairs == 0) return;
    PairList list;
    list_pairs(pairs, list);
    k.prefilter_tests += list.size;
    // Pass 2: triangles, eight pairs at a time.
    const LeafBlock &block_a = k.blocks_a[na.first], &block_b = k.blocks_b[nb.first];
    for (std::uint32_t begin = 0; begin < list.size; begin += 8) {
      const std::uint32_t current = list.size - begin < 8 ? (1U << (list.size - begin)) - 1 : 255U;
      const Lanes far = proven_far(pick(a, list.a + begin), pick(b, list.b + begin), current, w);
      for (std::uint32_t c = ~bits(far) & current; c != 0; c &= c - 1) {
        const std::uint32_t pair = begin + static_cast<std::uint32_t>(__builtin_ctz(c));
        k.out[k.out_size++] = {block_a.simplex[list.a[pair]], block_b.simplex[list.b[pair]], Certainty::none,
                               Side::a, 0};
      }
    }
  }
};

}  // namespace

void LRB_NEAR_KERNEL_NAME(TreeKernel& k) {
  run<NearWalk, false>(k, k.max_node_pairs);
}

}  // namespace lrb
