#pragma once
// Part of tree_kernel.inl: eight pairs of triangles, and what float arithmetic is certain of about them.

#include "engine/query/kernel_boxes.inl"

namespace lrb {
namespace {

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

}  // namespace
}  // namespace lrb
