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

/// A norm whose unit ball is a box about 0; by default the largest coordinate.
struct BoxNorm {
  Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();  ///< columns: half edges of the box
  /// The box is { x : |shares x| <= 1 in each coordinate }, whatever the rounding of `edges`.
  Eigen::Matrix3d shares = Eigen::Matrix3d::Identity();
  double least_half = 1;  ///< length of the shortest half edge

  double operator()(const Vector3d& x) const { return (shares * x).cwiseAbs().maxCoeff(); }
};

/// An AABB tree of the triangles of a body, for the distance of a point from its surface.
class SurfaceDistance {
 public:
  /// Keeps a reference to the body.
  explicit SurfaceDistance(const UnitBody& body);

  /// Returns the clearance of a point whose coordinates are at most 2: the open box of that size around it is
  /// proven to contain no point of the surface. It is less than the distance by kClearanceMargin and
  /// rounding, independently of the triangulation of the surface. Returns 0, early, if it is at most
  /// `enough`. normal: null, or set to that of a plane between the box and the nearest triangle: how much
  /// each of the box's axes counts for the distance, in sum 1.
  double at(const Vector3d& x, const BoxNorm& norm, double enough = -1, Vector3d* normal = nullptr) const;

 private:
  double bound(std::uint32_t triangle, const Vector3d& x, const BoxNorm& norm, double enough,
               Vector3d& normal) const;

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
  /// no cell is left.
  Vector3d undecided() const { return cells_.empty() ? Vector3d(Vector3d::Zero()) : cells_.front().centre; }

 private:
  /// A point of both bodies, for a translation.
  struct Common {
    Vector3d x{0, 0, 0}, of_b{0, 0, 0}, shift{0, 0, 0};  ///< x, x - v and v
    double clear_a = 0, clear_b = 0;  ///< of x from A's surface, of x - v from B's, in the cell's norm
    Vector3d blocked{0, 0, 0};        ///< how much each of the cell's axes counts for these
    double room() const { return clear_a + clear_b; }
  };
  /// The translations of lengths low[0] to high[0] in a rectangle of directions, on a face of a cube about 0.
  struct Cell {
    unsigned face;
    Vector3d low, high;  ///< length, and the two coordinates on the face, from -1 to 1
    Common near;         ///< of a nearby translation, in its cell's norm
    Vector3d centre{0, 0, 0};
    BoxNorm norm;      ///< its unit ball about the centre contains the cell
    int longer = 1;    ///< the coordinate of the longer side of the rectangle, the box's axis 1
    double bulge = 0;  ///< extent of the box along the lengths that is due to the range of directions
  };
  void push(Cell cell);
  void split(const Cell& cell, const Common& near);
  bool evaluate(const Cell& cell, const Vector3d& x, const Common& near, const Common& least, Common& out);
  bool is_in(Side side, const Cell& cell, const Vector3d& x, double clear, const Vector3d& known,
             double known_clear);
  void add_seeds(const Cell& cell, std::vector<Common>& out) const;
  bool find_room(const Cell& cell, double needed, const Common& seed, Common& best);
  bool prove(const Cell& cell, Common& best);
  void climb(const Cell& cell, double needed, Common& best);
  static bool has_more(const Common& x, const Common& y) { return x.room() > y.room() * (1 + kClearlyMore); }
  bool is_small(const Cell& cell) const { return cell.norm.least_half < kSmallCell * (most_ - cell.low[0]); }

  const SurfaceDistance &a_, &b_;
  IsInside is_inside_;
  /// The initial points, followed by those for the centres of the proven cells.
  std::vector<Common> found_;
  std::size_t first_ = 0;    ///< number of initial points
  std::vector<Cell> cells_;  ///< a min-heap
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
