#pragma once
/// The pairs of simplices that a distance query has looked at, and what follows from them.

#include <algorithm>
#include <limits>
#include <vector>

#include "engine/query/distance/distance.hpp"
#include "engine/query/distance/pair_bounds.hpp"
#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// A pair of simplices and a bound on its distance, world.
struct MeasuredPair {
  SimplexId a, b;
  double lower;
};

/// Returns a point of a body's simplex as a witness. on: where it lies on the simplex.
Witness witness_of(const LrbRep& rep, SimplexId simplex, const exact::Feature& on,
                   const Eigen::Vector3d& point);

class NearestPairs {
 public:
  /// Begins a query of the bodies that `ctx` has been begun with. `pairs`: memory that can be used again.
  NearestPairs(QueryContext& ctx, const DistanceRequest& request, std::vector<MeasuredPair>& pairs);

  double upper() const { return best_.upper; }
  /// Returns a bound on the distance, given that what was not measured is at least `rest` apart.
  double lower(double rest) const { return std::max(0.0, std::min({least_lower(), rest, upper()})); }
  /// Returns how many pairs were measured.
  std::uint64_t measured() const { return counters_.pairs_in_doubles + counters_.pairs_exact; }
  /// Returns the way between the points that gave upper(), from A to B; 0 if there are none yet.
  Eigen::Vector3d way() const;
  /// Returns the size of the larger body in the world: a bound on its radius.
  double size() const { return size_; }

  /// Lets a slab do where a pair is as far apart as the nearest one, but for rounding. upper() may then be
  /// too large by its last digits, depending on the order in which pairs are measured, so that more steps
  /// need not give less, as distance() promises.
  void spare_equal_pairs() { spares_ = true; }
  /// Says that intervals may be this wide, because the walk cannot tell more.
  void allow_width(double width) { allowed_ = width; }
  /// Returns the distance from which on pairs need not be measured.
  double dropped_from() const;
  /// Measures a pair in doubles; `lower` is known already. Returns true if it is proved not to meet.
  bool measure(SimplexId a, SimplexId b, double lower);
  /// Returns true if the request is answered: within, yes.
  bool is_near_enough() const { return request_.within && upper() <= *request_.within; }

  /// Returns true if the simplices meet, exactly: then the surfaces do.
  bool pair_meets(const std::array<SimplexId, 2>& pair);
  /// Finds out whether the surfaces meet, exactly, the first time it is asked.
  bool surfaces_meet();
  bool known_apart() const { return asked_ && !meet_; }
  bool known_to_meet() const { return meet_; }

  /// Completes the answer. `rest`: what was not measured is at least this far apart. finished: the walk came
  /// to its end.
  void finish(double rest, bool finished, DistanceResult& result);

 private:
  double width() const;
  double least_lower() const;
  void narrow(double rest);
  void decide_within(double rest, bool finished, DistanceResult& result);
  PairBounds measured_exactly(const double* const* of_a, const double* const* of_b);
  void see(const MeasuredPair& pair, const PairBounds& bounds);
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
  PairBounds best_;  ///< of the pair that has the least upper end
  bool spares_ = false, asked_ = false, meet_ = false;
  Relation met_ = Relation::touching;
  DistanceCounters counters_;
};

}  // namespace lrb
