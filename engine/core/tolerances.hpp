#pragma once
/// Numerical constants of the engine, with unit, reason, and the effect of other values. The answer of a
/// query depends on none of them: they only decide how many cases are left to the exact tests.

namespace lrb {

/// Weight of the corners of simplices in the computation of principal axes, relative to the squared diagonal
/// of their box, or of the box of a range that contains them. Gives segments and points (area 0) defined
/// axes. Larger: frames follow the tessellation.
inline constexpr double kFrameCornerWeight = 1e-12;

/// Cost of a box's length when trees are split, as a fraction of its squared diagonal, in addition to half
/// its surface area. Prefers short boxes among those without surface, such as parts of a straight line, which
/// would otherwise be peeled off leaf by leaf. Larger: parts that are small compared with the gaps between
/// them are not separated from the gaps.
inline constexpr double kLengthCost = 1e-5;

/// Height of a triangle, relative to its longest edge, below which `inspect` names it as a sliver. Larger:
/// also long faces of cylinders.
inline constexpr double kSliver = 1e-4;

/// Cost added to a node for each simplex beneath it when binary nodes are collapsed into wide ones. It
/// matters only for boxes smaller than about 1e-4 of the body, or without surface, where it minimises the
/// mean height of the tree. Larger: it also affects larger boxes.
inline constexpr double kSimplexCost = 0x1p-40;

/// Maximum deviation from orthonormality of a node's axes after rounding to float (largest row sum;
/// dimensionless): 8 u, u = 2^-24; rounding uses 5.2 u of it. Larger: kKernelRounding does not hold.
/// Smaller: nodes lose their own axes.
inline constexpr double kFrameDefect = 0x1p-21;

/// Enlargement of quantized boxes, relative to the box's coordinates. Covers the rounding of three products,
/// two sums and one difference in double (under 2^-50) and of decoding in float (under 2^-22). Smaller: a box
/// could lose a corner by rounding. Larger: more pairs to test.
inline constexpr double kTreeRounding = 0x1p-21;
/// Enlargement of quantized boxes for the rounding of a difference of coordinates, which are at most 1 in
/// units.
inline constexpr double kTreeRoundingUnits = 0x1p-50;

/// Error bound of a coordinate that the tree kernel transforms between the frames of two nodes, relative to
/// the sizes involved (radii and distance of the nodes). Derivation, with u = 2^-24:
/// - Relative rotation: a product of three matrices with entries rounded to float and rows of length 1; each
///   entry has an error of at most 16 u.
/// - Inverse by transposition: the axes of a node are orthonormal to 8 u.
/// - Offset: rounded to float and rotated once or twice; 8 u.
/// - Decoding of boxes: 3 u. Products and sums of three terms: 4 u.
/// The sum is below 48 u < 2^-18.
inline constexpr float kKernelRounding = 0x1p-18f;
/// Error bound of a coordinate that is rotated to the other node's axes and back, relative to the sum of the
/// sizes involved. Derivation in kernel_whole.inl: 48 + 112 + 84 + 10 u.
inline constexpr float kWholeRounding = 0x1p-16f;
/// Error bounds of the difference of two corners of one body, in which the error of the offset between the
/// nodes cancels. "Reach" is the size that kKernelRounding refers to.
/// - kOwnEdgeRounding, for the body in whose frame the kernel works, relative to its node's radius: corners
///   are rounded to float, 1 u of the radius each, and their difference by 2 u: 4 u, doubled to leave room
///   for rounding in the bound of products.
/// - kTurnedEdgeRounding, for the other body, relative to its node's radius: the rotation's entries have
///   errors of 16 u and the transposition of 8 u, together 36 u of the length of a difference, which is at
///   most 2 radii; rounding of the corners adds 2.1 u, products and sums 8 u, the difference 2 u: 84.1 u in
///   total.
/// - kFarEdgeRounding, also for the other body, relative to the reach: 3 sums for each corner to which the
///   offset contributes, 6 u.
inline constexpr float kOwnEdgeRounding = 0x1p-21f;
inline constexpr float kTurnedEdgeRounding = 0x1.8p-18f;
inline constexpr float kFarEdgeRounding = 0x1p-21f;
/// Error bound of the displacement of a swept node or simplex, which is rounded to float and rotated twice
/// (see kKernelRounding), relative to the sum of its coordinates' magnitudes.
inline constexpr float kSweepRounding = 0x1p-16f;
/// Factor for sizes that are rounded to float and must not become smaller: 16 u; rounding uses 1 u of it
/// and the arithmetic before it little more.
inline constexpr float kFloatUp = 1 + 0x1p-20f;
/// Added to bounds so that float underflow (an absolute error of 2^-149 per operation) cannot affect a
/// decision.
inline constexpr float kKernelTiny = 0x1p-120f;
/// Returns a size rounded up to float.
inline float rounded_up(double x) {
  return static_cast<float>(x) * kFloatUp + kKernelTiny;
}

/// Error bound of world coordinates and of the relative pose, relative to the largest term that occurs: 4 u
/// for each body's coordinates and 16 u for the relative pose, u = 2^-53.
inline constexpr double kWorldRounding = 0x1p-48;
/// Error bound of the dot product of a unit vector and a point, relative to the sum of the magnitudes of the
/// point's coordinates: three products and two sums, 3 u, u = 2^-53, and as much for the vector's length.
/// Smaller: a plane could be reported as separating although rounding makes it cut a body.
inline constexpr double kPlaneRounding = 0x1p-50;
/// Lower limit of the size for which the rounding of world coordinates is bounded: the smallest normal
/// double. Mesh units. Smaller: contacts of bodies with denormal coordinates could be missed.
inline constexpr double kWorldUnderflow = 0x1p-1022;
/// Safety factor on the sum of the pose's errors, for the conversion between norms; see set_up_kernel().
inline constexpr double kPoseSafety = 4;

/// Maximum deviation of a map from a rotation (largest row sum of r^T r - 1) up to which it is treated as
/// one. It enlarges boxes by 8 times this, relative to the bodies' size, which is far less than
/// kKernelRounding. Larger: fewer pairs are culled. Smaller: products of thousands of rounded rotations take
/// the slower path for general maps.
inline constexpr double kNearRotation = 0x1p-30;
/// Largest world coordinate, relative to the bodies' sizes, for which poses are treated as rotations: the
/// kernel's floats must not overflow.
inline constexpr double kNearEnough = 0x1p100;
/// Smallest singular value of a map, relative to its largest, for which boxes are compared on the body's own
/// axes unchanged; flatter bodies are treated as having this thickness. Smaller: the kernel's rounding, which
/// grows with the inverse, keeps more pairs. Larger: bodies that are merely thin are culled as flat ones.
inline constexpr double kFlatness = 0x1p-8;

/// Added to distances that bound a region's thickness, in units (coordinates are at most about 1).
/// Derivation, with u = 2^-53:
/// - A distance is the length of the difference between a point and a weighted sum of corners: a dozen
///   operations on numbers below 4, together under 2^-46.
/// - A lid is subdivided, and each new corner is computed by three operations per coordinate: under 2^-50,
///   repeated at most kMaxCuts = 2^8 times (thickness.cpp): under 2^-42.
/// Smaller: rounding could exceed an error bound. Larger: the bound is looser by that amount.
inline constexpr double kThicknessRounding = 0x1p-40;
/// Distance from which faces of two wrappers count as disjoint, relative to the largest term of any world
/// coordinate. Hidden faces may protrude from their lid by the rounding of world coordinates (under 2^-50 for
/// both bodies), and the error of the computed distance is smaller than that. Smaller: a touch under a flat
/// lid could be missed. Larger: bodies this close are refined further, or not proven separate.
inline constexpr double kWrapperMargin = 0x1p-44;

/// Factor on the kernel's slack for the traversal of wrappers. With it, pairs that the kernel rejects or
/// decides (crossing or disjoint) stay so under any displacement of vertices by rounding in the wrappers and
/// in the enclosed bodies. Derivation, with S the sum of the largest terms of both bodies' world coordinates:
/// - Rounding moves a vertex by at most sqrt(3) 2^-51 of its own body's largest term. In the deformation of
///   coarse_query.hpp two vertices therefore move relative to each other by less than 2 sqrt(3) 2^-51 S <
///   2^-49 S.
/// - The kernel's own slack is at least 2^-46 S (kPoseSafety kWorldRounding S, and twice that for rotations),
///   and this factor adds as much again.
/// Any factor above 1 + 2^-3 is sufficient. Larger: more pairs are left to exact tests.
inline constexpr float kWrapperSlack = 2;

/// Maximum deviation from a rotation (largest row sum of r^T r - 1) for which coherent queries use candidate
/// caches. Products of thousands of rotations drift less. The effect on lengths is accounted for
/// (relative_motion.hpp), and this times a body's size is less than the motions that caches are made for.
/// Larger: larger caches.
inline constexpr double kRigid = 0x1p-24;

/// Distance queries.

/// Relative error bound of a length computed by the distance kernel, in addition to the errors of
/// coordinates. Nodes' axes are orthonormal to kFrameDefect, which changes lengths by half of it; poses are
/// rotations to kNearRotation; squares, sums and roots add a few 2^-24. Smaller than 2^-21: a closer pair
/// could be pruned. Larger: more pairs are kept.
inline constexpr float kDistanceRounding = 0x1p-18f;
/// Error bound of a distance of two simplices in doubles, relative to the largest difference of any
/// coordinates: 64 u, u = 2^-53 (pair_bounds.cpp). Smaller: an interval could miss the distance. Larger:
/// wider intervals.
inline constexpr double kPairRounding = 0x1p-47;
/// Default width of an interval, relative to the larger body's size, but at least a few units in the last
/// place of the distance (kDistanceWidthUlps, relative to the distance).
inline constexpr double kDistanceWidth = 1e-12;
inline constexpr double kDistanceWidthUlps = 0x1p-50;
/// Distance of the bodies' origins, in units of the larger one, beyond which trees are traversed in doubles,
/// because floats could not resolve the bodies. Larger: floats keep more pairs. Smaller: the slower doubles
/// are used more often.
inline constexpr double kFarForFloats = 32;
/// Distance relative to the bodies' sizes from which intervals are kFarWidth of the distance wide, because
/// world coordinates have hardly any digits left for the shapes. Larger: all faces of such bodies are
/// compared with each other.
inline constexpr double kVeryFar = 0x1p36;
inline constexpr double kFarWidth = 0x1p-42;

/// First contact.

/// Maximum deviation from a rotation (largest row sum of r^T r - 1) of the two poses of a screw motion: that
/// of matrices written with three digits. Larger: the logarithm would be taken of a matrix that is not close
/// to a rotation.
inline constexpr double kMotionDefect = 4e-3;
/// Error bound of a moving vertex, relative to the largest terms of its position: 8 u, u = 2^-53; derived in
/// motion_bounds.hpp. Smaller: a contact could be missed by rounding. Larger: wider intervals at tangential
/// contacts.
inline constexpr double kMotionRounding = 0x1p-50;

/// Builders. The validity of an LRB-rep depends on none of these constants, because every proposal of a
/// builder is verified exactly.

/// Squared sine of the angle below which planes count as parallel when a new vertex is placed (10^-7 rad).
/// Larger: corners between nearly coplanar neighbours are not found. Smaller: corners are placed far away by
/// rounding.
inline constexpr double kParallelSineSq = 1e-14;
/// Distance of a new vertex from the planes that it must be in front of, relative to the radius of the star
/// that it replaces. Smaller: the exact verification fails due to rounding. Larger: fronts grow layer by
/// layer.
inline constexpr double kPlacementMargin = 1e-6;
/// Tolerance of the comparisons during placement, relative to the same radius: well below the margin, but
/// above rounding.
inline constexpr double kPlacementSlack = 1e-9;
/// In 2D: maximum area that a cap may add, relative to its chain's length^2. Larger: simpler
/// fronts with a larger deviation. Smaller: more layers.
inline constexpr double kCapVolumeLimit = 0.1;
/// Weight of the worst new triangle's shape, relative to volume, in the cost of a collapse: a needle costs
/// kCapShapeWeight area^1.5 / quality.
inline constexpr double kCapShapeWeight = 1e-4;
/// Maximum number of faces of a cap, relative to the faces it covers, as long as passes find such caps.
/// Larger: more regions and faces in total (measured on six bodies: 1.55 faces per real one at 0.8, 1.49 at
/// 0.45). Smaller: passes stop early.
inline constexpr double kCapWorth = 0.45;
/// The same ratio in the last passes, and for bridging.
inline constexpr double kLastCapWorth = 0.8;
/// Early fronts of large bodies stay inside the body's 26-DOP, offset outward by this fraction of the body's
/// width. Larger: fronts grow, and with them the outermost wrapper, which is planned around one of them.
inline constexpr double kFrontSwell = 0.01;
/// Distance of the outermost wrapper from the front that it is planned around, relative to the body's largest
/// extent. Larger: a looser wrapper (measured on six bodies: 1.1-1.2 times the convex hull's volume at 0.003,
/// 1.2-1.4 at 0.01). Smaller: later fronts have no room to grow where they touch it.
inline constexpr double kPolytopeDistance = 0.005;
/// Distance of later fronts from the outermost wrapper, relative to its largest extent. Smaller: the
/// verification that the wrapper contains them fails due to rounding, and another wrapper is added around
/// them.
inline constexpr double kFrontDistance = 1e-6;

/// Maximum difference of volumes that should be equal, relative to the outermost wrapper's volume: the
/// rounding of sums over up to millions of faces. Used only by validate(), in addition to exact checks.
/// Smaller: false alarms for large bodies.
inline constexpr double kVolumeRounding = 0x1p-33;

/// Minimum length of the weighted sum of a contact region's normals, relative to the total weight, for an
/// average normal to be reported. Dimensionless. Smaller: normals that consist of rounding errors.
inline constexpr double kContactNormalLeast = 0x1p-20;

/// Contact manifolds. They affect normals and the choice of points, never the list of pairs.

/// Cosine of the largest angle (20 degrees) between a manifold's normal and those of its pairs. Larger: a
/// curved contact is divided into more manifolds. Smaller: the sides of a groove share a normal.
inline constexpr double kManifoldAngle = 0.94;
/// Height of a neighbour over a vertex that counts as an extreme one, relative to their distance. Larger:
/// inner edges of slightly curved surfaces yield normals. Smaller: flat surfaces rounded to float are not
/// recognised as flat.
inline constexpr double kExtremeSlope = 1e-3;
/// Advantage in depth, relative to the extent of the two triangles, that another axis must have over one
/// found before. Smaller: rounding decides between axes of equal depth.
inline constexpr double kAxisAdvantage = 1e-6;
/// Cosine between a face's normal and the manifold's up to which the face carries contact points. Smaller:
/// rounding across the face is enlarged by its inverse.
inline constexpr double kSteepest = 0.3;
/// Ratio of depths from which the deeper of two axes is on the far side of a body or of an overlap. Larger:
/// solvers get normals across deep overlaps. Smaller: one of two walls is missing from a deep corner.
inline constexpr double kFarAxis = 2;
/// Least cosine between the normal of two edges in contact and those of the faces beside them. Smaller: an
/// edge on the far side of a body yields a normal. Larger: sharper edges have no normals.
inline constexpr double kSteepestEdge = 0.05;
/// Barycentric weight up to which a point is on the boundary of a projected triangle. Larger: points leave
/// the triangle by this fraction of it. Smaller: rounding loses vertices on edges.
inline constexpr double kOverlayRounding = 1e-9;
/// Sine of the angle up to which projected edges count as parallel: their crossing would be ill-conditioned.
inline constexpr double kParallelEdges = 1e-6;
/// Factor of the spread of points that were chosen in the previous step.
inline constexpr double kChosenBefore = 1.05;
/// Least spread of the points of a manifold, relative to the smaller body's size or to the points' distance.
inline constexpr double kSpreadLeast = 1e-6;
/// Depth, relative to the smaller body's size, from which a point must be inside one of the bodies. Smaller:
/// points on the surface are rejected because of rounding.
inline constexpr double kDepthRounding = 1e-9;
/// Distance, relative to the smaller body's size, by which a contact point moves at most in a step and keeps
/// its id although its features change.
inline constexpr double kContactMoves = 0.02;

/// Distances from a coplanar contact at which interiors_overlap() searches for a point inside both bodies,
/// relative to the contact's size. A point at any of them is a proof. Fewer distances: "unknown" for thinner
/// wedges.
inline constexpr double kInteriorProbes[] = {0x1p-4, 0x1p-20, 0x1p-52, 0x1p-80};

/// Maximum number of cells that interiors_overlap() samples in one face, and in total, before it returns
/// "unknown". Larger: rare configurations with thousands of contacts on one face are decided as well, in
/// minutes.
inline constexpr unsigned kInteriorCellsPerFace = 256;
inline constexpr unsigned kInteriorCells = 20000;
/// Number of pairs of crossing faces that interiors_overlap() tries for a proof. About one in two yields a
/// proof. Fewer: "unknown" for bodies that touch themselves nearly everywhere.
inline constexpr unsigned kCrossingsTried = 256;

}  // namespace lrb
