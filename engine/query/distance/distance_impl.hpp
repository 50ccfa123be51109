#pragma once
/// One distance query, with memory that the next one can use again: for code of ours. Users of the installed
/// engine have distance.hpp.

#include <vector>

#include "engine/query/distance/bounds_teller.hpp"
#include "engine/query/distance/distance_kernel.hpp"
#include "engine/query/distance/far_pairs.hpp"
#include "engine/query/distance/nearest_pairs.hpp"

namespace lrb {

/// Memory of a query; one for each thread.
struct DistanceContext {
  QueryContext query;
  std::vector<WaitingNodes> waiting;
  std::vector<NearPair> near;
  std::vector<MeasuredPair> pairs;
  std::vector<NodeEnd> ends[2];
  std::uint32_t turn = 0;  ///< the last that was used in `ends`
};

/// What is known from earlier steps of a motion.
struct KnownFromBefore {
  /// A simplex of A and one of B that are likely to be the nearest, or to meet; kNull: none.
  std::array<SimplexId, 2> likely = {kNull, kNull};
  FarPairs far;
};

/// Answers as distance() in distance.hpp does. before: null, or what earlier steps found, to which this one
/// adds. probe: null, or told how bounds tighten.
DistanceResult distance(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                        const DistanceRequest& request, DistanceContext& context,
                        KnownFromBefore* before = nullptr, BoundsProbe* probe = nullptr);

/// Throws InputError if a request cannot be answered.
void check_request(const DistanceRequest& request);

/// Returns true if floats can tell how far the bodies of a kernel are apart: they are rotated, not far from
/// each other, and their coordinates are not so large that rounding outweighs their sizes.
bool suits_floats(const TreeKernel& tree);

/// Walks two trees in floats and measures in doubles what is left.
class FloatWalk {
 public:
  /// `tree`: as suits_floats() wants it. unit: query_unit(). descend: no pair is known that is likely to be
  /// the nearest. far: null, or what earlier steps of a motion found.
  FloatWalk(DistanceContext& context, NearestPairs& found, const DistanceRequest& request,
            const TreeKernel& tree, double unit, bool descend, FarPairs* far);

  /// Returns true if the walk came to its end, or found that the surfaces meet. teller: null, or told what is
  /// known.
  bool run(BoundsTeller* teller);
  /// Measures the pairs that may be the nearest. Returns a bound on the distances of all others.
  double measure();
  void count(DistanceCounters& counters) const;

 private:
  void begin_ends();
  void give_room();
  bool descend_alone();
  void tell(BoundsTeller& teller) const;
  double dropped() const;
  double waiting_lower() const;

  DistanceContext& context_;
  NearestPairs& found_;
  double unit_;
  DistanceKernel k_;
};

}  // namespace lrb
