#pragma once
/// Every small constant of the engine: its unit, its reason, and what breaks if it is changed. The answer of
/// a query depends on none of them: they decide how much work is left to the exact tests.

namespace lrb {

/// Weight of a simplex's corners in the principal axes of a tree node, relative to the area of a node's box
/// squared. Keeps segments and points (area 0) from having no axes at all. Larger: frames follow the
/// tessellation.
inline constexpr double kFrameCornerWeight = 1e-12;

/// A node's axes, rounded to float, must be orthonormal to this (largest row sum; without unit): 8 u, u =
/// 2^-24, of which rounding uses 5.2. Larger: kKernelRounding does not hold; smaller: nodes lose their own
/// axes.
inline constexpr double kFrameDefect = 0x1p-21;

/// Growth of quantized boxes, relative to the box's coordinates: covers the rounding of three products, two
/// sums and one difference in double (under 2^-50) and of the decoding in float (under 2^-22). Smaller: a box
/// could lose a corner by a rounding error; larger: more pairs to test.
inline constexpr double kTreeRounding = 0x1p-21;
/// The same for the rounding of a difference of coordinates, which are at most 1 in units.
inline constexpr double kTreeRoundingUnits = 0x1p-50;

/// Error of a coordinate that the tree kernel has taken from one node's frame to the other's, relative to the
/// sizes involved (radii and distance of the nodes). Derivation, with u = 2^-24: the relative rotation is a
/// product of three matrices with entries rounded to float and rows of length 1, at most 16 u off per entry;
/// a node's axes are orthonormal to 8 u, which the inverse by transposition sees; the offset is rounded to
/// float and turned once or twice, 8 u; boxes are decoded with 3 u; products and sums of three terms add 4 u.
/// Together under 48 u < 2^-18.
inline constexpr float kKernelRounding = 0x1p-18f;
/// The same for the difference of two corners of one body, in which the error of the offset between the nodes
/// cancels; (reach) is what kKernelRounding is relative to. Of the body whose frame it is: corners are
/// rounded to float, 1 u of the node's radius each, their difference by 2 u: 4 u, taken twice for rounding in
/// the bound of products. Of the other, relative to its node's radius: the rotation's entries are 16 u off
/// and the transposition 8 u, together 36 u of a difference's length, which is 2 radii; rounding of the
/// corners 2.1 u, of products and sums 8 u, of the difference 2 u: 84.1 u; and 3 sums for each corner to which
/// the offset contributes, 6 u of the reach.
inline constexpr float kOwnEdgeRounding = 0x1p-21f;
inline constexpr float kTurnedEdgeRounding = 0x1.8p-18f;
inline constexpr float kFarEdgeRounding = 0x1p-21f;
/// Of the way that a node or simplex is swept, rounded to float and turned twice (see kKernelRounding), relative
/// to the sum of its coordinates.
inline constexpr float kSweepRounding = 0x1p-16f;
/// For sizes that are rounded to float and must not come out too small: 16 u, of which rounding uses 1, and the
/// arithmetic before it little more.
inline constexpr float kFloatUp = 1 + 0x1p-20f;
/// Added to bounds so that float underflow (absolute error 2^-149 an operation) cannot decide anything.
inline constexpr float kKernelTiny = 0x1p-120f;

/// Rounding of world coordinates and of the relative pose, relative to the largest term that occurs: 4 u for
/// each body's coordinates and 16 u for the relative pose, u = 2^-53.
inline constexpr double kWorldRounding = 0x1p-48;
/// World coordinates below this size are rounded as if they were this large: it is the least normal double.
/// Unit: the mesh's. Smaller: contacts of bodies made of denormals could be missed.
inline constexpr double kWorldUnderflow = 0x1p-1022;
/// Safety on the sum of the pose's errors, for the change of norms; see set_up_kernel().
inline constexpr double kPoseSafety = 4;

/// How far two maps may be from rotations (largest row sum of r^T r - 1) to be queried as if they were: what it adds
/// to boxes, 8 of it in bodies, is far less than kKernelRounding adds. Larger: less is culled; smaller: rotations
/// that have been multiplied and rounded thousands of times take the slower way of other maps.
inline constexpr double kNearRotation = 0x1p-30;
/// Largest world coordinate, in bodies, at which they are: floats of the kernel must not overflow.
inline constexpr double kNearEnough = 0x1p100;
/// Least singular value of a map, relative to its largest, at which boxes are compared on the body's own axes as they
/// are; flatter bodies are looked at as if they were as thick as this. Smaller: the kernel's rounding, which grows
/// by its inverse, keeps more pairs; larger: bodies that are merely thin are culled as flat ones.
inline constexpr double kFlatness = 0x1p-8;

/// Added to distances that bound a region's thickness, in units (coordinates are at most about 1): covers the
/// rounding of a dozen operations on them, which is under 2^-46. Smaller: an error bound could be exceeded by
/// a rounding error; larger: it is that much looser.
inline constexpr double kThicknessRounding = 0x1p-40;
/// Distance that faces of two wrappers must keep to count as apart, relative to the largest term of any world
/// coordinate: what is hidden may stand out of its lid by the rounding of world coordinates (under 2^-50 for
/// both bodies), and the distance is found with less than that. Smaller: a touch under a flat lid could be
/// missed; larger: bodies this close are refined further, or not proved apart.
inline constexpr double kWrapperMargin = 0x1p-44;

/// How far a matrix may be from a rotation (largest row sum of r^T r - 1) for coherent queries to keep lists:
/// thousands of products of rotations drift less than this. What it does to lengths is allowed for (course.hpp),
/// and this times a body's size is less than lists are made for. Larger: longer lists.
inline constexpr double kRigid = 0x1p-24;

/// The builders. None of these decides whether an LRB-rep is right: what they propose is confirmed exactly.

/// Squared sine of the angle under which planes count as parallel when a new vertex is placed (10^-7 rad).
/// Larger: corners between flat neighbours are not found; smaller: they are found far off, where rounding
/// puts them.
inline constexpr double kParallelSineSq = 1e-14;
/// Distance that a new vertex keeps from the planes it must be in front of, relative to the radius of the
/// star it replaces. Smaller: exact confirmation fails on rounding; larger: hulls swell, layer by layer.
inline constexpr double kPlacementMargin = 1e-6;
/// Slack of the placement's own comparisons, relative to the same radius: well under the margin, above
/// rounding.
inline constexpr double kPlacementSlack = 1e-9;
/// A cap's collapse may add this much volume, relative to the patch's area to the power 1.5. Larger: simpler
/// hulls that stand further off; smaller: more layers.
inline constexpr double kCapVolumeLimit = 0.1;
/// Weight of the worst new triangle's shape against volume in the cost of a collapse: needles cost
/// kCapShapeWeight area^1.5 / quality.
inline constexpr double kCapShapeWeight = 1e-4;
/// A cap must have at most this share of the triangles it covers, as long as passes find such. Larger: more
/// regions and faces in all (measured on six bodies: 1.55 faces per real one at 0.8, 1.49 at 0.45); smaller:
/// passes stop early.
inline constexpr double kCapWorth = 0.45;
/// The same for the last passes, and for bridging.
inline constexpr double kLastCapWorth = 0.8;
/// Early hulls of large bodies stay in the polytope of 26 directions about the body moved outward by this
/// share of the body's width. Larger: hulls swell, and the outermost wrapper, which is planned around one of
/// them, with them.
inline constexpr double kHullSwell = 0.01;
/// Distance of the outermost wrapper from the hull it is planned around, relative to the body's largest
/// extent. Larger: looser (measured on six bodies: 1.1-1.2 times the convex hull's volume at 0.003, 1.2-1.4
/// at 0.01); smaller: later hulls have no room to grow where it touches.
inline constexpr double kPolytopeDistance = 0.005;
/// Distance that later hulls keep from the outermost wrapper, relative to its largest extent. Smaller:
/// confirmation that it holds them fails on rounding, and another one is put around.
inline constexpr double kHullDistance = 1e-6;

/// Volumes that should be equal may differ by this much of the outermost wrapper's volume: the rounding of
/// sums over up to millions of faces. Only validate() looks at it, beside exact checks. Smaller: false alarms
/// on large bodies.
inline constexpr double kVolumeRounding = 0x1p-33;

/// A contact region's average normal is given only if the weighted normals do not cancel to less than this
/// share of their weight. Without unit. Smaller: normals made of rounding errors.
inline constexpr double kContactNormalLeast = 0x1p-20;

/// How far from a coplanar contact interiors_overlap() looks for a point inside both bodies, as shares of the
/// contact's size. Only such a point counts, wherever it is found. Fewer: "unknown" for thinner wedges.
inline constexpr double kInteriorProbes[] = {0x1p-4, 0x1p-20, 0x1p-52, 0x1p-80};

/// Most cells that interiors_overlap() samples in one face, and in all, before it answers "unknown". Larger:
/// rare configurations with thousands of contacts on one face are decided too, in minutes instead of never.
inline constexpr unsigned kInteriorCellsPerFace = 256;
inline constexpr unsigned kInteriorCells = 20000;
/// Pairs of crossing faces among which interiors_overlap looks for a proof. One in two is one; fewer:
/// "unknown" for bodies that touch themselves nearly everywhere.
inline constexpr unsigned kCrossingsTried = 256;

}  // namespace lrb
