#pragma once
/// Queries to a tolerance, or within a limit of tests or time.
///
/// Steps:
/// 1. Run the exact query until a pair crosses. It proves bodies separate faster than wrappers could, and
///    finds a crossing pair early, because it descends where boxes overlap most. So the relation is exact,
///    and so is an answer of one pair.
/// 2. If little work is left (TrialRules), as when bodies barely cross, complete the exact query: wrappers
///    would intersect in more pairs than such bodies.
/// 3. Otherwise find all pairs between levels, which have fewer faces: at the level of the tolerance or,
///    within limits, at one level after another, coarsest first.
/// 4. Run the exact query if the wrappers' surfaces do not intersect though the bodies' do, because one
///    wrapper is inside the other.
///
/// A query to a tolerance of bodies without a level that is much smaller than they are is the exact query
/// from the beginning (first_step()).
///
/// Step 1 may use half of a limit. If it ends without an answer, the levels decide as much as they can.
///
/// Whether step 2 completes the query depends on the bodies and poses alone, not on the tolerance, so that a
/// smaller tolerance never yields a larger error bound.
///
/// Correctness: levels never report intersecting bodies as separate. Each wrapper encloses its body
/// (wrapper.hpp), so bodies share no point if their wrappers share none. Two wrappers share no point if no
/// two of their faces intersect and no connected piece of either boundary has a point in the other wrapper.
/// Pairs of faces are found as in the complete query, and pieces are located exactly.
///
/// It remains to account for rounding, which moves hidden vertices and lids independently of each other.
/// Suppose that the rounded bodies share a point x. The exact bodies then have points p (of A) and q (of B)
/// no further from x than a vertex of each is rounded. Move every vertex of the wrappers from its rounded to
/// its exact position, and then wrapper B by p - q: now both wrappers contain p. If no two faces intersect
/// during this motion, a piece of one boundary is inside the other wrapper at its end, and hence was at its
/// beginning, where the location of pieces would have found it. So it suffices that faces that count as
/// disjoint stay disjoint when vertices shift relative to each other by twice the rounding of both bodies:
/// - The kernel guarantees this for every pair that it drops or decides (kWrapperSlack).
/// - Undecided pairs are tested exactly, and count as disjoint only if wrapper_margin() separates them.

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "engine/collide/relation.hpp"
#include "engine/collide/tree_query.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/tree/kernel_setup.hpp"
#include <lrbscope/wrapper.hpp>

namespace lrb {

/// One step of a coarse query: a level of each body; null: the body itself.
struct CoarseStep {
  const WrapperLevel *a = nullptr, *b = nullptr;
  bool exact() const { return a == nullptr && b == nullptr; }
};

/// Returns true if the request has a limit of tests or time.
bool is_limited(const CollideRequest& request);

/// Returns the first step to try: the only one, or within limits the coarsest; exact if no level is worth it.
/// Returns nullopt if a query to a tolerance is the exact query: if it is for one pair, or if no level is
/// worth it, as for bodies of a few hundred faces. Measured, the rules of a trial cost 3 to 8 % of such
/// queries.
std::optional<CoarseStep> first_step(const LrbRep& a, const LrbRep& b, const CollideRequest& request);

/// Returns the steps to try, coarsest first; the last is as fine as requested.
std::vector<CoarseStep> coarse_steps(const LrbRep& a, const LrbRep& b, const CoarseStep& first,
                                     const CollideRequest& request);

/// Returns true if a piece of either wrapper's boundary is in the other wrapper, or nullopt if `in_time()`,
/// which is called before each point location, returns false. For wrappers whose faces do not intersect.
/// Calls visit(side, vertex, where) for each point.
template <class InTime, class Visit>
std::optional<bool> wrappers_nested(QueryContext& ctx, InTime&& in_time, Visit&& visit) {
  for (const Side side : {Side::a, Side::b}) {
    QueryBody &inner = ctx[side], &outer = ctx[other(side)];
    for (const VertexId v : inner.component_vertices()) {
      if (!in_time()) return std::nullopt;
      const Where where = locate(outer, inner.world(v));
      visit(side, v, where);
      if (where != Where::outside) return true;
    }
  }
  return false;
}

/// Work between two clock readings in a query with a time limit; a reading takes as long as one to three
/// tests. Smaller: less work done within a limit; larger: limits are exceeded by more, especially on old
/// processors.
namespace between_looks {
constexpr std::uint64_t kNodePairs = 16;  ///< one or two microseconds; four without AVX2
constexpr unsigned kTests = 32;           ///< decided by the kernel: less than a microsecond
constexpr unsigned kUncertainTests = 8;   ///< about a microsecond; twenty if all need exact arithmetic
}  // namespace between_looks

/// Rules of an exact query within limits. Clock: std::chrono::steady_clock, or a test's own clock.
template <class Clock = std::chrono::steady_clock>
struct LimitedRules {
  static constexpr bool kLimited = true, kWrappers = false, kTrial = false;
  /// Time that each pair still costs after the traversal, for sorting.
  static constexpr std::chrono::nanoseconds kAfterwards{20};

  std::uint64_t max_tests = 0;
  bool has_deadline = false;
  typename Clock::time_point deadline;
  bool stopped = false;  ///< a limit was reached
  unsigned done = 0;     ///< tests since the last clock reading, in units of certain tests

  bool time_is_up(std::size_t pairs = 0) {
    done = 0;
    return stopped |=
           has_deadline && Clock::now() + static_cast<std::int64_t>(pairs) * kAfterwards >= deadline;
  }
  /// Called only when another test is due: the last test that is allowed may also be the last one needed.
  bool no_test_left(std::uint64_t tests, bool certain, std::size_t pairs) {
    if (max_tests > 0 && tests >= max_tests) stopped = true;
    if (stopped || !has_deadline) return stopped;
    done += certain ? 1 : between_looks::kTests / between_looks::kUncertainTests;
    return done >= between_looks::kTests && time_is_up(pairs);
  }
  /// Returns the number of node pairs after which the kernel must return.
  std::uint64_t max_node_pairs(std::uint64_t pairs) const {
    return has_deadline ? pairs + between_looks::kNodePairs : kNoLimit;
  }
};

/// Rules of the first, exact query for all pairs: it gives up after a crossing pair, unless little work is
/// left. The work left is estimated by the node pairs on the stack. These are few if bodies barely cross.
/// More are allowed if the first crossing pair took long to find, because crossing pairs are then deep in the
/// trees.
template <class Clock = std::chrono::steady_clock>
class TrialRules : public LimitedRules<Clock> {
 public:
  static constexpr bool kTrial = true;
  /// Maximum number of node pairs on the stack to continue: for a query to a tolerance, and within limits,
  /// where levels are tried one after another and the exact query last. Larger: deeply intersecting bodies
  /// waste work that is given up; smaller: barely crossing bodies waste work on levels.
  static constexpr std::uint32_t kFewToTolerance = 8, kFewWithinLimits = 24;

  std::uint32_t few_waiting = kFewToTolerance;

  /// Records the state of the traversal, before its candidates are tested.
  void came_to(std::uint64_t node_pairs, std::uint32_t waiting) {
    node_pairs_ = node_pairs;
    waiting_ = waiting;
  }
  /// Records a crossing pair. Returns true if the traversal should end at once.
  bool crossed() {
    if (crossed_at_ == kNoLimit) crossed_at_ = node_pairs_;
    return gives_up(false);
  }
  /// Returns true if a pair crosses and the levels should provide the answer. too_many: more pairs than the
  /// limit were found.
  bool gives_up(bool too_many) {
    if (crossed_at_ == kNoLimit) return false;
    const bool much = waiting_ > few_waiting + crossed_at_ / 4 || node_pairs_ >= crossed_at_ + kMaxMore;
    gave_up_ = too_many || (waiting_ > 0 && much);
    return gave_up_;
  }
  bool gave_up() const { return gave_up_; }

  std::uint64_t max_node_pairs(std::uint64_t pairs) const {
    const std::uint64_t limit = LimitedRules<Clock>::max_node_pairs(pairs);
    return crossed_at_ == kNoLimit ? limit : std::min(limit, pairs + kBetween);
  }

 private:
  /// Maximum number of node pairs after the first crossing pair, and interval at which the stack is checked.
  static constexpr std::uint64_t kMaxMore = 192, kBetween = 16;

  std::uint64_t node_pairs_ = 0, crossed_at_ = kNoLimit;
  std::uint32_t waiting_ = 0;
  bool gave_up_ = false;
};

/// Rules of a query between wrappers, within limits.
template <class Clock = std::chrono::steady_clock>
struct WrapperRules : LimitedRules<Clock> {
  static constexpr bool kWrappers = true;

  double margin = 0;
  bool near = false;  ///< real faces do not intersect, but are within the margin

  /// Returns the Meet to record for a pair that is disjoint in exact arithmetic but undecided by the kernel.
  exact::Meet meet_of_near(QueryContext& ctx, SimplexId a, SimplexId b) {
    const double *ca[3], *cb[3];
    ctx[Side::a].world.corners(a, ca);
    ctx[Side::b].world.corners(b, cb);
    if (separated_by(margin, ctx[Side::a].rep().dim(), ca, cb)) return exact::Meet::disjoint;
    if (!ctx[Side::a].rep().is_real_simplex(a) || !ctx[Side::b].rep().is_real_simplex(b))
      return exact::Meet::touch;
    near = true;
    return exact::Meet::disjoint;
  }
};

template <class Probe, class Clock = std::chrono::steady_clock>
class CoarseQuery {
 public:
  /// `first`: see first_step(). `may_be_apart`: false if roots_are_apart() has returned false.
  CoarseQuery(QueryContext& ctx, const CollideRequest& request, const CoarseStep& first, bool may_be_apart,
              CollideResult& result, Probe& probe)
      : ctx_(ctx),
        request_(request),
        first_(first),
        may_be_apart_(may_be_apart),
        result_(result),
        probe_{probe} {}

  void run() {
    // Reading the clock takes as long as a pair of nodes.
    if (request_.max_time > 0) began_ = Clock::now();
    result_.relation = Relation::unresolved;
    result_.error_bound = kInfinity;
    result_.finished = false;
    if (first_.exact())
      ask_exactly(0);
    else if (!first_walk_decides())
      climb(coarse_steps(ctx_[Side::a].rep(), ctx_[Side::b].rep(), first_, request_));
    if constexpr (Probe::kEnabled)
      for (std::size_t i = 0; i < result_.pairs.size(); ++i)
        probe_.probe.contact(result_.pairs[i].a, result_.pairs[i].b, result_.meets[i]);
  }

 private:
  static constexpr double kLongest = 1e6;  ///< seconds: longer times overflow the clock on some machines
  /// Capacity reserved for pairs when a level is traversed: most answers have no more.
  static constexpr std::size_t kLikelyPairs = 128;

  /// Hides contacts from the probe: the contacts of a step belong to the answer only if it is the last step.
  struct WithoutContacts {
    static constexpr bool kEnabled = Probe::kEnabled;
    Probe& probe;
    void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t da, std::uint32_t db) {
      probe.face_test(a, b, meet, da, db);
    }
    void refine(Side side, RegionId r, std::uint32_t added) { probe.refine(side, r, added); }
    void contact(SimplexId, SimplexId, exact::Meet) {}
    EventLevel level() const { return probe.level(); }
    std::uint32_t node_pair(const NodeVisit& visit) { return probe.node_pair(visit); }
    void plane_test(SimplexId a, SimplexId b, Side whose) { probe.plane_test(a, b, whose); }
    void tested_by(TestedBy how) { probe.tested_by(how); }
    void point(Side whose, VertexId v, Where where) { probe.point(whose, v, where); }
    void begin(Phase phase, std::uint32_t a, std::uint32_t b) { probe.begin(phase, a, b); }
    void end(Phase phase, std::uint64_t count) { probe.end(phase, count); }
  };

  /// Sorts the pairs found.
  void sort(CollideResult& found) {
    in_phase(probe_, Phase::sort, [&] {
      ctx_.pair_order.sort(found);
      return found.pairs.size();
    });
  }

  /// Sets the limits of a step: everything that is left, or half of it.
  void limit(LimitedRules<Clock>& rules, bool half) const {
    rules.max_tests = half ? (request_.max_tests + 1) / 2 : request_.max_tests;
    rules.has_deadline = request_.max_time > 0;
    const double seconds = std::min(request_.max_time, kLongest);
    if (rules.has_deadline)
      rules.deadline = began_ + std::chrono::duration_cast<typename Clock::duration>(
                                    std::chrono::duration<double>(half ? seconds / 2 : seconds));
  }

  /// Traverses the trees selected for the bodies. Returns false if a limit was reached before the end.
  template <class Rules>
  bool walk(const CollideRequest& request, CollideResult& found, Rules& rules) {
    found.counters = std::move(result_.counters);
    TreeQuery<WithoutContacts, Rules> query(ctx_, request, found, probe_, rules);
    query.run(may_be_apart_);
    apart_ = query.ends_at_roots();
    result_.counters = std::move(found.counters);
    rules = query.rules();
    return !rules.stopped;
  }

  /// Returns the predicate for decide_relation() that stops point location when time is up.
  static auto in_time(LimitedRules<Clock>& rules) {
    return [&rules] { return !rules.has_deadline || !rules.time_is_up(); };
  }

  /// Decides the relation after a walk of the bodies themselves. Returns false if time is up.
  bool decide(CollideResult& found, LimitedRules<Clock>& rules) {
    // A probe is shown the location of points even if boxes decide.
    if (Probe::kEnabled || !apart_ || !ctx_[Side::a].rep().closed() || !ctx_[Side::b].rep().closed())
      return decide_relation_watched(ctx_, found, probe_, in_time(rules));
    set_separate(found);
    return true;
  }

  /// Makes `found` the answer.
  void answer(CollideResult& found, double error_bound, bool finished) {
    result_.pairs.swap(found.pairs);
    result_.meets.swap(found.meets);
    result_.relation = found.relation;
    result_.interiors_overlap = found.interiors_overlap;
    result_.error_bound = error_bound;
    result_.finished = finished;
  }

  /// Queries the bodies themselves. The answer is exact if the limits allow it; `error_bound` is reported as
  /// for a level.
  void ask_exactly(double error_bound) {
    for (const Side side : {Side::a, Side::b}) ctx_[side].query_body();
    CollideResult found;
    LimitedRules<Clock> rules;
    limit(rules, false);
    if (!walk(request_, found, rules)) return;
    sort(found);
    if (decide(found, rules)) answer(found, error_bound, true);
  }

  /// Queries the bodies themselves, until one pair is found that completes the answer, or one of many pairs
  /// crosses. Returns true if the answer is complete, also if nothing crosses or if little work was left.
  bool first_walk_decides() {
    CollideResult found;
    TrialRules<Clock> rules;
    limit(rules, true);
    if (is_limited(request_)) rules.few_waiting = TrialRules<Clock>::kFewWithinLimits;
    const bool whole = walk(request_, found, rules) && !rules.gave_up();
    if (!whole) keep_one_crossing(found);
    if (whole || !found.pairs.empty()) {
      sort(found);
      const bool known = decide(found, rules);
      if (known) answer(found, whole ? 0 : kInfinity, whole);
      if (known && whole) return true;
    }
    take_back(Side::a);
    take_back(Side::b);
    return false;
  }

  /// Keeps only the first crossing pair. Clears the result if no pair crosses.
  static void keep_one_crossing(CollideResult& found) {
    const auto crossing = std::find(found.meets.begin(), found.meets.end(), exact::Meet::cross);
    const auto kept = static_cast<std::size_t>(crossing - found.meets.begin());
    found.pairs = crossing == found.meets.end() ? std::vector<SimplexPair>{} : std::vector{found.pairs[kept]};
    found.meets.assign(found.pairs.size(), exact::Meet::cross);
  }

  /// Coarsens all refined regions: these show real faces, which are not part of a level.
  void take_back(Side side) {
    Wrapper& wrapper = *ctx_[side].wrapper;
    if constexpr (Probe::kEnabled)
      for (auto r = wrapper.excluded().rbegin(); r != wrapper.excluded().rend(); ++r)
        probe_.probe.coarsen(side, *r, static_cast<std::uint32_t>(ctx_[side].rep().floor(*r).size()));
    wrapper.reset();
  }

  /// Tries level after level until a limit is reached or the answer is as fine as requested.
  void climb(const std::vector<CoarseStep>& steps) {
    for (std::size_t i = 0; i < steps.size() && !result_.finished; ++i) {
      if (steps[i].exact()) return ask_exactly(0);
      const bool last = i + 1 == steps.size(), crosses = result_.relation == Relation::crossing;
      if (!(crosses ? add_level(steps[i], last) : try_level(steps[i], last))) return;
    }
  }

  /// Traverses a level of each body. Returns false if a limit was reached before its end.
  bool walk_level(const CoarseStep& step, CollideResult& found, WrapperRules<Clock>& rules) {
    QueryBody &a = ctx_[Side::a], &b = ctx_[Side::b];
    step.a == nullptr ? a.query_body() : a.query_level(*step.a);
    step.b == nullptr ? b.query_body() : b.query_level(*step.b);
    rules.margin = wrapper_margin(a.world.pose(), a.tree(), b.world.pose(), b.tree());
    limit(rules, false);
    found.pairs.reserve(kLikelyPairs);
    found.meets.reserve(kLikelyPairs);
    if (!walk(request_, found, rules)) return false;
    sort(found);
    const double offset = off_body(step.a, a.world.pose()) + off_body(step.b, b.world.pose());
    found.error_bound = (offset + rules.margin) * (1 + kKernelRounding);
    return true;
  }

  /// Returns an upper bound on the distance of a level's wrapper from its body in the world. Avoids 0 times
  /// infinity.
  static double off_body(const WrapperLevel* level, const Pose& pose) {
    return level == nullptr || level->bound == 0 ? 0 : level->bound * stretch(pose);
  }

  /// Finds the pairs of a level of bodies that cross. Returns false if a limit was reached before its end;
  /// the answer of the level before then remains.
  bool add_level(const CoarseStep& step, bool last) {
    CollideResult found;
    WrapperRules<Clock> rules;
    if (!walk_level(step, found, rules)) return false;
    found.relation = result_.relation;
    found.interiors_overlap = result_.interiors_overlap;
    const bool nested = found.pairs.empty();
    const double bound = found.error_bound;
    answer(found, bound, last && !nested);
    // The exact pairs are better than requested, but keep this level's bound: otherwise a smaller tolerance
    // could report a larger bound.
    if (last && nested) ask_exactly(bound);
    return true;
  }

  /// Determines as much as a level proves while the relation is unresolved. Returns false if a limit was
  /// reached before its end, or if the answer is complete.
  bool try_level(const CoarseStep& step, bool last) {
    CollideResult found;
    WrapperRules<Clock> rules;
    if (!walk_level(step, found, rules)) return false;
    double bound = found.error_bound;
    found.relation = Relation::unresolved;
    if (found.pairs.empty() && !rules.near) {
      // If one wrapper is inside the other, nothing bounds the distance of the bodies.
      const std::optional<bool> nested = locate_wrappers(rules);
      if (!nested) return false;
      if (!*nested) found.relation = Relation::separate;
      bound = *nested ? kInfinity : 0;
    } else if (has_real_crossing(found)) {
      found.relation = Relation::crossing;
      found.interiors_overlap = Answer::yes;
      if (request_.mode != Mode::all_pairs) bound = 0;
    }
    if (found.relation == Relation::separate) found.interiors_overlap = Answer::no;
    const bool resolved = found.relation != Relation::unresolved;
    answer(found, bound, bound == 0 || (last && resolved));
    return !result_.finished;
  }

  std::optional<bool> locate_wrappers(LimitedRules<Clock>& rules) {
    std::optional<bool> nested;
    locate_in_phase(probe_,
                    [&](const auto& visit) { nested = wrappers_nested(ctx_, in_time(rules), visit); });
    return nested;
  }

  bool has_real_crossing(const CollideResult& found) {
    for (std::size_t i = 0; i < found.pairs.size(); ++i)
      if (found.meets[i] == exact::Meet::cross && ctx_[Side::a].rep().is_real_simplex(found.pairs[i].a) &&
          ctx_[Side::b].rep().is_real_simplex(found.pairs[i].b))
        return true;
    return false;
  }

  QueryContext& ctx_;
  const CollideRequest& request_;
  const CoarseStep first_;
  const bool may_be_apart_;
  CollideResult& result_;
  WithoutContacts probe_;
  bool apart_ = false;                ///< the last walk has proven the bounds of the roots disjoint
  typename Clock::time_point began_;  ///< set only under a time limit
};

}  // namespace lrb
