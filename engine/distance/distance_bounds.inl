#pragma once
// Part of distance_kernel.inl: bounds of the distances of boxes, and of triangles along a direction; dropping
// of pairs.

#include "engine/distance/distance_kernel.hpp"
#include "engine/distance/kernel_distances.inl"
#include "engine/tree/kernel_walk.inl"

namespace lrb {
namespace {

inline float dot3(const float* x, const float* y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/// Normalises `towards`, which is on a node's axes, and writes it on the axes of its body. Returns false if
/// it is too short.
inline bool direction_of(const TreeNode& n, const float* towards, float* direction) {
  // Above this length the sum of squares, 2^-120, is a normal float.
  constexpr float kLeast = 0x1p-60F;
  const float length = __builtin_sqrtf(dot3(towards, towards));
  if (!(length > kLeast)) return false;
  for (int i = 0; i < 3; ++i)
    direction[i] =
        (n.frame[0][i] * towards[0] + n.frame[1][i] * towards[1] + n.frame[2][i] * towards[2]) / length;
  return true;
}

/// Squared distances of eight boxes from one box with the same axes, and the largest signed gap along any
/// axis.
struct BoxGaps {
  Float8 square{}, most = splat(-__builtin_inff());

  void add(const Float8* centre, const Float8* half, const float* other_centre, const float* other_half) {
    Float8 sum{};
    for (int i = 0; i < 3; ++i) {
      // Signed gap of the projections on axis i; negative if they overlap.
      const Float8 gap = abs8(centre[i] - splat(other_centre[i])) - (half[i] + splat(other_half[i]));
      // Only positive gaps add to the distance.
      const Float8 ahead = larger(gap, Float8{});
      most = larger(gap, most);
      sum += ahead * ahead;
    }
    // Both nodes' axes give a lower bound: keep the larger one.
    square = larger(sum, square);
  }

  /// Returns WaitingNodes::bound, but at least `other`: the bound of the expanded pair, or of a slab.
  Float8 bound(Float8 other) const {
    // Disjoint: the squared distance. Overlapping: minus the least penetration, so that deep overlaps come
    // first.
    return larger(select(greater(square, Float8{}), square, smaller(most, Float8{})), other);
  }
};

inline Float8 bounds_of(const Row& row, const Boxes& own_b, const Turned& bt, Float8 other) {
  BoxGaps gaps;
  // On A's axes, then on B's: the six face normals of the separating axis test (Gottschalk et al. 1996).
  gaps.add(bt.centre, bt.half, row.own_centre, row.own_half);
  gaps.add(own_b.centre, own_b.half, row.turned_centre, row.turned_half);
  return gaps.bound(other);
}

/// A direction, given on A's axes, on the axes of two nodes. Its length is at most 1 up to kDistanceRounding.
struct Ahead {
  float on_a[3], on_b[3];
  float errors;   ///< bound on the error of a difference along it
  float between;  ///< offset of B's node along it, less the errors

  Ahead(const TreeNode& na, const Between& w, const float* direction) {
    float sizes = 0;
    for (int i = 0; i < 3; ++i) {
      // Axes of A's node are the rows of its frame. The L1 norm scales errors per coordinate to the dot
      // product.
      on_a[i] = dot3(na.frame[i], direction);
      sizes += __builtin_fabsf(on_a[i]);
    }
    // B's axes are the columns of r: multiply by its transpose.
    for (int j = 0; j < 3; ++j) on_b[j] = w.r[0][j] * on_a[0] + w.r[1][j] * on_a[1] + w.r[2][j] * on_a[2];
    // Error bound as in slab(): 2 error |d|_1, plus underflow.
    errors = 2 * w.error * sizes + kKernelTiny;
    between = on_a[0] * w.t[0] + on_a[1] * w.t[1] + on_a[2] * w.t[2] - errors;
  }
};

inline Float8 along(const float* direction, const Float8* x) {
  return splat(direction[0]) * x[0] + splat(direction[1]) * x[1] + splat(direction[2]) * x[2];
}

/// Returns the upper ends (sign 1) or the lower ends (sign -1) of the boxes' projections on a direction.
inline Float8 reach_of(const float* direction, const Boxes& boxes, float sign) {
  // Projection radius of a box: its half extents, weighted by the absolute direction.
  Float8 half{};
  for (int i = 0; i < 3; ++i) half += splat(__builtin_fabsf(direction[i])) * boxes.half[i];
  return along(direction, boxes.centre) + splat(sign) * half;
}

/// Returns the bounds (WaitingNodes::bound) from slabs: the squared width, but at least the parent's bound.
/// Slabs without width yield the parent's bound.
inline Float8 bound_of_slab(Float8 width, Float8 parent) {
  // Rounded down. NaN compares false, which leaves the parent's bound.
  const Float8 sure = width * splat(1 - 2 * kDistanceRounding);
  return larger(select(greater(sure, Float8{}), sure * sure, parent), parent);
}

/// Projections of the children of two nodes on the direction: the upper ends of A's, the lower ends of B's.
struct Ends {
  Float8 of_a, of_b;
};

inline Ends ends_of(const Boxes& a, const Boxes& b, const Ahead& ahead) {
  return {reach_of(ahead.on_a, a, 1), reach_of(ahead.on_b, b, -1) + splat(ahead.between)};
}

/// Returns the upper ends of the triangles' projections on a direction, in the unit of their tree.
inline Float8 reach_of(const float* direction, const LeafBlock& triangles) {
  // A triangle is the convex hull of its corners: the largest of three dot products is its end.
  Float8 end[3];
  for (int c = 0; c < 3; ++c) {
    const auto& x = triangles.corner[c];
    end[c] = splat(direction[0]) * load8(x[0]) + splat(direction[1]) * load8(x[1]) +
             splat(direction[2]) * load8(x[2]);
  }
  return larger(larger(end[0], end[1]), end[2]);
}

/// Ends of the triangles of two leaves.
inline Ends ends_of(const TreeKernel& k, const TreeNode& na, const TreeNode& nb, const Ahead& ahead) {
  const float back[3] = {-ahead.on_b[0], -ahead.on_b[1], -ahead.on_b[2]};
  return {reach_of(ahead.on_a, k.blocks_a[na.first]) * splat(k.ratio_a),
          splat(ahead.between) - reach_of(back, k.blocks_b[nb.first]) * splat(k.ratio_b)};
}

/// Pruning thresholds: box bounds above `square` and bounds of triangles above `length` are dropped.
struct Dropping {
  float length, square;

  explicit Dropping(const DistanceKernel& k) : length(dropped_from(k)) {
    // Not positive if the tolerance exceeds the upper bound: then only bounds of at most 0 are kept.
    length = length > 0 ? length : 0;
    // A computed length has a relative error of up to kDistanceRounding: allow for twice that, and for
    // underflow.
    square = length * length * ((1 + 2 * kDistanceRounding) * (1 + 2 * kDistanceRounding)) + kKernelTiny;
  }
};

/// Calls keep(i, lanes, bounds) for each box of A. `lanes`: the boxes of B that may be within the pruning
/// distance. `ends`: along the kernel's direction; own: along the pair's.
template <class Keep>
inline void compare_boxes(DistanceKernel& k, const TreeNode& na, const Boxes& a, const TreeNode& nb,
                          const Boxes& b, const Between& w, const Ends& ends, const Ends& own, float parent,
                          Keep&& keep) {
  const Dropping dropping(k);
  k.tree.box_tests += static_cast<std::uint32_t>(na.count) * nb.count;
  // Pass 1: slabs, one box of A against eight of B for one subtraction. Written so that NaN keeps a pair.
  Float8 slabs[8];
  std::uint32_t mask[8], rows = 0;
  for (int i = 0; i < na.count; ++i) {
    slabs[i] =
        bound_of_slab(larger(ends.of_b - splat(ends.of_a[i]), own.of_b - splat(own.of_a[i])), splat(parent));
    mask[i] = ~bits(greater(slabs[i], splat(dropping.square))) & present(nb);
    rows |= static_cast<std::uint32_t>(mask[i] != 0) << i;
  }
  if (rows == 0) return;
  // Pass 2: box distances, only if slabs left pairs. Rotating the boxes to the other node's axes is deferred
  // until now.
  const Turned at = turn_a<false>(a, w), bt = turn_b<false>(b, w);
  // The rows with remaining pairs; `rows & rows - 1` clears the lowest one.
  for (; rows != 0; rows &= rows - 1) {
    const int i = __builtin_ctz(rows);
    const Float8 bound = bounds_of(row_of(a, at, i), b, bt, slabs[i]);
    const std::uint32_t lanes = ~bits(greater(bound, splat(dropping.square))) & mask[i];
    if (lanes != 0) keep(i, lanes, bound);
  }
}

}  // namespace
}  // namespace lrb
