#pragma once
/// Given pairs of triangles, eight at a time, in float arithmetic whose every error is bounded: which of them
/// certainly cross or are disjoint, and how far apart they certainly are.
///
/// Plain structures only: this header is compiled once per instruction set (pair_kernel_*.cpp).

#include <cstdint>

namespace lrb {

/// A simplex, query units: its first corner, in a frame with the axes of its body, and the way from there to
/// the others. Differences are small where the simplices are, and so are their errors. A segment repeats its
/// second corner.
struct alignas(16) CachedSimplex {
  float corner[3], edge[2][3];
  float longest;  ///< edge, rounded up
  float unused[2];
};

/// Of a simplex of A and one of B, by their places in PairKernel::a and b.
struct CachedPair {
  std::uint32_t a, b;
};

/// Each bit is that of one of eight pairs. Where neither is set nothing is certain.
struct PairVerdicts {
  std::uint8_t cross, disjoint;
};

struct PairKernel {
  const CachedSimplex *a, *b;
  const CachedPair* pairs;  ///< (8 block_count)
  std::uint32_t block_count;
  float r[3][3], t[3];       ///< A's frame <- B's frame: r x + t
  float radius_a, radius_b;  ///< of balls about the frames' origins that hold all first corners
  float slack, m_size;       ///< as in TreeKernel

  PairVerdicts* verdicts;  ///< (block_count), or null: not asked for

  /// (8 block_count), or null: not asked for. Pairs meet only after a motion from `from` to `to`. Of a motion
  /// there is known, where `is_swept`, that it brings the points of B by s times (sweep x + sweep_t), from
  /// A's frame seen, s from -1 to 1, and then by no more than `margin` from there: the span is one of s. Else
  /// it is one of the length, query units, of whatever motion.
  float *from, *to;
  bool is_swept;
  float sweep[3][3], sweep_t[3];  ///< rows; on A's axes <- in B's frame
  float sweep_turn, margin;
};

/// With the instruction set that run_tree_kernel() chooses, and the same outcome with each.
void run_pair_kernel(const PairKernel& k);

}  // namespace lrb
