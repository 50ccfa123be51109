#pragma once
/// Every small constant of the engine, with its unit, its reason, and what breaks if it is changed. The
/// answer of a query depends on none of them: they decide how much work is left to the exact tests.

namespace lrb {

/// Weight of a simplex's corners when the principal axes of some simplices are found, relative to the squared
/// diagonal of their box, or of the box of a range that they are part of. Keeps segments and points (area 0)
/// from having no axes at all. Larger: frames follow the tessellation.
inline constexpr double kFrameCornerWeight = 1e-12;

/// What a box costs for its length where trees are cut, as a share of its squared diagonal, beside half its
/// surface. Among boxes without a surface, like those of the parts of a straight line, it makes the short
/// ones the better ones; without it, a line is peeled off leaf by leaf. Larger: parts that are small beside
/// what lies between them are not told apart from it.
inline constexpr double kLengthCost = 1e-5;

/// What each simplex beneath a node of a tree adds to the node's cost where it is decided which nodes become
/// wide ones. It decides between boxes that are no larger than about a ten thousandth of the body, or have no
/// surface: there the tree becomes as low as it can on average. Larger: it also decides between larger boxes.
inline constexpr double kSimplexCost = 0x1p-40;

/// A range of simplices is measured anew if its variance is less than this share of the squared diagonal of
/// the range it was measured with. Smaller: rounding errors hide how the simplices of small parts are spread.
inline constexpr double kMeasureAgain = 1e-6;

/// Largest defect allowed in the orthonormality of a node's axes once they are rounded to float (largest row
/// sum; without unit): 8 u, u = 2^-24, of which rounding uses 5.2 u. Larger: kKernelRounding does not hold;
/// smaller: nodes lose their own axes.
inline constexpr double kFrameDefect = 0x1p-21;

/// Growth of quantized boxes, relative to the box's coordinates. Covers the rounding of three products, two
/// sums and one difference in double (under 2^-50) and of the decoding in float (under 2^-22). Smaller: a box
/// could lose a corner to a rounding error; larger: more pairs to test.
inline constexpr double kTreeRounding = 0x1p-21;
/// Growth of quantized boxes for the rounding of a difference of coordinates, which are at most 1 in units.
inline constexpr double kTreeRoundingUnits = 0x1p-50;

/// Bound on the error of a coordinate that the tree kernel transforms from one node's frame to the other's,
/// relative to the sizes involved (radii and distance of the nodes). Derivation, with u = 2^-24: the relative
/// rotation is a product of three matrices with entries rounded to float and rows of length 1, so each entry
/// is at most 16 u off; a node's axes are orthonormal to 8 u, which matters because the inverse is taken by
/// transposition; the offset is rounded to float and rotated once or twice, 8 u; boxes are decoded with 3 u;
/// products and sums of three terms add 4 u. Together this is under 48 u < 2^-18.
inline constexpr float kKernelRounding = 0x1p-18f;
/// Bound on the error of a coordinate that is turned to the other node's axes and back, relative to the sum
/// of the sizes involved. Derivation in kernel_whole.inl: 48 + 112 + 84 + 10 u.
inline constexpr float kWholeRounding = 0x1p-16f;
/// Bounds on the error of the difference of two corners of one body, in which the error of the offset between
/// the nodes cancels. "Reach" is what kKernelRounding is relative to.
/// - kOwnEdgeRounding, for the body in whose frame the kernel works, relative to its node's radius: corners
///   are rounded to float, 1 u of the radius each, and their difference by 2 u: 4 u, taken twice to leave
///   room for rounding in the bound of products.
/// - kTurnedEdgeRounding, for the other body, relative to its node's radius: the rotation's entries are 16 u
///   off and the transposition 8 u, together 36 u of the length of a difference, which is 2 radii; the
///   rounding of the corners adds 2.1 u, of products and sums 8 u, of the difference 2 u: 84.1 u in all.
/// - kFarEdgeRounding, for the other body too, relative to the reach: 3 sums for each corner to which the
///   offset contributes, 6 u.
inline constexpr float kOwnEdgeRounding = 0x1p-21f;
inline constexpr float kTurnedEdgeRounding = 0x1.8p-18f;
inline constexpr float kFarEdgeRounding = 0x1p-21f;
/// Bound on the error of the displacement by which a node or simplex is swept, which is rounded to float and
/// rotated twice (see kKernelRounding), relative to the sum of its coordinates' sizes.
inline constexpr float kSweepRounding = 0x1p-16f;
/// Factor for sizes that are rounded to float and must not come out too small: 16 u, of which rounding uses 1
/// u and the arithmetic before it little more.
inline constexpr float kFloatUp = 1 + 0x1p-20f;
/// Added to bounds so that float underflow (an absolute error of 2^-149 per operation) cannot decide
/// anything.
inline constexpr float kKernelTiny = 0x1p-120f;
/// Returns a size as a float that is no smaller.
inline float rounded_up(double x) {
  return static_cast<float>(x) * kFloatUp + kKernelTiny;
}

/// Bound on the rounding of world coordinates and of the relative pose, relative to the largest term that
/// occurs: 4 u for each body's coordinates and 16 u for the relative pose, u = 2^-53.
inline constexpr double kWorldRounding = 0x1p-48;
/// Bound on the error of a product of a unit vector and a point, relative to the sum of the point's
/// coordinates: three products and two sums, 3 u, u = 2^-53, and as much for the vector's length. Smaller: a
/// plane could be said to part bodies that it cuts by a rounding error.
inline constexpr double kPlaneRounding = 0x1p-50;
/// World coordinates below this size are treated as if they were this large when their rounding is bounded:
/// it is the least normal double. Unit: the mesh's. Smaller: contacts of bodies made of denormals could be
/// missed.
inline constexpr double kWorldUnderflow = 0x1p-1022;
/// Safety factor on the sum of the pose's errors, for the change of norms; see set_up_kernel().
inline constexpr double kPoseSafety = 4;

/// How far two maps may be from rotations (largest row sum of r^T r - 1) to be queried as if they were: what
/// it adds to boxes, 8 of it in bodies, is far less than kKernelRounding adds. Larger: less is culled;
/// smaller: rotations that have been multiplied and rounded thousands of times take the slower way of other
/// maps.
inline constexpr double kNearRotation = 0x1p-30;
/// Largest world coordinate, in sizes of the bodies, at which poses are treated as rotations: floats of the
/// kernel must not overflow.
inline constexpr double kNearEnough = 0x1p100;
/// Least singular value of a map, relative to its largest, at which boxes are compared on the body's own axes
/// as they are; flatter bodies are looked at as if they were as thick as this. Smaller: the kernel's
/// rounding, which grows by its inverse, keeps more pairs; larger: bodies that are merely thin are culled as
/// flat ones.
inline constexpr double kFlatness = 0x1p-8;

/// Added to distances that bound a region's thickness, in units (coordinates are at most about 1). Covers,
/// with u = 2^-53: a distance is the length of the difference between a point and a weighted sum of corners,
/// a dozen operations on numbers below 4, together under 2^-46; a lid is cut in pieces, and a new corner lies
/// beside its edge by three operations on each coordinate, under 2^-50, at most kMostCuts = 2^8 times over
/// (thickness.cpp): under 2^-42. Smaller: an error bound could be exceeded by a rounding error; larger: it is
/// that much looser.
inline constexpr double kThicknessRounding = 0x1p-40;
/// Distance that faces of two wrappers must keep to count as apart, relative to the largest term of any world
/// coordinate. What is hidden may stand out of its lid by the rounding of world coordinates (under 2^-50 for
/// both bodies), and the distance is computed with a smaller error than that. Smaller: a touch under a flat
/// lid could be missed; larger: bodies this close are refined further, or not proved apart.
inline constexpr double kWrapperMargin = 0x1p-44;

/// Factor on the kernel's slack where it walks wrappers. What it then drops or calls certain, a crossing as
/// well as two faces that are apart, is so however the vertices are shifted by what rounding does to the
/// wrappers and to the bodies in them. With S the sum of the largest terms of both bodies' world coordinates:
/// a vertex is rounded by at most sqrt(3) 2^-51 of its own body's, so that in the deformation of
/// coarse_query.hpp two vertices shift against each other by less than 2 sqrt(3) 2^-51 S < 2^-49 S; the
/// kernel's own slack is at least 2^-46 S (kPoseSafety kWorldRounding S, and twice that for rotations), and
/// so is what this factor adds. Smaller, but above 1 + 2^-3: enough, too; larger: more pairs are left to
/// exact tests.
inline constexpr float kWrapperSlack = 2;

/// Largest deviation from a rotation (largest row sum of r^T r - 1) at which coherent queries still use
/// candidate caches. Products of thousands of rotations drift less than this. The effect on lengths is
/// allowed for (relative_motion.hpp), and this times a body's size is less than the motions that caches are
/// made for. Larger: larger caches.
inline constexpr double kRigid = 0x1p-24;

/// The distance query.

/// Share by which a length that the distance kernel computes may be off, beside the errors of coordinates:
/// node's axes are orthonormal to kFrameDefect, which changes lengths by half of that; poses are rotations to
/// kNearRotation; squares, sums and roots take a few 2^-24. Smaller than 2^-21: a nearer pair could be
/// dropped; larger: more pairs are kept.
inline constexpr float kDistanceRounding = 0x1p-18f;
/// Bound on the error of a distance of two simplices in doubles, relative to the largest difference of any
/// coordinates: 64 u, u = 2^-53 (pair_bounds.cpp). Smaller: an interval could miss the distance; larger:
/// wider intervals.
inline constexpr double kPairRounding = 0x1p-47;
/// Width to which an interval is narrowed unless the request asks for less, relative to the larger body's
/// size; but not below a few units in the last place of the distance (kDistanceWidthUlps, relative to it).
inline constexpr double kDistanceWidth = 1e-12;
inline constexpr double kDistanceWidthUlps = 0x1p-50;
/// Bodies whose origins are further apart than this many of the larger one's units are walked in doubles:
/// floats could not tell their near sides from their far ones. Larger: more pairs are kept, in floats;
/// smaller: doubles are slower.
inline constexpr double kFarForFloats = 32;
/// From this many of their sizes on, two bodies' intervals are kFarWidth of the distance wide, because their
/// world coordinates have hardly a digit for their shapes. Larger: such bodies' faces are all compared with
/// each other.
inline constexpr double kVeryFar = 0x1p36;
inline constexpr double kFarWidth = 0x1p-42;

/// First contact.

/// Largest deviation from a rotation (largest row sum of r^T r - 1) of the poses that a screw leads between:
/// as of matrices written with three digits. Larger: the logarithm is that of a matrix that is not nearly a
/// rotation.
inline constexpr double kMotionDefect = 4e-3;
/// Bound on the error of a moving vertex, relative to the largest terms of its place: 8 u, u = 2^-53; derived
/// in motion_bounds.hpp. Smaller: a contact could be missed by a rounding error; larger: wider intervals
/// where bodies graze.
inline constexpr double kMotionRounding = 0x1p-50;

/// The builders. None of these constants decides whether an LRB-rep is right: what the builders propose is
/// confirmed exactly.

/// Squared sine of the angle under which planes count as parallel when a new vertex is placed (10^-7 rad).
/// Larger: corners between flat neighbours are not found; smaller: they are found far away, where rounding
/// puts them.
inline constexpr double kParallelSineSq = 1e-14;
/// Distance that a new vertex keeps from the planes that it must be in front of, relative to the radius of
/// the star that it replaces. Smaller: the exact confirmation fails on rounding; larger: hulls swell, layer
/// by layer.
inline constexpr double kPlacementMargin = 1e-6;
/// Slack of the placement's own comparisons, relative to the same radius: well under the margin, but above
/// rounding.
inline constexpr double kPlacementSlack = 1e-9;
/// Largest volume that one collapse in a cap may add, relative to the patch's area to the power 1.5. Larger:
/// simpler hulls that stand further off; smaller: more layers.
inline constexpr double kCapVolumeLimit = 0.1;
/// Weight of the worst new triangle's shape, against volume, in the cost of a collapse: a needle costs
/// kCapShapeWeight area^1.5 / quality.
inline constexpr double kCapShapeWeight = 1e-4;
/// Largest share of the triangles it covers that a cap may have, as long as passes find such caps. Larger:
/// more regions and faces in all (measured on six bodies: 1.55 faces per real one at 0.8, 1.49 at 0.45);
/// smaller: passes stop early.
inline constexpr double kCapWorth = 0.45;
/// The same share in the last passes, and for bridging.
inline constexpr double kLastCapWorth = 0.8;
/// Early hulls of large bodies stay inside the body's polytope of 26 directions, moved outward by this share
/// of the body's width. Larger: hulls swell, and with them the outermost wrapper, which is planned around one
/// of them.
inline constexpr double kHullSwell = 0.01;
/// Distance of the outermost wrapper from the hull that it is planned around, relative to the body's largest
/// extent. Larger: a looser wrapper (measured on six bodies: 1.1-1.2 times the convex hull's volume at 0.003,
/// 1.2-1.4 at 0.01); smaller: later hulls have no room to grow where it touches.
inline constexpr double kPolytopeDistance = 0.005;
/// Distance that later hulls keep from the outermost wrapper, relative to its largest extent. Smaller: the
/// confirmation that the wrapper holds them fails on rounding, and another wrapper is put around them.
inline constexpr double kHullDistance = 1e-6;

/// Largest difference allowed between volumes that should be equal, relative to the outermost wrapper's
/// volume: the rounding of sums over up to millions of faces. Only validate() uses it, beside exact checks.
/// Smaller: false alarms on large bodies.
inline constexpr double kVolumeRounding = 0x1p-33;

/// Least share of their total weight that the weighted normals of a contact region must add up to for an
/// average normal to be given. Without unit. Smaller: normals made of rounding errors.
inline constexpr double kContactNormalLeast = 0x1p-20;

/// Distances from a coplanar contact at which interiors_overlap() looks for a point inside both bodies, as
/// shares of the contact's size. Only finding such a point counts, no matter at which distance. Fewer
/// distances: "unknown" for thinner wedges.
inline constexpr double kInteriorProbes[] = {0x1p-4, 0x1p-20, 0x1p-52, 0x1p-80};

/// Largest number of cells that interiors_overlap() samples in one face, and in all, before it answers
/// "unknown". Larger: rare configurations with thousands of contacts on one face are decided too, in minutes
/// instead of never.
inline constexpr unsigned kInteriorCellsPerFace = 256;
inline constexpr unsigned kInteriorCells = 20000;
/// Number of pairs of crossing faces in which interiors_overlap() looks for a proof. About one in two proves
/// it. Fewer: "unknown" for bodies that touch themselves nearly everywhere.
inline constexpr unsigned kCrossingsTried = 256;

}  // namespace lrb
