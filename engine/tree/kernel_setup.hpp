#pragma once
/// Setup of the dual traversal of two trees: both poses as one motion of B in A's frame, and a bound on all
/// its errors.

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

/// Returns the unit in which two trees are compared, in mesh units.
inline double query_unit(const ObbTree& a, const ObbTree& b) {
  return std::max(a.unit(), b.unit());
}

/// Returns a kernel with everything set except its buffers (stacks and out). Intended for poses that are
/// nearly rotations; valid for others, but culls little.
TreeKernel set_up_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b);

/// Returns such a kernel for any poses. The data for poses that are not rotations are stored in `terms`,
/// which must outlive the kernel. dim: dimension of both bodies.
TreeKernel set_up_any_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b,
                             int dim, AffineTerms& terms);

/// Returns the required capacity of `stack`, and of `tested`.
///
/// Visiting a pair replaces it by at most 64 others: depth first, 63 wait at each step down. Batches of eight
/// leave at most 7 pairs, which the next batches include. The pairs moved to `tested` at one time are
/// therefore at least one step below the least deep of those moved two times before, so that at most two such
/// groups wait at each step down.
inline std::size_t stack_room(std::uint32_t height_a, std::uint32_t height_b) {
  return 160 * (std::size_t{height_a} + height_b) + 160;
}

/// Returns true if no pair of nodes is waiting.
inline bool is_done(const TreeKernel& k) {
  return k.stack_size + k.tested_size == 0;
}

/// Resets the traversal to a single pair of nodes.
inline void start_at(TreeKernel& k, NodePair pair) {
  k.stack[0] = pair;
  k.stack_size = 1;
  k.tested_size = k.base = 0;
}

/// Pushes the pair of roots on the kernel's stacks, which are allocated in `room`.
void start_at_roots(TreeKernel& k, const ObbTree& a, const ObbTree& b, std::vector<NodePair>& room);

/// Returns true if the balls around the roots of two trees are proven disjoint in the world: no traversal is
/// needed. Cheaper than the setup of a kernel. False for empty trees, and for maps other than rotations.
bool roots_are_apart(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b);

/// Enlarges the slack of a kernel for two wrappers to cover rounding of the enclosed bodies: see
/// kWrapperSlack.
void allow_for_wrappers(TreeKernel& k);

// Bounds on the effect of a pose on lengths and coordinates, used for culling and for proofs in doubles.

/// Returns the deviation of r^T r from the identity, as the largest row sum, which bounds the Euclidean norm
/// because the matrix is symmetric. Returns NaN if r^T r overflows to NaN.
double rotation_defect(const Eigen::Matrix3d& r);

/// Returns a bound on every world coordinate of a tree's simplices, and on every term in its computation.
double world_size(const Pose& pose, const ObbTree& tree);

/// Returns the distance between wrappers that proves the enclosed bodies separate: see kWrapperMargin.
double wrapper_margin(const Pose& pose_a, const ObbTree& a, const Pose& pose_b, const ObbTree& b);

/// Returns a bound on the factor by which a pose stretches distances, for any finite matrix; 1 for rotations,
/// up to rounding.
double stretch(const Pose& pose);

/// Returns a bound on |d|, d the difference of two near-rotations. For rotations |d|^2 is half the sum of the
/// squares of its entries. A matrix with |r^T r - 1| <= D is within D of a rotation, which adds at most 2.3
/// (at least 1 + sqrt(3 / 2)) times the sum of both D, `defects`.
inline double turn_bound(const Eigen::Matrix3d& d, double defects) {
  constexpr double kToRotations = 2.3;
  return std::sqrt(d.squaredNorm() / 2) + kToRotations * defects;
}

// Setup of the kernel for bodies under arbitrary finite affine maps: scaled, sheared, mirrored, flattened to
// a plane, a line or a point; of any size.
//
// Boxes. The boxes of a node are tight on the node's axes, in the body. Therefore each body X is assigned a
// matrix G_X that maps the world back to the body, and the kernel compares boxes there, on X's axes:
//     x(w) = G_X (w - t_X) / L,
// where L, the query's unit, is a power of two near the larger body's size in the world. Write the map of X
// as 2^e R_X, with entries of R_X of at most 1, take coordinates in units of X's tree times the ratio 2^e
// unit / L, and let Y be the other body. Then the points there are
//     own p with own = G_X R_X for p of X,     other q + origin with other = G_X R_Y for q of Y.
// Boxes that are disjoint on these axes prove that the points in the world are disjoint, for any G: a bad G
// costs time, but never loses a contact. G may therefore be computed in any arithmetic, and the errors are
// bounded from G itself:
// - If R_X is well conditioned, G_X is its inverse, own is taken as 1, and its difference from 1 is added to
//   the errors.
// - Otherwise G_X is the inverse of R_X with its small singular values raised to kFlatness of the largest.
//   Then own is nearly a projection, and X's own boxes are transformed by it as well.
//
// Errors. If points of both bodies are equal in the world, including all rounding, so are their x(w), and
//     |own p - (other q + origin)| <= |own - G_X R_X| |p|
//         + |G_X| (rounding of the world, own, other, origin),
// because each of these is a sum of products of G_X and of terms of a world coordinate. Let u = 2^-53, and S
// the size of both bodies' world coordinates in units of L. World coordinates take 4 u S, own and other 3 u
// each, the origin 4 u, the offset of two nodes 5 u, for each coordinate. With sqrt 3 for the length of such
// a vector and sqrt 3 for the sizes of the entries of G_X, the total is at most 57 u |G_X| S. kPoseSafety
// kWorldRounding is 128 u. Scaling by powers of two is exact except for underflow, which is far below
// kKernelTiny. The remainder is the kernel's own rounding in floats: see see_on().
//
// Triangles are compared on the world's axes, in units of L. Decisions there are proven, with the same errors
// for G = 1.
//
// Overflow makes bounds infinite or NaN: then nothing is culled, and nothing is decided.

/// The map of a body and its inverse, as above.
struct AffineMap {
  Eigen::Matrix3d r;     ///< R
  int exponent;          ///< exponent of a tree unit in the world: e plus the unit's exponent
  Eigen::Matrix3d back;  ///< G
  Eigen::Matrix3d own;   ///< G R if flat, otherwise the identity
  bool flat;
  double defect;           ///< unless flat: bound on the Euclidean norm of G R - 1
  double size, back_size;  ///< bounds on the Euclidean norms of R and G

  AffineMap(const Pose& pose, const ObbTree& tree, int dim);
};

/// Returns a kernel with everything set except its buffers, as set_up_kernel() does for rotations. Stores its
/// affine terms in `terms`, which must outlive the kernel. dim: dimension of both bodies.
TreeKernel set_up_affine_kernel(const ObbTree& a, const Pose& pose_a, const ObbTree& b, const Pose& pose_b,
                                int dim, AffineTerms& terms);

}  // namespace lrb
