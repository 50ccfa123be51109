#pragma once
/// Prepares the dual traversal of two trees: both bodies' poses as one motion of B in A's frame, and a bound
/// on all errors that come with it.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "engine/tree/tree_kernel.hpp"
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

/// The instruction sets that kernels are compiled for.
enum class InstructionSet : std::uint8_t {
  baseline,  ///< what every processor has
  avx2,
  avx512,  ///< still eight lanes, but truth values in mask registers
};

/// Returns the newest that the processor has and that the environment variable LRB_SIMD ("baseline", "avx2")
/// allows.
InstructionSet best_instruction_set();

/// Returns the unit in which two trees are compared, as a multiple of the meshes' unit.
inline double query_unit(const ObbTree& a, const ObbTree& b) {
  return std::max(a.unit(), b.unit());
}

/// Returns a kernel with everything filled in but its buffers (stacks and out). Meant for poses that are
/// nearly rotations; for others it is right, too, but culls little.
TreeKernel set_up_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b);

/// Returns the same for any poses. What it needs for poses that are not rotations is put into `terms`, which
/// must live as long as the kernel. dim: that of both bodies.
TreeKernel set_up_any_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b,
                             int dim, AffineTerms& terms);

/// Returns how many pairs `stack` needs room for, and `tested` too.
///
/// A pair that is visited leaves at most 64 others: depth first, 63 wait for each step down. Of pairs in
/// eights at most 7 are left over, and the next ones take them along. What is put on `tested` at one time is
/// therefore at least one step below the least deep of what two times before put there, so that at most two
/// such lots wait for each step down.
inline std::size_t stack_room(std::uint32_t height_a, std::uint32_t height_b) {
  return 160 * (std::size_t{height_a} + height_b) + 160;
}

/// Returns true if no pair of nodes waits to be visited.
inline bool is_done(const TreeKernel& k) {
  return k.stack_size + k.tested_size == 0;
}

/// Makes one pair of nodes all there is to be visited.
inline void start_at(TreeKernel& k, NodePair pair) {
  k.stack[0] = pair;
  k.stack_size = 1;
  k.tested_size = k.base = 0;
}

/// Puts the pair of roots on the kernel's stacks, which are in `room`; that grows if it has to.
void start_at_roots(TreeKernel& k, const ObbTree& a, const ObbTree& b, std::vector<NodePair>& room);

/// Makes the kernel of two wrappers allow for what rounding does to the bodies in them, too: see
/// kWrapperSlack.
void allow_for_wrappers(TreeKernel& k);

// Bounds on what a pose can do to lengths and coordinates, on which culling and proofs in doubles rest.

/// Returns how far r^T r is from the identity, as the largest row sum: a bound on the Euclidean norm, because
/// the matrix is symmetric. Returns not-a-number where r^T r overflows to that.
double rotation_defect(const Eigen::Matrix3d& r);

/// Returns a bound on every world coordinate of a tree's simplices, and on every term on the way to it.
double world_size(const Pose& pose, const ObbTree& tree);

/// Returns the distance that wrappers must keep to prove that what is in them is separate: see
/// kWrapperMargin.
double wrapper_margin(const Pose& pose_a, const ObbTree& a, const Pose& pose_b, const ObbTree& b);

/// Returns a bound on how much the pose stretches distances, for any finite matrix; for rotations that is 1,
/// up to rounding.
double stretch(const Pose& pose);

/// Returns a bound on |d|, d the difference of two matrices that are nearly rotations. Between rotations
/// |d|^2 is half the sum of the squares of its entries. A matrix with |r^T r - 1| <= D is within D of a
/// rotation, and 2.3 (at least 1 + sqrt(3 / 2)) times the sum of both D, `defects`, is what that can add.
inline double turn_bound(const Eigen::Matrix3d& d, double defects) {
  constexpr double kToRotations = 2.3;
  return std::sqrt(d.squaredNorm() / 2) + kToRotations * defects;
}

}  // namespace lrb
