// Compiled once per instruction set by tree_kernel_*.cpp, which define LRB_KERNEL_NAME. Only plain loops over
// plain arrays here: an inline function of a library, compiled for a newer processor, could be picked by the
// linker for all.
//
// The floating-point operations are the same for every instruction set and are not contracted, so that
// counters and traces do not depend on the processor.

#include "engine/tree/kernel_needles.inl"
#include "engine/tree/kernel_triangles.inl"

namespace lrb {
namespace {

/// All lines of a node.
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

/// Sorts what was pushed last, the pair with the least gap last; of many only that one is moved.
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

/// Descends both nodes. kNearest: into the pair first whose boxes overlap most, for where one pair of
/// simplices is enough it is likely to be there.
template <bool kMargin, bool kNearest>
inline void descend_both(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  std::uint32_t mask[8];
  Gaps gaps;
  const std::uint32_t rows =
      pair_masks<kMargin>(k, na, nb, between<kMargin>(k, na, nb), mask, kNearest ? &gaps : nullptr);
  if (rows == 0) return;
  float gap_of[64];
  const std::uint32_t bottom = k.stack_size;
  for (std::uint32_t r = rows; r != 0; r &= r - 1) {
    const std::uint32_t i = static_cast<std::uint32_t>(__builtin_ctz(r));
    for (std::uint32_t c = mask[i]; c != 0; c &= c - 1) {
      const int j = __builtin_ctz(c);
      if constexpr (kNearest) gap_of[k.stack_size - bottom] = gaps.of[i][j];
      push(k, na.first + i, nb.first + static_cast<std::uint32_t>(j));
    }
  }
  if constexpr (kNearest) nearest_last(k.stack + bottom, gap_of, k.stack_size - bottom);
}

/// Descends A's node alone: its boxes against the whole box of B's, in both frames.
template <bool kMargin>
inline void descend_a(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t b_index) {
  const Boxes a = decode(na, k.ratio_a);
  const Whole b = whole_of(nb, k.ratio_b);
  const Between w = between<kMargin>(k, na, nb);
  const Turned at = turn_a<kMargin>(a, w);
  float centre[3], half[3];
  for (int i = 0; i < 3; ++i) {
    centre[i] = w.t[i] + w.r[i][0] * b.centre[0] + w.r[i][1] * b.centre[1] + w.r[i][2] * b.centre[2];
    half[i] = grow_of<kMargin>(w, 0, i) + w.abs_r[i][0] * b.half[0] + w.abs_r[i][1] * b.half[1] +
              w.abs_r[i][2] * b.half[2];
  }
  const Lanes gap =
      either(apart(at.centre, at.half, b.centre, b.half), apart(a.centre, a.half, centre, half));
  k.box_tests += na.count;
  for (std::uint32_t c = ~bits(gap) & present(na); c != 0; c &= c - 1)
    push(k, na.first + static_cast<std::uint32_t>(__builtin_ctz(c)), b_index);
}

/// Descends B's node alone.
template <bool kMargin>
inline void descend_b(TreeKernel& k, const TreeNode& na, const TreeNode& nb, std::uint32_t a_index) {
  const Whole a = whole_of(na, k.ratio_a);
  const Boxes b = decode(nb, k.ratio_b);
  const Between w = between<kMargin>(k, na, nb);
  const Turned bt = turn_b<kMargin>(b, w);
  float centre[3], half[3];
  for (int j = 0; j < 3; ++j) {
    centre[j] = w.back[j] + w.r[0][j] * a.centre[0] + w.r[1][j] * a.centre[1] + w.r[2][j] * a.centre[2];
    half[j] = grow_of<kMargin>(w, 1, j) + w.abs_r[0][j] * a.half[0] + w.abs_r[1][j] * a.half[1] +
              w.abs_r[2][j] * a.half[2];
  }
  const Lanes gap =
      either(apart(bt.centre, bt.half, a.centre, a.half), apart(b.centre, b.half, centre, half));
  k.box_tests += nb.count;
  for (std::uint32_t c = ~bits(gap) & present(nb); c != 0; c &= c - 1)
    push(k, a_index, nb.first + static_cast<std::uint32_t>(__builtin_ctz(c)));
}

/// Pairs of simplices of two blocks, by their numbers there. Room for eight at a time beyond the last.
struct PairList {
  std::uint8_t a[72], b[72];
  std::uint32_t size = 0;
};

inline void list_pairs(std::uint32_t rows, const std::uint32_t mask[8], PairList& list) {
  for (; rows != 0; rows &= rows - 1) {
    const int i = __builtin_ctz(rows);
    for (std::uint32_t c = mask[i]; c != 0; c &= c - 1) {
      list.a[list.size] = static_cast<std::uint8_t>(i);
      list.b[list.size++] = static_cast<std::uint8_t>(__builtin_ctz(c));
    }
  }
  __builtin_memset(list.a + list.size, 0, 8);
  __builtin_memset(list.b + list.size, 0, 8);
}

template <bool kMargin>
inline void leaf_pair(TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  const Between w = between<kMargin>(k, na, nb);
  std::uint32_t mask[8];
  const std::uint32_t rows = pair_masks<kMargin>(k, na, nb, w, mask);
  if (rows == 0) return;
  const LeafBlock& block_a = k.blocks_a[na.first];
  const LeafBlock& block_b = k.blocks_b[nb.first];
  PairList list;
  list_pairs(rows, mask, list);
  k.prefilter_tests += list.size;
  Corners a, b;
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
  for (std::uint32_t begin = 0; begin < list.size; begin += 8) {
    const Corners some_a = pick(a, list.a + begin), some_b = pick(b, list.b + begin);
    const SideLanes b_sides = sides_of_planes<kMargin>(some_a, some_b, w, w.edge_error[0]);
    const SideLanes a_sides = sides_of_planes<kMargin>(some_b, some_a, w, w.edge_error[1]);
    const std::uint32_t here = list.size - begin < 8 ? (1u << (list.size - begin)) - 1 : 255u;
    const std::uint32_t left = ~bits(either(a_sides.parted, b_sides.parted)) & here;
    if (left == 0) continue;
    EightCertainties certainties;
    if constexpr (!kMargin) certainties = certainties_of(some_a, a_sides, some_b, b_sides, w, left);
    for (std::uint32_t c = left; c != 0; c &= c - 1) {
      const int lane = __builtin_ctz(c);
      const std::uint32_t pair = begin + static_cast<std::uint32_t>(lane);
      Candidate& found = k.out[k.out_size++];
      found = {block_a.simplex[list.a[pair]], block_b.simplex[list.b[pair]], Certainty::none, Side::a, 0};
      if constexpr (!kMargin) certainties.tell(lane, found);
    }
  }
}

/// A node so many times as large as the other is descended alone: all that the other holds would meet the
/// same few of its boxes.
constexpr float kMuchLarger = 3;

template <bool kMargin, bool kNearest>
void run(TreeKernel& k) {
  while (k.stack_size != 0 && k.out_capacity - k.out_size >= 64) {
    const NodePair p = k.stack[--k.stack_size];
    const TreeNode& a = k.nodes_a[p.a];
    const TreeNode& b = k.nodes_b[p.b];
    ++k.node_pairs;
    if constexpr (!kMargin)
      if (k.needles && needles_apart(k, a, b)) continue;
    const float size_a = a.radius * k.ratio_a, size_b = b.radius * k.ratio_b;
    const bool hold_a = a.is_leaf || size_b > kMuchLarger * size_a;
    const bool hold_b = b.is_leaf || size_a > kMuchLarger * size_b;
    if (a.is_leaf && b.is_leaf)
      leaf_pair<kMargin>(k, a, b);
    else if (!a.is_leaf && hold_b)
      descend_a<kMargin>(k, a, b, p.b);
    else if (!b.is_leaf && hold_a)
      descend_b<kMargin>(k, a, b, p.a);
    else
      descend_both<kMargin, kNearest>(k, a, b);
  }
}

}  // namespace

void LRB_KERNEL_NAME(TreeKernel& k) {
  if (k.margin > 0)
    run<true, false>(k);
  else
    k.nearest_first ? run<false, true>(k) : run<false, false>(k);
}

}  // namespace lrb
