/// The search for a first contact in one piece of both motions, by conservative advancement (Mirtich 1996;
/// Tang, Kim and Manocha, "C2A", 2009).
///
/// 1. Find all pairs of simplices that may intersect in a time interval, by one traversal with B swept. If
///    there are too many, halve the interval.
/// 2. Advance each pair while a slab is proven to separate it. The bodies are separate up to the least time
///    reached.
/// 3. Where pairs stop, run the exact query slightly later. If bodies intersect then, that is the contact.
/// 4. Else advance by shorter steps, sample more densely, or prove by continuity that a pair has passed.
/// 5. Else lengthen the interval until the bodies are proven to stay separate again. The time before that is
///    reported as ambiguous.
///
/// Bodies are reported as separate only if find_swept_pairs(), PairMotion::separated_for() or a distance
/// proves it, and as in contact only if the exact query or PairMotion::has_passed() proves it. All other
/// decisions affect only the amount of work.

#include "engine/motion/contact_search.hpp"

#include <algorithm>
#include <cmath>

#include "engine/collide/tree_query.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb {
namespace {

using Eigen::Vector3d;

/// Largest tolerance used for steps, even if the request's is wider: while bodies penetrate each other, long
/// intervals contain many pairs.
constexpr double kWidestStep = 1e-6;
/// Maximum number of pairs for which an interval is not halved. An interval of at most kHardlyLonger
/// tolerances is never halved.
constexpr std::uint64_t kFewPairs = 128;
constexpr double kHardlyLonger = 64;
/// In intervals shorter than this share of a piece, the maximum number of pairs is doubled after each
/// failure: if long faces pass each other, shorter intervals contain no fewer pairs.
constexpr double kShortShare = 0x1p-10;
/// A pair stops when a step advances it by at most kMinStep tolerances; for a stuck pair the limit is
/// kMinStuckStep.
constexpr double kMinStep = 0x1p-3, kMinStuckStep = 0x1p-20;
constexpr int kMaxStepsOfPair = 256;
/// Factor between the lengths of the intervals in which the end of an ambiguity is searched, and share of
/// that length for which the bodies must then be proven separate.
constexpr double kLonger = 4, kGoesOn = 0.25;
/// Accuracy to which the end of an ambiguous interval is found, relative to its length.
constexpr double kNarrow = 0x1p-10;
constexpr std::uint64_t kMaxStuckPairs = 1 << 20;
constexpr int kProbes = 8;
/// Number of distances in a piece after which single pairs are followed instead, if there are not too many.
constexpr std::uint64_t kMaxDistances = 512;

/// Returns t + step, rounded down.
double later(double t, double step) {
  // The sum is rounded to nearest: one double towards t is a lower bound.
  return step > 0 ? std::max(t, std::nextafter(t + step, t)) : t;
}

}  // namespace

void FirstContactSearch::search_piece(const MovingBody& a, const MovingBody& b, double end) {
  a_ = &a;
  b_ = &b;
  // For scaled or sheared bodies the swept kernel culls nothing: use distances instead.
  is_swept_ = suits_sweeps(a, b);
  is_swept_ ? search_swept(end) : search_by_distance(end);
}

/// Collects the pairs of an interval. Returns false if there are more than `most`, or more than steps are
/// left, which are used up then.
bool FirstContactSearch::find_pairs(TimeSpan span, std::uint64_t most) {
  ++result_.counters.spans;
  // A pair costs one step: never collect more pairs than there are steps left.
  const std::uint64_t left = most_ - std::min(most_, spent_);
  const bool found_all = find_swept_pairs(query(), *a_, *b_, span, std::min(most, left), context_.pairs);
  // If the remaining steps were the limit, the search ends.
  spent_ = !found_all && left < most ? most_ : spent_ + 1 + context_.pairs.size();
  result_.counters.pairs += context_.pairs.size();
  if (request_.history) result_.history.push_back({span, context_.pairs.size(), free_until_});
  return found_all;
}

double FirstContactSearch::step_tolerance() const {
  return std::min(tolerance_, kWidestStep);
}

void FirstContactSearch::search_swept(double end) {
  const double whole = end - free_until_;
  double width = whole;
  std::uint64_t few = kFewPairs;
  while (free_until_ < end && !is_over()) {
    const double t = free_until_;
    // At least up to the next double, at most to the end of the piece.
    const TimeSpan span{t, end - t > width ? std::max(t + width, std::nextafter(t, 2)) : end};
    // An interval hardly longer than the tolerance is not halved again, however many pairs it has.
    const bool is_short =
        span.end - t <= kHardlyLonger * step_tolerance() || span.end <= std::nextafter(t, 2);
    if (!find_pairs(span, is_short ? kNoLimit : few)) {
      // Too many pairs: halve the interval. If that does not help, allow more pairs.
      width = (span.end - t) / 2;
      if (width < kShortShare * whole) few *= 2;
      continue;
    }
    // No pair can intersect before the least time that the pairs reach.
    free_until_ = advance_all(span, kMinStep * step_tolerance());
    // Success: try an interval twice as long next.
    width = 2 * (span.end - t);
    notify(free_until_);
    if (free_until_ >= span.end) continue;
    // A pair has stopped: a contact, or bodies too close for steps of this length.
    free_until_ = look_closer(free_until_, end);
    // The bodies are still close: continue with short intervals.
    width = kHardlyLonger * step_tolerance();
    if (!is_done_) notify(free_until_);
  }
}

/// Returns the length of time after t for which the distance proves the bodies separate, or 0.
double FirstContactSearch::rejected_by_distance(double t) {
  // An approximate distance is enough: any lower bound yields a valid step.
  DistanceRequest rough;
  rough.relative_tolerance = 0.25;
  rough.relation = false;
  ++result_.counters.steps;
  const DistanceResult at =
      distance(*rep_[0], a_->at(t).pose, *rep_[1], b_->at(t).pose, rough, context_.distance);
  const DistanceCounters& work = at.counters;
  spent_ += 1 + work.pairs_in_doubles / 8 + kStepsOfExact * work.pairs_exact + work.steps / kNodePairsOfStep;
  // The distance is of poses in doubles; the exact motions may deviate from them now and later.
  const double gap = at.lower - 2 * (a_->rounding() + b_->rounding()) * kWorldUp;
  // Two points approach no faster than the relative travel plus both rotations.
  const double speed = ((b_->travel() - a_->travel()).norm() + a_->spin() + b_->spin()) * kWorldUp;
  // Conservative advancement (Mirtich 1996).
  return gap > 0 ? gap / speed * (1 - kWorldRounding) : 0;
}

/// Returns true if the bodies are small enough to follow all pairs of simplices.
bool FirstContactSearch::suits_all_pairs() const {
  const std::uint64_t pairs = std::uint64_t{rep_[0]->real_simplex_count()} * rep_[1]->real_simplex_count();
  return pairs <= kMaxStuckPairs && pairs <= (most_ - std::min(most_, spent_)) / 4;
}

/// Advances by distances. A distance has no direction: bodies that slide along each other advance by at most
/// their gap per step. If that takes many steps, all pairs of small bodies are followed instead, because
/// their slabs have a direction.
void FirstContactSearch::search_by_distance(double end) {
  for (std::uint64_t steps = 0; free_until_ < end && !is_over(); ++steps) {
    // Many small steps: follow single pairs instead.
    if (steps == kMaxDistances && suits_all_pairs()) {
      is_swept_ = true;
      return search_swept(end);
    }
    const double rejected = rejected_by_distance(free_until_);
    free_until_ = std::min(end, later(free_until_, rejected));
    notify(free_until_);
    // The gap closes within a fraction of the tolerance: contact, or nearly.
    if (rejected < kMinStep * step_tolerance() && free_until_ < end)
      free_until_ = look_closer(free_until_, end);
  }
}

/// Advances a pair from the states at the interval's start while it is proven separate and steps are at least
/// `least`. Returns the time reached.
double FirstContactSearch::advance(SimplexPair pair, const PieceState& at_a, const PieceState& at_b,
                                   TimeSpan span, double least) {
  PairMotion moving(*a_, *b_, pair);
  moving.place(at_a, at_b);
  if (is_long()) moving.look_at_axes();
  double t = span.begin;
  // The direction that separated the previous pair often separates this one as well.
  Vector3d n = hint_;
  for (int i = 0;; ++i) {
    ++result_.counters.steps;
    ++spent_;
    double rejected = moving.separated_for(n);
    if (later(t, rejected) < span.end) {
      // It does not for long enough: try the line between the closest points.
      const Vector3d across = moving.bounds().direction;
      const double rejected_across = moving.separated_for(across);
      if (rejected_across > rejected) {
        rejected = rejected_across;
        n = across;
      }
    }
    const double before = t;
    t = std::min(span.end, later(t, rejected));
    if (t >= span.end) hint_ = n;
    // Steps towards a contact shrink quickly: stop once they are negligible, or too short to change t.
    if (t >= span.end || rejected < least || t == before || i >= kMaxStepsOfPair) return t;
    if (is_spent()) return t;
    moving.place(a_->at(t), b_->at(t));
  }
}

/// Returns the time up to which all pairs found in an interval are proven separate.
double FirstContactSearch::advance_all(TimeSpan span, double least) {
  const PieceState at_a = a_->at(span.begin), at_b = b_->at(span.begin);
  double until = span.end;
  for (const SimplexPair& pair : context_.pairs) {
    // Out of steps: nothing is proven about the remaining pairs.
    if (is_spent()) return span.begin;
    // Later pairs need not advance beyond the least time so far.
    until = advance(pair, at_a, at_b, {span.begin, until}, least);
  }
  return until;
}

/// Handles a time t up to which the bodies are separate and beyond which no pair advances: finds a contact
/// right after t, or returns the time up to which there is no contact except in ambiguous intervals.
double FirstContactSearch::look_closer(double t, double end) {
  const double soon = std::min(end, std::max(t + step_tolerance() / 2, std::nextafter(t, 2)));
  // A contact half a tolerance later: the interval is narrow enough.
  if (const auto pair = meets_at(soon)) {
    contact_in({t, soon}, *pair);
    return t;
  }
  // No contact then: shorter steps may lead past t.
  const double until = advance_stuck({t, soon});
  if (until >= soon || meets_right_after({until, soon}) || has_passed({t, soon})) return until;
  // All proofs failed: determine the end of the ambiguity.
  return look_further(until, end);
}

/// Runs the exact query at a few times right after the interval's start. Returns true, and records the
/// contact, if one is found, as for bodies that pass each other in less than the tolerance.
bool FirstContactSearch::meets_right_after(TimeSpan span) {
  // Sample far more densely than the tolerance, and increasingly towards the start.
  for (const double share : {0x1p-24, 0x1p-16, 0x1p-8}) {
    const double t = std::max(span.begin + share * step_tolerance(), std::nextafter(span.begin, 2));
    if (t >= span.end) return false;
    if (const auto pair = meets_at(t)) {
      contact_in({span.begin, t}, *pair);
      return true;
    }
  }
  return false;
}

/// Returns the time up to which the bodies are proven separate, in steps as short as necessary. Stores the
/// pairs that do not reach the interval's end.
double FirstContactSearch::advance_stuck(TimeSpan span) {
  const double least = kMinStuckStep * step_tolerance();
  context_.stuck.clear();
  double until = span.end;
  if (!is_swept_) {
    // By distances: at most kMaxStepsOfPair steps, each of at least `least`.
    double t = span.begin, rejected = span.end - t;
    for (int i = 0; i < kMaxStepsOfPair && t < until && rejected >= least; ++i) {
      rejected = rejected_by_distance(t);
      t = std::min(until, later(t, rejected));
    }
    return t;
  }
  // Fails only if steps run out: then nothing is proven.
  if (!find_pairs(span, kNoLimit)) return span.begin;
  const PieceState at_a = a_->at(span.begin), at_b = b_->at(span.begin);
  for (const SimplexPair& pair : context_.pairs) {
    if (is_spent()) return span.begin;
    // Each pair is followed over the full interval, because has_passed() needs all stuck pairs.
    const double gone = advance(pair, at_a, at_b, span, least);
    if (gone < span.end) context_.stuck.push_back(pair);
    until = std::min(until, gone);
  }
  return until;
}

/// Returns true, and records the contact, if a stuck pair is proven to have intersected in the interval.
bool FirstContactSearch::has_passed(TimeSpan span) {
  const double time = (span.end - span.begin) * kWorldUp;
  for (const SimplexPair& pair : context_.stuck) {
    PairMotion before(*a_, *b_, pair), now(*a_, *b_, pair);
    before.place(a_->at(span.begin), b_->at(span.begin));
    now.place(a_->at(span.end), b_->at(span.end));
    Vector3d n = before.bounds().direction;
    // Orient the separating direction from A to B.
    if (n.dot(before.ahead()) < 0) n = -n;
    if (!now.has_passed(before, n, time)) continue;
    result_.passed = true;
    contact_in(span, pair);
    return true;
  }
  return false;
}

/// Searches for the end of the time after t in which the gap between the bodies is within rounding.
double FirstContactSearch::look_further(double t, double end) {
  // Lengthen the interval by kLonger each time, until the bodies are in contact at its end, have passed
  // through each other, or are proven to stay separate for a while.
  for (double width = tolerance_; !is_over(); width *= kLonger) {
    const TimeSpan span{t, end - t > width ? std::max(t + width, std::nextafter(t, 2)) : end};
    if (auto pair = meets_at(span.end)) {
      contact_at_last(span, *pair);
      return t;
    }
    if (is_swept_) {
      const bool found_all = find_pairs(span, kMaxStuckPairs);
      if (is_spent()) return t;
      // Any pair may have passed through: test all.
      context_.stuck = context_.pairs;
      if (has_passed(span)) return t;
      // An incomplete list cannot prove that the bodies stay separate.
      if (!found_all && span.end < end) continue;
    }
    if (span.end < end && !goes_on_from(span)) continue;
    // The ambiguity ends within this interval: narrow down its end, then sample it for a contact.
    const TimeSpan shortest = shortened(span, width / kLonger);
    if (!found_between(shortest)) doubt(shortest);
    return shortest.end;
  }
  return t;
}

/// Returns the shortest interval, by bisection, after which the bodies are proven to stay separate. span: an
/// interval after which they are, or that reaches the end. too_short: a length after which they are not.
TimeSpan FirstContactSearch::shortened(TimeSpan span, double too_short) {
  // Invariant: an interval that ends at `excluded` is too short, one that ends at span.end is long enough.
  double excluded = std::min(span.begin + too_short, span.end);
  while (span.end - excluded > std::max(tolerance_, kNarrow * (span.end - span.begin)) && !is_over()) {
    const double midpoint = excluded + (span.end - excluded) / 2;
    if (!(midpoint > excluded && midpoint < span.end)) break;
    // goes_on_from() uses the pairs found last.
    if (is_swept_ && !find_pairs({span.begin, midpoint}, kMaxStuckPairs)) break;
    (goes_on_from({span.begin, midpoint}) ? span.end : excluded) = midpoint;
  }
  return span;
}

/// Returns true if the pairs that may intersect in an interval are proven separate right after it.
bool FirstContactSearch::goes_on_from(TimeSpan span) {
  const double wanted = kGoesOn * (span.end - span.begin);
  // Without pairs the distance must prove it.
  if (!is_swept_) return rejected_by_distance(span.end) >= wanted;
  const PieceState at_a = a_->at(span.end), at_b = b_->at(span.end);
  return std::all_of(context_.pairs.begin(), context_.pairs.end(), [&](const SimplexPair& pair) {
    PairMotion moving(*a_, *b_, pair);
    moving.place(at_a, at_b);
    if (is_long()) moving.look_at_axes();
    // Try the last separating direction first; closest points take longer to compute.
    return moving.separated_for(hint_) >= wanted || moving.separated_for(moving.bounds().direction) >= wanted;
  });
}

/// Runs the exact query at a few times within an ambiguous interval. Returns true, and records the contact,
/// if one is found.
bool FirstContactSearch::found_between(TimeSpan span) {
  double before = span.begin;
  for (int i = 1; i < kProbes; ++i) {
    const double t = span.begin + (span.end - span.begin) * i / kProbes;
    // In an interval of few doubles the samples coincide.
    if (!(t > before) || !(t < span.end)) continue;
    if (auto pair = meets_at(t)) {
      contact_at_last({span.begin, t}, *pair);
      return true;
    }
    before = t;
  }
  return false;
}

/// Records a contact at the end of an interval; first searches for an earlier one by bisection.
void FirstContactSearch::contact_at_last(TimeSpan span, SimplexPair pair) {
  double none = span.begin;
  notify(span.begin, span.end);
  // Contact need not be monotone in t, so the start of the interval remains t0.
  while (span.end - none > tolerance_ / 2 && !is_spent()) {
    const double midpoint = none + (span.end - none) / 2;
    if (!(midpoint > none && midpoint < span.end)) break;
    if (const auto earlier = meets_at(midpoint)) {
      span.end = midpoint;
      pair = *earlier;
      notify(span.begin, span.end);
    } else {
      none = midpoint;
    }
  }
  contact_in(span, pair);
}

void FirstContactSearch::contact_in(TimeSpan span, SimplexPair pair) {
  is_done_ = true;
  result_.outcome = MotionOutcome::contact;
  result_.t0 = span.begin;
  result_.t1 = span.end;
  result_.pair = pair;
  write_features(span.begin, pair);
  notify(span.begin, span.end);
}

void FirstContactSearch::doubt(TimeSpan span) {
  std::vector<TimeSpan>& list = result_.ambiguous;
  // Merge adjacent intervals.
  if (!list.empty() && list.back().end >= span.begin)
    list.back().end = span.end;
  else
    list.push_back(span);
}

void FirstContactSearch::write_features(double t, SimplexPair pair) {
  PairMotion moving(*a_, *b_, pair);
  moving.place(a_->at(t), b_->at(t));
  const PairBounds at = moving.bounds();
  // Coordinates overflowed: no closest features.
  if (!std::isfinite(at.upper)) return;
  result_.witness = {witness_of(*rep_[0], pair.a, at.on[0], at.point[0]),
                     witness_of(*rep_[1], pair.b, at.on[1], at.point[1])};
  const double length = stable_norm3(at.direction);
  // The closest points coincide up to rounding: the normal is unknown.
  if (!(length > 0)) return;
  result_.normal = at.direction / length;
  if (result_.normal.dot(moving.ahead()) < 0) result_.normal = -result_.normal;
  result_.speed = moving.approach_speed(at, result_.normal);
}

}  // namespace lrb
