#pragma once
/// The distance of two bodies: an interval of doubles that is proven to contain the distance of their
/// surfaces.
///
/// As in collide(), bodies consist of the simplices whose corners are the doubles given by
/// Pose::apply(), exactly. The distance is 0 if and only if the exact query finds an intersecting pair.
///
/// Algorithm: best-first traversal of two BVHs (Quinlan, "Efficient Distance Computation between Non-Convex
/// Objects", 1994). The distance of two boxes bounds that of their contents from below (Larsen, Gottschalk,
/// Lin and Manocha, "Fast Distance Queries with Rectangular Swept Sphere Volumes", 2000; here with OBBs
/// instead of swept rectangles). Simplices are compared in floats first, then in doubles with proven errors
/// (pair_bounds.hpp), and finally in integers (pair_distance.hpp) where the previous stage cannot
/// decide.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <lrbscope/collide.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

struct DistanceRequest {
  /// Decide only whether the distance of the surfaces is at most `within`: DistanceResult::within. The search
  /// stops once that is decided, so the interval may be wide. Finite, at least 0; world units.
  std::optional<double> within;
  /// Maximum width of the interval: the larger of `tolerance` (world units) and `relative_tolerance` times
  /// its upper end. If both are 0: 1e-12 of the larger body's size, or 4 units in the last place of the
  /// distance if that is more; for distances beyond 7e10 times the bodies' size, 2.3e-13 of the distance.
  double tolerance = 0, relative_tolerance = 0;
  /// Maximum number of steps; 0: no limit. A step expands a pair of tree nodes. More steps only narrow the
  /// interval.
  std::uint64_t max_steps = 0;
  /// Determine the relation of bodies whose surfaces do not intersect. If false, DistanceResult::relation is
  /// `undefined` for them.
  bool relation = true;
};

/// A closest point on one body's surface.
struct Witness {
  Eigen::Vector3d point{0, 0, 0};  ///< world frame; on the feature up to rounding
  SimplexId simplex = kNull;
  FaceId face = kNull;     ///< the face of the simplex
  exact::Feature feature;  ///< feature of the simplex: corner, edge or interior
  /// The vertices that span the feature: the first `corner_count` entries.
  std::array<VertexId, 3> corners{kNull, kNull, kNull};
  int corner_count = 0;
};

/// The work done by a distance query.
struct DistanceCounters {
  std::uint64_t steps = 0;            ///< pairs of nodes expanded
  std::uint64_t box_tests = 0;        ///< tests of two boxes
  std::uint64_t pairs_in_floats = 0;  ///< pairs of simplices compared in floats
  std::uint64_t pairs_in_doubles = 0;
  std::uint64_t pairs_exact = 0;
  friend bool operator==(const DistanceCounters&, const DistanceCounters&) = default;
};

struct DistanceResult {
  /// Bounds of the distance of the surfaces. Both 0 if they intersect; otherwise `lower` > 0 unless a limit
  /// was reached or a tolerance permits 0. Infinite if a body has no faces.
  double lower = 0, upper = 0;
  bool meet = false;  ///< the surfaces are proven to have a common point
  /// The answer to DistanceRequest::within; nullopt if a limit was reached before it was decided.
  std::optional<bool> within;
  bool finished = true;  ///< false: max_steps was reached before the interval was narrow enough
  /// The relation of the bodies. If surfaces intersect, it is derived from the first pair found, as for
  /// Mode::any_pair; `unresolved` if it is not known whether they do.
  Relation relation = Relation::undefined;
  /// Closest points of A and of B, at distance `upper` up to rounding; equal if the surfaces intersect.
  /// Simplices are kNull if a body has no faces.
  std::array<Witness, 2> witness;
  DistanceCounters counters;

  /// Bounds of the distance of the solids: 0 also if one contains the other.
  bool solids_meet() const { return meet || is_inside(relation); }
  double solids_lower() const { return solids_meet() ? 0 : lower; }
  double solids_upper() const { return solids_meet() ? 0 : upper; }
};

/// Returns the distance of body `a` at pose_a and body `b` at pose_b. Poses may be any finite affine maps.
/// Throws InputError unless both bodies are 3D or both 2D and world coordinates are finite, and for negative
/// or non-finite numbers in the request.
DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request = {});

/// Throws InputError for a request that distance() rejects: a negative or non-finite number.
void check_request(const DistanceRequest& request);

/// Returns the distances for several poses of B, in their order. The result does not depend on `threads` (0:
/// all cores).
std::vector<DistanceResult> distances(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                      std::span<const Pose> poses_b, const DistanceRequest& request = {},
                                      unsigned threads = 0);

/// Distance queries for two bodies that move little between queries. Starts with the pair of simplices that
/// was closest or intersected before, reuses the relation if the surfaces cannot have intersected in between,
/// and reuses separating planes of parts. Intervals are proven and as narrow as in distance(). If
/// several pairs are equally close, or intersect, the witness may differ, and with it the relation of
/// intersecting surfaces.
class CoherentDistance {
 public:
  /// Stores references to the bodies, which must outlive it and must not be assigned to.
  CoherentDistance(const LrbRep& a, const LrbRep& b, const DistanceRequest& request = {});

  /// Returns the distance for these poses. Throws InputError as distance() does.
  DistanceResult distance(const Pose& pose_a, const Pose& pose_b);

  ~CoherentDistance();
  CoherentDistance(CoherentDistance&&) noexcept;
  CoherentDistance& operator=(CoherentDistance&&) noexcept;

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

// Observing the convergence of a distance query: derive from BoundsProbe and pass it to distance(). The
// answer is the same with and without a probe. Each report takes a pass over all pairs in the queue.

/// Bounds of a number after some work.
struct Bounds {
  std::uint64_t work = 0;       ///< done so far, in steps defined by the query
  double lower = 0, upper = 0;  ///< the number is in [lower, upper]; `upper` is infinite if no upper bound is
                                ///< known yet
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

class BoundsProbe {
 public:
  virtual ~BoundsProbe() = default;
  /// The bounds became narrower. Called in the order of the work.
  virtual void bounds(const Bounds& known) = 0;
};

/// Records all bounds.
class BoundsHistory final : public BoundsProbe {
 public:
  void bounds(const Bounds& known) override { history.push_back(known); }
  std::vector<Bounds> history;
};

/// Returns the same as distance() without a probe, and reports the bounds while they converge. The last
/// bounds are inside those of the answer, and equal to them unless `within` or a tolerance ends the search
/// earlier. Work counts pairs of nodes expanded and pairs of simplices measured in doubles or exactly.
DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request, BoundsProbe& probe);

}  // namespace lrb
