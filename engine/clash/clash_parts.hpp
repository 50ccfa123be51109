#pragma once
/// One clash query, with buffers that later queries reuse, and the parts that it consists of. Internal: users
/// of the installed engine include clash.hpp.

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/clash/clash_tolerances.hpp"
#include "engine/collide/query_context.hpp"
#include "engine/distance/distance_context.hpp"
#include "engine/mesh/box_tree.hpp"
#include <lrbscope/clash.hpp>

namespace lrb {

/// Performs the query of clash() in clash.hpp. probe: null, or notified of bounds.
ClashResult clash(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                  const ClashRequest& request, DistanceContext& context, ClashProbe* probe = nullptr);

}  // namespace lrb

namespace lrb {

// The triangles of two bodies in the world, relative to the centre of their common box and in a unit in
// which no coordinate exceeds 1/2.

using Eigen::Vector3d;

struct UnitBody {
  std::vector<Vector3d> points;  ///< each coordinate within kUnitRounding of the exact one
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< outward, also for mirrored bodies
};

/// From world to unit coordinates: subtract `origin`, divide by 2^exponent.
struct UnitFrame {
  Vector3d origin{0, 0, 0};
  int exponent = 0;

  Vector3d to_unit(const Vector3d& world) const;
  Vector3d to_world(const Vector3d& unit) const;
  /// Returns a length in world units. Exact, unless it overflows or underflows.
  double length_to_world(double x) const;
};

struct UnitBodies {
  UnitFrame frame;
  UnitBody body[2];
};

/// Returns the bodies with which a context was begun. Both must have faces.
UnitBodies unit_bodies(QueryContext& context);

/// An AABB tree of the triangles of a body, for the distance of a point from its surface.
class SurfaceDistance {
 public:
  /// Keeps a reference to the body.
  explicit SurfaceDistance(const UnitBody& body);

  /// Returns the clearance of a point whose coordinates are at most 2: the open ball of that radius around it
  /// is proven to contain no point of the surface. It is less than the distance by kClearanceMargin and
  /// rounding, independently of the triangulation of the surface. Returns 0, early, if it is at most
  /// `enough`.
  double at(const Vector3d& x, double enough = -1) const;

 private:
  double bound(std::uint32_t triangle, const Vector3d& x) const;

  const UnitBody& body_;
  BoxTree tree_;  ///< of the triangles
};

// Convex sets that are proven to be inside a body.

/// Points whose convex hull is the set; unit coordinates, without rounding. The proof that the set is inside
/// the body: a plane separates every triangle of the body from the set by more than all rounding, so that the
/// surface does not enter the set, and one point of the set is inside.
using ConvexPoints = std::vector<Vector3d>;

/// Returns nearly all of a body that is convex up to rounding, or nullopt if the body is not convex: its
/// points, moved towards `inside` by the least of kShrinks for which the proof succeeds. `inside`: a point
/// that was located inside the body, up to kUnitRounding.
std::optional<ConvexPoints> shrunken_body(const UnitBody& body, const Vector3d& inside);

/// Whether planes may be placed in front of entire triangles if the proof fails with planes in front of the
/// nearest points. The sets are then smaller, and depend on the triangulation.
enum class WholeTriangles : std::uint8_t { no, yes };

/// Returns a large convex set around a point inside, or nullopt if the surface is too near or the proof
/// fails. The set is bounded by planes in front of the nearest points of the surface, added one after the
/// other (as in Deits and Tedrake, "Computing Large Convex Regions of Obstacle-Free Space", 2015, without
/// their ellipsoids).
std::optional<ConvexPoints> convex_about(const UnitBody& body, const Vector3d& inside, WholeTriangles whole);

/// Proves that two bodies overlap after all translations that are short enough (overlap_proof.cpp).
class OverlapProof {
 public:
  /// Returns true if a point is inside a body (units; B at its pose, before any translation).
  using IsInside = std::function<bool(Side, const Vector3d&)>;
  /// Keeps references to the surfaces.
  OverlapProof(const SurfaceDistance& a, const SurfaceDistance& b, IsInside is_inside);

  /// Begins with common points of both bodies, the best first, and with all translations shorter than `most`,
  /// which must be less than 2 and should be slightly above the depth. Returns false if no point is in both
  /// bodies.
  bool begin(const std::vector<Vector3d>& common, double most);
  /// Continues until about `max_points` more points have been tried, or no larger bound can be proven.
  /// Returns the number of points tried.
  unsigned grow(unsigned max_points);
  /// Returns a proven lower bound: after all shorter translations of B the interiors overlap.
  double lower() const { return lower_; }
  /// Returns a translation near the shortest one that is not proven, which may separate the bodies, or 0 if
  /// no cube is left.
  Vector3d undecided() const { return cubes_.empty() ? Vector3d(Vector3d::Zero()) : cubes_.front().centre; }

 private:
  /// A point of both bodies, for a translation.
  struct Common {
    Vector3d x{0, 0, 0}, of_b{0, 0, 0}, shift{0, 0, 0};  ///< x, x - v and v
    double clear_a = 0, clear_b = 0;                     ///< of x from A's surface, of x - v from B's
    double room() const { return clear_a + clear_b; }
  };
  struct Cube {
    double least;  ///< lower bound on the length of its translations
    Vector3d centre;
    double half;
    Common near;  ///< of a nearby translation
  };
  void push(const Vector3d& centre, double half, const Common& near);
  bool evaluate(const Vector3d& x, const Vector3d& v, const Common& near, const Common& least, Common& out);
  bool is_in(Side side, const Vector3d& x, double radius, const Vector3d& known, double known_radius);
  void add_seeds(const Cube& cube, std::vector<Common>& out) const;
  bool find_room(const Cube& cube, double needed, const Common& seed, Common& best);
  bool prove(const Cube& cube, Common& best);
  void climb(double needed, bool thorough, Common& best);
  static bool has_more(const Common& x, const Common& y) { return x.room() > y.room() * (1 + kClearlyMore); }
  bool is_small(const Cube& cube) const { return cube.half < kSmallCube * (most_ - cube.least); }

  const SurfaceDistance &a_, &b_;
  IsInside is_inside_;
  /// The initial points, followed by those for the centres of the proven cubes.
  std::vector<Common> found_;
  std::size_t first_ = 0;    ///< number of initial points
  std::vector<Cube> cubes_;  ///< a min-heap
  double most_ = 0, lower_ = 0;
  unsigned points_ = 0;
};

// The measures of an overlap.

/// Bounds the penetration depth and the depth along a direction, each if it is requested, of solids whose
/// interiors overlap. Lower bounds come from overlapping sets inside the bodies, upper bounds from
/// translations that are proven to separate. For convex bodies both agree up to rounding. query: begun with
/// the bodies. found: all pairs of intersecting simplices. adapter: null, or notified of bounds on the depth.
void measure_depth(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                   const ClashRequest& request, QueryContext& query, const CollideResult& found,
                   const UnitBodies& bodies, BoundsProbeAdapter* adapter, ClashResult& result);

/// Returns an interval that contains the volume of the intersection of two bodies, in unit lengths cubed. The
/// bodies must be closed and must not intersect themselves.
///
/// Along x a closed surface is a signed sum of prisms: a point is inside if, of the triangles above it, one
/// more faces up than down. So the common volume is the sum over all pairs of triangles, one of each body, of
/// the integral of the lower height over the intersection of their projections, with the product of their
/// orientations as sign. No configuration is degenerate; only rounding has to be bounded.
ProvedInterval shared_volume(const UnitBodies& bodies);

}  // namespace lrb
