#pragma once
/// Sets up the kernel for bodies under any finite affine maps: scaled, sheared, mirrored, flattened to a
/// plane, a line or a point; of any size.
///
/// Boxes. A node's boxes are tight on the node's axes, in the body. Therefore each body X is given a matrix
/// G_X that takes the world back to the body, and the kernel compares boxes there, on X's axes:
///     x(w) = G_X (w - t_X) / L,
/// where L, the query's unit, is a power of two near the larger body's size in the world. Write the map of X
/// as 2^e R_X, with entries of R_X at most 1, take coordinates in units of X's tree times the ratio 2^e unit
/// / L, and let Y be the other body. Then the points there are
///     own p with own = G_X R_X for p of X,     other q + origin with other = G_X R_Y for q of Y.
/// Boxes that are apart on these axes prove points of the world apart, whatever G is: a bad G costs time,
/// never a contact. So G may come from any arithmetic, and the errors are bounded from G itself:
/// - where R_X is well conditioned, G_X is its inverse, own is taken as 1, and its difference from 1 is added
///   to the errors;
/// - else G_X is the inverse of what R_X becomes when its small singular values are raised to kFlatness of
///   the largest. Then own is nearly a projection, and X's own boxes are turned by it, too.
///
/// Errors. If points of both bodies are equal in the world, with all rounding, so are their x(w), and
///     |own p - (other q + origin)| <= |own - G_X R_X| |p|
///         + |G_X| (rounding of the world, own, other, origin),
/// because each of these is a sum of products of G_X and of terms of a world coordinate. Let u = 2^-53 and S
/// the size of both bodies' world coordinates in units of L. World coordinates take 4 u S, own and other 3 u
/// each, the origin 4 u, the offset of two nodes 5 u, for each coordinate. With sqrt 3 for the length of such
/// a vector and sqrt 3 for the sizes of the entries of G_X that makes at most 57 u |G_X| S. kPoseSafety
/// kWorldRounding is 128 u. Scaling by powers of two is exact but for underflow, which is far below
/// kKernelTiny. The rest is the kernel's own rounding in floats: see see_on().
///
/// Triangles are compared on the world's axes, in units of L. What is certain there is certain, with the same
/// errors for G = 1.
///
/// Overflow makes bounds infinite or not a number: then nothing is culled, and nothing is certain.

#include "engine/tree/tree_kernel.hpp"
#include <lrbscope/pose.hpp>

namespace lrb {

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
