#pragma once
/// The small constants of the clash query, as tolerances.hpp has them for the rest of the engine: each with
/// its unit, its reason, and what breaks if it is changed.
///
/// The clash query. It sees bodies in units in which no coordinate, nor any difference of two, exceeds 1
/// (unit_bodies.hpp): lengths and volumes are in these units. u = 2^-53.

namespace lrb {

/// Bound on what a coordinate in units is off: it is at most 1/2, and a difference of doubles.
inline constexpr double kUnitRounding = 0x1p-53;
/// A half-space that holds everything, in units.
inline constexpr double kUnitReach = 2;
/// Distance by which a triangle must lie beyond a plane to be proved beyond it, per unit of the normal's
/// |n|_1: two products n . x of points whose coordinates are at most 1, each off by 3 u |n|_1, twice the
/// point's own kUnitRounding |n|_1 (the triangle's corner, and the point that was found inside), the sum with
/// this margin, u, and half of u for each time that a triangle was divided: 15 u in all, of 32.
inline constexpr double kConvexMargin = 0x1p-48;
inline constexpr unsigned kMostSplits = 6;
/// Shares by which convex sets are shrunk until they are proved to lie in a body. Larger: looser lower ends
/// of depths.
inline constexpr double kShrinks[] = {0x1p-42, 0x1p-36, 0x1p-28, 0x1p-18};
/// A triangle whose doubled area is less than this share of its longest edge's square says nothing about
/// being convex; neither do corners less than kHollow in front of a face. Anything else is proved, so these
/// only save work.
inline constexpr double kSliver = 0x1p-20, kHollow = 0x1p-28;
/// Number of triangles that may need another's plane, and of corners times triangles, up to which a body is
/// tried as a convex one. Larger: seconds.
inline constexpr unsigned kMostHardTriangles = 1000;
inline constexpr double kMostConvexWork = 1e9;
/// Share of its first offset that a half-space about a point keeps when others' triangles are put behind it;
/// the number of half-spaces; and how near the surface may come to the point. Larger share: more half-spaces,
/// larger sets.
inline constexpr double kLittleLost = 0.97;
/// Share of an offset by which a plane is moved as if for rounding, and by which what is clipped by it may
/// stand before it.
inline constexpr double kFlatShare = 0x1p-40, kClipShare = 0x1p-45;
inline constexpr unsigned kMostHalfSpaces = 400;
inline constexpr double kLeastClearance = 0x1p-36;
/// Smallest gain for which the EPA polytope of a Minkowski difference is grown. Smaller: no nearer to the
/// depth than rounding.
inline constexpr double kDepthGain = 0x1p-48;
/// Maximum number of steps by which it is grown. Fewer: wide intervals for round bodies.
inline constexpr unsigned kMostDepthSteps = 1500;
/// The same if the polytope only has to contain the origin, or to give a first direction.
inline constexpr unsigned kRoughDepthSteps = 100;
/// Bound on the error of a difference of two points of convex sets whose coordinates are at most 1: 2 u in
/// length for the difference, and 4 u where one of them was moved by a product before.
inline constexpr double kDifferenceRounding = 0x1p-50;
/// What is added to a translation before it is proved to part two bodies, times 8 as often as that is needed,
/// up to kMostPartingMargin; and how narrow the way out is narrowed down to. Smaller: nothing between
/// rounding and it.
inline constexpr double kPartingMargin = 0x1p-42, kMostPartingMargin = 0x1p-6;
/// Largest world coordinate up to which translations are tried: beyond it they could overflow.
inline constexpr double kLargestMoved = 0x1p1020;

// The search for the shortest separating translation of bodies that are not convex. These only bound how long
// it takes; what it finds is proved apart.

/// Directions are deduplicated on a grid of 1 / kDirectionGrid (about 0.6 degrees).
inline constexpr double kDirectionGrid = 100;
/// Number of directions that are tried: those of largest contact area, and those of largest face area.
inline constexpr unsigned kDirectionsInContact = 32, kDirectionsOfFaces = 16;
/// Number of lengths that are tried in each direction, and in the best one at the end.
inline constexpr int kDirectionSamples = 16, kWaySamples = 128;
/// Share by which a direction's translation must be shorter than the best one so far.
inline constexpr double kDirectionGain = 0x1p-20;
/// The best direction is refined by rotations of decreasing angle: the first and the last angle, in radians,
/// and the share of the angle by which a rotation must shorten the translation.
inline constexpr double kFirstTurn = 0.2, kLeastTurn = 1e-5, kTurnGain = 0x1p-6;
/// Maximum number of rotations, and of steps of the other searches.
inline constexpr unsigned kMostSteps = 200;

/// Where to look for the point that lies deepest in both bodies: points of a grid, so many each way, or twice
/// and four times as many if none of them lies in both; then steps, until they are this share of its
/// clearance. A point counts as deeper if it is so by more than rounding (kClearlyMore).
inline constexpr int kStartGrid = 6, kFinestStartGrid = 24;
inline constexpr double kStartStep = 0x1p-6, kClearlyMore = 1e-9;
/// What clearances are less than distances, in units: 10 u for the product that bounds them, kUnitRounding in
/// each coordinate of the triangle; and what room two balls must have beyond the translation that they stand
/// for, for the rounding of their middles. Smaller than 2^-49: unproved.
inline constexpr double kClearanceMargin = 0x1p-46, kRoomMargin = 0x1p-46;
/// How long it is tried to prove that bodies overlap after short translations: until the lower end is this
/// share of the upper one, or so many points have been looked at, in so many parts. Larger: narrower depths.
inline constexpr double kNarrowDepth = 0.99;
inline constexpr unsigned kMostRoomPoints = 12000, kRoomLooks = 24;
/// Where to look for a point with room enough for a cube of translations; nothing is proved by these. Points
/// of that many cubes nearby that were proved are begun with. Where that gives less than kNearlyEnough of the
/// room needed, the cube is rather divided than looked at more closely; but not a cube that is smaller than
/// kSmallCube of what is missing to the upper end: for it, points of 2 kOtherSeeds others are tried, too.
/// Steps to more room are not tried below kLeastClimb of the room needed, nor cubes below kLeastCube.
inline constexpr unsigned kSeeds = 3, kOtherSeeds = 8;
inline constexpr double kNearlyEnough = 0.5, kSmallCube = 0x1p-3, kLeastClimb = 0x1p-4, kLeastCube = 0x1p-30;
/// How often the proof of a way out goes on from another common point, and where along the way it went
/// before.
inline constexpr unsigned kMostWaySteps = 40;
inline constexpr double kWayShare = 0.9;

/// Bound on the error of a point's share of an edge, 1e-13 for the point and a few roundings; where
/// coordinates are larger than the edge, 2^-8 of this and more for each time that they are, which is 16 of
/// their roundings. Larger: more faces are cut in rational arithmetic.
inline constexpr double kShareRounding = 0x1p-41;

}  // namespace lrb
