#pragma once
/// Contact manifolds for a solver of rigid-body contacts: a normal and at most 4 points (2D: 2) with signed
/// depths for each region of contact, and ids that persist from step to step.
///
/// As in collide(), the corners of triangles are the doubles given by Pose::apply(), exactly.
///
/// Algorithm:
/// 1. Pairs: near_pairs() finds all pairs of triangles that intersect or are at most `margin` apart, exactly.
/// 2. Regions: two pairs are connected if their triangles share a vertex, or are the same, on both bodies.
/// 3. Normals: for each pair, the axis of least depth among the normals of both triangles and the products
///    of edges (the separating axis test of Gottschalk et al., 1996). An axis counts only if the feature that
///    it touches is extreme on its surface, so that inner edges of a flat surface yield no normals of their
///    own (cf. the Gauss map test: Gregorius, "The Separating Axis Test", 2013).
/// 4. Manifolds: a region is divided into groups of pairs whose normals differ by at most kManifoldAngle from
///    that of the group's deepest pair, which is the manifold's normal (cf. contact patches of PhysX). Every
///    pair of step 1 is in one manifold.
/// 5. Points: both patches of a manifold are projected along its normal. Their depth is linear in each cell
///    of the overlay of both patches, so that the deepest points are corners of the overlay: a vertex of one
///    body on a face of the other, or two edges that cross. The parts that a region encloses in the other
///    body belong to the patches.
/// 6. Reduction: the deepest point, the farthest from it, the one that spans the largest triangle with both,
///    and the one that adds the largest area to it (Gregorius, "Robust Contact Creation for Physics
///    Simulations", 2015; cf. the manifolds of Bullet and Jolt).
///
/// Proven: no pair is missed or added; points named as vertices are the world coordinates of these vertices.
/// Up to rounding: each point is on the triangles of its features, point[0] - point[1] = depth * normal, and
/// no two points of the patches that overlap along the normal have a larger depth. Heuristic: the normals,
/// the division into manifolds, the parts that count as overlapping (faces steeper than kSteepest do not, nor
/// do points between which the segment leaves both bodies), and the choice of points.

#include <array>
#include <compare>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

struct ManifoldRequest {
  /// Maximum distance of speculative contacts, pairs that are near but do not intersect. 0: only pairs that
  /// intersect. Finite, at least 0; world units.
  double margin = 0;
  /// Maximum number of pairs; a query that finds more throws InputError. 0: kMaxPairsWithContacts.
  std::uint64_t max_pairs = 0;
  friend bool operator==(const ManifoldRequest&, const ManifoldRequest&) = default;
};

enum class FeatureKind : std::uint8_t { vertex, edge, triangle };
constexpr auto enum_names(FeatureKind) {
  return std::to_array<EnumName<FeatureKind>>(
      {{FeatureKind::vertex, "vertex"}, {FeatureKind::edge, "edge"}, {FeatureKind::triangle, "triangle"}});
}

/// A vertex, an edge or the interior of a triangle (2D: of a segment) of a body, by its numbers in the body.
struct SurfaceFeatureId {
  FeatureKind kind = FeatureKind::triangle;
  std::uint32_t first = 0;   ///< vertex; lesser vertex of an edge; SimplexId of a triangle
  std::uint32_t second = 0;  ///< greater vertex of an edge; else equal to `first`
  friend auto operator<=>(const SurfaceFeatureId&, const SurfaceFeatureId&) = default;
};

struct ManifoldPoint {
  /// Number of the point. A point that continues one of the previous answer keeps its number.
  std::uint64_t id = 0;
  Eigen::Vector3d point[2];  ///< on A's surface and on B's, world frame
  double depth = 0;          ///< along the normal: positive if the surfaces overlap, negative for a gap
  SurfaceFeatureId on[2];    ///< features of A and of B that contain the points
};

struct ContactManifold {
  /// Unit vector from A to B: moved along it, B leaves A. Zero if no face of the region has an area.
  Eigen::Vector3d normal{0, 0, 0};
  std::vector<ManifoldPoint> points;  ///< 1 to 4 (2D: 1 or 2), the deepest first
  std::vector<std::uint32_t> pairs;   ///< indices into ManifoldResult::pairs, ascending
  std::uint32_t region = 0;           ///< number of the connected region, which may have several manifolds
  /// A pair intersects, or the surfaces overlap at a point (depth above 0, only in a region with a pair that
  /// intersects); otherwise all points are speculative, with depths of at most 0.
  bool intersects = false;
};

struct ManifoldResult {
  std::vector<NearPair> pairs;             ///< all pairs at most `margin` apart, as near_pairs() lists them
  std::vector<ContactManifold> manifolds;  ///< by region
  Pose pose[2];                            ///< of A and of B, for the next answer's comparison
  std::uint64_t next_id = 0;               ///< greater than all ids given so far
};

/// Returns the contact manifolds of body `a` at pose_a and body `b` at pose_b. Bodies may be open, intersect
/// themselves or have faces without area. Faces of a body that is not closed count from both sides, and
/// nothing is inside it.
///
/// previous: the answer of the previous step for the same bodies, or null. Points that continue its points
/// keep their ids, and are preferred where candidates are nearly equivalent: first those with the same
/// features, then those that moved least on A or on B, by less than 2 % of the smaller body.
///
/// The result does not depend on `threads` (0: all cores). Throws InputError as near_pairs() does, for a
/// negative or non-finite margin, and if there are too many pairs.
ManifoldResult contact_manifolds(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                                 const ManifoldRequest& request = {},
                                 const ManifoldResult* previous = nullptr, unsigned threads = 1);

/// Throws InputError for a request that contact_manifolds() rejects.
void check_request(const ManifoldRequest& request);

}  // namespace lrb
