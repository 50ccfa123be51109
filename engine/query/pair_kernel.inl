// Compiled once per instruction set by pair_kernel_*.cpp, which define LRB_PAIR_KERNEL_NAME: apart from the
// tree kernel, whose speed hangs on what the compiler makes part of its one loop.

#include "engine/query/kernel_triangles.inl"
#include "engine/query/pair_kernel.hpp"

namespace lrb {
namespace {

inline Float8 root8(Float8 x) {
#if defined(__AVX__)
  return reinterpret_cast<Float8>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x)));
#else
  for (int k = 0; k < 8; ++k) x[k] = __builtin_sqrtf(x[k]);
  return x;
#endif
}

inline Float8 smaller(Float8 x, Float8 y) {
  return select(greater(x, y), y, x);
}

inline float largest_of(Float8 x) {
  x = larger(x, __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3));
  x = larger(x, __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5));
  x = larger(x, __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6));
  return x[0];
}

/// Eight simplices of a table, lane by lane.
struct EightSimplices {
  Float8 corner[3], edge[2][3], longest;

  EightSimplices(const NearSimplex* table, const std::uint32_t* which) {  // every second of which
    Float8 column[3][4];
    for (int part = 0; part < 3; ++part) {
      Float8 row[4];
      for (int i = 0; i < 4; ++i) {
        Float4 low, high;
        __builtin_memcpy(&low, table[which[2 * i]].corner + 4 * part, sizeof low);
        __builtin_memcpy(&high, table[which[2 * (i + 4)]].corner + 4 * part, sizeof high);
        row[i] = __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
      }
      const Float8 low01 = __builtin_shufflevector(row[0], row[1], 0, 8, 1, 9, 4, 12, 5, 13);
      const Float8 low23 = __builtin_shufflevector(row[2], row[3], 0, 8, 1, 9, 4, 12, 5, 13);
      const Float8 high01 = __builtin_shufflevector(row[0], row[1], 2, 10, 3, 11, 6, 14, 7, 15);
      const Float8 high23 = __builtin_shufflevector(row[2], row[3], 2, 10, 3, 11, 6, 14, 7, 15);
      column[part][0] = __builtin_shufflevector(low01, low23, 0, 1, 8, 9, 4, 5, 12, 13);
      column[part][1] = __builtin_shufflevector(low01, low23, 2, 3, 10, 11, 6, 7, 14, 15);
      column[part][2] = __builtin_shufflevector(high01, high23, 0, 1, 8, 9, 4, 5, 12, 13);
      column[part][3] = __builtin_shufflevector(high01, high23, 2, 3, 10, 11, 6, 7, 14, 15);
    }
    for (int x = 0; x < 3; ++x) {
      corner[x] = column[x / 4][x % 4];
      edge[0][x] = column[(3 + x) / 4][(3 + x) % 4];
      edge[1][x] = column[(6 + x) / 4][(6 + x) % 4];
    }
    longest = column[9 / 4][9 % 4];
  }
};

/// Eight pairs, from A's first corners.
struct EightPairs {
  Corners a, b;
  Between w;

  EightPairs(const PairKernel& k, const NearPair* pairs) {
    const EightSimplices of_a(k.a, &pairs->a), of_b(k.b, &pairs->b);
    const float edge_a = largest_of(of_a.longest), edge_b = largest_of(of_b.longest);
    Float8 between{};  // the first corners, at least
    for (int x = 0; x < 3; ++x) {
      const auto turned = [&](const Float8* way) {
        return splat(k.r[x][0]) * way[0] + splat(k.r[x][1]) * way[1] + splat(k.r[x][2]) * way[2];
      };
      a.x[0][x] = Float8{};
      b.x[0][x] = (splat(k.t[x]) + turned(of_b.corner)) - of_a.corner[x];
      between += abs8(b.x[0][x]);
      for (int which = 0; which < 2; ++which) {
        a.x[1 + which][x] = of_a.edge[which][x];
        b.x[1 + which][x] = b.x[0][x] + turned(of_b.edge[which]);
      }
    }
    const float whole = k.m_size * (k.radius_a + k.radius_b + __builtin_fabsf(k.t[0]) +
                                    __builtin_fabsf(k.t[1]) + __builtin_fabsf(k.t[2]) + edge_b);
    const float error = k.slack + kKernelRounding * whole;
    const float reach = (largest_of(between) + edge_a + k.m_size * edge_b + 3 * error) * kFloatUp;
    set_errors(w, k.slack, k.m_size, edge_a, edge_b, reach, whole);
    w.error += kOwnEdgeRounding * edge_a;  // corners of A, too, are reached by edges
  }
};

/// How far eight simplices reach along a direction.
struct Shadow {
  Float8 low, high;

  Shadow(Float8 x, Float8 y, Float8 z)
      : low(smaller(smaller(x, y), z)), high(larger(larger(x, y), z)) {}

  /// Between this and another; negative where they overlap.
  Float8 gap(const Shadow& other) const { return larger(other.low - high, low - other.high); }
};

/// Width of the slab between eight pairs across directions, less all errors; 0 if there is none. Any
/// direction will do, however it came about: only the corners' errors count, those of A's among them, 2 error
/// |d|_1, in which there is room for the rounding of the products as there is in Normal.
inline Float8 slab(const Float8* across, const EightPairs& p) {
  // Neither too long nor too short for its square; of no direction, NaN, which proves nothing.
  const Float8 scale = splat(1) / larger(larger(abs8(across[0]), abs8(across[1])), abs8(across[2]));
  Float8 d[3];
  for (int x = 0; x < 3; ++x) d[x] = across[x] * scale;
  const auto along = [&d](const Float8* x) { return d[0] * x[0] + d[1] * x[1] + d[2] * x[2]; };
  const Shadow of_a(Float8{}, along(p.a.x[1]), along(p.a.x[2]));
  const Shadow of_b(along(p.b.x[0]), along(p.b.x[1]), along(p.b.x[2]));
  const Float8 size = abs8(d[0]) + abs8(d[1]) + abs8(d[2]);
  const Float8 width = of_a.gap(of_b) - (splat(2 * p.w.error) * size + splat(kKernelTiny));
  const Float8 length = root8(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * splat(kFloatUp);
  return select(greater(width, Float8{}), width / length, Float8{});
}

/// The widest slab across: the planes of both, the axes, and the line between the middles.
inline Float8 widest_slab(const EightPairs& p) {
  Float8 widest{}, d[3];
  const Corners* const of[2] = {&p.a, &p.b};
  for (const Corners* t : of) {
    Float8 u[3], v[3];
    subtract(t->x[1], t->x[0], u);
    subtract(t->x[2], t->x[0], v);
    for (int x = 0; x < 3; ++x) d[x] = u[(x + 1) % 3] * v[(x + 2) % 3] - u[(x + 2) % 3] * v[(x + 1) % 3];
    widest = larger(slab(d, p), widest);
  }
  for (int x = 0; x < 3; ++x) {
    const Shadow of_a(Float8{}, p.a.x[1][x], p.a.x[2][x]), of_b(p.b.x[0][x], p.b.x[1][x], p.b.x[2][x]);
    widest = larger(of_a.gap(of_b) - splat(2 * p.w.error + kKernelTiny), widest);
    d[x] = (p.b.x[0][x] + p.b.x[1][x] + p.b.x[2][x]) - (p.a.x[1][x] + p.a.x[2][x]);
  }
  return larger(slab(d, p), widest);
}

inline PairVerdicts verdicts_of(const EightPairs& p) {
  const SideLanes b_sides = sides_of_planes(p.a, p.b, p.w, p.w.edge_error[0], 0);
  const SideLanes a_sides = sides_of_planes(p.b, p.a, p.w, p.w.edge_error[1], 0);
  const std::uint32_t parted = bits(either(a_sides.parted, b_sides.parted));
  if (parted == 255u) return {0, 255u};
  const Verdict v = overlap(p.a, a_sides, p.b, b_sides, p.w);  // of the others
  return {static_cast<std::uint8_t>(bits(v.cross) & ~parted), static_cast<std::uint8_t>(bits(v.disjoint) | parted)};
}

}  // namespace

void LRB_PAIR_KERNEL_NAME(const PairKernel& k) {
  for (std::uint32_t i = 0; i < k.block_count; ++i) {
    const EightPairs p(k, k.pairs + 8 * i);
    if (k.verdicts) k.verdicts[i] = verdicts_of(p);
    if (k.gaps) {
      const Float8 gap = widest_slab(p);
      __builtin_memcpy(k.gaps + 8 * i, &gap, sizeof gap);
    }
  }
}

}  // namespace lrb
