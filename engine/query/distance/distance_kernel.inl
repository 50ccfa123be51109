// Compiled once per instruction set by distance_kernel_*.cpp, which define LRB_DISTANCE_KERNEL_NAME. See
// tree_kernel.inl.
//
// Distances of boxes. On the axes of a node, an orthonormal frame but for kFrameDefect, the boxes of the
// other node become boxes along the axes that hold them, grown by Between::error. Two boxes along the same
// axes are
//     sqrt(sum of the squares of the gaps that are positive)
// apart, and so are points in them: kernel_setup.cpp shows that a difference of the points of two bodies, on
// these axes, is off by no more than the error, however large it is. What the frames' defect and the rounding
// of squares and sums (2^-21 and a few 2^-24) do to lengths is in kDistanceRounding. Of the distances on A's
// axes and on B's the larger counts.
//
// Most bounds come from a slab: along the direction in which the nearest points that are known lie to each
// other, boxes and triangles are as far apart as their ends are. From far off that is nearly their distance,
// and it takes one subtraction for each pair.

#include "engine/query/distance/distance_kernel.hpp"
#include "engine/query/distance/kernel_distances.inl"
#include "engine/tree/kernel_walk.inl"

namespace lrb {
namespace {

/// The best first: a binary heap of pairs of nodes.
inline void push_waiting(DistanceKernel& k, const WaitingNodes& pair) {
  std::uint32_t at = k.waiting_size++;
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
  for (std::uint32_t child = 1; child < size; child = 2 * at + 1) {
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

/// Writes the direction of a way, given on a node's axes, on its body's axes, with a length of 1. Returns
/// false if it has none.
inline bool direction_of(const TreeNode& n, const float* way, float* direction) {
  constexpr float kLeast = 0x1p-60F;
  const float length = __builtin_sqrtf(dot3(way, way));
  if (!(length > kLeast)) return false;
  for (int i = 0; i < 3; ++i)
    direction[i] = (n.frame[0][i] * way[0] + n.frame[1][i] * way[1] + n.frame[2][i] * way[2]) / length;
  return true;
}

inline float largest_of(Float8 x) {
  x = larger(x, __builtin_shufflevector(x, x, 4, 5, 6, 7, 0, 1, 2, 3));
  x = larger(x, __builtin_shufflevector(x, x, 2, 3, 0, 1, 6, 7, 4, 5));
  x = larger(x, __builtin_shufflevector(x, x, 1, 0, 3, 2, 5, 4, 7, 6));
  return x[0];
}

/// What is dropped: bounds of boxes above `square`, and of triangles above `length`.
struct Dropping {
  float length, square;

  explicit Dropping(const DistanceKernel& k) : length(dropped_from(k)) {
    length = length > 0 ? length : 0;
    square = length * length * ((1 + 2 * kDistanceRounding) * (1 + 2 * kDistanceRounding)) + kKernelTiny;
  }
};

/// The squared distances of eight boxes and one on the same axes, and the largest gap along any of them.
struct BoxGaps {
  Float8 square{}, most = splat(-__builtin_inff());

  void see(const Float8* centre, const Float8* half, const float* other_centre, const float* other_half) {
    Float8 sum{};
    for (int i = 0; i < 3; ++i) {
      const Float8 gap = abs8(centre[i] - splat(other_centre[i])) - (half[i] + splat(other_half[i]));
      const Float8 ahead = larger(gap, Float8{});
      most = larger(gap, most);
      sum += ahead * ahead;
    }
    square = larger(sum, square);
  }

  /// Returns WaitingNodes::bound, given another bound: that of the pair that was opened, or a slab's.
  Float8 bound(Float8 other) const {
    return larger(select(greater(square, Float8{}), square, smaller(most, Float8{})), other);
  }
};

inline Float8 bounds_of(const Row& row, const Boxes& own_b, const Turned& bt, Float8 other) {
  BoxGaps gaps;
  gaps.see(bt.centre, bt.half, row.own_centre, row.own_half);
  gaps.see(own_b.centre, own_b.half, row.turned_centre, row.turned_half);
  return gaps.bound(other);
}

/// A direction, given on A's axes, on the axes of two nodes; no longer than 1 but for kDistanceRounding.
struct Ahead {
  float on_a[3], on_b[3];
  float errors;   ///< of a difference along it
  float between;  ///< how far ahead B's node is, less the errors

  Ahead(const TreeNode& na, const Between& w, const float* direction) {
    float sizes = 0;
    for (int i = 0; i < 3; ++i) {
      on_a[i] = dot3(na.frame[i], direction);
      sizes += __builtin_fabsf(on_a[i]);
    }
    for (int j = 0; j < 3; ++j) on_b[j] = w.r[0][j] * on_a[0] + w.r[1][j] * on_a[1] + w.r[2][j] * on_a[2];
    // As in slab().
    errors = 2 * w.error * sizes + kKernelTiny;
    between = on_a[0] * w.t[0] + on_a[1] * w.t[1] + on_a[2] * w.t[2] - errors;
  }
};

inline Float8 along(const float* direction, const Float8* x) {
  return splat(direction[0]) * x[0] + splat(direction[1]) * x[1] + splat(direction[2]) * x[2];
}

/// Returns how far boxes reach along a direction, or, with a sign of -1, minus how far they reach back.
inline Float8 reach_of(const float* direction, const Boxes& boxes, float sign) {
  Float8 half{};
  for (int i = 0; i < 3; ++i) half += splat(__builtin_fabsf(direction[i])) * boxes.half[i];
  return along(direction, boxes.centre) + splat(sign) * half;
}

/// Returns the bounds (WaitingNodes::bound) that slabs of a width give; those of the parent where there is no
/// slab.
inline Float8 bound_of_slab(Float8 width, float parent) {
  const Float8 sure = width * splat(1 - 2 * kDistanceRounding);
  return larger(select(greater(sure, Float8{}), sure * sure, splat(parent)), splat(parent));
}

/// How far the children of two nodes reach along the direction: those of A ahead, those of B back.
struct Ends {
  Float8 of_a, of_b;
};

inline Ends ends_of(const Boxes& a, const Boxes& b, const Ahead& ahead) {
  return {reach_of(ahead.on_a, a, 1), reach_of(ahead.on_b, b, -1) + splat(ahead.between)};
}

/// Returns the same of triangles, all on A's axes.
inline Ends ends_of(const Corners& a, const Corners& b, const Ahead& ahead) {
  Float8 on_a[3], on_b[3];
  for (int corner = 0; corner < 3; ++corner) {
    on_a[corner] = along(ahead.on_a, a.x[corner]);
    on_b[corner] = along(ahead.on_a, b.x[corner]);
  }
  return {larger(larger(on_a[0], on_a[1]), on_a[2]),
          smaller(smaller(on_b[0], on_b[1]), on_b[2]) - splat(ahead.errors)};
}

/// Calls keep(i, lanes, bounds) for each box of A: the boxes of B that may be near enough.
template <class Keep>
inline void compare_boxes(DistanceKernel& k, const TreeNode& na, const Boxes& a, const TreeNode& nb,
                          const Boxes& b, const Between& w, const Ends& ends, float parent, Keep&& keep) {
  const Dropping dropping(k);
  k.tree.box_tests += static_cast<std::uint32_t>(na.count) * nb.count;
  Float8 slabs[8];
  std::uint32_t mask[8], rows = 0;
  for (int i = 0; i < na.count; ++i) {
    slabs[i] = bound_of_slab(ends.of_b - splat(ends.of_a[i]), parent);
    mask[i] = ~bits(greater(slabs[i], splat(dropping.square))) & present(nb);
    rows |= static_cast<std::uint32_t>(mask[i] != 0) << i;
  }
  if (rows == 0) return;
  const Turned at = turn_a<false>(a, w), bt = turn_b<false>(b, w);
  for (; rows != 0; rows &= rows - 1) {
    const int i = __builtin_ctz(rows);
    const Float8 bound = bounds_of(row_of(a, at, i), b, bt, slabs[i]);
    const std::uint32_t lanes = ~bits(greater(bound, splat(dropping.square))) & mask[i];
    if (lanes != 0) keep(i, lanes, bound);
  }
}

/// Returns how far a node's triangles, or the boxes of its children, reach along the kernel's direction.
template <Side kSide>
inline float find_end(const DistanceKernel& k, const TreeNode& n) {
  constexpr int kOf = static_cast<int>(kSide);
  const float ratio = kSide == Side::a ? k.tree.ratio_a : k.tree.ratio_b;
  const TreeNode& root = *(kSide == Side::a ? k.tree.nodes_a : k.tree.nodes_b);
  const LeafBlock* const blocks = kSide == Side::a ? k.tree.blocks_a : k.tree.blocks_b;
  double offset = 0;
  float direction[3];  // outward: the largest is looked for
  for (int i = 0; i < 3; ++i) {
    offset += (n.origin[i] - root.origin[i]) * static_cast<double>(k.direction[kOf][i]);
    direction[i] =
        kSide == Side::a ? dot3(n.frame[i], k.direction[kOf]) : -dot3(n.frame[i], k.direction[kOf]);
  }
  const float start = static_cast<float>(offset) * ratio;
  Float8 most;
  if (n.is_leaf) {
    Float8 corner[3];
    for (int c = 0; c < 3; ++c) {
      const auto& x = blocks[n.first].corner[c];
      corner[c] = splat(direction[0]) * load8(x[0]) + splat(direction[1]) * load8(x[1]) +
                  splat(direction[2]) * load8(x[2]);
    }
    most = larger(larger(corner[0], corner[1]), corner[2]) * splat(ratio);
  } else {
    most = reach_of(direction, decode(n, ratio), 1);
  }
  return kSide == Side::a ? start + largest_of(most) : start - largest_of(most);
}

template <Side kSide>
inline float end_of(DistanceKernel& k, std::uint32_t node) {
  NodeEnd& known = k.ends[static_cast<int>(kSide)][node];
  if (known.turn != k.turn)
    known = {find_end<kSide>(k, (kSide == Side::a ? k.tree.nodes_a : k.tree.nodes_b)[node]), k.turn};
  return known.end;
}

/// Returns where a pair of nodes is kept; what is there may be of another pair.
inline FarNodes& far_slot(const DistanceKernel& k, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t mixed = a * 0x9e3779b1U + b * 0x85ebca77U;
  return k.far[(mixed ^ mixed >> 15) & (k.far_slots - 1)];
}

/// Returns whether the slab that was between two nodes still is wide enough to drop them. Along its direction
/// n, what lies under A's node reaches from its origin as far as it did, and what lies under B's as far but
/// for the turn since: from M y to M' y, which is no more than |M' - M| |y|. How far the origins are apart
/// now is computed anew, with errors as in turn_to().
inline bool is_known_far(const DistanceKernel& k, std::uint32_t a, std::uint32_t b, float least) {
  const FarNodes& far = far_slot(k, a, b);
  if (far.a != a || far.b != b) return false;
  const TreeNode &na = k.tree.nodes_a[a], &nb = k.tree.nodes_b[b];
  const Float4 apart = offset_between(k.tree, na, nb);
  const float *n = far.direction, x[3] = {apart[0], apart[1], apart[2]};
  const float radius_b = nb.radius * k.tree.ratio_b;
  float sizes = 0, whole = na.radius * k.tree.ratio_a + radius_b;
  for (int i = 0; i < 3; ++i) {
    sizes += __builtin_fabsf(n[i]);
    whole += __builtin_fabsf(x[i]);
  }
  const float errors = 2 * (k.tree.slack + kKernelRounding * (k.tree.m_size * whole)) * sizes + kKernelTiny;
  const float turn = (k.turned - far.turned) * radius_b * kFloatUp;
  return (dot3(n, x) + far.width - turn - errors) * (1 - 2 * kDistanceRounding) > least;
}

/// Keeps for the next steps a plane that holds all under two nodes apart, if there is one across a way, given
/// on the axes of A's node, that is far enough from them.
template <class Of>
inline void keep_far(DistanceKernel& k, const WaitingNodes& pair, const TreeNode& na, const TreeNode& nb,
                     const Of& a, const Of& b, const Between& w, const float* way) {
  float direction[3];
  if (!direction_of(na, way, direction)) return;
  const Ends ends = ends_of(a, b, Ahead(na, w, direction));
  const float width = -largest_of(-ends.of_b) - largest_of(ends.of_a);
  if (!(width * (1 - 4 * kDistanceRounding) > dropped_from(k))) return;
  const Float4 apart = offset_between(k.tree, na, nb);
  const float x[3] = {apart[0], apart[1], apart[2]};
  FarNodes& far = far_slot(k, pair.a, pair.b);
  far.a = pair.a, far.b = pair.b;
  for (int i = 0; i < 3; ++i) far.direction[i] = direction[i];
  far.width = width - dot3(direction, x);
  far.turned = k.least_turned;
}

/// Lets a pair of nodes wait, unless their ends show that they are not near enough.
inline void wait_for(DistanceKernel& k, std::uint32_t a, std::uint32_t b, float bound,
                     const Dropping& dropping) {
  const float slab = (end_of<Side::b>(k, b) - end_of<Side::a>(k, a) + k.ahead) * (1 - 2 * kDistanceRounding);
  if (slab > 0 && slab * slab > bound) bound = slab * slab;
  if (bound > dropping.square || (k.far != nullptr && is_known_far(k, a, b, dropping.length))) return;
  push_waiting(k, {bound, a, b});
}

inline void distance_both(DistanceKernel& k, const TreeNode& na, const TreeNode& nb,
                          const WaitingNodes& pair) {
  const Between w = between<false>(k.tree, na, nb);
  const Boxes a = decode(na, k.tree.ratio_a), b = decode(nb, k.tree.ratio_b);
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
  if (k.far == nullptr || k.waiting_size != waited) return;
  keep_far(k, pair, na, nb, a, b, w, w.t);
}

/// Descends one node only: its boxes against the whole box of the other.
template <bool kDescendA>
inline void distance_one(DistanceKernel& k, const TreeNode& na, const TreeNode& nb,
                         const WaitingNodes& pair) {
  const Between w = between<false>(k.tree, na, nb);
  BoxGaps gaps;
  if constexpr (kDescendA) {
    const Boxes a = decode(na, k.tree.ratio_a);
    const Whole b = whole_of(nb, k.tree.ratio_b), on_a = turn_whole_b<false>(b, w);
    const Turned on_b = turn_a<false>(a, w);
    gaps.see(on_b.centre, on_b.half, b.centre, b.half);
    gaps.see(a.centre, a.half, on_a.centre, on_a.half);
  } else {
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
  std::uint32_t lanes = ~bits(greater(bound, splat(dropping.square))) & present(opened);
  for (; lanes != 0; lanes &= lanes - 1) {
    const int c = __builtin_ctz(lanes);
    const std::uint32_t child = opened.first + static_cast<std::uint32_t>(c);
    wait_for(k, kDescendA ? child : pair.a, kDescendA ? pair.b : child, bound[c], dropping);
  }
}

/// Pairs of simplices of two blocks, and the bounds of their boxes. There is room for eight more beyond the
/// last.
struct BoundedList {
  std::uint8_t a[72], b[72];
  float bound[72];
  std::uint32_t size = 0;

  /// Moves the nearest eight that are left to the front, and drops those that need not be looked at any more.
  void select_eight(std::uint32_t begin, float most) {
    std::uint32_t end = begin;
    for (std::uint32_t i = begin; i < size; ++i)
      if (!(bound[i] > most)) swap(i, end++);
    size = end;
    for (std::uint32_t front = begin; size - begin > 8 && front < begin + 8; ++front) {
      std::uint32_t least = front;
      for (std::uint32_t i = front + 1; i < size; ++i)
        if (bound[i] < bound[least]) least = i;
      swap(front, least);
    }
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

/// Sets the direction, given on A's axes.
inline void turn_to(DistanceKernel& k, const float* direction) {
  const TreeNode &a = k.tree.nodes_a[0], &b = k.tree.nodes_b[0];
  float sizes = 0, offsets = 0;
  double ahead = 0;
  for (int i = 0; i < 3; ++i) {
    k.direction[0][i] = direction[i];
    sizes += __builtin_fabsf(direction[i]);
    const double at_b =
        k.tree.m[0][i] * b.origin[0] + k.tree.m[1][i] * b.origin[1] + k.tree.m[2][i] * b.origin[2];
    const double offset = at_b * k.tree.ratio_b + k.tree.t[i] - a.origin[i] * k.tree.ratio_a;
    ahead += offset * direction[i];
    offsets += __builtin_fabsf(static_cast<float>(offset));
  }
  for (int j = 0; j < 3; ++j)
    k.direction[1][j] = k.tree.m_rows[0][j] * direction[0] + k.tree.m_rows[1][j] * direction[1] +
                        k.tree.m_rows[2][j] * direction[2];
  // As for one pair of nodes, see Ahead, with those of the roots.
  const float whole = k.tree.m_size * (a.radius * k.tree.ratio_a + b.radius * k.tree.ratio_b + offsets);
  const float errors = 2 * (k.tree.slack + kKernelRounding * whole) * sizes + kKernelTiny;
  k.ahead = static_cast<float>(ahead) - errors;
  ++k.turn;
}

/// Takes over which way the nearest points lie to each other. way: on the axes of A's node.
inline void look_ahead(DistanceKernel& k, const TreeNode& na, const float* way) {
  float direction[3];
  if (direction_of(na, way, direction)) turn_to(k, direction);
}

/// Takes over what floats say of some pairs.
inline void take_over(DistanceKernel& k, const Distances& d, const BoundedList& list, std::uint32_t begin,
                      std::uint32_t count, const TreeNode& na, const TreeNode& nb) {
  const LeafBlock &block_a = k.tree.blocks_a[na.first], &block_b = k.tree.blocks_b[nb.first];
  for (std::uint32_t lane = 0; lane < count; ++lane)
    if (d.upper[lane] < k.upper) {
      k.upper = d.upper[lane];
      k.best_a = block_a.simplex[list.a[begin + lane]];
      k.best_b = block_b.simplex[list.b[begin + lane]];
      const float way[3] = {d.way[0][lane], d.way[1][lane], d.way[2][lane]};
      look_ahead(k, na, way);
    }
  const Dropping dropping(k);
  for (std::uint32_t lane = 0; lane < count; ++lane) {
    const float box = list.bound[begin + lane];
    const float by_box = box > 0 ? __builtin_sqrtf(box) * (1 - kDistanceRounding) : 0;
    const float lower = d.lower[lane] > by_box ? d.lower[lane] : by_box;
    if (lower > dropping.length) continue;
    k.near[k.near_size++] = {block_a.simplex[list.a[begin + lane]], block_b.simplex[list.b[begin + lane]],
                             lower};
    if (!(lower > 0) && !k.apart) k.stop = KernelStop::doubtful;
  }
}

inline void distance_leaves(DistanceKernel& k, const TreeNode& na, const TreeNode& nb,
                            const WaitingNodes& pair) {
  const Between w = between<false>(k.tree, na, nb);
  Corners a, b;
  corners_of(k.tree, na, nb, w, a, b);
  BoundedList list;
  const Boxes boxes_a = decode(na, k.tree.ratio_a), boxes_b = decode(nb, k.tree.ratio_b);
  const Ends ends = ends_of(a, b, Ahead(na, w, k.direction[0]));
  compare_boxes(k, na, boxes_a, nb, boxes_b, w, ends, pair.bound,
                [&](int i, std::uint32_t lanes, Float8 bound) {
                  for (; lanes != 0; lanes &= lanes - 1) {
                    const int j = __builtin_ctz(lanes);
                    list.a[list.size] = static_cast<std::uint8_t>(i);
                    list.b[list.size] = static_cast<std::uint8_t>(j);
                    list.bound[list.size++] = bound[j];
                  }
                });
  float nearest = __builtin_inff(), way[3] = {w.t[0], w.t[1], w.t[2]};
  for (std::uint32_t begin = 0, count = 8; list.size > 0 && count == 8; begin += 8) {
    list.select_eight(begin, Dropping(k).square);
    if (begin >= list.size) break;
    count = list.size - begin < 8 ? list.size - begin : 8;
    k.triangle_pairs += count;
    const Distances d(pick(a, list.a + begin), pick(b, list.b + begin), w);
    take_over(k, d, list, begin, count, na, nb);
    if (k.far == nullptr) continue;
    for (std::uint32_t lane = 0; lane < count; ++lane)
      if (d.upper[lane] < nearest) {
        nearest = d.upper[lane];
        for (int i = 0; i < 3; ++i) way[i] = d.way[i][lane];
      }
  }
  if (k.far == nullptr || !(nearest > k.upper)) return;
  keep_far(k, pair, na, nb, a, b, w, way);
}

/// Which of a pair's nodes are opened: both of a pair of leaves.
struct Opening {
  bool a, b, leaves;

  Opening(const DistanceKernel& k, const TreeNode& na, const TreeNode& nb) {
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

/// Follows the nearest boxes down to a first pair of leaves, so that the walk has an upper end to begin with.
inline void descend_to_first_pair(DistanceKernel& k) {
  WaitingNodes at = k.waiting[0];
  const std::uint32_t bottom = k.waiting_size;
  for (;;) {
    const TreeNode& a = k.tree.nodes_a[at.a];
    const TreeNode& b = k.tree.nodes_b[at.b];
    ++k.tree.node_pairs;
    if (Opening(k, a, b).leaves) {
      distance_leaves(k, a, b, at);
      // Boxes that overlap all the way down: the exact query is likely to find that the bodies meet.
      if (!(at.bound > 0) && !k.apart) k.stop = KernelStop::doubtful;
      return;
    }
    // What is pushed is taken back but for the nearest.
    WaitingNodes* const heap = k.waiting;
    k.waiting += bottom;
    k.waiting_size = 0;
    distance_step(k, at);
    if (k.waiting_size > 0) at = k.waiting[0];
    const bool is_stuck = k.waiting_size == 0;
    k.waiting = heap;
    k.waiting_size = bottom;
    if (is_stuck || k.tree.node_pairs >= k.tree.most_node_pairs) return;
  }
}

}  // namespace

void LRB_DISTANCE_KERNEL_NAME(DistanceKernel& k) {
  k.stop = KernelStop::done;
  if (!k.begun) {
    k.begun = true;
    const float direction[3] = {k.direction[0][0], k.direction[0][1], k.direction[0][2]};
    turn_to(k, direction);
    if (k.descend) descend_to_first_pair(k);
    if (k.stop == KernelStop::doubtful) return;
  }
  while (k.waiting_size != 0 && !(k.waiting[0].bound > Dropping(k).square)) {
    if (k.upper <= k.enough) {
      k.stop = KernelStop::enough;
      return;
    }
    if (k.waiting_capacity - k.waiting_size < kRoomForStep || k.near_capacity - k.near_size < kRoomForStep) {
      k.stop = KernelStop::room;
      return;
    }
    if (k.tree.node_pairs >= k.tree.most_node_pairs) {
      k.stop = KernelStop::limit;
      return;
    }
    ++k.tree.node_pairs;
    distance_step(k, pop_waiting(k));
    if (k.stop == KernelStop::doubtful) return;
  }
  if (k.upper <= k.enough) k.stop = KernelStop::enough;
}

}  // namespace lrb
