/// The outer loop of the search for a first contact; contact_search.cpp searches within one piece of both
/// motions.
///
/// 1. Query the bodies exactly at t = 0. If they intersect, the search ends there.
/// 2. Search one interval of t after another in which both motions stay in one piece.
/// 3. Derive the outcome from the contact found, or from the ambiguous intervals and the remaining steps.

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>

#include "engine/collide/collide_into.hpp"
#include "engine/core/geometry.hpp"
#include "engine/motion/contact_search.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

namespace {

/// Returns the maximum number of steps of a search (first_contact.hpp). It is far more than needed, except
/// along clearances that are small relative to the path.
std::uint64_t max_steps(const LrbRep& a, const Motion& motion_a, const LrbRep& b, const Motion& motion_b) {
  constexpr double kSteps = 8192, kStepsOfSimplex = 512, kMax = 0x1p40;
  // A thousand revolutions must not take a thousand times as long to give up on as one.
  constexpr double kMaxRevolutions = 16;
  double parts = 0;
  for (const Motion* motion : {&motion_a, &motion_b})
    for (const Motion::Piece& piece : motion->pieces())
      // Half a piece for each body, so that `parts` is the mean number of pieces plus the number of full
      // turns.
      parts += 0.5 + std::min(stable_norm3(piece.turn) / (2 * std::numbers::pi), kMaxRevolutions);
  const double simplices = 1.0 * a.real_simplex_count() + b.real_simplex_count();
  return static_cast<std::uint64_t>(std::min((kSteps + kStepsOfSimplex * simplices) * parts, kMax));
}

/// Returns an interval of t below which rounding hides all motion. With S as in motion_bounds.hpp and u =
/// 2^-53, positions have an error bound of at least 8 u (1 + 2^-10 |turn|) S, and move by at most 2 (1 +
/// |turn|) S in a piece: moving by the error bound takes at least 2^-61 of the piece.
double min_tolerance(const Motion& motion_a, const Motion& motion_b) {
  double shortest = 1;
  for (const Motion* motion : {&motion_a, &motion_b})
    for (const Motion::Piece& piece : motion->pieces())
      shortest = std::min(shortest, piece.end - piece.begin);
  return 0x1p-61 * shortest;
}

}  // namespace

void check_request(const FirstContactRequest& request) {
  if (!(request.tolerance > 0 && request.tolerance <= 1))
    throw InputError(
        "first contact: expected a tolerance above 0 and at most 1 (fraction of the motion), found " +
        std::to_string(request.tolerance));
}

FirstContactSearch::FirstContactSearch(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                       const Motion& motion_b, const FirstContactRequest& request,
                                       FirstContactContext& context, FirstContactProbe* probe)
    : rep_{&a, &b},
      motion_{&motion_a, &motion_b},
      request_(request),
      context_(context),
      probe_(probe),
      tolerance_(std::max(request.tolerance, min_tolerance(motion_a, motion_b))),
      most_(max_steps(a, motion_a, b, motion_b)) {}

std::uint64_t FirstContactSearch::work() const {
  const FirstContactCounters& c = result_.counters;
  return c.spans + c.steps + c.exact_queries;
}

bool FirstContactSearch::is_out_of_steps() const {
  return request_.max_steps > 0 && work() >= request_.max_steps;
}

/// Reports to the probe that the bodies are separate before t0 and in contact by t1, unless reported before.
void FirstContactSearch::notify(double t0, double t1) {
  if (probe_ == nullptr) return;
  ContactBounds now{work(), std::min(t0, 1.0), t1, 0, 0};
  // Report only changes.
  if (reported_.work > 0 && now.t0 == reported_.t0 && now.t1 == reported_.t1) return;
  // Separate buffers: the context of the search must not change.
  if (!to_tell_) to_tell_.emplace();
  DistanceRequest rough;
  rough.relative_tolerance = 0.01;
  rough.relation = false;
  const DistanceResult at =
      distance(*rep_[0], motion_[0]->at(now.t0), *rep_[1], motion_[1]->at(now.t0), rough, *to_tell_);
  now.lower = at.lower;
  now.upper = at.upper;
  reported_ = now;
  probe_->bounds(now);
}

/// Runs the exact query, and leaves the bodies of its context at their poses.
std::optional<SimplexPair> FirstContactSearch::meets_at(double t) {
  ++result_.counters.exact_queries;
  const Pose pose_a = motion_[0]->at(t), pose_b = motion_[1]->at(t);
  check_query(*rep_[0], pose_a, *rep_[1], pose_b);
  // The poses remain set: write_start() and meets_at_start() read them.
  query().body[0].begin(*rep_[0], pose_a, WrapperMode::regularised);
  query().body[1].begin(*rep_[1], pose_b, WrapperMode::regularised);
  CollideRequest any;
  // One pair is enough, whether it touches or crosses.
  any.mode = Mode::any_pair;
  CollideResult found;
  NullProbe probe;
  TreeQuery<NullProbe>(query(), any, found, probe).run();
  // Count the work in steps as defined in first_contact.hpp.
  spent_ += 1 + found.counters.face_tests + kStepsOfExact * found.counters.exact_fallbacks +
            found.counters.node_pairs / kNodePairsOfStep;
  if (found.pairs.empty()) return std::nullopt;
  return found.pairs[0];
}

/// Writes the position and kind of the intersection of a pair at t = 0.
void FirstContactSearch::write_start(SimplexPair pair) {
  const double *of_a[3], *of_b[3];
  query()[Side::a].world.corners(pair.a, of_a);
  query()[Side::b].world.corners(pair.b, of_b);
  const exact::PairContact contact =
      rep_[0]->dim() == 3 ? exact::contact_of_triangles(of_a, of_b) : exact::contact_of_segments(of_a, of_b);
  // Any corner of the intersection serves as the witness point of both bodies.
  const exact::ContactCorner& corner = contact.corners[0];
  result_.outcome = MotionOutcome::contact;
  result_.t0 = result_.t1 = 0;
  result_.at_start = true;
  result_.at_begin = contact.meet == exact::Meet::cross ? Relation::crossing : Relation::touching;
  result_.pair = pair;
  result_.witness = {witness_of(*rep_[0], pair.a, corner.on_a, corner.x),
                     witness_of(*rep_[1], pair.b, corner.on_b, corner.x)};
}

bool FirstContactSearch::meets_at_start() {
  if (const auto pair = meets_at(0)) {
    write_start(*pair);
    return true;
  }
  if (request_.relation) {
    // No surfaces intersect at t = 0: containment of vertices decides the relation.
    CollideResult none;
    decide_relation(query(), none);
    result_.at_begin = none.relation;
  }
  return false;
}

FirstContactResult FirstContactSearch::run() {
  const FloatMode float_mode;
  check_request(request_);
  // Reject world coordinates that are not finite at either end; meets_at() checks the times in between.
  for (const double t : {0.0, 1.0}) check_query(*rep_[0], motion_[0]->at(t), *rep_[1], motion_[1]->at(t));
  // A body without faces never collides.
  if (rep_[0]->tree().empty() || rep_[1]->tree().empty()) return result_;
  const bool at_once = meets_at_start();
  notify(0, at_once ? 0 : std::numeric_limits<double>::infinity());
  if (at_once) return result_;
  // Merge both lists of pieces: search each interval of t in which both motions stay in one piece.
  const std::vector<Motion::Piece>*const of_a = &motion_[0]->pieces(), *const of_b = &motion_[1]->pieces();
  for (std::size_t i = 0, j = 0; i < of_a->size() && j < of_b->size() && !is_over();) {
    const MovingBody a(*rep_[0], (*of_a)[i]), b(*rep_[1], (*of_b)[j]);
    const double end_a = a.piece().end, end_b = b.piece().end;
    search_piece(a, b, std::min(end_a, end_b));
    // Continue with the piece that ends later, or with the next of both if they end together.
    i += end_a <= end_b;
    j += end_b <= end_a;
  }
  return finish();
}

FirstContactResult FirstContactSearch::finish() {
  if (!is_done_) {
    // If the proof does not reach t = 1, the steps ran out: the remaining time is ambiguous.
    result_.finished = free_until_ >= 1;
    if (!result_.finished) doubt({free_until_, 1});
    if (!result_.finished) result_.unresolved = Unresolved::steps;
    if (!result_.ambiguous.empty()) {
      // No contact was found, but the ambiguous intervals may hide one.
      result_.outcome = MotionOutcome::undecided;
      result_.t1 = result_.ambiguous.back().end;
    }
  }
  // The uninterrupted proof of separation ends at the first ambiguous interval.
  if (!result_.ambiguous.empty()) result_.t0 = result_.ambiguous[0].begin;
  // Ambiguous intervals just before the contact need not make the interval wider than requested.
  const bool is_wide =
      result_.outcome == MotionOutcome::undecided || result_.t1 - result_.t0 > request_.tolerance;
  result_.grazing = is_wide && result_.finished;
  if (result_.grazing) result_.unresolved = Unresolved::rounding;
  return std::move(result_);
}

FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request,
                                 FirstContactContext& context, FirstContactProbe* probe) {
  return FirstContactSearch(a, motion_a, b, motion_b, request, context, probe).run();
}

FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request) {
  FirstContactContext context;
  return first_contact(a, motion_a, b, motion_b, request, context);
}

FirstContactResult first_contact(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                 const Motion& motion_b, const FirstContactRequest& request,
                                 FirstContactProbe& probe) {
  FirstContactContext context;
  return first_contact(a, motion_a, b, motion_b, request, context, &probe);
}

std::vector<FirstContactResult> first_contacts(const LrbRep& a, const Motion& motion_a, const LrbRep& b,
                                               std::span<const Motion> motions_b,
                                               const FirstContactRequest& request, unsigned threads) {
  Workers workers(threads);
  std::vector<FirstContactContext> contexts(workers.count());
  std::vector<FirstContactResult> results(motions_b.size());
  // Searches are independent, and each worker has its own context: results do not depend on the threads.
  workers.for_each(motions_b.size(), [&](std::size_t i, unsigned worker) {
    results[i] = first_contact(a, motion_a, b, motions_b[i], request, contexts[worker]);
  });
  return results;
}

}  // namespace lrb
