#pragma once
/// The pair kernel: for given pairs of triangles, eight at a time, decides in float arithmetic with bounded
/// errors whether they cross or are disjoint, and computes lower bounds of their distance.
///
/// Contains only plain structures: this header is compiled once per instruction set (cmake/kernels.cmake).

#include <cstdint>

namespace lrb {

/// A simplex in query units: its first corner, in a frame with the axes of its body, and the edges from there
/// to the other corners. For small simplices these differences and their errors are small. A segment repeats
/// its second corner.
struct alignas(16) CachedSimplex {
  float corner[3], edge[2][3];
  float longest;  ///< length of the longest edge, rounded up
  float unused[2];
};

/// A simplex of A and one of B, by their indices in PairKernel::a and b.
struct CachedPair {
  std::uint32_t a, b;
};

/// One bit for each of eight pairs; undecided if neither is set.
struct PairVerdicts {
  std::uint8_t cross, disjoint;
};

struct PairKernel {
  const CachedSimplex *a, *b;
  const CachedPair* pairs;  ///< (8 block_count)
  std::uint32_t block_count;
  float r[3][3], t[3];       ///< A's frame <- B's frame: r x + t
  float radius_a, radius_b;  ///< radii of balls about the frames' origins that contain all first corners
  float slack, m_size;       ///< as in TreeKernel

  PairVerdicts* verdicts;  ///< (block_count), or null if not requested

  /// (8 block_count), or null if not requested. Each pair can intersect only after a motion in [from, to]. If
  /// `is_swept`, the motion displaces the points of B, relative to A's frame, by s times (sweep x + sweep_t),
  /// s in [-1, 1], and then by at most `margin`: the interval is one of s. Otherwise the motion is arbitrary,
  /// and the interval is one of its length, query units.
  float *from, *to;
  bool is_swept;
  float sweep[3][3], sweep_t[3];  ///< rows; on A's axes <- in B's frame
  float sweep_turn, margin;
};

/// Runs the kernel with the instruction set of run_tree_kernel(). The result does not depend on the
/// instruction set.
void run_pair_kernel(const PairKernel& k);

}  // namespace lrb
