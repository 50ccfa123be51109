#pragma once
/// The inner loops of the search for near pairs: the traversal of two OBB trees in eight-wide float
/// arithmetic, and bounds on the distances of eight pairs at a time in doubles.
///
/// Contains only plain structures: this header is compiled once per instruction set (cmake/kernels.cmake).

#include <cstdint>

#include "engine/tree/tree_kernel.hpp"

namespace lrb {

/// Writes the pairs of simplices that may be at most TreeKernel::margin apart, on A's axes and on B's:
/// candidates of Certainty::none. All pairs within this distance are among them. Stops as run_tree_kernel()
/// does, but needs less space for its stack: near_stack_room(). The kernel must be set up for rotations.
void run_near_kernel(TreeKernel& k);

/// Returns the required capacity of TreeKernel::stack: visiting a pair replaces it by at most 64 others, of
/// which 63 wait at each step down.
inline std::size_t near_stack_room(std::uint32_t height_a, std::uint32_t height_b) {
  return 63 * (std::size_t{height_a} + height_b) + 64;
}

/// Eight pairs of triangles; a segment repeats its second corner. Given: their corners. Found: bounds of
/// their distances, and closest points in the world, up to rounding.
struct alignas(64) EightPairsMeasured {
  double corner[2][3][3][8];  ///< (A and B, corner, axis, pair) in the bodies' frames
  /// Bounds of the distance. `upper` is infinite if doubles do not suffice. `lower` is 0 if contact is not
  /// excluded; narrow if it is at most PairBoundsKernel::within.
  double lower[8], upper[8];
  double point[2][3][8];  ///< valid if `lower` is at most PairBoundsKernel::within
};

struct PairBoundsKernel {
  double r[2][3][3], t[2][3];  ///< both poses. 2D: with zeros in the third row
  double within;
  EightPairsMeasured* pairs;  ///< (block_count)
  std::uint32_t block_count;
};

void run_pair_bounds_kernel(const PairBoundsKernel& k);

}  // namespace lrb
