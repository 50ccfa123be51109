// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_PAIR_KERNEL_NAME. Separate from
// the tree kernel, because the speed of that kernel depends on inlining into its one loop.

#include "engine/tree/kernel_triangles.inl"
#include "engine/tree/tree_kernel.hpp"

namespace lrb {
namespace {

/// Eight simplices of a table, lane by lane.
struct EightSimplices {
  Float8 corner[3], edge[2][3], longest;

  EightSimplices(const CachedSimplex* table, const std::uint32_t* which) {  // every second entry of `which`
    // Gather by transposing: 12 floats per simplex are three rows of four.
    Float8 column[3][4];
    for (int part = 0; part < 3; ++part) {
      Float4 row[8];
      for (int k = 0; k < 8; ++k)
        __builtin_memcpy(&row[k], part_of(table[which[2 * k]], part), sizeof row[k]);
      transpose(row, column[part]);
    }
    for (int x = 0; x < 3; ++x) {
      corner[x] = column[x / 4][x % 4];
      edge[0][x] = column[(3 + x) / 4][(3 + x) % 4];
      edge[1][x] = column[(6 + x) / 4][(6 + x) % 4];
    }
    longest = column[9 / 4][9 % 4];
  }

 private:
  /// Returns four numbers of a simplex. Bytewise, because they belong to more than one of its arrays.
  static const char* part_of(const CachedSimplex& s, int part) {
    static_assert(sizeof s == 3 * sizeof(Float4));
    return reinterpret_cast<const char*>(&s) + static_cast<std::size_t>(part) * sizeof(Float4);
  }
};

/// Eight pairs, each relative to the first corner of its simplex of A.
struct EightPairs {
  Corners a, b;
  Float8 corner_b[3];  ///< the first corner, in B's frame
  float edge_b;
  Between w;

  EightPairs(const PairKernel& k, const CachedPair* pairs) {
    // Relative to A's first corner, coordinates and errors are small if the simplices are small and close.
    const EightSimplices of_a(k.a, &pairs->a), of_b(k.b, &pairs->b);
    const float edge_a = largest_of(of_a.longest);
    edge_b = largest_of(of_b.longest);
    Float8 between{};  // at least the distance of the first corners
    for (int x = 0; x < 3; ++x) {
      const auto turned = [&](const Float8* towards) {
        return splat(k.r[x][0]) * towards[0] + splat(k.r[x][1]) * towards[1] + splat(k.r[x][2]) * towards[2];
      };
      a.x[0][x] = Float8{};
      corner_b[x] = of_b.corner[x];
      b.x[0][x] = (splat(k.t[x]) + turned(of_b.corner)) - of_a.corner[x];
      between += abs8(b.x[0][x]);
      for (int which = 0; which < 2; ++which) {
        a.x[1 + which][x] = of_a.edge[which][x];
        b.x[1 + which][x] = b.x[0][x] + turned(of_b.edge[which]);
      }
    }
    // Bounds for all eight pairs together, from the largest of each quantity.
    const float whole = k.m_size * (k.radius_a + k.radius_b + __builtin_fabsf(k.t[0]) +
                                    __builtin_fabsf(k.t[1]) + __builtin_fabsf(k.t[2]) + edge_b);
    const float error = k.slack + kKernelRounding * whole;
    const float reach = (largest_of(between) + edge_a + k.m_size * edge_b + 3 * error) * kFloatUp;
    set_errors(w, k.slack, k.m_size, edge_a, edge_b, reach, whole);
    w.error += kOwnEdgeRounding * edge_a;  // corners of A are computed from edges as well
  }
};

/// The extent of eight simplices along a direction.
struct Shadow {
  Float8 low, high;

  Shadow(Float8 x, Float8 y, Float8 z) : low(smaller(smaller(x, y), z)), high(larger(larger(x, y), z)) {}
};

/// A direction, of any length, and the gaps of eight pairs along it.
struct Across {
  /// Lower bounds on the height of one simplex above the other; negative if they overlap.
  Float8 d[3], a_above, b_above;
  Float8 size;  ///< |d|_1

  /// Any direction is valid, however it was computed: only the errors of the corners count (including those
  /// of A's), 2 error |d|_1, which leaves room for the rounding of the products as in Normal. The direction
  /// is scaled so that its square neither overflows nor vanishes. A zero direction gives NaN, which proves
  /// nothing.
  Across(const Float8* direction, const EightPairs& p) {
    // The largest component of d becomes 1.
    const Float8 scale =
        splat(1) / larger(larger(abs8(direction[0]), abs8(direction[1])), abs8(direction[2]));
    for (int x = 0; x < 3; ++x) d[x] = direction[x] * scale;
    // Project both simplices. A's first corner is the origin.
    const auto along = [this](const Float8* x) { return d[0] * x[0] + d[1] * x[1] + d[2] * x[2]; };
    size = abs8(d[0]) + abs8(d[1]) + abs8(d[2]);
    compare({Float8{}, along(p.a.x[1]), along(p.a.x[2])}, {along(p.b.x[0]), along(p.b.x[1]), along(p.b.x[2])},
            splat(2 * p.w.error) * size);
  }
  Across(int axis, const EightPairs& p) : d{} {
    d[axis] = size = splat(1);
    compare({Float8{}, p.a.x[1][axis], p.a.x[2][axis]}, {p.b.x[0][axis], p.b.x[1][axis], p.b.x[2][axis]},
            splat(2 * p.w.error));
  }

 private:
  void compare(const Shadow& a, const Shadow& b, Float8 error) {
    // Lower bounds on the gap: the error is subtracted, so a positive value proves a separation.
    a_above = a.low - b.high - error - splat(kKernelTiny);
    b_above = b.low - a.high - error - splat(kKernelTiny);
  }
};

/// Calls visit() with directions that may separate the pairs: both normals, the coordinate axes, and the line
/// between the centroids.
template <class Visit>
inline void for_directions(const EightPairs& p, Visit&& visit) {
  Float8 d[3];
  const Corners* const of[2] = {&p.a, &p.b};
  for (const Corners* t : of) {
    Float8 u[3], v[3];
    subtract(t->x[1], t->x[0], u);
    subtract(t->x[2], t->x[0], v);
    for (int x = 0; x < 3; ++x) d[x] = u[(x + 1) % 3] * v[(x + 2) % 3] - u[(x + 2) % 3] * v[(x + 1) % 3];
    visit(Across(d, p));
  }
  for (int x = 0; x < 3; ++x) {
    visit(Across(x, p));
    d[x] = (p.b.x[0][x] + p.b.x[1][x] + p.b.x[2][x]) - (p.a.x[1][x] + p.a.x[2][x]);
  }
  visit(Across(d, p));
}

struct Span {
  Float8 from, to;

  /// Narrow the interval. A NaN proves nothing and is ignored.
  void not_before(Float8 x) { from = larger(x, from); }
  void not_after(Float8 x) { to = select(greater(to, x), x, to); }
};

/// Returns the lengths of motions after which the pairs may intersect: at least the width of the widest
/// separating slab.
inline Span span_of_lengths(const EightPairs& p) {
  Span span{Float8{}, splat(__builtin_inff())};
  for_directions(p, [&](const Across& x) {
    // The slab has the width gap / |d|. |d| is rounded up, so the quotient is a lower bound.
    const Float8 length = root8(x.d[0] * x.d[0] + x.d[1] * x.d[1] + x.d[2] * x.d[2]) * splat(kFloatUp);
    span.not_before(larger(x.a_above, x.b_above) / length);
  });
  return span;
}

/// Returns the parts of a sweep in which the pairs may intersect. Along each direction B moves at a constant
/// rate, up to `spared`: it enters from one side of A and leaves on the other.
inline Span span_of_sweep(const PairKernel& k, const EightPairs& p) {
  Span span{splat(-__builtin_inff()), splat(__builtin_inff())};
  // `spared` bounds the difference between the motion of any point of B's simplex and the sweep of its first
  // corner.
  const float longest = k.sweep_turn * k.radius_b + __builtin_fabsf(k.sweep_t[0]) +
                        __builtin_fabsf(k.sweep_t[1]) + __builtin_fabsf(k.sweep_t[2]);
  const Float8 spared = splat(k.margin + k.sweep_turn * p.edge_b + kSweepRounding * longest);
  Float8 towards[3];
  for (int x = 0; x < 3; ++x)
    towards[x] = splat(k.sweep_t[x]) + splat(k.sweep[x][0]) * p.corner_b[0] +
                 splat(k.sweep[x][1]) * p.corner_b[1] + splat(k.sweep[x][2]) * p.corner_b[2];
  for_directions(p, [&](const Across& x) {
    // As in the slab test of rays (Kay and Kajiya 1986): B enters A's slab at one time and leaves it at
    // another.
    const Float8 rate = x.d[0] * towards[0] + x.d[1] * towards[1] + x.d[2] * towards[2];
    const Lanes rises = greater(rate, Float8{});
    // A rate of 0 gives infinity, or NaN, which Span ignores.
    const Float8 per_rate = splat(1) / abs8(rate), spare = spared * x.size;
    span.not_before((select(rises, x.a_above, x.b_above) - spare) * per_rate);
    span.not_after((spare - select(rises, x.b_above, x.a_above)) * per_rate);
  });
  return span;
}

inline PairVerdicts verdicts_of(const EightPairs& p) {
  const SideLanes b_sides = sides_of_planes(p.a, p.b, p.w, p.w.edge_error[0]);
  const SideLanes a_sides = sides_of_planes(p.b, p.a, p.w, p.w.edge_error[1]);
  const std::uint32_t rejected = bits(either(a_sides.rejected, b_sides.rejected));
  // All eight pairs are separated by planes: the common line is not needed.
  if (rejected == 255u) return {0, 255u};
  const Verdict v = overlap(p.a, a_sides, p.b, b_sides, p.w);  // for the others
  return {static_cast<std::uint8_t>(bits(v.cross) & ~rejected),
          static_cast<std::uint8_t>(bits(v.disjoint) | rejected)};
}

}  // namespace

void LRB_PAIR_KERNEL_NAME(const PairKernel& k) {
  for (std::uint32_t i = 0; i < k.block_count; ++i) {
    const EightPairs p(k, k.pairs + 8 * i);
    if (k.verdicts) k.verdicts[i] = verdicts_of(p);
    if (k.from) {
      const Span span = k.is_swept ? span_of_sweep(k, p) : span_of_lengths(p);
      __builtin_memcpy(k.from + 8 * i, &span.from, sizeof span.from);
      __builtin_memcpy(k.to + 8 * i, &span.to, sizeof span.to);
    }
  }
}

}  // namespace lrb
