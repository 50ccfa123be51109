#pragma once
/// The pair kernel: tells for given pairs of triangles, eight at a time, in float arithmetic whose every
/// error is bounded, which of them certainly cross or are disjoint, and how far apart they certainly are.
///
/// Contains only plain structures: this header is compiled once per instruction set (cmake/kernels.cmake).

#include <cstdint>

namespace lrb {

/// A simplex in query units: its first corner, in a frame with the axes of its body, and the edges from there
/// to the other corners. Where simplices are small, so are these differences and their errors. A segment
/// repeats its second corner.
struct alignas(16) CachedSimplex {
  float corner[3], edge[2][3];
  float longest;  ///< length of the longest edge, rounded up
  float unused[2];
};

/// A simplex of A and one of B, by their indices in PairKernel::a and b.
struct CachedPair {
  std::uint32_t a, b;
};

/// One bit for each of eight pairs. Where neither bit is set nothing is certain.
struct PairVerdicts {
  std::uint8_t cross, disjoint;
};

struct PairKernel {
  const CachedSimplex *a, *b;
  const CachedPair* pairs;  ///< (8 block_count)
  std::uint32_t block_count;
  float r[3][3], t[3];       ///< A's frame <- B's frame: r x + t
  float radius_a, radius_b;  ///< radii of balls about the frames' origins that hold all first corners
  float slack, m_size;       ///< as in TreeKernel

  PairVerdicts* verdicts;  ///< (block_count), or null if not asked for

  /// (8 block_count), or null if not asked for. A pair meets only after a motion from `from` to `to`. If
  /// `is_swept`, the motion is known to displace the points of B, seen from A's frame, by s times (sweep x +
  /// sweep_t), s from -1 to 1, and then by no more than `margin`: the span is one of s. Otherwise the motion
  /// may be any, and the span is one of its length, query units.
  float *from, *to;
  bool is_swept;
  float sweep[3][3], sweep_t[3];  ///< rows; on A's axes <- in B's frame
  float sweep_turn, margin;
};

/// Runs the kernel with the instruction set that run_tree_kernel() chooses; the outcome is the same with
/// each.
void run_pair_kernel(const PairKernel& k);

}  // namespace lrb
