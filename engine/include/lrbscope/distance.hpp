#pragma once
/// How far two bodies are apart: an interval of doubles that is proved to hold the distance of their
/// surfaces.
///
/// The distance is that of the contract of collide(): of the simplices whose corners are the doubles that
/// Pose::apply() gives, exactly. It is 0 where the exact query finds a pair that meets, and only there.
///
/// Two trees of boxes are walked, pairs of nodes whose boxes are nearest first; the distance of two boxes is
/// a lower bound for all in them (Larsen, Gottschalk, Lin, Manocha, "Fast Distance Queries with Rectangular
/// Swept Sphere Volumes", 2000, with oriented boxes in place of swept rectangles; best first as Quinlan,
/// "Efficient Distance Computation between Non-Convex Objects", 1994). What floats cannot tell is compared in
/// doubles with proved errors (pair_bounds.hpp), and what these cannot, in integers
/// (exact/pair_distance.hpp).

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
  /// Asks only whether the surfaces are this near (at most `within`): DistanceResult::within. The interval
  /// then is as narrow as it was when that was decided. Finite, at least 0; unit: the world's.
  std::optional<double> within;
  /// The interval may be as wide as the larger of `tolerance` (unit: the world's) and `relative_tolerance`
  /// times its upper end. 0, 0: at most 1e-12 of the larger body's size, or 4 units in the last place of the
  /// distance where that is more; beyond 7e10 times the bodies' size, 2.3e-13 of the distance.
  double tolerance = 0, relative_tolerance = 0;
  /// The largest number of steps; 0: no limit. A step opens a pair of nodes of the trees. With more steps the
  /// interval only becomes narrower.
  std::uint64_t max_steps = 0;
  /// Decide how bodies lie whose surfaces do not meet. Without it, DistanceResult::relation is always
  /// `undefined` for them.
  bool relation = true;
};

/// A point of one body's surface.
struct Witness {
  Eigen::Vector3d point{0, 0, 0};  ///< the world; but for rounding, on the feature
  SimplexId simplex = kNull;
  FaceId face = kNull;     ///< whose simplex it is
  exact::Feature feature;  ///< of the simplex: corner, edge or inside
  /// The vertices that span the feature: the first `corner_count` of them.
  std::array<VertexId, 3> corners{kNull, kNull, kNull};
  int corner_count = 0;
};

/// The work that a distance took.
struct DistanceCounters {
  std::uint64_t steps = 0;            ///< pairs of nodes that were opened
  std::uint64_t box_tests = 0;        ///< boxes compared
  std::uint64_t pairs_in_floats = 0;  ///< pairs of simplices compared in floats
  std::uint64_t pairs_in_doubles = 0;
  std::uint64_t pairs_exact = 0;
  friend bool operator==(const DistanceCounters&, const DistanceCounters&) = default;
};

struct DistanceResult {
  /// Hold the distance of the surfaces. Both 0 if they meet; else the lower end is more than 0 unless a limit
  /// was reached or a tolerance leaves room for 0. Infinite if a body has no faces.
  double lower = 0, upper = 0;
  bool meet = false;  ///< the surfaces are proved to have a point in common
  std::optional<bool>
      within;            ///< the answer to DistanceRequest::within; none if a limit was reached before it
  bool finished = true;  ///< false: max_steps were reached before the interval was narrow enough
  /// How the bodies lie. For surfaces that meet, what the first pair found shows, as for Mode::any_pair;
  /// `unresolved` where it was not found out whether they do.
  Relation relation = Relation::undefined;
  /// Of A and of B, `upper` apart but for rounding; equal if they meet. Simplices are kNull if a body has no
  /// faces.
  std::array<Witness, 2> witness;
  DistanceCounters counters;

  /// The distance of the solids: 0 also where one holds the other.
  bool solids_meet() const {
    return meet || relation == Relation::a_inside_b || relation == Relation::b_inside_a;
  }
  double solids_lower() const { return solids_meet() ? 0 : lower; }
  double solids_upper() const { return solids_meet() ? 0 : upper; }
};

/// Returns the distance of body `a` at pose_a and body `b` at pose_b; both must be 3D, or both 2D. Poses may
/// be any finite maps, and world coordinates must be finite. Throws InputError for these, and for numbers of
/// the request that are negative or not finite.
DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request = {});

/// Throws InputError for a request that distance() rejects: a number that is negative or not finite.
void check_request(const DistanceRequest& request);

/// Returns the distances for some poses of B, in their order; the same for any number of threads (0: all
/// cores).
std::vector<DistanceResult> distances(const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                                      std::span<const Pose> poses_b, const DistanceRequest& request = {},
                                      unsigned threads = 0);

/// Asks for two bodies again and again as they move by little: begins with the pair of simplices that was
/// nearest before, or met, keeps how they lie where they cannot have met in between, and planes that hold
/// parts of them apart. Intervals are proved as those of distance() are, and as narrow; where pairs are
/// equally near, or several meet, the witness may be another, and the relation of surfaces that meet is what
/// that pair shows.
class CoherentDistance {
 public:
  /// Keeps references to the bodies, which must outlive it. Do not assign to them.
  CoherentDistance(const LrbRep& a, const LrbRep& b, const DistanceRequest& request = {});

  /// Returns the answer for these poses. Throws InputError as distance() does.
  DistanceResult distance(const Pose& pose_a, const Pose& pose_b);

  ~CoherentDistance();
  CoherentDistance(CoherentDistance&&) noexcept;
  CoherentDistance& operator=(CoherentDistance&&) noexcept;

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

// Watching how the bounds of a distance tighten, from outside the engine: derive from BoundsProbe and give
// it to distance(). The answer is the same as without; what is told costs a look at all pairs that wait.

/// What is known of a number after some work.
struct Bounds {
  std::uint64_t work = 0;       ///< done until then, in steps that the query names
  double lower = 0, upper = 0;  ///< hold the number; `upper` is infinite where none is known yet
  friend bool operator==(const Bounds&, const Bounds&) = default;
};

class BoundsProbe {
 public:
  virtual ~BoundsProbe() = default;
  /// Bounds became narrower: in the order of the work.
  virtual void bounds(const Bounds& known) = 0;
};

/// Keeps what it is told.
class BoundsCourse final : public BoundsProbe {
 public:
  void bounds(const Bounds& known) override { course.push_back(known); }
  std::vector<Bounds> course;
};

/// Does what distance() in distance.hpp does, and tells the probe what is known, after more and more work:
/// the last bounds lie within those of the answer, and are the answer's unless `within` or a tolerance asks
/// for less. Work is counted in pairs of nodes opened and pairs of simplices measured in doubles or exactly.
DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request, BoundsProbe& probe);

}  // namespace lrb
