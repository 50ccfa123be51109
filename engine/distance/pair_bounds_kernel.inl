// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_PAIR_BOUNDS_KERNEL_NAME. See
// tree_kernel.inl.
//
// Bounds the distances of eight pairs of triangles in double. Steps, proofs and error bounds are those of
// pair_bounds.cpp:
// 1. Map the corners to the world, as Pose::apply() does.
// 2. Find the closest points among edge-edge and vertex-face pairs: their distance is the upper bound.
// 3. The lower bound is the width of a slab normal to the line between these points. Where rounding makes it
//    clearly less than the upper bound, the normals of the closest features and of the faces are tried.

#include "engine/distance/kernel_distances.inl"
#include "engine/distance/near_kernel.hpp"

namespace lrb {
namespace {

using DoubleCorners = CornersOf<Doubles>;

/// Factors that cover the rounding of a root and of the operations after it.
constexpr double kPairUp = 1 + 0x1p-51, kPairDown = 1 - 0x1p-50;

/// The closest points found of some pairs. Lane-wise minimum.
struct Closest {
  Doubles square = splat_as(Doubles{}, __builtin_inf());
  Doubles on[2] = {}, share[2] = {};  ///< as FeaturePoints, with numbers as doubles

  void add(const FeaturePoints<Doubles>& p) {
    // NaN compares false and is never kept.
    const DoubleLanes nearer = greater(square, p.square);
    square = select(nearer, p.square, square);
    for (int i = 0; i < 2; ++i) {
      on[i] = select(nearer, splat_as(Doubles{}, p.on[i]), on[i]);
      share[i] = select(nearer, p.share[i], share[i]);
    }
  }
};

/// The feature of one side that contains the closest point: the point, and the edges that span the feature.
struct OnFeature {
  Doubles point[3], relative[3];   ///< in the world, and relative to A's first corner
  Doubles edge[3], other_edge[3];  ///< `other_edge`: of a face
  DoubleLanes face, inner;         ///< the feature is a face; it is the interior of an edge

  OnFeature(const DoubleCorners& t, const Closest& closest, int side, const Doubles* origin) {
    const auto number = [](double x) { return splat_as(Doubles{}, x); };
    const Doubles on = closest.on[side];
    face = greater(on, number(kOnFace - 0.5));
    const DoubleLanes from_1 = both(greater(on, number(0.5)), greater(number(1.5), on)),
                      from_2 = both(greater(on, number(1.5)), greater(number(2.5), on));
    // The other side's point is a corner if this one is on a face, and the reverse.
    const DoubleLanes other_face = greater(closest.on[1 - side], number(kOnFace - 0.5));
    const Doubles share = select(face, closest.share[0], select(other_face, Doubles{}, closest.share[side]));
    const Doubles other_share = select(face, closest.share[1], Doubles{});
    // A clamped parameter is exactly 0 or 1: the point is a corner, which is copied without rounding.
    const DoubleLanes end = greater(share, number(1 - 0x1p-53));
    inner = both(greater(share, Doubles{}), greater(number(1), share));
    for (int x = 0; x < 3; ++x) {
      const Doubles first = select(from_1, t.x[1][x], select(from_2, t.x[2][x], t.x[0][x]));
      const Doubles next = select(from_1, t.x[2][x], select(from_2, t.x[0][x], t.x[1][x]));
      edge[x] = next - first;
      other_edge[x] = t.x[2][x] - t.x[0][x];
      const Doubles along = share * edge[x] + other_share * other_edge[x];
      relative[x] = (first - origin[x]) + along;
      point[x] = select(end, next, first + along);
    }
  }
};

/// Writes a normal of the closest features that stays accurate if they nearly touch. towards: from A's point
/// to B's.
inline void normal_of_features(const OnFeature& a, const OnFeature& b, const Doubles* towards,
                               Doubles* normal) {
  Doubles u[3], v[3], across[3];
  // A face: its own normal. Two edges: their common normal, unless they are parallel.
  for (int x = 0; x < 3; ++x) {
    u[x] = select(b.face, b.edge[x], a.edge[x]);
    v[x] = select(b.face, b.other_edge[x], select(a.face, a.other_edge[x], b.edge[x]));
  }
  cross(u, v, across);
  const DoubleLanes spanned =
      both(either(either(a.face, b.face), both(a.inner, b.inner)), greater(dot(across, across), Doubles{}));
  // A vertex and an edge, or parallel edges: the difference without its component along the edge
  // (Gram-Schmidt). Two vertices: only their difference.
  Doubles along[3];
  for (int x = 0; x < 3; ++x) along[x] = select(a.inner, a.edge[x], b.edge[x]);
  const Doubles share = select(either(a.inner, b.inner), dot(towards, along) / dot(along, along), Doubles{});
  for (int x = 0; x < 3; ++x) normal[x] = select(spanned, across[x], towards[x] - share * along[x]);
}

/// Measures the pairs of lanes `lane` to `lane` + kDoubles - 1.
inline void measure(const PairBoundsKernel& k, EightPairsMeasured& pairs, int lane) {
  // Step 1, with the same operations as Pose::apply(), in the same order.
  DoubleCorners world[2], relative[2];
  for (int side = 0; side < 2; ++side)
    for (int corner = 0; corner < 3; ++corner) {
      Doubles own[3];
      for (int x = 0; x < 3; ++x) own[x] = load(pairs.corner[side][corner][x] + lane);
      for (int x = 0; x < 3; ++x) {
        const double* r = k.r[side][x];
        const auto number = [](double y) { return splat_as(Doubles{}, y); };
        world[side].x[corner][x] =
            ((number(r[0]) * own[0] + number(r[1]) * own[1]) + number(r[2]) * own[2]) + number(k.t[side][x]);
      }
    }
  // Relative to A's first corner: errors scale with the simplices, not with their distance from the origin.
  const Doubles* const origin = world[0].x[0];
  Doubles reach{};
  for (int side = 0; side < 2; ++side)
    for (int corner = 0; corner < 3; ++corner) {
      subtract(world[side].x[corner], origin, relative[side].x[corner]);
      for (const Doubles& x : relative[side].x[corner]) reach = larger(abs8(x), reach);
    }
  // Step 2.
  const EdgesOf<Doubles> of_a(relative[0]), of_b(relative[1]);
  Closest closest;
  for_close_points(relative[0], of_a, relative[1], of_b,
                   [&](const FeaturePoints<Doubles>& p) { closest.add(p); });
  const Doubles rounding = splat_as(Doubles{}, kPairRounding) * reach;
  Doubles upper = (root8(closest.square) + rounding) * splat_as(Doubles{}, kPairUp);
  // Outside this range, squares of lengths, or their products, would overflow or underflow.
  const DoubleLanes in_range =
      both(greater(reach, splat_as(Doubles{}, 0x1p-200)), greater(splat_as(Doubles{}, 0x1p200), reach));
  upper = select(in_range, upper, splat_as(Doubles{}, __builtin_inf()));
  // Step 3. The error of the difference of two products is at most a quarter of kPairRounding: 16 u.
  const OnFeature on_a(world[0], closest, 0, origin), on_b(world[1], closest, 1, origin);
  Doubles towards[3], lower{};
  subtract(on_b.relative, on_a.relative, towards);
  const auto width = [&](const Doubles* direction) {
    return slab(direction, relative[0], relative[1], splat_as(Doubles{}, 0.25) * rounding, Doubles{},
                splat_as(Doubles{}, kPairDown));
  };
  // The lanes that may be near, and whose interval is wider than rounding explains. Only they take other
  // directions, so that the result for a pair does not depend on the others.
  const auto wide = [&] {
    return both(greater(upper - (rounding + rounding), lower),
                static_cast<DoubleLanes>(~greater(lower, splat_as(Doubles{}, k.within))));
  };
  const auto raise_lower = [&](const Doubles* direction, DoubleLanes lanes) {
    lower = select(lanes, larger(width(direction), lower), lower);
  };
  lower = larger(width(towards), lower);
  if (DoubleLanes lanes = wide(); bits(lanes) != 0) {
    Doubles normal[3];
    normal_of_features(on_a, on_b, towards, normal);
    raise_lower(normal, lanes);
    if (lanes = wide(); bits(lanes) != 0)
      for (const EdgesOf<Doubles>* t : {&of_a, &of_b}) {
        cross(t->along[0], t->along[1], normal);
        raise_lower(normal, lanes);
      }
  }
  // Only rounding can raise the lower bound above the upper one.
  store(select(in_range, smaller(lower, upper), Doubles{}), pairs.lower + lane);
  store(upper, pairs.upper + lane);
  for (int x = 0; x < 3; ++x) {
    store(on_a.point[x], pairs.point[0][x] + lane);
    store(on_b.point[x], pairs.point[1][x] + lane);
  }
}

}  // namespace

void LRB_PAIR_BOUNDS_KERNEL_NAME(const PairBoundsKernel& k) {
  for (std::uint32_t i = 0; i < k.block_count; ++i)
    for (int lane = 0; lane < 8; lane += kDoubles) measure(k, k.pairs[i], lane);
}

}  // namespace lrb
