#pragma once
// Part of tree_kernel.inl and pair_kernel.inl: eight pairs of triangles, and what float arithmetic proves
// about them.

#include "engine/tree/kernel_boxes.inl"

namespace lrb {
namespace {

/// The corners of some simplices, one in each lane of V.
template <class V>
struct CornersOf {
  V x[3][3];  // [corner][axis]
};

/// The corners of eight simplices in A's leaf frame, query units.
using Corners = CornersOf<Float8>;

/// Computes (u x v) . d in float arithmetic, lane by lane, with an error bound. u and v are each a difference
/// of two corners of one body; d is a difference of corners of both.
///
/// Let eu and ev bound the errors of the coordinates of u and v, U and V bound those coordinates, and w =
/// 2^-24. The normal n = u x v has an error of at most 2 (U ev + V eu + eu ev) in each component, and a
/// rounding error of 4 w U V. |d| is at most reach + 2 error, so the sum of its coordinates is below 1.75
/// times that. Hence n . d has two errors:
/// - 2 error |n|_1, which leaves room for rounding d and its products (4 w reach of 128);
/// - 3.5 (reach + 2 error) (U ev + V eu + eu ev + 2 w U V). The factor 4 instead of 3.5 leaves room for the
///   last term (eu and ev are at least 8 w times a radius, U and V at most 2 radii) and for rounding in this
///   computation.
struct Normal {
  Float8 n[3], size, bound;

  Normal(const Float8* u, float u_error, const Float8* v, float v_error, float reach, float error) {
    // The largest coordinates bound U and V of the derivation above.
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
    // The four terms of the bound: the position of d, the errors of v and of u, and their product.
    const float far = 4 * (reach + 2 * error);
    bound = splat(2 * error) * size + splat(far * v_error) * u_max + splat(far * u_error) * v_max +
            splat(far * u_error * v_error + kKernelTiny);
  }

  Float8 dot(const Float8* d) const { return n[0] * d[0] + n[1] * d[1] + n[2] * d[2]; }
};

template <class V>
inline void subtract(const V* x, const V* y, V* difference) {
  for (int axis = 0; axis < 3; ++axis) difference[axis] = x[axis] - y[axis];
}

/// The sides of the corners of eight simplices relative to other simplices' planes, lane by lane.
struct SideLanes {
  Lanes positive[3], negative[3];  ///< proven to be in front, or behind, by more than the margin
  Lanes certain;                   ///< each corner is proven to be in front or behind
  Lanes rejected;                  ///< all are in front, or all behind: the plane separates

  /// Returns the lanes whose corners are not proven to be on both sides.
  Lanes one_side() const {
    return static_cast<Lanes>(
        ~((positive[0] | positive[1] | positive[2]) & (negative[0] | negative[1] | negative[2])));
  }
};

/// Computes the sides of `points` relative to `planes`. plane_edge_error: Between::edge_error of the body of
/// the planes. kMargin: as for between().
template <bool kMargin = false>
inline SideLanes sides_of_planes(const Corners& planes, const Corners& points, const Between& w,
                                 float plane_edge_error) {
  Float8 e1[3], e2[3];
  // The unnormalised normals of the planes. Heights are compared with bounds of the same scale.
  subtract(planes.x[1], planes.x[0], e1);
  subtract(planes.x[2], planes.x[0], e2);
  const Normal n(e1, plane_edge_error, e2, plane_edge_error, w.reach, w.error);
  Float8 bound = n.bound;
  // The plane must separate by more than the margin and by more than the sweep's extent along the normal.
  if constexpr (kMargin)  // the size is at least the normal's length
    bound += splat(w.margin) * n.size + abs8(n.n[0] * splat(w.direction[0]) + n.n[1] * splat(w.direction[1]) +
                                             n.n[2] * splat(w.direction[2]));
  SideLanes sides;
  Lanes above = kAllLanes, below = kAllLanes;
  sides.certain = kAllLanes;
  for (int corner = 0; corner < 3; ++corner) {
    Float8 d[3];
    subtract(points.x[corner], planes.x[0], d);
    // Proven only beyond the bound. NaN compares false on both sides and leaves the corner undecided.
    const Float8 height = n.dot(d);
    sides.positive[corner] = greater(height, bound);
    sides.negative[corner] = greater(-bound, height);
    above &= sides.positive[corner];
    below &= sides.negative[corner];
    sides.certain = both(sides.certain, either(sides.positive[corner], sides.negative[corner]));
  }
  sides.rejected = either(above, below);
  return sides;
}

/// Triangles with their corners rotated so that corner 0, the tip, is alone on its side of the other's plane.
struct TipFirst {
  Corners t;
  Lanes positive;  ///< lanes with the tip on the positive side

  TipFirst(const Corners& from, const SideLanes& s) {
    // The two corners on the same side are the ends; the third is the tip. By selection, because lanes
    // differ.
    const Lanes first = equal(s.positive[1], s.positive[2]), second = equal(s.positive[0], s.positive[2]);
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        t.x[corner][axis] =
            select(first, from.x[corner][axis],
                   select(second, from.x[(corner + 1) % 3][axis], from.x[(corner + 2) % 3][axis]));
    positive = select(first, s.positive[0], select(second, s.positive[1], s.positive[2]));
  }
};

/// Proven relations of pairs of triangles, lane by lane.
struct Verdict {
  Lanes cross, disjoint;
};

/// Decides whether two triangles overlap on the line in which their planes cross, if each has corners proven
/// to be on both sides of the other's plane. Follows engine/exact/plane_side.hpp, whose orient3d(tip of a,
/// end of a, tip of b, end of b) equals -(edge of a x edge of b) . (tip of b - tip of a). A sign proven here
/// is also the sign in world coordinates: the map from the world to the leaf's frame is affine, possibly
/// mirrored, and preserves intersections, and every corner is within `error` of its image.
inline Verdict overlap(const Corners& a, const SideLanes& a_sides, const Corners& b, const SideLanes& b_sides,
                       const Between& w) {
  // Step 1: rotate both triangles so that their tips come first.
  const TipFirst ta(a, a_sides), tb(b, b_sides);
  const Lanes alike = equal(ta.positive, tb.positive);
  Float8 between_tips[3], ua[2][3], ub[2][3];
  subtract(tb.t.x[0], ta.t.x[0], between_tips);
  // Step 2: pair each end of A with the opposite end of B (low with high). The choice depends on whether the
  // tips are on equal sides.
  for (int end = 0; end < 2; ++end) subtract(ta.t.x[1 + end], ta.t.x[0], ua[end]);
  for (int end = 0; end < 2; ++end)
    for (int axis = 0; axis < 3; ++axis)
      ub[end][axis] = select(alike, tb.t.x[1 + end][axis], tb.t.x[2 - end][axis]) - tb.t.x[0][axis];
  // Step 3: the two comparisons of interval overlap, each as a certified sign.
  Lanes low[2], high[2];
  for (int end = 0; end < 2; ++end) {
    const Normal n(ua[end], w.edge_error[0], ub[end], w.edge_error[1], w.reach, w.error);
    const Float8 value = n.dot(between_tips);
    low[end] = greater(-n.bound, value);
    high[end] = greater(value, n.bound);
  }
  // Both comparisons positive: the triangles cross. One negative: they are disjoint. Otherwise undecided.
  const Lanes certain = both(a_sides.certain, b_sides.certain);
  return {both(certain, select(tb.positive, both(high[0], low[1]), both(low[0], high[1]))),
          both(certain, select(tb.positive, either(low[0], high[1]), either(high[0], low[1])))};
}

/// The decisions for eight pairs of triangles, as bit masks.
struct EightCertainties {
  std::uint32_t cross = 0, disjoint = 0, uncertain = 0;
  std::uint32_t one_side[2] = {};   ///< for A's and B's: all decided corners are on one side
  std::uint32_t unsure[2][3] = {};  ///< [A's, B's][corner]: the corner may be in the other's plane

  /// Writes the decision for one pair. Branch-free, because it is unpredictable.
  void write(int lane, Candidate& c) const {
    const auto is = [lane](std::uint32_t lanes) { return lanes >> lane & 1; };
    const auto value = [](Certainty certainty) { return static_cast<std::uint32_t>(certainty); };
    // A triangle whose decided corners are on one side of a plane intersects the plane in the convex hull of
    // its undecided corners. If these are also corners of the other triangle, that hull is a corner or an
    // edge of it, or the entire triangle. Report A's corners if A is such a triangle, otherwise B's.
    const std::uint32_t of = is(one_side[0]) ^ 1, touch = is(uncertain) & (is(one_side[0]) | is(one_side[1]));
    c.certainty = static_cast<Certainty>(is(cross) * value(Certainty::cross) +
                                         is(disjoint) * value(Certainty::disjoint) +
                                         touch * value(Certainty::touch_if_shared));
    c.side = static_cast<Side>(of);
    c.corners =
        static_cast<std::uint8_t>(is(unsure[of][0]) | is(unsure[of][1]) << 1 | is(unsure[of][2]) << 2);
  }
};

inline EightCertainties certainties_of(const Corners& a, const SideLanes& a_sides, const Corners& b,
                                       const SideLanes& b_sides, const Between& w, std::uint32_t which) {
  EightCertainties c;
  // Pairs with all six corners proven off the other's plane: compare the spans on the common line.
  const std::uint32_t certain = bits(both(a_sides.certain, b_sides.certain)) & which;
  if (certain != 0) {
    const Verdict v = overlap(a, a_sides, b, b_sides, w);
    c.cross = bits(v.cross);
    c.disjoint = bits(v.disjoint);
  }
  // The remaining pairs have corners that may be in a plane. Record them for the test of shared corners.
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

/// Gathers simplices of a block, lane by lane: lane k gets simplex which[k].
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
