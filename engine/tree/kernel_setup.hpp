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

// Sets up the kernel for bodies under any finite affine maps: scaled, sheared, mirrored, flattened to a
// plane, a line or a point; of any size.
//
// Boxes. A node's boxes are tight on the node's axes, in the body. Therefore each body X is given a matrix
// G_X that takes the world back to the body, and the kernel compares boxes there, on X's axes:
//     x(w) = G_X (w - t_X) / L,
// where L, the query's unit, is a power of two near the larger body's size in the world. Write the map of X
// as 2^e R_X, with entries of R_X at most 1, take coordinates in units of X's tree times the ratio 2^e unit
// / L, and let Y be the other body. Then the points there are
//     own p with own = G_X R_X for p of X,     other q + origin with other = G_X R_Y for q of Y.
// Boxes that are apart on these axes prove points of the world apart, whatever G is: a bad G costs time,
// never a contact. So G may come from any arithmetic, and the errors are bounded from G itself:
// - where R_X is well conditioned, G_X is its inverse, own is taken as 1, and its difference from 1 is added
//   to the errors;
// - else G_X is the inverse of what R_X becomes when its small singular values are raised to kFlatness of
//   the largest. Then own is nearly a projection, and X's own boxes are turned by it, too.
//
// Errors. If points of both bodies are equal in the world, with all rounding, so are their x(w), and
//     |own p - (other q + origin)| <= |own - G_X R_X| |p|
//         + |G_X| (rounding of the world, own, other, origin),
// because each of these is a sum of products of G_X and of terms of a world coordinate. Let u = 2^-53 and S
// the size of both bodies' world coordinates in units of L. World coordinates take 4 u S, own and other 3 u
// each, the origin 4 u, the offset of two nodes 5 u, for each coordinate. With sqrt 3 for the length of such
// a vector and sqrt 3 for the sizes of the entries of G_X that makes at most 57 u |G_X| S. kPoseSafety
// kWorldRounding is 128 u. Scaling by powers of two is exact but for underflow, which is far below
// kKernelTiny. The rest is the kernel's own rounding in floats: see see_on().
//
// Triangles are compared on the world's axes, in units of L. What is certain there is certain, with the same
// errors for G = 1.
//
// Overflow makes bounds infinite or not a number: then nothing is culled, and nothing is certain.

/// A body's map and the way back, as above.
struct AffineMap {
  Eigen::Matrix3d r;     ///< R
  int exponent;          ///< power of two that a unit of the tree has in the world: e and the unit's exponent
  Eigen::Matrix3d back;  ///< G
  Eigen::Matrix3d own;   ///< G R where flat, else the identity
  bool flat;
  double defect;           ///< unless flat: a bound on the Euclidean norm of G R - 1
  double size, back_size;  ///< bounds on the Euclidean norms of R and G

  AffineMap(const Pose& pose, const ObbTree& tree, int dim);
};

/// Returns a kernel with everything filled in but its buffers, as set_up_kernel() does for rotations; puts
/// its affine terms into `terms`, which must live as long as the kernel. dim: that of both bodies.
TreeKernel set_up_affine_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b,
                                int dim, AffineTerms& terms);

}  // namespace lrb
