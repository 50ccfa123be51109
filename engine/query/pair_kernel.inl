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

/// Width of the slab between eight pairs across directions, less all errors; 0 if there is none. Any
/// direction will do, however it came about: only the corners' errors count, those of A's among them, 2 error
/// |d|_1, in which there is room for the rounding of the products as there is in Normal.
inline Float8 slab(const Float8* across, const Corners& a, const Corners& b, const Between& w) {
  // Neither too long nor too short for its square; of no direction, NaN, which proves nothing.
  const Float8 longest = larger(larger(abs8(across[0]), abs8(across[1])), abs8(across[2]));
  Float8 d[3];
  for (int x = 0; x < 3; ++x) d[x] = across[x] / longest;
  Float8 low[2], high[2];
  const Corners* const of[2] = {&a, &b};
  for (int side = 0; side < 2; ++side)
    for (int corner = 0; corner < 3; ++corner) {
      Float8 from_a[3];
      subtract(of[side]->x[corner], a.x[0], from_a);
      const Float8 at = d[0] * from_a[0] + d[1] * from_a[1] + d[2] * from_a[2];
      low[side] = corner == 0 ? at : smaller(low[side], at);
      high[side] = corner == 0 ? at : larger(high[side], at);
    }
  const Float8 size = abs8(d[0]) + abs8(d[1]) + abs8(d[2]);
  const Float8 width =
      larger(low[1] - high[0], low[0] - high[1]) - (splat(2 * w.error) * size + splat(kKernelTiny));
  const Float8 length = root8(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * splat(kFloatUp);
  return select(greater(width, Float8{}), width / length, Float8{});
}

/// The widest slab across: the planes of both, the axes, and the line between the middles.
inline Float8 widest_slab(const Corners& a, const Corners& b, const Between& w) {
  Float8 widest{};
  const Corners* const of[2] = {&a, &b};
  Float8 d[3];
  for (const Corners* t : of) {
    Float8 u[3], v[3];
    subtract(t->x[1], t->x[0], u);
    subtract(t->x[2], t->x[0], v);
    for (int x = 0; x < 3; ++x) d[x] = u[(x + 1) % 3] * v[(x + 2) % 3] - u[(x + 2) % 3] * v[(x + 1) % 3];
    widest = larger(slab(d, a, b, w), widest);
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int x = 0; x < 3; ++x) d[x] = splat(x == axis ? 1.0f : 0.0f);
    widest = larger(slab(d, a, b, w), widest);
  }
  for (int x = 0; x < 3; ++x)
    d[x] = (b.x[0][x] + b.x[1][x] + b.x[2][x]) - (a.x[0][x] + a.x[1][x] + a.x[2][x]);
  return larger(slab(d, a, b, w), widest);
}

}  // namespace

void LRB_PAIR_KERNEL_NAME(const PairKernel& k) {
  const float whole = k.m_size * (k.radius_a + k.radius_b + __builtin_fabsf(k.t[0]) +
                                  __builtin_fabsf(k.t[1]) + __builtin_fabsf(k.t[2]));
  for (std::uint32_t i = 0; i < k.block_count; ++i) {
    const PairBlock& block = k.blocks[i];
    Between w;
    set_errors(w, k.slack, k.m_size, block.edge_a, block.edge_b, block.reach + k.moved,
               whole + k.m_size * block.edge_b);
    w.error += kOwnEdgeRounding * block.edge_a;  // corners of A, too, are reached by edges
    Corners a, b;                                // from A's first corner
    for (int x = 0; x < 3; ++x) {
      const auto turned = [&](int which) {
        return splat(k.r[x][0]) * load8(block.b[which][0]) + splat(k.r[x][1]) * load8(block.b[which][1]) +
               splat(k.r[x][2]) * load8(block.b[which][2]);
      };
      a.x[0][x] = Float8{};
      b.x[0][x] = (splat(k.t[x]) + turned(0)) - load8(block.a[0][x]);
      for (int which = 1; which < 3; ++which) {
        a.x[which][x] = load8(block.a[which][x]);
        b.x[which][x] = b.x[0][x] + turned(which);
      }
    }
    const SideLanes b_sides = sides_of_planes(a, b, w, w.edge_error[0], 0);
    const SideLanes a_sides = sides_of_planes(b, a, w, w.edge_error[1], 0);
    const std::uint32_t parted = bits(either(a_sides.parted, b_sides.parted));
    k.verdicts[i] = {0, static_cast<std::uint8_t>(parted)};
    if (parted != 255u) {
      const Verdict v = overlap(a, a_sides, b, b_sides, w);  // of the others
      k.verdicts[i] = {static_cast<std::uint8_t>(bits(v.cross) & ~parted),
                       static_cast<std::uint8_t>(bits(v.disjoint) | parted)};
    }
    if (k.gaps) {
      const Float8 gap = widest_slab(a, b, w);
      __builtin_memcpy(k.gaps + 8 * i, &gap, sizeof gap);
    }
  }
}

}  // namespace lrb
