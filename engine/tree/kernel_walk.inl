#pragma once
// Part of tree_kernel.inl and affine_kernel.inl: the descent of two trees. The type Walk knows how nodes lie
// to each other.

#include "engine/tree/kernel_triangles.inl"
#include "engine/tree/kernel_whole.inl"

namespace lrb {
namespace {

/// Returns the gap between boxes on the axis on which they are furthest apart; negative if they overlap on
/// all axes.
inline Float8 gap_between(const Float8* centre, const Float8* half, const float* other_centre,
                          const float* other_half) {
  Float8 gap = abs8(centre[0] - splat(other_centre[0])) - (half[0] + splat(other_half[0]));
  for (int i = 1; i < 3; ++i)
    gap = larger(gap, abs8(centre[i] - splat(other_centre[i])) - (half[i] + splat(other_half[i])));
  return gap;
}

/// Where two or more pairs may meet: the gaps (see gap_between()) from box i of A to the boxes of B.
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

/// Finds which of A's boxes may meet which of B's: mask[k] has a bit for each of B's boxes that A's box k may
/// meet. Most pairs of nodes are apart, and most of these show it in the first test. kGaps: finds the gaps,
/// too.
template <bool kMargin, bool kGaps, class Lie>
inline std::uint64_t pair_masks(TreeKernel& k, const TreeNode& na, const TreeNode& nb, const Lie& w,
                                Gaps* gaps = nullptr) {
  k.box_tests += na.count + nb.count;
  const Whole whole_a = whole_on_own(whole_of(na, k.ratio_a), Side::a, w);
  const Boxes b = decode(nb, k.ratio_b);
  const Turned bt = turn_b<kMargin>(b, w);
  const std::uint32_t mask_b = ~bits(apart(bt.centre, bt.half, whole_a.centre, whole_a.half)) & present(nb);
  if (mask_b == 0) return 0;
  const Whole whole_b = whole_on_own(whole_of(nb, k.ratio_b), Side::b, w);
  const Boxes a = decode(na, k.ratio_a);
  const Turned at = turn_a<kMargin>(a, w);
  const std::uint32_t mask_a = ~bits(apart(at.centre, at.half, whole_b.centre, whole_b.half)) & present(na);
  const Boxes &own_a = boxes_on_own(a, Side::a, w), &own_b = boxes_on_own(b, Side::b, w);
  const auto in_mask_b = static_cast<unsigned>(__builtin_popcount(mask_b));
  std::uint64_t all = 0;
  int alone =
      -1;  // the only row so far, if it has one pair: its gap is not needed unless there is another row
  for (std::uint32_t todo = mask_a; todo != 0; todo &= todo - 1) {
    const int i = __builtin_ctz(todo);
    const Row row = row_of(own_a, at, i);
    const Lanes gap = either(apart(bt.centre, bt.half, row.own_centre, row.own_half),
                             apart(own_b.centre, own_b.half, row.turned_centre, row.turned_half));
    const std::uint32_t mask = ~bits(gap) & mask_b;
    k.box_tests += in_mask_b;
    if constexpr (kGaps) {
      if (mask == 0) continue;
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

/// Writes the corners of two leaves' simplices to `a` and `b`, in the frame of A's leaf and query units, and
/// returns the bounds on their errors: those of the two nodes.
inline const Between& corners_of(const TreeKernel& k, const TreeNode& na, const TreeNode& nb,
                                 const Between& w, Corners& a, Corners& b) {
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

/// Fetches all cache lines of a node.
inline void prefetch(const TreeNode& n) {
  constexpr std::size_t kLine = 64;
  for (std::size_t at = 0; at < sizeof n; at += kLine)
    __builtin_prefetch(reinterpret_cast<const char*>(&n) + at);
}

inline void push(TreeKernel& k, std::uint32_t a, std::uint32_t b) {
  prefetch(k.nodes_a[a]);
  prefetch(k.nodes_b[b]);
  k.stack[k.stack_size++] = {a, b};
}

/// Sorts the pairs that were pushed last, so that the one with the least gap comes last; if there are many,
/// moves only that one.
inline void nearest_last(NodePair* pairs, float* gaps, std::uint32_t size) {
  constexpr std::uint32_t kFew = 8;
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
  std::uint32_t nearest = 0;
  for (std::uint32_t i = 1; i < size; ++i)
    if (gaps[i] < gaps[nearest]) nearest = i;
  const NodePair last = pairs[size - 1];
  pairs[size - 1] = pairs[nearest];
  pairs[nearest] = last;
}

/// Descends both nodes. kNearest: first into the pair whose boxes overlap most. Where one pair of simplices
/// is enough, it is likely to be there.
template <class Walk, bool kNearest>
inline void descend_both(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  Gaps gaps;
  const std::uint64_t pairs = pair_masks<Walk::kMargin, kNearest>(k, na, nb, Walk::between(k, na, nb), &gaps);
  float gap_of[64];
  const std::uint32_t bottom = k.stack_size;
  for (std::uint64_t c = pairs; c != 0; c &= c - 1) {
    const std::uint32_t at = static_cast<std::uint32_t>(__builtin_ctzll(c)), i = at / 8, j = at % 8;
    if constexpr (kNearest) gap_of[k.stack_size - bottom] = gaps.of[i][j];
    push(k, na.first + i, nb.first + j);
  }
  if constexpr (kNearest) nearest_last(k.stack + bottom, gap_of, k.stack_size - bottom);
}

/// Descends A's node only: its boxes against the whole box of B's, in both frames.
template <class Walk>
inline void descend_a(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t b_index) {
  const Boxes a = decode(na, k.ratio_a);
  const Whole b = whole_of(nb, k.ratio_b);
  const auto w = Walk::between(k, na, nb);
  const Turned at = turn_a<Walk::kMargin>(a, w);
  const Whole bt = turn_whole_b<Walk::kMargin>(b, w), own_b = whole_on_own(b, Side::b, w);
  const Boxes& own_a = boxes_on_own(a, Side::a, w);
  const Lanes gap = either(apart(at.centre, at.half, own_b.centre, own_b.half),
                           apart(own_a.centre, own_a.half, bt.centre, bt.half));
  k.box_tests += na.count;
  for (std::uint32_t c = ~bits(gap) & present(na); c != 0; c &= c - 1)
    push(k, na.first + static_cast<std::uint32_t>(__builtin_ctz(c)), b_index);
}

/// Descends B's node only.
template <class Walk>
inline void descend_b(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t a_index) {
  const Whole a = whole_of(na, k.ratio_a);
  const Boxes b = decode(nb, k.ratio_b);
  const auto w = Walk::between(k, na, nb);
  const Turned bt = turn_b<Walk::kMargin>(b, w);
  const Whole at = turn_whole_a<Walk::kMargin>(a, w), own_a = whole_on_own(a, Side::a, w);
  const Boxes& own_b = boxes_on_own(b, Side::b, w);
  const Lanes gap = either(apart(bt.centre, bt.half, own_a.centre, own_a.half),
                           apart(own_b.centre, own_b.half, at.centre, at.half));
  k.box_tests += nb.count;
  for (std::uint32_t c = ~bits(gap) & present(nb); c != 0; c &= c - 1)
    push(k, a_index, nb.first + static_cast<std::uint32_t>(__builtin_ctz(c)));
}

/// Pairs of simplices of two blocks, by their numbers there. There is room for eight more beyond the last.
struct PairList {
  std::uint8_t a[72], b[72];
  std::uint32_t size = 0;
};

inline void list_pairs(std::uint64_t pairs, PairList& list) {
  for (; pairs != 0; pairs &= pairs - 1) {
    const int at = __builtin_ctzll(pairs);
    list.a[list.size] = static_cast<std::uint8_t>(at / 8);
    list.b[list.size++] = static_cast<std::uint8_t>(at % 8);
  }
  __builtin_memset(list.a + list.size, 0, 8);
  __builtin_memset(list.b + list.size, 0, 8);
}

/// Notes the pairs that planes part, of eight in a list.
[[gnu::noinline, gnu::cold]] inline void note_parted(TreeKernel& k, const LeafBlock& a, const LeafBlock& b,
                                                     const PairList& list, std::uint32_t begin,
                                                     std::uint32_t by_a, std::uint32_t by_b) {
  for (std::uint32_t c = by_a | by_b; c != 0; c &= c - 1) {
    const std::uint32_t lane = static_cast<std::uint32_t>(__builtin_ctz(c));
    k.parted[k.parted_size++] = {a.simplex[list.a[begin + lane]], b.simplex[list.b[begin + lane]],
                                 by_a >> lane & 1 ? Side::a : Side::b};
  }
}

template <class Walk>
inline void leaf_pair(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  constexpr bool kMargin = Walk::kMargin;
  const auto w = Walk::between(k, na, nb);
  const std::uint64_t pairs = pair_masks<kMargin, false>(k, na, nb, w);
  if (pairs == 0) return;
  const LeafBlock& block_a = k.blocks_a[na.first];
  const LeafBlock& block_b = k.blocks_b[nb.first];
  PairList list;
  list_pairs(pairs, list);
  k.prefilter_tests += list.size;
  Corners a, b;
  const Between& errors = corners_of(k, na, nb, w, a, b);
  for (std::uint32_t begin = 0; begin < list.size; begin += 8) {
    const Corners some_a = pick(a, list.a + begin), some_b = pick(b, list.b + begin);
    const SideLanes b_sides = sides_of_planes<kMargin>(some_a, some_b, errors, errors.edge_error[0]);
    const SideLanes a_sides = sides_of_planes<kMargin>(some_b, some_a, errors, errors.edge_error[1]);
    const std::uint32_t here = list.size - begin < 8 ? (1u << (list.size - begin)) - 1 : 255u;
    const std::uint32_t left = ~bits(either(a_sides.parted, b_sides.parted)) & here;
    if (k.parted != nullptr && left != here) [[unlikely]]
      note_parted(k, block_a, block_b, list, begin, bits(b_sides.parted) & here, bits(a_sides.parted) & here);
    if (left == 0) continue;
    EightCertainties certainties;
    if constexpr (!kMargin) certainties = certainties_of(some_a, a_sides, some_b, b_sides, errors, left);
    for (std::uint32_t c = left; c != 0; c &= c - 1) {
      const int lane = __builtin_ctz(c);
      const std::uint32_t pair = begin + static_cast<std::uint32_t>(lane);
      Candidate& found = k.out[k.out_size++];
      found = {block_a.simplex[list.a[pair]], block_b.simplex[list.b[pair]], Certainty::none, Side::a, 0};
      if constexpr (!kMargin) certainties.tell(lane, found);
    }
  }
}

/// Compares what is in two nodes. Puts pairs of their children that may meet on the stack.
template <class Walk, bool kNearest>
inline void open(TreeKernel& k, const NodePair& pair) {
  const TreeNode& a = k.nodes_a[pair.a];
  const TreeNode& b = k.nodes_b[pair.b];
  ++k.node_pairs;
  k.opened = pair;
  k.opened_at = k.stack_size;
  const float size_a = Walk::size(k, a, Side::a), size_b = Walk::size(k, b, Side::b);
  const bool hold_a = a.is_leaf || size_b > kMuchLarger * size_a;
  const bool hold_b = b.is_leaf || size_a > kMuchLarger * size_b;
  if (a.is_leaf && b.is_leaf)
    leaf_pair<Walk>(k, a, b);
  else if (!a.is_leaf && hold_b)
    descend_a<Walk>(k, a, b, pair.b);
  else if (!b.is_leaf && hold_a)
    descend_b<Walk>(k, a, b, pair.a);
  else
    descend_both<Walk, kNearest>(k, a, b);
}

/// Returns true if there is room for what may come of a pair of leaves, and not yet `end` pairs of nodes.
inline bool may_go_on(const TreeKernel& k, std::uint64_t end) {
  return k.out_capacity - k.out_size >= 64 && k.node_pairs < end;
}

template <class Walk, bool kNearest>
void run(TreeKernel& k, std::uint64_t end) {
  while (k.stack_size != 0 && may_go_on(k, end)) {
    const NodePair pair = k.stack[--k.stack_size];
    open<Walk, kNearest>(k, pair);
  }
}

/// Notes the pairs of nodes that are parted as wholes.
[[gnu::noinline]] inline void note_parted_nodes(TreeKernel& k, const NodePair* pairs, std::uint32_t apart) {
  for (; apart != 0; apart &= apart - 1) k.parted_nodes[k.parted_nodes_size++] = pairs[__builtin_ctz(apart)];
}

/// Compares whole nodes, the first pairs on the stack, and moves those that may meet to `tested`. `count`: at
/// most 8.
inline void test_wholes(TreeKernel& k, const NodePair* pairs, std::uint32_t count) {
  const std::uint32_t apart = pairs_apart(k, pairs, count);
  const auto parted = static_cast<unsigned>(__builtin_popcount(apart));
  k.node_pairs += parted;
  k.box_tests += parted;
  if (k.parted_nodes != nullptr && apart != 0) [[unlikely]]
    note_parted_nodes(k, pairs, apart);
  for (std::uint32_t c = ~apart & ((1u << count) - 1); c != 0; c &= c - 1)
    k.tested[k.tested_size++] = pairs[__builtin_ctz(c)];
}

/// Does so for all full eights that have come onto the stack, and if nothing else is to be done for the rest
/// of them, too, or for the last ones of those that waited before.
inline void test_stack(TreeKernel& k) {
  const std::uint32_t came = k.stack_size - k.base, eights = came - came % 8;
  NodePair* const pairs = k.stack + k.base;
  for (std::uint32_t at = 0; at < eights; at += 8) test_wholes(k, pairs + at, 8);
  std::uint32_t left = came - eights;
  if (k.tested_size != 0) {
    for (std::uint32_t i = 0; i < left; ++i) pairs[i] = pairs[eights + i];
    k.stack_size = k.base + left;
    return;
  }
  if (came == 0) {
    left = k.base < 8 ? k.base : 8;
    k.base -= left;
  }
  k.stack_size = k.base;
  if (left != 0) test_wholes(k, k.stack + (k.base + eights), left);
}

/// Does what run() does, but compares whole nodes before what is in them: half of the pairs end there, for a
/// fraction of the work, if eight are compared at a time. So that there are eight, pairs wait for others.
template <class Walk>
void run_tested(TreeKernel& k, std::uint64_t end) {
  while (k.stack_size + k.tested_size != 0 && may_go_on(k, end)) {
    if (k.stack_size - k.base >= 8 || k.tested_size == 0) {
      test_stack(k);
    } else {
      const NodePair pair = k.tested[--k.tested_size];
      ++k.box_tests;  // of the whole nodes
      open<Walk, false>(k, pair);
    }
  }
}

/// The nearest pair of boxes is looked for in the first so many pairs of nodes: bodies that meet mostly show
/// it in these, and for bodies that do not meet any order is as good.
constexpr std::uint64_t kNearestPairs = 8;

/// Begins with the nearest boxes, where one pair of simplices is enough.
template <class Walk>
void run_nearest(TreeKernel& k) {
  if (k.node_pairs >= kNearestPairs) return;
  const std::uint64_t most = k.most_node_pairs;
  run<Walk, true>(k, kNearestPairs < most ? kNearestPairs : most);
  k.base = k.stack_size;
}

}  // namespace
}  // namespace lrb
