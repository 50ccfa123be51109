#pragma once
// Part of tree_kernel.inl, affine_kernel.inl and near_kernel.inl: the dual traversal of two trees. The type
// Walk computes the relative position of two nodes, decides which boxes are dropped, and compares the
// simplices of two leaves.

#include "engine/tree/kernel_triangles.inl"
#include "engine/tree/kernel_whole.inl"

namespace lrb {
namespace {

/// Returns the largest gap between boxes on any axis; negative if they overlap on all axes.
inline Float8 gap_between(const Float8* centre, const Float8* half, const float* other_centre,
                          const float* other_half) {
  Float8 gap = abs8(centre[0] - splat(other_centre[0])) - (half[0] + splat(other_half[0]));
  for (int i = 1; i < 3; ++i)
    gap = larger(gap, abs8(centre[i] - splat(other_centre[i])) - (half[i] + splat(other_half[i])));
  return gap;
}

/// The gaps (see gap_between()) from box i of A to the boxes of B. Set only if at least two pairs may
/// intersect.
struct Gaps {
  Float8 of[8];
};

/// One of A's boxes, on its own axes and on B's.
struct Row {
  float own_centre[3], own_half[3], turned_centre[3], turned_half[3];
};

inline Row row_of(const Boxes& own, const Turned& turned, int i) {
  const auto* own_centre = reinterpret_cast<const float*>(own.centre);
  const auto* own_half = reinterpret_cast<const float*>(own.half);
  const auto* turned_centre = reinterpret_cast<const float*>(turned.centre);
  const auto* turned_half = reinterpret_cast<const float*>(turned.half);
  return {{own_centre[i], own_centre[8 + i], own_centre[16 + i]},
          {own_half[i], own_half[8 + i], own_half[16 + i]},
          {turned_centre[i], turned_centre[8 + i], turned_centre[16 + i]},
          {turned_half[i], turned_half[8 + i], turned_half[16 + i]}};
}

inline Float8 gaps_of(const Row& row, const Boxes& own_b, const Turned& bt) {
  return larger(gap_between(bt.centre, bt.half, row.own_centre, row.own_half),
                gap_between(own_b.centre, own_b.half, row.turned_centre, row.turned_half));
}

/// Finds the pairs of boxes that may intersect: bit 8 i + j of the result is set for box i of A and box j of
/// B. The separating axes are the six face normals, without cross products of edges ("SAT lite", van den
/// Bergen 1997). Most pairs of nodes are disjoint, and the first test rejects most of these. kGaps: also
/// computes the gaps.
template <class Walk, bool kGaps, class Lie>
inline std::uint64_t pair_masks(TreeKernel& k, const TreeNode& na, const TreeNode& nb, const Lie& w,
                                Gaps* gaps = nullptr) {
  constexpr bool kMargin = Walk::kMargin;
  // Step 1: B's boxes against the node box of A, on A's axes.
  k.box_tests += na.count + nb.count;
  const Whole whole_a = whole_on_own(whole_of(na, k.ratio_a), Side::a, w);
  const Boxes b = decode(nb, k.ratio_b);
  const Turned bt = turn_b<kMargin>(b, w);
  const std::uint32_t mask_b =
      ~bits(Walk::apart(bt.centre, bt.half, whole_a.centre, whole_a.half, w)) & present(nb);
  if (mask_b == 0) return 0;
  // Step 2: A's boxes against the node box of B, on B's axes.
  const Whole whole_b = whole_on_own(whole_of(nb, k.ratio_b), Side::b, w);
  const Boxes a = decode(na, k.ratio_a);
  const Turned at = turn_a<kMargin>(a, w);
  const std::uint32_t mask_a =
      ~bits(Walk::apart(at.centre, at.half, whole_b.centre, whole_b.half, w)) & present(na);
  // Step 3: each remaining box of A against all boxes of B at once, on the axes of both.
  const Boxes &own_a = boxes_on_own(a, Side::a, w), &own_b = boxes_on_own(b, Side::b, w);
  const auto in_mask_b = static_cast<unsigned>(__builtin_popcount(mask_b));
  std::uint64_t all = 0;
  // The only row so far, if it has one pair: its gap is needed only if there is another row
  int alone = -1;
  for (std::uint32_t todo = mask_a; todo != 0; todo &= todo - 1) {
    const int i = __builtin_ctz(todo);
    const Row row = row_of(own_a, at, i);
    const Lanes gap = either(Walk::apart(bt.centre, bt.half, row.own_centre, row.own_half, w),
                             Walk::apart(own_b.centre, own_b.half, row.turned_centre, row.turned_half, w));
    // Boxes of B that step 1 rejected stay rejected.
    const std::uint32_t mask = ~bits(gap) & mask_b;
    k.box_tests += in_mask_b;
    if constexpr (kGaps) {
      if (mask == 0) continue;
      // A single pair needs no gap, because there is nothing to sort. Its row is computed when a second pair
      // appears.
      if (all == 0 && (mask & (mask - 1)) == 0) {
        alone = i;
      } else {
        if (alone >= 0) gaps->of[alone] = gaps_of(row_of(own_a, at, alone), own_b, bt);
        alone = -1;
        gaps->of[i] = gaps_of(row, own_b, bt);
      }
    }
    all |= static_cast<std::uint64_t>(mask) << (8 * i);
  }
  return all;
}

/// Writes the corners of two leaves' simplices to `a` and `b`, in the frame of A's leaf and query units.
/// Returns their error bounds: those of the two nodes.
inline const Between& corners_of(const TreeKernel& k, const TreeNode& na, const TreeNode& nb,
                                 const Between& w, Corners& a, Corners& b) {
  // A's corners are only scaled: A's leaf frame is the common frame. B's are rotated and translated to it.
  const LeafBlock& block_a = k.blocks_a[na.first];
  const LeafBlock& block_b = k.blocks_b[nb.first];
  for (int corner = 0; corner < 3; ++corner) {
    Float8 own[3];
    for (int axis = 0; axis < 3; ++axis) {
      a.x[corner][axis] = load8(block_a.corner[corner][axis]) * splat(k.ratio_a);
      own[axis] = load8(block_b.corner[corner][axis]) * splat(k.ratio_b);
    }
    for (int i = 0; i < 3; ++i)
      b.x[corner][i] =
          splat(w.t[i]) + splat(w.r[i][0]) * own[0] + splat(w.r[i][1]) * own[1] + splat(w.r[i][2]) * own[2];
  }
  return w;
}

/// Prefetches all cache lines of a node.
inline void prefetch(const TreeNode& n) {
  // A node has 192 bytes, three cache lines.
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < sizeof n; at += kLine)
    __builtin_prefetch(reinterpret_cast<const char*>(&n) + at);
}

inline void push(TreeKernel& k, std::uint32_t a, std::uint32_t b) {
  // Prefetch now: in a depth-first traversal the pair is read a few steps later.
  prefetch(k.nodes_a[a]);
  prefetch(k.nodes_b[b]);
  k.stack[k.stack_size++] = {a, b};
}

/// Moves the pair with the smallest gap among the last `size` pairs to the top of the stack. Sorts all of
/// them if there are few.
inline void nearest_last(NodePair* pairs, float* gaps, std::uint32_t size) {
  constexpr std::uint32_t kFew = 8;
  // Insertion sort by descending gap, for a short list.
  if (size <= kFew) {
    for (std::uint32_t i = 1; i < size; ++i) {
      const NodePair pair = pairs[i];
      const float gap = gaps[i];
      std::uint32_t at = i;
      for (; at > 0 && gaps[at - 1] < gap; --at) {
        gaps[at] = gaps[at - 1];
        pairs[at] = pairs[at - 1];
      }
      gaps[at] = gap;
      pairs[at] = pair;
    }
    return;
  }
  // Many pairs: one linear pass finds the closest, instead of a sort.
  std::uint32_t nearest = 0;
  for (std::uint32_t i = 1; i < size; ++i)
    if (gaps[i] < gaps[nearest]) nearest = i;
  const NodePair last = pairs[size - 1];
  pairs[size - 1] = pairs[nearest];
  pairs[nearest] = last;
}

/// Descends both nodes. kNearest: visits the pair with the deepest overlap of boxes first, where an
/// intersecting pair of simplices is most likely.
template <class Walk, bool kNearest>
inline void descend_both(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  // All 64 combinations of children are decided before any is pushed.
  Gaps gaps;
  const std::uint64_t pairs = pair_masks<Walk, kNearest>(k, na, nb, Walk::between(k, na, nb), &gaps);
  float gap_of[64];
  const std::uint32_t bottom = k.stack_size;
  for (std::uint64_t c = pairs; c != 0; c &= c - 1) {
    const std::uint32_t at = static_cast<std::uint32_t>(__builtin_ctzll(c)), i = at / 8, j = at % 8;
    if constexpr (kNearest) gap_of[k.stack_size - bottom] = gaps.of[i][j];
    push(k, na.first + i, nb.first + j);
  }
  if constexpr (kNearest) nearest_last(k.stack + bottom, gap_of, k.stack_size - bottom);
}

/// Descends only A's node: its boxes against the node box of B, in both frames.
template <class Walk>
inline void descend_a(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t b_index) {
  const Boxes a = decode(na, k.ratio_a);
  const Whole b = whole_of(nb, k.ratio_b);
  const auto w = Walk::between(k, na, nb);
  const Turned at = turn_a<Walk::kMargin>(a, w);
  const Whole bt = turn_whole_b<Walk::kMargin>(b, w), own_b = whole_on_own(b, Side::b, w);
  const Boxes& own_a = boxes_on_own(a, Side::a, w);
  // Six separating axes for each of A's boxes, in one pass over eight lanes.
  const Lanes gap = either(Walk::apart(at.centre, at.half, own_b.centre, own_b.half, w),
                           Walk::apart(own_a.centre, own_a.half, bt.centre, bt.half, w));
  k.box_tests += na.count;
  for (std::uint32_t c = ~bits(gap) & present(na); c != 0; c &= c - 1)
    push(k, na.first + static_cast<std::uint32_t>(__builtin_ctz(c)), b_index);
}

/// Descends only B's node.
template <class Walk>
inline void descend_b(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t a_index) {
  const Whole a = whole_of(na, k.ratio_a);
  const Boxes b = decode(nb, k.ratio_b);
  const auto w = Walk::between(k, na, nb);
  const Turned bt = turn_b<Walk::kMargin>(b, w);
  const Whole at = turn_whole_a<Walk::kMargin>(a, w), own_a = whole_on_own(a, Side::a, w);
  const Boxes& own_b = boxes_on_own(b, Side::b, w);
  const Lanes gap = either(Walk::apart(bt.centre, bt.half, own_a.centre, own_a.half, w),
                           Walk::apart(own_b.centre, own_b.half, at.centre, at.half, w));
  k.box_tests += nb.count;
  for (std::uint32_t c = ~bits(gap) & present(nb); c != 0; c &= c - 1)
    push(k, a_index, nb.first + static_cast<std::uint32_t>(__builtin_ctz(c)));
}

/// Pairs of simplices of two blocks, by their indices there. Has space for eight more than 64.
struct PairList {
  std::uint8_t a[72], b[72];
  std::uint32_t size = 0;
};

inline void list_pairs(std::uint64_t pairs, PairList& list) {
  // Unpack bit 8 i + j into (i, j), lowest bit first.
  for (; pairs != 0; pairs &= pairs - 1) {
    const int at = __builtin_ctzll(pairs);
    list.a[list.size] = static_cast<std::uint8_t>(at / 8);
    list.b[list.size++] = static_cast<std::uint8_t>(at % 8);
  }
  // Pad to a multiple of eight with simplex 0: lanes beyond the list are computed and masked out.
  __builtin_memset(list.a + list.size, 0, 8);
  __builtin_memset(list.b + list.size, 0, 8);
}

/// Records the pairs of a batch that are separated by a plane of one of their simplices.
[[gnu::noinline, gnu::cold]] inline void note_rejected(TreeKernel& k, const LeafBlock& a, const LeafBlock& b,
                                                       const PairList& list, std::uint32_t begin,
                                                       std::uint32_t by_a, std::uint32_t by_b) {
  for (std::uint32_t c = by_a | by_b; c != 0; c &= c - 1) {
    const std::uint32_t lane = static_cast<std::uint32_t>(__builtin_ctz(c));
    k.rejected[k.rejected_size++] = {a.simplex[list.a[begin + lane]], b.simplex[list.b[begin + lane]],
                                     by_a >> lane & 1 ? Side::a : Side::b};
  }
}

template <class Walk>
inline void leaf_pair(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  constexpr bool kMargin = Walk::kMargin;
  const auto w = Walk::between(k, na, nb);
  // Pass 1: boxes of the simplices.
  const std::uint64_t pairs = pair_masks<Walk, false>(k, na, nb, w);
  if (pairs == 0) return;
  // Pass 2: list the remaining pairs, so that the lanes of the next passes are full.
  const LeafBlock& block_a = k.blocks_a[na.first];
  const LeafBlock& block_b = k.blocks_b[nb.first];
  PairList list;
  list_pairs(pairs, list);
  k.prefilter_tests += list.size;
  Corners a, b;
  const Between& errors = corners_of(k, na, nb, w, a, b);
  for (std::uint32_t begin = 0; begin < list.size; begin += 8) {
    // Pass 3: planes. A pair is separated if all corners of one are on one side of the other's plane.
    const Corners some_a = pick(a, list.a + begin), some_b = pick(b, list.b + begin);
    const SideLanes b_sides = sides_of_planes<kMargin>(some_a, some_b, errors, errors.edge_error[0]);
    const SideLanes a_sides = sides_of_planes<kMargin>(some_b, some_a, errors, errors.edge_error[1]);
    // `current` masks the lanes in use; only the last batch may have fewer than eight.
    const std::uint32_t current = list.size - begin < 8 ? (1u << (list.size - begin)) - 1 : 255u;
    const std::uint32_t left = ~bits(either(a_sides.rejected, b_sides.rejected)) & current;
    if (k.rejected != nullptr && left != current) [[unlikely]]
      note_rejected(k, block_a, block_b, list, begin, bits(b_sides.rejected) & current,
                    bits(a_sides.rejected) & current);
    // Pass 4: decide the remaining pairs as far as float arithmetic can. Exact tests get the undecided ones.
    if (left == 0) continue;
    EightCertainties certainties;
    if constexpr (!kMargin) certainties = certainties_of(some_a, a_sides, some_b, b_sides, errors, left);
    for (std::uint32_t c = left; c != 0; c &= c - 1) {
      const int lane = __builtin_ctz(c);
      const std::uint32_t pair = begin + static_cast<std::uint32_t>(lane);
      Candidate& found = k.out[k.out_size++];
      found = {block_a.simplex[list.a[pair]], block_b.simplex[list.b[pair]], Certainty::none, Side::a, 0};
      if constexpr (!kMargin) certainties.write(lane, found);
    }
  }
}

/// Compares the boxes in two nodes. Pushes the pairs of children that may intersect.
template <class Walk, bool kNearest>
inline void open(TreeKernel& k, const NodePair& pair) {
  const TreeNode& a = k.nodes_a[pair.a];
  const TreeNode& b = k.nodes_b[pair.b];
  ++k.node_pairs;
  k.opened = pair;
  k.opened_at = k.stack_size;
  // Descend both nodes, or only the larger one if the other is a leaf or much smaller.
  const float size_a = Walk::size(k, a, Side::a), size_b = Walk::size(k, b, Side::b);
  const bool hold_a = a.is_leaf || size_b > kMuchLarger * size_a;
  const bool hold_b = b.is_leaf || size_a > kMuchLarger * size_b;
  if (a.is_leaf && b.is_leaf)
    Walk::leaves(k, a, b);
  else if (!a.is_leaf && hold_b)
    descend_a<Walk>(k, a, b, pair.b);
  else if (!b.is_leaf && hold_a)
    descend_b<Walk>(k, a, b, pair.a);
  else
    descend_both<Walk, kNearest>(k, a, b);
}

/// Returns true if `out` has space for all 64 pairs of two leaves, and fewer than `end` pairs of nodes were
/// visited.
inline bool may_go_on(const TreeKernel& k, std::uint64_t end) {
  return k.out_capacity - k.out_size >= 64 && k.node_pairs < end;
}

template <class Walk, bool kNearest>
void run(TreeKernel& k, std::uint64_t end) {
  // Depth-first traversal with an explicit stack. It can stop after any pair and be resumed.
  while (k.stack_size != 0 && may_go_on(k, end)) {
    const NodePair pair = k.stack[--k.stack_size];
    open<Walk, kNearest>(k, pair);
  }
}

/// Records the pairs of nodes that are rejected by their node boxes.
[[gnu::noinline]] inline void note_rejected_nodes(TreeKernel& k, const NodePair* pairs, std::uint32_t apart) {
  for (; apart != 0; apart &= apart - 1)
    k.rejected_nodes[k.rejected_nodes_size++] = pairs[__builtin_ctz(apart)];
}

/// Tests the node boxes of up to 8 pairs and moves those that may intersect to `tested`.
inline void test_wholes(TreeKernel& k, const NodePair* pairs, std::uint32_t count) {
  const std::uint32_t apart = pairs_disjoint(k, pairs, count);
  const auto rejected = static_cast<unsigned>(__builtin_popcount(apart));
  k.node_pairs += rejected;
  k.box_tests += rejected;
  if (k.rejected_nodes != nullptr && apart != 0) [[unlikely]]
    note_rejected_nodes(k, pairs, apart);
  for (std::uint32_t c = ~apart & ((1u << count) - 1); c != 0; c &= c - 1)
    k.tested[k.tested_size++] = pairs[__builtin_ctz(c)];
}

/// Tests all complete batches of eight pairs on the stack. If no tested pair is left to expand, also tests an
/// incomplete batch, or the last pairs below `base`.
inline void test_stack(TreeKernel& k) {
  // Complete batches first: SIMD lanes are full.
  const std::uint32_t came = k.stack_size - k.base, eights = came - came % 8;
  NodePair* const pairs = k.stack + k.base;
  for (std::uint32_t at = 0; at < eights; at += 8) test_wholes(k, pairs + at, 8);
  std::uint32_t left = came - eights;
  // There is other work: the incomplete batch waits at the bottom of the stack for more pairs.
  if (k.tested_size != 0) {
    for (std::uint32_t i = 0; i < left; ++i) pairs[i] = pairs[eights + i];
    k.stack_size = k.base + left;
    return;
  }
  // No new pairs: take up to eight of those left by the search for the closest boxes.
  if (came == 0) {
    left = k.base < 8 ? k.base : 8;
    k.base -= left;
  }
  k.stack_size = k.base;
  if (left != 0) test_wholes(k, k.stack + (k.base + eights), left);
}

/// As run(), but tests node boxes before the boxes inside. This rejects half of the pairs, at a fraction of
/// the cost if eight are tested at a time. Pairs wait until a batch of eight is complete.
template <class Walk>
void run_tested(TreeKernel& k, std::uint64_t end) {
  while (k.stack_size + k.tested_size != 0 && may_go_on(k, end)) {
    // Test if a batch is complete or no tested pair is left. Otherwise expand a tested pair, which may push
    // more.
    if (k.stack_size - k.base >= 8 || k.tested_size == 0) {
      test_stack(k);
    } else {
      const NodePair pair = k.tested[--k.tested_size];
      ++k.box_tests;  // for the node boxes
      open<Walk, false>(k, pair);
    }
  }
}

/// Number of pairs of nodes for which the closest boxes are visited first. If bodies intersect, an
/// intersecting pair is mostly found within these; for disjoint bodies the order is irrelevant.
constexpr std::uint64_t kNearestPairs = 8;

/// Starts with the closest boxes, if one pair of simplices is enough.
template <class Walk>
void run_nearest(TreeKernel& k) {
  // A resumed traversal has done this already.
  if (k.node_pairs >= kNearestPairs) return;
  const std::uint64_t most = k.max_node_pairs;
  run<Walk, true>(k, kNearestPairs < most ? kNearestPairs : most);
  // The remaining pairs stay at the bottom of the stack, below `base`; run_tested() processes them last.
  k.base = k.stack_size;
}

}  // namespace
}  // namespace lrb
