// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_DISTANCE_KERNEL_NAME. See
// tree_kernel.inl.
//
// Distance of two OBB trees by best-first traversal (sources: distance.hpp). Steps:
// 1. Descend along the nearest boxes to a first pair of leaves, for an upper bound.
// 2. Pop the pair of nodes with the least bound. Stop when that bound exceeds the pruning distance.
// 3. Bound the pairs of children: first by slabs, then by box distances, then by cached projections and
//    planes. Push the pairs within the pruning distance.
// 4. At leaves, bound the distances of triangles, eight pairs at a time, and lower the upper bound.
//
// Box distances. On the axes of a node, which are orthonormal up to kFrameDefect, the boxes of the other node
// are enclosed in boxes along these axes, grown by Between::error. The distance of two such boxes is
//     sqrt(sum of the squares of the positive gaps),
// a lower bound on the distance of the points in them: kernel_setup.cpp shows that on these axes the error of
// a difference of points of two bodies is at most Between::error, however large the difference is.
// kDistanceRounding covers the effect on lengths of the frames' defect and of the rounding of squares and
// sums (2^-21 and a few 2^-24). The larger of the distances on A's axes and on B's axes counts.
//
// Slabs. Along the direction between the closest points known so far, boxes and triangles are separated by at
// least the gap between their projections. For distant bodies this is nearly the distance, and it takes one
// subtraction per pair: most bounds come from slabs.

#include "engine/distance/distance_kernel.hpp"
#include "engine/distance/kernel_distances.inl"
#include "engine/tree/kernel_walk.inl"

namespace lrb {
namespace {

/// Pushes a pair of nodes to a binary min-heap ordered by `bound`.
inline void push_waiting(DistanceKernel& k, const WaitingNodes& pair) {
  std::uint32_t at = k.waiting_size++;
  // Sift up: parents with a larger bound move down into the hole.
  while (at > 0) {
    const std::uint32_t parent = (at - 1) / 2;
    if (!(pair.bound < k.waiting[parent].bound)) break;
    k.waiting[at] = k.waiting[parent];
    at = parent;
  }
  k.waiting[at] = pair;
}

inline WaitingNodes pop_waiting(DistanceKernel& k) {
  const WaitingNodes top = k.waiting[0], last = k.waiting[--k.waiting_size];
  const std::uint32_t size = k.waiting_size;
  std::uint32_t at = 0;
  // Sift down: the smaller child moves up into the hole until the last pair fits there.
  for (std::uint32_t child = 1; child < size; child = 2 * at + 1) {
    // Choose the smaller child without a branch.
    child +=
        static_cast<std::uint32_t>(child + 1 < size && k.waiting[child + 1].bound < k.waiting[child].bound);
    if (!(k.waiting[child].bound < last.bound)) break;
    k.waiting[at] = k.waiting[child];
    at = child;
  }
  k.waiting[at] = last;
  return top;
}

inline float dot3(const float* x, const float* y) {
  return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
}

/// Normalises `way`, which is on a node's axes, and writes it on the axes of its body. Returns false if it is
/// too short.
inline bool direction_of(const TreeNode& n, const float* way, float* direction) {
  // Above this length the sum of squares, 2^-120, is a normal float.
  constexpr float kLeast = 0x1p-60F;
  const float length = __builtin_sqrtf(dot3(way, way));
  if (!(length > kLeast)) return false;
  for (int i = 0; i < 3; ++i)
    direction[i] = (n.frame[0][i] * way[0] + n.frame[1][i] * way[1] + n.frame[2][i] * way[2]) / length;
  return true;
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

/// Squared distances of eight boxes from one box with the same axes, and the largest signed gap along any
/// axis.
struct BoxGaps {
  Float8 square{}, most = splat(-__builtin_inff());

  void see(const Float8* centre, const Float8* half, const float* other_centre, const float* other_half) {
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
  gaps.see(bt.centre, bt.half, row.own_centre, row.own_half);
  gaps.see(own_b.centre, own_b.half, row.turned_centre, row.turned_half);
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
inline Float8 bound_of_slab(Float8 width, float parent) {
  // Rounded down. NaN compares false, which leaves the parent's bound.
  const Float8 sure = width * splat(1 - 2 * kDistanceRounding);
  return larger(select(greater(sure, Float8{}), sure * sure, splat(parent)), splat(parent));
}

/// Projections of the children of two nodes on the direction: the upper ends of A's, the lower ends of B's.
struct Ends {
  Float8 of_a, of_b;
};

inline Ends ends_of(const Boxes& a, const Boxes& b, const Ahead& ahead) {
  return {reach_of(ahead.on_a, a, 1), reach_of(ahead.on_b, b, -1) + splat(ahead.between)};
}

/// Ends of triangles, all on A's axes.
inline Ends ends_of(const Corners& a, const Corners& b, const Ahead& ahead) {
  // A triangle is the convex hull of its corners: the extremes of three dot products are its ends.
  Float8 on_a[3], on_b[3];
  for (int corner = 0; corner < 3; ++corner) {
    on_a[corner] = along(ahead.on_a, a.x[corner]);
    on_b[corner] = along(ahead.on_a, b.x[corner]);
  }
  // B's corners include the offset of the nodes already: only the errors are subtracted.
  return {larger(larger(on_a[0], on_a[1]), on_a[2]),
          smaller(smaller(on_b[0], on_b[1]), on_b[2]) - splat(ahead.errors)};
}

/// Calls keep(i, lanes, bounds) for each box of A. `lanes`: the boxes of B that may be within the pruning
/// distance.
template <class Keep>
inline void compare_boxes(DistanceKernel& k, const TreeNode& na, const Boxes& a, const TreeNode& nb,
                          const Boxes& b, const Between& w, const Ends& ends, float parent, Keep&& keep) {
  const Dropping dropping(k);
  k.tree.box_tests += static_cast<std::uint32_t>(na.count) * nb.count;
  // Pass 1: slabs, one box of A against eight of B for one subtraction. Written so that NaN keeps a pair.
  Float8 slabs[8];
  std::uint32_t mask[8], rows = 0;
  for (int i = 0; i < na.count; ++i) {
    slabs[i] = bound_of_slab(ends.of_b - splat(ends.of_a[i]), parent);
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

/// Returns the end of a node's triangles or child boxes along the kernel's direction: the upper end for A,
/// the lower end for B.
template <Side kSide>
inline float find_end(const DistanceKernel& k, const TreeNode& n) {
  constexpr int kOf = static_cast<int>(kSide);
  const float ratio = kSide == Side::a ? k.tree.ratio_a : k.tree.ratio_b;
  const TreeNode& root = *(kSide == Side::a ? k.tree.nodes_a : k.tree.nodes_b);
  const LeafBlock* const blocks = kSide == Side::a ? k.tree.blocks_a : k.tree.blocks_b;
  double offset = 0;
  float direction[3];  // B's is reversed, so that both sides need a maximum
  // Offset from the root in double: it may be much larger than the node.
  for (int i = 0; i < 3; ++i) {
    offset += (n.origin[i] - root.origin[i]) * static_cast<double>(k.direction[kOf][i]);
    direction[i] =
        kSide == Side::a ? dot3(n.frame[i], k.direction[kOf]) : -dot3(n.frame[i], k.direction[kOf]);
  }
  const float start = static_cast<float>(offset) * ratio;
  Float8 most;
  if (n.is_leaf) {
    // Leaf: project the corners of the triangles. Unused lanes repeat the first.
    Float8 corner[3];
    for (int c = 0; c < 3; ++c) {
      const auto& x = blocks[n.first].corner[c];
      corner[c] = splat(direction[0]) * load8(x[0]) + splat(direction[1]) * load8(x[1]) +
                  splat(direction[2]) * load8(x[2]);
    }
    most = larger(larger(corner[0], corner[1]), corner[2]) * splat(ratio);
  } else {
    // Inner node: project the child boxes. Unused lanes have negative extents and never give the maximum.
    most = reach_of(direction, decode(n, ratio), 1);
  }
  // B's direction was reversed: its maximum is subtracted.
  return kSide == Side::a ? start + largest_of(most) : start - largest_of(most);
}

/// Returns find_end(), cached for each node until the direction changes: `turn` is the direction's version.
template <Side kSide>
inline float end_of(DistanceKernel& k, std::uint32_t node) {
  // Entries of other versions are stale.
  NodeEnd& known = k.ends[static_cast<int>(kSide)][node];
  if (known.turn != k.turn)
    known = {find_end<kSide>(k, (kSide == Side::a ? k.tree.nodes_a : k.tree.nodes_b)[node]), k.turn};
  return known.end;
}

/// Returns the cache slot of a pair of nodes. Direct-mapped: the slot may contain another pair.
inline FarNodes& far_slot(const DistanceKernel& k, std::uint32_t a, std::uint32_t b) {
  // Multiplicative hash with two odd constants (primes of xxHash). The shift brings high bits into the slot's
  // index.
  const std::uint32_t mixed = a * 0x9e3779b1U + b * 0x85ebca77U;
  return k.far[(mixed ^ mixed >> 15) & (k.far_slots - 1)];
}

/// Returns true if the slab that separated two nodes at an earlier step is still wide enough to drop them.
/// Along its direction n, the contents of A's node reach as far from the node's origin as they did then. So
/// do the contents of B's node, up to the rotation since then: from M y to M' y, a shift of at most |M' - M|
/// |y|. Only the offset of the origins is recomputed, with errors as in turn_to().
inline bool is_known_far(const DistanceKernel& k, std::uint32_t a, std::uint32_t b, float least) {
  const FarNodes& far = far_slot(k, a, b);
  // The slot may have been overwritten by another pair.
  if (far.a != a || far.b != b) return false;
  const TreeNode &na = k.tree.nodes_a[a], &nb = k.tree.nodes_b[b];
  const Float4 apart = offset_between(k.tree, na, nb);
  const float *n = far.direction, x[3] = {apart[0], apart[1], apart[2]};
  const float radius_b = nb.radius * k.tree.ratio_b;
  // The same reach as in between(): radii of both nodes, and the offset of their origins.
  float sizes = 0, whole = na.radius * k.tree.ratio_a + radius_b;
  for (int i = 0; i < 3; ++i) {
    sizes += __builtin_fabsf(n[i]);
    whole += __builtin_fabsf(x[i]);
  }
  const float errors = 2 * (k.tree.slack + kKernelRounding * (k.tree.m_size * whole)) * sizes + kKernelTiny;
  // `turned` sums the changes of M, so by the triangle inequality the difference bounds |M' - M|.
  const float turn = (k.turned - far.turned) * radius_b * kFloatUp;
  // Rounded down by twice the factor that a length needs.
  return (dot3(n, x) + far.width - turn - errors) * (1 - 2 * kDistanceRounding) > least;
}

/// Caches for the next steps a plane that separates the contents of two nodes, if its slab is wider than the
/// pruning distance. `way`: the plane's normal, of any length, on the axes of A's node.
template <class Of>
inline void keep_far(DistanceKernel& k, const WaitingNodes& pair, const TreeNode& na, const TreeNode& nb,
                     const Of& a, const Of& b, const Between& w, const float* way) {
  float direction[3];
  // Any direction is valid; the one between close points gives the widest slab.
  if (!direction_of(na, way, direction)) return;
  const Ends ends = ends_of(a, b, Ahead(na, w, direction));
  // Gap between the extremes of both projections. Unused lanes are never the extremes.
  const float width = -largest_of(-ends.of_b) - largest_of(ends.of_a);
  // Worth storing only if it would drop the pair now, by twice the margin of is_known_far().
  if (!(width * (1 - 4 * kDistanceRounding) > dropped_from(k))) return;
  const Float4 apart = offset_between(k.tree, na, nb);
  const float x[3] = {apart[0], apart[1], apart[2]};
  FarNodes& far = far_slot(k, pair.a, pair.b);
  far.a = pair.a, far.b = pair.b;
  for (int i = 0; i < 3; ++i) far.direction[i] = direction[i];
  // Stored without the offset of the origins, which the next steps recompute.
  far.width = width - dot3(direction, x);
  // Rounded down, so that the rotation since then is not underestimated.
  far.turned = k.min_turned;
}

/// Pushes a pair of nodes, unless their projections or a cached plane prove that it is too far.
inline void wait_for(DistanceKernel& k, std::uint32_t a, std::uint32_t b, float bound,
                     const Dropping& dropping) {
  // Slab along the kernel's direction between the contents of the nodes. Both ends are usually cached.
  const float slab = (end_of<Side::b>(k, b) - end_of<Side::a>(k, a) + k.ahead) * (1 - 2 * kDistanceRounding);
  if (slab > 0 && slab * slab > bound) bound = slab * slab;
  // Last test: the plane stored by an earlier step of a motion.
  if (bound > dropping.square || (k.far != nullptr && is_known_far(k, a, b, dropping.length))) return;
  push_waiting(k, {bound, a, b});
}

/// Expands both nodes: up to 64 pairs of children.
inline void distance_both(DistanceKernel& k, const TreeNode& na, const TreeNode& nb,
                          const WaitingNodes& pair) {
  // Relative pose of the nodes, with bounds on the errors of all transformed coordinates.
  const Between w = between<false>(k.tree, na, nb);
  const Boxes a = decode(na, k.tree.ratio_a), b = decode(nb, k.tree.ratio_b);
  // Projections on the direction from A to B at the closest points known so far.
  const Ends ends = ends_of(a, b, Ahead(na, w, k.direction[0]));
  const Dropping dropping(k);
  const std::uint32_t waited = k.waiting_size;
  compare_boxes(k, na, a, nb, b, w, ends, pair.bound, [&](int i, std::uint32_t lanes, Float8 bound) {
    for (; lanes != 0; lanes &= lanes - 1) {
      const int j = __builtin_ctz(lanes);
      wait_for(k, na.first + static_cast<std::uint32_t>(i), nb.first + static_cast<std::uint32_t>(j),
               bound[j], dropping);
    }
  });
  // No pair of children was pushed: cache a plane normal to the line between the nodes' origins.
  if (k.far == nullptr || k.waiting_size != waited) return;
  keep_far(k, pair, na, nb, a, b, w, w.t);
}

/// Expands one node only: its boxes against the node box of the other.
template <bool kDescendA>
inline void distance_one(DistanceKernel& k, const TreeNode& na, const TreeNode& nb,
                         const WaitingNodes& pair) {
  const Between w = between<false>(k.tree, na, nb);
  BoxGaps gaps;
  // A's boxes rotated to B's axes against B's node box, then B's node box on A's axes.
  if constexpr (kDescendA) {
    const Boxes a = decode(na, k.tree.ratio_a);
    const Whole b = whole_of(nb, k.tree.ratio_b), on_a = turn_whole_b<false>(b, w);
    const Turned on_b = turn_a<false>(a, w);
    gaps.see(on_b.centre, on_b.half, b.centre, b.half);
    gaps.see(a.centre, a.half, on_a.centre, on_a.half);
  } else {
    // The roles are exchanged.
    const Boxes b = decode(nb, k.tree.ratio_b);
    const Whole a = whole_of(na, k.tree.ratio_a), on_b = turn_whole_a<false>(a, w);
    const Turned on_a = turn_b<false>(b, w);
    gaps.see(on_a.centre, on_a.half, a.centre, a.half);
    gaps.see(b.centre, b.half, on_b.centre, on_b.half);
  }
  const TreeNode& opened = kDescendA ? na : nb;
  const Float8 bound = gaps.bound(splat(pair.bound));
  k.tree.box_tests += opened.count;
  const Dropping dropping(k);
  // Children within the pruning distance; NaN counts as within.
  std::uint32_t lanes = ~bits(greater(bound, splat(dropping.square))) & present(opened);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int c = __builtin_ctz(lanes);
    const std::uint32_t child = opened.first + static_cast<std::uint32_t>(c);
    wait_for(k, kDescendA ? child : pair.a, kDescendA ? pair.b : child, bound[c], dropping);
  }
}

/// Pairs of simplices of two blocks, with the bounds of their boxes. Arrays have eight spare entries after
/// the largest possible list.
struct BoundedList {
  std::uint8_t a[72], b[72];
  float bound[72];
  std::uint32_t size = 0;

  /// Moves the closest eight of the remaining pairs to the front, and drops those beyond `most`.
  void select_eight(std::uint32_t begin, float most) {
    // Compact: the upper bound may have fallen since the last call.
    std::uint32_t end = begin;
    for (std::uint32_t i = begin; i < size; ++i)
      if (!(bound[i] > most)) swap(i, end++);
    size = end;
    // Partial selection sort: only eight are needed now, and the next call may drop the rest.
    for (std::uint32_t front = begin; size - begin > 8 && front < begin + 8; ++front) {
      std::uint32_t least = front;
      for (std::uint32_t i = front + 1; i < size; ++i)
        if (bound[i] < bound[least]) least = i;
      swap(front, least);
    }
    // Pad with simplex 0: unused lanes of the last group then compute with valid data.
    __builtin_memset(a + size, 0, 8);
    __builtin_memset(b + size, 0, 8);
  }

 private:
  void swap(std::uint32_t i, std::uint32_t j) {
    const std::uint8_t of_a = a[i], of_b = b[i];
    const float of_bound = bound[i];
    a[i] = a[j], b[i] = b[j], bound[i] = bound[j];
    a[j] = of_a, b[j] = of_b, bound[j] = of_bound;
  }
};

/// Sets the direction of the kernel's slabs, given on A's axes.
inline void turn_to(DistanceKernel& k, const float* direction) {
  const TreeNode &a = k.tree.nodes_a[0], &b = k.tree.nodes_b[0];
  float sizes = 0, offsets = 0;
  double ahead = 0;
  for (int i = 0; i < 3; ++i) {
    k.direction[0][i] = direction[i];
    sizes += __builtin_fabsf(direction[i]);
    // Offset of B's root from A's, and its projection, in double.
    const double at_b =
        k.tree.m[0][i] * b.origin[0] + k.tree.m[1][i] * b.origin[1] + k.tree.m[2][i] * b.origin[2];
    const double offset = at_b * k.tree.ratio_b + k.tree.t[i] - a.origin[i] * k.tree.ratio_a;
    ahead += offset * direction[i];
    offsets += __builtin_fabsf(static_cast<float>(offset));
  }
  // On B's axes: multiply by the transposed rotation.
  for (int j = 0; j < 3; ++j)
    k.direction[1][j] = k.tree.m_rows[0][j] * direction[0] + k.tree.m_rows[1][j] * direction[1] +
                        k.tree.m_rows[2][j] * direction[2];
  // Error bound as in Ahead, with the radii and the offset of the roots.
  const float whole = k.tree.m_size * (a.radius * k.tree.ratio_a + b.radius * k.tree.ratio_b + offsets);
  const float errors = 2 * (k.tree.slack + kKernelRounding * whole) * sizes + kKernelTiny;
  k.ahead = static_cast<float>(ahead) - errors;
  // A new version: all cached NodeEnd become stale.
  ++k.turn;
}

/// Uses the direction between the closest points for slabs from now on. way: on the axes of A's node.
inline void look_ahead(DistanceKernel& k, const TreeNode& na, const float* way) {
  float direction[3];
  if (direction_of(na, way, direction)) turn_to(k, direction);
}

/// Applies the float bounds of some pairs of triangles.
inline void take_over(DistanceKernel& k, const Distances& d, const BoundedList& list, std::uint32_t begin,
                      std::uint32_t count, const TreeNode& na, const TreeNode& nb) {
  const LeafBlock &block_a = k.tree.blocks_a[na.first], &block_b = k.tree.blocks_b[nb.first];
  // Pass 1: lower the upper bound first, so that pass 2 drops as many pairs as possible.
  for (std::uint32_t lane = 0; lane < count; ++lane)
    if (d.upper[lane] < k.upper) {
      k.upper = d.upper[lane];
      k.best_a = block_a.simplex[list.a[begin + lane]];
      k.best_b = block_b.simplex[list.b[begin + lane]];
      // Closer points give a better direction for slabs.
      const float way[3] = {d.way[0][lane], d.way[1][lane], d.way[2][lane]};
      look_ahead(k, na, way);
    }
  // Pass 2: collect the pairs to measure in double.
  const Dropping dropping(k);
  for (std::uint32_t lane = 0; lane < count; ++lane) {
    // The bound of the boxes is valid for the triangles as well, and may be larger than theirs.
    const float box = list.bound[begin + lane];
    const float by_box = box > 0 ? __builtin_sqrtf(box) * (1 - kDistanceRounding) : 0;
    const float lower = d.lower[lane] > by_box ? d.lower[lane] : by_box;
    if (lower > dropping.length) continue;
    k.near[k.near_size++] = {block_a.simplex[list.a[begin + lane]], block_b.simplex[list.b[begin + lane]],
                             lower};
    // Contact is not excluded: stop, so that the caller runs the exact query.
    if (!(lower > 0) && !k.apart) k.stop = KernelStop::doubtful;
  }
}

/// Compares the triangles of two leaves.
inline void distance_leaves(DistanceKernel& k, const TreeNode& na, const TreeNode& nb,
                            const WaitingNodes& pair) {
  const Between w = between<false>(k.tree, na, nb);
  Corners a, b;
  corners_of(k.tree, na, nb, w, a, b);
  BoundedList list;
  const Boxes boxes_a = decode(na, k.tree.ratio_a), boxes_b = decode(nb, k.tree.ratio_b);
  // Slabs of the triangles, which are tighter than the slabs of their boxes.
  const Ends ends = ends_of(a, b, Ahead(na, w, k.direction[0]));
  // Pass 1: list the pairs whose bounds are small enough.
  compare_boxes(k, na, boxes_a, nb, boxes_b, w, ends, pair.bound,
                [&](int i, std::uint32_t lanes, Float8 bound) {
                  for (; lanes != 0; lanes &= lanes - 1) {
                    const int j = __builtin_ctz(lanes);
                    list.a[list.size] = static_cast<std::uint8_t>(i);
                    list.b[list.size] = static_cast<std::uint8_t>(j);
                    list.bound[list.size++] = bound[j];
                  }
                });
  // Pass 2: eight pairs at a time, closest boxes first: each eight lower the bound for the next.
  float nearest = __builtin_inff(), way[3] = {w.t[0], w.t[1], w.t[2]};
  for (std::uint32_t begin = 0, count = 8; list.size > 0 && count == 8; begin += 8) {
    list.select_eight(begin, Dropping(k).square);
    if (begin >= list.size) break;
    count = list.size - begin < 8 ? list.size - begin : 8;
    k.triangle_pairs += count;
    const Distances d(pick(a, list.a + begin), pick(b, list.b + begin), w);
    take_over(k, d, list, begin, count, na, nb);
    if (k.far == nullptr) continue;
    // The line between the closest points in these leaves is normal to the best separating plane.
    for (std::uint32_t lane = 0; lane < count; ++lane)
      if (d.upper[lane] < nearest) {
        nearest = d.upper[lane];
        for (int i = 0; i < 3; ++i) way[i] = d.way[i][lane];
      }
  }
  // The closest pair so far is elsewhere: try to cache a plane that separates these leaves.
  if (k.far == nullptr || !(nearest > k.upper)) return;
  keep_far(k, pair, na, nb, a, b, w, way);
}

/// Decides which nodes of a pair are expanded: both, unless only one is a leaf or one is much larger. Two
/// leaves are both expanded.
struct Opening {
  bool a, b, leaves;

  Opening(const DistanceKernel& k, const TreeNode& na, const TreeNode& nb) {
    // Comparing all children of a much smaller node would only repeat the same few boxes of the larger one.
    const float size_a = na.radius * k.tree.ratio_a, size_b = nb.radius * k.tree.ratio_b;
    leaves = na.is_leaf && nb.is_leaf;
    a = leaves || (!na.is_leaf && (nb.is_leaf || size_b <= kMuchLarger * size_a));
    b = leaves || (!nb.is_leaf && (na.is_leaf || size_a <= kMuchLarger * size_b));
  }
};

inline void distance_step(DistanceKernel& k, const WaitingNodes& pair) {
  const TreeNode& a = k.tree.nodes_a[pair.a];
  const TreeNode& b = k.tree.nodes_b[pair.b];
  const Opening opening(k, a, b);
  if (opening.leaves)
    distance_leaves(k, a, b, pair);
  else if (!opening.b)
    distance_one<true>(k, a, b, pair);
  else if (!opening.a)
    distance_one<false>(k, a, b, pair);
  else
    distance_both(k, a, b, pair);
}

/// Follows the closest boxes down to a first pair of leaves, so that the traversal starts with an upper
/// bound.
inline void descend_to_first_pair(DistanceKernel& k) {
  WaitingNodes at = k.waiting[0];
  const std::uint32_t bottom = k.waiting_size;
  for (;;) {
    const TreeNode& a = k.tree.nodes_a[at.a];
    const TreeNode& b = k.tree.nodes_b[at.b];
    ++k.tree.node_pairs;
    if (Opening(k, a, b).leaves) {
      distance_leaves(k, a, b, at);
      // The boxes overlap at every depth: the surfaces probably intersect, so stop for the exact query.
      if (!(at.bound > 0) && !k.apart) k.stop = KernelStop::doubtful;
      return;
    }
    // Expand into an empty heap above the real one, follow its best pair, and discard the others: the
    // traversal starts at the top pair and finds them again.
    WaitingNodes* const heap = k.waiting;
    k.waiting += bottom;
    k.waiting_size = 0;
    distance_step(k, at);
    if (k.waiting_size > 0) at = k.waiting[0];
    // No child is within the pruning distance.
    const bool is_stuck = k.waiting_size == 0;
    k.waiting = heap;
    k.waiting_size = bottom;
    if (is_stuck || k.tree.node_pairs >= k.tree.max_node_pairs) return;
  }
}

}  // namespace

void LRB_DISTANCE_KERNEL_NAME(DistanceKernel& k) {
  k.stop = KernelStop::done;
  if (!k.begun) {
    // First call: set the direction on both sides' axes, then look for a first upper bound.
    k.begun = true;
    const float direction[3] = {k.direction[0][0], k.direction[0][1], k.direction[0][2]};
    turn_to(k, direction);
    if (k.descend) descend_to_first_pair(k);
    if (k.stop == KernelStop::doubtful) return;
  }
  // The top pair has the least bound: if it is too far, so are all others.
  while (k.waiting_size != 0 && !(k.waiting[0].bound > Dropping(k).square)) {
    if (k.upper <= k.enough) {
      k.stop = KernelStop::enough;
      return;
    }
    // A step adds at most 8 x 8 pairs to either buffer: stop before it could overflow.
    if (k.waiting_capacity - k.waiting_size < kRoomForStep || k.near_capacity - k.near_size < kRoomForStep) {
      k.stop = KernelStop::room;
      return;
    }
    if (k.tree.node_pairs >= k.tree.max_node_pairs) {
      k.stop = KernelStop::limit;
      return;
    }
    // Each expanded pair counts as a step.
    ++k.tree.node_pairs;
    distance_step(k, pop_waiting(k));
    if (k.stop == KernelStop::doubtful) return;
  }
  // The last step may have answered the request.
  if (k.upper <= k.enough) k.stop = KernelStop::enough;
}

}  // namespace lrb
