#pragma once
/// One distance query, with buffers that later queries reuse. Internal: users of the installed engine include
/// distance.hpp.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "engine/distance/distance_kernel.hpp"
#include "engine/distance/nearest_pairs.hpp"
#include <lrbscope/distance.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

/// Reports bounds to a probe when they change.
class BoundsProbeAdapter {
 public:
  explicit BoundsProbeAdapter(BoundsProbe& probe) : probe_(probe) {}

  /// Reports the intersection of these bounds with all reported before, if it is narrower.
  void notify(std::uint64_t work, double lower, double upper) {
    const Bounds now{std::max(work, known_.work), std::max(lower, known_.lower),
                     std::min(upper, known_.upper)};
    if (now.lower == known_.lower && now.upper == known_.upper) return;
    put(now);
  }
  /// Reports the bounds of the answer, even if bounds reported before were narrower.
  void settle(std::uint64_t work, double lower, double upper) {
    if (lower == known_.lower && upper == known_.upper) return;
    put({std::max(work, known_.work), lower, upper});
  }

  /// Returns the work count of the next report. Intervals grow geometrically, to limit the number of reports.
  static std::uint64_t next_look(std::uint64_t work) { return work + 1 + work / 16; }

 private:
  void put(const Bounds& now) {
    known_ = now;
    probe_.bounds(now);
  }

  BoundsProbe& probe_;
  Bounds known_{0, 0, std::numeric_limits<double>::infinity()};
};

/// Planes that separate pairs of nodes, kept from step to step of a motion.
class FarPairs {
 public:
  /// Passes the cache to the kernel for one step. k.tree: of the same trees at each step. node_pairs: the
  /// number of pairs of nodes of both trees.
  void lend(DistanceKernel& k, std::size_t node_pairs);

 private:
  std::vector<FarNodes> nodes_;
  double m_[3][4] = {};  ///< TreeKernel::m of the last step; 0 before the first, a large change
  double turned_ = 0;    ///< sum of the norms of its changes since planes were last cleared
};

// Bounds the approach of two bodies from one step of a motion to the next.

/// The poses of two bodies.
struct PosePair {
  Pose a, b;
};

/// Returns an upper bound on the decrease of the distance between any point of A and any point of B from
/// `from` to `to`, for points at most `reach` apart at `from`, or infinity if a pose is not a rotation or B
/// becomes mirrored. The bound also holds for all poses in between if the motion of B relative to A is
/// interpolated at constant velocity.
double nearer_by(const LrbRep& a, const LrbRep& b, const PosePair& from, const PosePair& to, double reach);

/// Buffers of a query; one for each thread.
struct DistanceContext {
  QueryContext query;
  std::vector<WaitingNodes> waiting;
  std::vector<ReadyNodes> ready;
  std::vector<FloatPair> near;
  std::vector<MeasuredPair> pairs;
  std::vector<NodeEnd> ends[2];
  std::uint32_t turn = 0;  ///< the last one used in `ends`
};

/// Results of earlier steps of a motion.
struct KnownFromBefore {
  /// A simplex of A and one of B that are likely to be the closest, or to intersect; kNull: unknown.
  std::array<SimplexId, 2> likely = {kNull, kNull};
  FarPairs far;
};

/// Computes the distance as distance() in distance.hpp does. before: null, or the results of earlier steps,
/// which are updated. probe: null, or notified when bounds tighten.
DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request, DistanceContext& context,
                        KnownFromBefore* before = nullptr, BoundsProbe* probe = nullptr);

/// Returns true if floats are accurate enough for the distance: the poses are rotations, the bodies are not
/// too far from each other, and the rounding of their coordinates is small relative to their sizes.
bool suits_floats(const TreeKernel& tree);

/// Traverses two trees in float and measures the remaining pairs in double.
class FloatWalk {
 public:
  /// `tree`: accepted by suits_floats(). unit: query_unit(). descend: find a first pair by descent, because
  /// none is known that is likely to be the closest. far: null, or the planes of earlier steps of a motion.
  FloatWalk(DistanceContext& context, NearestPairs& found, const DistanceRequest& request,
            const TreeKernel& tree, double unit, bool descend, FarPairs* far);

  /// Returns true if the traversal was completed, or if the surfaces were found to intersect. adapter: null,
  /// or notified of bounds.
  bool run(BoundsProbeAdapter* adapter);
  /// Measures the pairs that may be the closest. Returns a lower bound on the distances of all others.
  double measure();
  void count(DistanceCounters& counters) const;

 private:
  void begin_ends();
  void give_room();
  void notify(BoundsProbeAdapter& adapter) const;
  double dropped() const;
  double waiting_lower() const;

  DistanceContext& context_;
  NearestPairs& found_;
  double unit_;
  DistanceKernel k_;
};

}  // namespace lrb
