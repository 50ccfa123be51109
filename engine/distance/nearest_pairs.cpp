/// Narrows the distance interval by measuring the pairs that the traversal did not prune, by increasingly
/// expensive means:
/// 1. Bound each pair in double, with proven rounding errors (pair_bounds.hpp).
/// 2. If the interval is still too wide or contains 0, decide by the exact query whether the surfaces
///    intersect.
/// 3. If they do not, measure the relevant pairs in integers (pair_distance.hpp).
/// 4. Complete the answer: decision on `within`, relation of the bodies, closest points.

#include "engine/distance/nearest_pairs.hpp"

#include <algorithm>
#include <cmath>

#include "engine/collide/collide_into.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/pair_distance.hpp>
#include <lrbscope/world_box.hpp>

namespace lrb {
namespace {

/// Returns a length of at most the body's diameter in the world.
double world_radius(const QueryBody& body) {
  const ObbTree& tree = body.tree();
  const Pose& pose = body.world.pose();
  const double most = stretch(pose),
               radius = static_cast<double>(tree.nodes()[0].radius) * tree.unit() * most;
  // The body touches all sides of its root box. If the map stretches every direction by at least 0.9 of the
  // most, the radius is at most the diameter; else the body may have little extent in the stretched one.
  constexpr double kNearlyEven = 0.9;
  if (std::abs((pose.r / most).determinant()) >= kNearlyEven) return radius;
  return std::min(radius, 0.5 * stable_norm3(world_box(body.rep(), pose).sizes()));
}

}  // namespace

NearestPairs::NearestPairs(QueryContext& ctx, const DistanceRequest& request,
                           std::vector<MeasuredPair>& pairs)
    : ctx_(ctx), request_(request), pairs_(pairs), dim_(ctx[Side::a].rep().dim()) {
  pairs_.clear();
  best_.upper = kInfinity;
  size_ = std::max(world_radius(ctx[Side::a]), world_radius(ctx[Side::b]));
}

Eigen::Vector3d NearestPairs::towards() const {
  return best_simplex_[0] == kNull ? Eigen::Vector3d(0, 0, 0)
                                   : Eigen::Vector3d(best_.point[1] - best_.point[0]);
}

double NearestPairs::dropped_from() const {
  // Pairs that would improve the upper bound by less than the allowed width need not be found.
  const double useful =
      upper() - std::max({request_.tolerance, upper() * request_.relative_tolerance, allowed_});
  // Without an upper bound, `useful` is NaN or infinite: then no pair may be dropped by it.
  const double least = useful >= 0 ? std::min(useful, upper()) : 0;
  const double by_upper = upper() < kInfinity ? least : kInfinity;
  // The next double, so that a pair at exactly `within` is kept.
  return request_.within ? std::min(by_upper, std::nextafter(*request_.within, kInfinity)) : by_upper;
}

/// Returns the allowed width of the interval.
double NearestPairs::width() const {
  // The last two terms are the default precision, for requests without tolerances.
  return std::max({request_.tolerance, request_.relative_tolerance * upper(), allowed_,
                   kDistanceWidth * size_, kDistanceWidthUlps * upper()});
}

void NearestPairs::corners(SimplexId a, SimplexId b, const double** of_a, const double** of_b) {
  ctx_[Side::a].world.corners(a, of_a);
  ctx_[Side::b].world.corners(b, of_b);
}

/// Adopts a pair's upper bound if it is the least so far.
void NearestPairs::adopt(const MeasuredPair& pair, const PairBounds& bounds) {
  // Only a smaller bound replaces the best pair: the first of equally close ones remains.
  if (best_simplex_[0] != kNull && !(bounds.upper < best_.upper)) return;
  best_ = bounds;
  best_simplex_[0] = pair.a;
  best_simplex_[1] = pair.b;
}

/// Returns the exact bounds of two disjoint simplices.
PairBounds NearestPairs::measured_exactly(const double* const* of_a, const double* const* of_b) {
  ++counters_.pairs_exact;
  const exact::PairDistance exact = exact::distance_of_simplices(of_a, of_b, dim_);
  return {exact.lower, exact.upper, {exact.point[0], exact.point[1]}, {exact.on[0], exact.on[1]}};
}

bool NearestPairs::measure(SimplexId a, SimplexId b, double lower) {
  // The candidate of the previous step was measured before the traversal began.
  if (spares_ && a == best_simplex_[0] && b == best_simplex_[1] && best_.lower > 0) return true;
  const double *of_a[3], *of_b[3];
  corners(a, b, of_a, of_b);
  ++counters_.pairs_in_doubles;
  // Fast path: pairs that share the closest vertex or edge have the same slab as the best pair.
  const double apart = spares_ ? distance_along(best_.direction, best_.upper, of_a, of_b, dim_) : 0;
  if (apart > 0) {
    pairs_.push_back({a, b, std::max(apart, lower)});
    return true;
  }
  // General case: closest points, and the best slab along the direction between them.
  PairBounds bounds = bound_distance(of_a, of_b, dim_);
  if (!std::isfinite(bounds.upper)) {  // too large, or too small, for doubles
    // Exact distances need disjoint simplices: without a positive bound, exclude contact first.
    if (!(lower > 0) && surfaces_meet()) return false;
    corners(a, b, of_a, of_b);
    bounds = measured_exactly(of_a, of_b);
  }
  // Both lower bounds are valid; rounding must not raise them above the upper one.
  pairs_.push_back({a, b, std::min(std::max(bounds.lower, lower), bounds.upper)});
  adopt(pairs_.back(), bounds);
  // A lower bound of 0 does not exclude contact.
  return pairs_.back().lower > 0;
}

bool NearestPairs::surfaces_meet() {
  // At most one exact query for each distance query.
  if (is_known_) return meet_;
  is_known_ = true;
  // One intersecting pair is enough.
  CollideRequest any;
  any.mode = Mode::any_pair;
  CollideResult found;
  NullProbe probe;
  TreeQuery<NullProbe>(ctx_, any, found, probe).run();
  if (!found.pairs.empty()) take_contact(found.pairs[0].a, found.pairs[0].b, found.meets[0]);
  return meet_;
}

bool NearestPairs::pair_meets(const std::array<SimplexId, 2>& pair) {
  const exact::Meet meet = test_simplices(ctx_, pair[0], pair[1]);
  if (meet == exact::Meet::disjoint) return false;
  is_known_ = true;
  take_contact(pair[0], pair[1], meet);
  return true;
}

/// Records an intersecting pair; the witness is a point shared by the two simplices.
void NearestPairs::take_contact(SimplexId a, SimplexId b, exact::Meet meet) {
  meet_ = true;
  met_ = meet == exact::Meet::cross ? Relation::crossing : Relation::touching;
  best_simplex_[0] = a;
  best_simplex_[1] = b;
  const double *of_a[3], *of_b[3];
  corners(best_simplex_[0], best_simplex_[1], of_a, of_b);
  // A corner of the intersection: its features are exact, its coordinates rounded.
  const exact::PairContact contact =
      dim_ == 3 ? exact::contact_of_triangles(of_a, of_b) : exact::contact_of_segments(of_a, of_b);
  const exact::ContactCorner& corner = contact.corners[0];
  best_.lower = best_.upper = 0;
  best_.point[0] = best_.point[1] = corner.x;
  best_.on[0] = corner.on_a;
  best_.on[1] = corner.on_b;
}

double NearestPairs::min_lower() const {
  double least = kInfinity;
  for (const MeasuredPair& pair : pairs_) least = std::min(least, pair.lower);
  return least;
}

/// Measures pairs exactly if doubles left too wide an interval. `rest`: lower bound for all unmeasured pairs.
void NearestPairs::narrow(double rest) {
  // Exact distances are needed if the interval is too wide or contains 0, and the surfaces are disjoint.
  const double least = std::min(min_lower(), rest);
  const bool is_wide = !(upper() - least <= width()) || !(least > 0);
  if (!is_wide || surfaces_meet()) return;
  // Least lower bound first; ties by index, for a deterministic order.
  std::sort(pairs_.begin(), pairs_.end(), [](const MeasuredPair& x, const MeasuredPair& y) {
    return x.lower != y.lower ? x.lower < y.lower : x.a != y.a ? x.a < y.a : x.b < y.b;
  });
  for (MeasuredPair& pair : pairs_) {
    // All remaining pairs are within the allowed width of the upper bound.
    if (pair.lower > 0 && pair.lower >= upper() - width()) break;
    const double *of_a[3], *of_b[3];
    corners(pair.a, pair.b, of_a, of_b);
    const PairBounds exact = measured_exactly(of_a, of_b);
    pair.lower = exact.lower;
    adopt(pair, exact);
  }
}

/// Decides exactly whether the distance is at most `within`. `finished`: all unmeasured pairs are farther
/// than that.
void NearestPairs::decide_within(double rest, bool finished, DistanceResult& result) {
  const double most = *request_.within;
  // The bounds already decide, or the surfaces intersect.
  if (upper() <= most || (min_lower() <= most && surfaces_meet())) {
    result.within = true;
    return;
  }
  // Bounds on both sides of `within`: compare the exact distance of the pair with it.
  for (const MeasuredPair& pair : pairs_) {
    if (pair.lower > most) continue;
    const double *of_a[3], *of_b[3];
    corners(pair.a, pair.b, of_a, of_b);
    ++counters_.pairs_exact;
    if (exact::compare_distance(of_a, of_b, dim_, most) > 0) continue;
    result.within = true;
    return;
  }
  // All measured pairs are farther: the answer is no if the unmeasured ones are farther as well.
  if (finished || rest > most) result.within = false;
}

Witness witness_of(const LrbRep& rep, SimplexId simplex, const exact::Feature& on,
                   const Eigen::Vector3d& point) {
  Witness w;
  w.simplex = simplex;
  w.point = point;
  w.feature = on;
  w.face = rep.face_of_simplex(simplex);
  VertexId v[3];
  rep.simplex(simplex, v);
  w.corner_count = on.dim + 1;
  // A feature of dimension d is spanned by d + 1 consecutive corners of the simplex.
  for (int k = 0; k < w.corner_count; ++k) {
    const int first = on.dim == 2 ? 0 : on.index;
    w.corners[static_cast<std::size_t>(k)] = v[(first + k) % rep.dim()];
  }
  return w;
}

void NearestPairs::write_witness(int side, DistanceResult& result) const {
  const SimplexId simplex = best_simplex_[side];
  if (simplex == kNull) return;
  result.witness[side] = witness_of(ctx_.body[side].rep(), simplex, best_.on[side], best_.point[side]);
}

void NearestPairs::write_relation(DistanceResult& result) {
  result.relation = Relation::undefined;
  if (meet_) {
    result.relation = met_;
  } else if (!(result.lower > 0)) {
    // The bounds still contain 0: the query stopped early, or within a tolerance that includes 0.
    result.relation = Relation::unresolved;
  } else if (request_.relation) {
    // Disjoint surfaces: locate one vertex of each component in the other body.
    CollideResult none;
    decide_relation(ctx_, none);
    result.relation = none.relation;
  }
}

void NearestPairs::finish(double rest, bool finished, DistanceResult& result) {
  // Not after an early stop: then `rest` may be the smallest bound, which exact distances cannot raise.
  if (!meet_ && finished && !request_.within) narrow(rest);
  if (request_.within && !meet_) decide_within(rest, finished, result);
  result.meet = meet_;
  if (meet_) {
    if (request_.within) result.within = true;
  } else {
    result.upper = upper();
    result.lower = lower(rest);
    result.finished = request_.within ? result.within.has_value() : finished;
  }
  write_relation(result);
  for (int side = 0; side < 2; ++side) write_witness(side, result);
  // The traversal wrote its own counters to the result: keep them.
  counters_.steps = result.counters.steps;
  counters_.box_tests = result.counters.box_tests;
  counters_.pairs_in_floats = result.counters.pairs_in_floats;
  result.counters = counters_;
}

}  // namespace lrb
