#pragma once
/// The small constants of the clash query, in the form of tolerances.hpp: each with its unit, its reason, and
/// the effect of changing it.
///
/// The clash query transforms bodies to units in which no coordinate and no difference of two coordinates
/// exceeds 1 (unit_bodies.cpp): lengths and volumes are in these units. u = 2^-53.

namespace lrb {

/// Error bound of a unit coordinate, which is at most 1/2 and a difference of doubles.
inline constexpr double kUnitRounding = 0x1p-53;
/// Half size of a box that contains everything, in units.
inline constexpr double kUnitReach = 2;
/// Distance by which a triangle must be beyond a plane to be proven beyond it, per unit of the normal's
/// |n|_1. It covers two products n . x of points with coordinates of at most 1, with an error of 3 u |n|_1
/// each; twice the points' own kUnitRounding |n|_1 (the triangle's corner, and the point found inside); the
/// sum with this margin, u; and u / 2 for each time that a triangle was divided: 15 u in all, of 32.
inline constexpr double kConvexMargin = 0x1p-48;
inline constexpr unsigned kMaxSplits = 6;
/// Shares by which convex sets are shrunk until they are proven to be inside a body. Larger: looser lower
/// bounds on depths.
inline constexpr double kShrinks[] = {0x1p-42, 0x1p-36, 0x1p-32, 0x1p-28, 0x1p-24, 0x1p-21, 0x1p-18};
/// A triangle whose doubled area is less than kThinTriangle times its longest edge's square is no evidence
/// against convexity; neither is a corner less than kHollow in front of a face. Convexity is proven
/// separately, so these only save work.
inline constexpr double kThinTriangle = 0x1p-20, kHollow = 0x1p-28;
/// A body is tested for convexity only up to this number of triangles that need another triangle's plane, and
/// this product of the numbers of corners and triangles. Larger: seconds.
inline constexpr unsigned kMaxHardTriangles = 1000;
inline constexpr double kMaxConvexWork = 1e9;
/// kLittleLost: share of its first offset that a half-space about a point keeps when it is moved to exclude
/// other triangles. Larger: more half-spaces, larger sets. Below: the number of half-spaces, and the least
/// distance of the surface from the point.
inline constexpr double kLittleLost = 0.97;
/// Share of an offset by which a plane is moved to allow for rounding, and tolerance of clipping by a plane
/// as a share of its offset.
inline constexpr double kFlatShare = 0x1p-40, kClipShare = 0x1p-45;
inline constexpr unsigned kMaxHalfSpaces = 400;
inline constexpr double kMinClearance = 0x1p-36;
/// Smallest gain for which the EPA polytope of a Minkowski difference is expanded. Smaller: no improvement
/// beyond rounding.
inline constexpr double kDepthGain = 0x1p-48;
/// Maximum number of expansion steps. Smaller: wide intervals for round bodies.
inline constexpr unsigned kMaxDepthSteps = 1500;
/// The same maximum if the polytope only has to contain the origin, or to yield a first direction.
inline constexpr unsigned kRoughDepthSteps = 100;
/// Error bound of a difference of two points of convex sets with coordinates of at most 1: 2 u in length for
/// the difference, and 4 u if one point was displaced by a product before.
inline constexpr double kDifferenceRounding = 0x1p-50;
/// kSeparationMargin is added to a translation before it is proven to separate two bodies, times 8 after each
/// failure, up to kMaxSeparationMargin. It is also the resolution of the bisection for a separating
/// translation. Both are smaller if one body is smaller than kSmallBody, in proportion. Smaller: proofs fail
/// because of rounding.
inline constexpr double kSeparationMargin = 0x1p-42, kMaxSeparationMargin = 0x1p-6;
inline constexpr double kSmallBody = 0x1p-4;
/// Largest world coordinate for which translations are tried: beyond it they could overflow.
inline constexpr double kLargestMoved = 0x1p1020;

// The search for the shortest separating translation of bodies that are not convex. These constants only
// bound its running time; its result is proven to separate.

/// Directions are deduplicated on a grid of 1 / kDirectionGrid (about 0.6 degrees).
inline constexpr double kDirectionGrid = 100;
/// Number of directions tried: by largest contact area, and by largest face area.
inline constexpr unsigned kDirectionsInContact = 32, kDirectionsOfFaces = 16;
/// Number of lengths tried in each direction, and in the requested direction of the depth along it.
inline constexpr int kDirectionSamples = 16, kWaySamples = 128;
/// Share by which a direction's translation must be shorter than the best one so far. kSearchShare: to which
/// lengths are bisected before the last one; less than any gain asked for, so that no better direction is
/// lost.
inline constexpr double kDirectionGain = 0x1p-20, kSearchShare = 0x1p-23;
/// The best direction is refined by rotations of decreasing angle: the first and the last angle, in radians,
/// and the share of the angle by which a rotation must shorten the translation.
inline constexpr double kFirstTurn = 0.2, kMinTurn = 1e-5, kTurnGain = 0x1p-6;
/// Maximum number of rotations, and of steps of the other searches.
inline constexpr unsigned kMaxSteps = 200;

/// Search for the common point with the largest clearance: a grid of kStartGrid points per axis, refined up
/// to kFinestStartGrid while no grid point is in both bodies; then steps down to kStartStep of the point's
/// clearance. A clearance counts as larger only if it is larger by more than rounding (kClearlyMore).
inline constexpr int kStartGrid = 6, kFinestStartGrid = 24;
inline constexpr double kStartStep = 0x1p-6, kClearlyMore = 1e-9;
/// kClearanceMargin: amount by which clearances are less than distances, in units, for kUnitRounding in each
/// coordinate of the triangle and 75 u of the products that bound them. kRoomMargin: excess of two clearances
/// over the translations that they prove, for the rounding of their centres. Smaller than 2^-49: not proven.
inline constexpr double kClearanceMargin = 0x1p-46, kRoomMargin = 0x1p-46;
/// The proof that bodies overlap after short translations ends when the lower bound is kNarrowDepth of the
/// upper one, or after kMaxRoomPoints points, which are spent in kRoomLooks rounds. Larger: narrower depth
/// intervals.
inline constexpr double kNarrowDepth = 0.99;
inline constexpr unsigned kMaxRoomPoints = 12000, kRoomLooks = 24;
/// Share of ClashRequest::max_steps after which the search for short translations ends; the rest is left for
/// that proof. Larger: shorter translations, lower ends nearer to 0.
inline constexpr double kShareOfSearch = 0.5;
/// The search for a point with enough clearance for a cell of translations; it proves nothing by itself. It
/// starts at the points of the kSeeds nearest proven cells. If the clearance found is less than kNearlyEnough
/// of that needed, the cell is divided instead of searched further, unless it is thinner than kSmallCell of
/// the remaining distance to the upper bound; for such a cell 2 kOtherSeeds other points are tried as well.
/// Steps below kMinClimb of the clearance needed, and cells thinner than kMinCell, are not tried.
inline constexpr unsigned kSeeds = 3, kOtherSeeds = 8;
inline constexpr double kNearlyEnough = 0.5, kSmallCell = 0x1p-3, kMinClimb = 0x1p-4, kMinCell = 0x1p-30;
/// Maximum number of common points from which the depth along a direction is proven in turn, and the share of
/// each proven length after which the next point is sought.
inline constexpr unsigned kMaxWaySteps = 40;
inline constexpr double kWayShare = 0.9;

/// Error bound of a point's parameter on an edge: 1e-13 for the point, and a few roundings. If coordinates
/// are larger than the edge, the bound grows by 2^-8 of this times their ratio, which is 16 of their
/// roundings. Larger: more faces are cut in rational arithmetic.
inline constexpr double kShareRounding = 0x1p-41;

}  // namespace lrb
