#pragma once
/// The pairs of simplices that a distance query has measured, and the answer derived from them.

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/collide/query_context.hpp"
#include "engine/distance/pair_bounds.hpp"
#include <lrbscope/distance.hpp>

namespace lrb {

/// A pair of simplices and a lower bound on its distance, world units.
struct MeasuredPair {
  SimplexId a, b;
  double lower;
};

/// Returns a point of a body's simplex as a witness. on: the feature of the simplex that contains it.
Witness witness_of(const LrbRep& rep, SimplexId simplex, const exact::Feature& on,
                   const Eigen::Vector3d& point);

class NearestPairs {
 public:
  /// Begins a query of the bodies of `ctx`. `pairs`: a reusable buffer.
  NearestPairs(QueryContext& ctx, const DistanceRequest& request, std::vector<MeasuredPair>& pairs);

  double upper() const { return best_.upper; }
  /// Returns a lower bound on the distance, given that the distances of unmeasured pairs are at least `rest`.
  double lower(double rest) const { return std::max(0.0, std::min({min_lower(), rest, upper()})); }
  /// Returns the number of measured pairs.
  std::uint64_t measured() const { return counters_.pairs_in_doubles + counters_.pairs_exact; }
  /// Returns the vector between the points that gave upper(), from A to B, or 0 if no pair was measured.
  Eigen::Vector3d towards() const;
  /// Returns an upper bound on the radius of the larger body in the world.
  double size() const { return size_; }

  /// Lets the best pair's slab suffice for pairs whose distance equals the least one up to rounding, without
  /// their closest points. The last digits of upper() then depend on the order of the pairs, so the promise
  /// of distance(), that more steps only narrow the interval, does not hold.
  void spare_equal_pairs() { spares_ = true; }
  /// Allows intervals of this width (world units), for traversals whose bounds are no more accurate.
  void allow_width(double width) { allowed_ = width; }
  /// Returns the pruning distance: pairs at least this far need not be measured.
  double dropped_from() const;
  /// Measures a pair in double. `lower`: a known lower bound. Returns true if the pair is proven disjoint.
  bool measure(SimplexId a, SimplexId b, double lower);
  /// Returns true if the request is answered: the distance is at most `within`.
  bool is_near_enough() const { return request_.within && upper() <= *request_.within; }

  /// Returns true if the two simplices, and so the surfaces, intersect. Exact.
  bool pair_meets(const std::array<SimplexId, 2>& pair);
  /// Returns true if the surfaces intersect. Exact; computed at the first call.
  bool surfaces_meet();
  bool known_apart() const { return is_known_ && !meet_; }
  bool known_to_meet() const { return meet_; }

  /// Completes the answer. `rest`: a lower bound on the distances of unmeasured pairs. finished: the
  /// traversal was completed.
  void finish(double rest, bool finished, DistanceResult& result);

 private:
  double width() const;
  double min_lower() const;
  void narrow(double rest);
  void decide_within(double rest, bool finished, DistanceResult& result);
  PairBounds measured_exactly(const double* const* of_a, const double* const* of_b);
  void adopt(const MeasuredPair& pair, const PairBounds& bounds);
  void corners(SimplexId a, SimplexId b, const double** of_a, const double** of_b);
  void write_witness(int side, DistanceResult& result) const;
  void take_contact(SimplexId a, SimplexId b, exact::Meet meet);
  void write_relation(DistanceResult& result);

  QueryContext& ctx_;
  const DistanceRequest& request_;
  std::vector<MeasuredPair>& pairs_;
  int dim_;
  double size_ = 0, allowed_ = 0;
  SimplexId best_simplex_[2] = {kNull, kNull};
  PairBounds best_;  ///< of the pair with the least upper bound
  bool spares_ = false, is_known_ = false, meet_ = false;
  Relation met_ = Relation::touching;
  DistanceCounters counters_;
};

}  // namespace lrb
