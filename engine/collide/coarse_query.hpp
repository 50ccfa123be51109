#pragma once
/// Queries that do no more than a scene needs: to a tolerance, or as far as a limit of tests or time allows.
///
/// How. The exact query is asked first, until a pair crosses: bodies that are apart it tells apart faster
/// than wrappers could, and of bodies that cross it finds a pair at once, since it looks where boxes overlap
/// most. So the relation is exact, and so is an answer of one pair. If little is left to do then
/// (TrialRules), as where bodies hardly more than touch, it goes on to the end: wrappers meet in more pairs
/// than such bodies. Else the list of all pairs is left to wrappers, whose faces are fewer: to the level that
/// the tolerance allows or, within limits, to one level after another, coarsest first. Where surfaces of
/// wrappers do not meet though the bodies do, one wrapper being in the other, and where no level is much
/// smaller than the bodies, the exact query finds the pairs. The first question may take half of a limit;
/// should it end without an answer, levels tell what they can.
///
/// Whether the exact query goes on depends on the bodies and poses alone, not on the tolerance: so a finer
/// tolerance never gives a larger error bound.
///
/// Why levels never call bodies separate that meet. Each wrapper encloses its body (wrapper.hpp), so
/// bodies whose wrappers share no point share none. Two wrappers share no point if no two of their faces meet
/// and no connected piece of either one's boundary has a point in the other: pairs of faces are found as the
/// complete query finds them, and pieces are located exactly. But in the world, rounding moves hidden
/// vertices and lids separately. Let x be a point in which the bodies meet as rounded. There are points p and
/// q of the bodies as they would be without rounding, no further from x than a vertex of each is rounded.
/// Move every vertex of the wrappers from its rounded place to its true one, and then wrapper B by p - q: now
/// both wrappers hold p. If no two faces meet all the way, then a piece of one boundary lies in the other
/// wrapper now, and did at the beginning, where it was looked for. So it is enough that faces which count as
/// apart stay apart when vertices shift against each other by twice what both bodies are rounded:
/// - the kernel vouches for this in all that it drops and in all that it calls certain (kWrapperSlack);
/// - what it leaves open is tested exactly, and counts as apart only with wrapper_margin() between.

#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>
#include <vector>

#include "engine/collide/relation.hpp"
#include "engine/collide/separation.hpp"
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

/// Returns whether there is a limit of tests or time.
bool is_limited(const CollideRequest& request);

/// Returns the first step to be tried: the only one, or within limits the coarsest. Exact where no level is
/// worth it.
CoarseStep first_step(const LrbRep& a, const LrbRep& b, const CollideRequest& request);

/// Returns the steps to be tried, coarsest first; the last is as fine as was asked for.
std::vector<CoarseStep> coarse_steps(const LrbRep& a, const LrbRep& b, const CollideRequest& request);

/// Returns whether the boundary of either wrapper has a piece in the other; nothing if `in_time()`, which is
/// asked before each point is located, returns false. For wrappers whose faces do not meet. Calls see(side,
/// vertex, where) for each point.
template <class InTime, class See>
std::optional<bool> wrappers_nested(QueryContext& ctx, InTime&& in_time, See&& see) {
  for (const Side side : {Side::a, Side::b}) {
    QueryBody &inner = ctx[side], &outer = ctx[other(side)];
    for (const VertexId v : inner.component_vertices()) {
      if (!in_time()) return std::nullopt;
      const Where where = locate(outer, inner.world(v));
      see(side, v, where);
      if (where != Where::outside) return true;
    }
  }
  return false;
}

/// Work of a query with a limit in time between two readings of the clock, each of which takes as long as one
/// to three tests. Less: queries with a limit in time do less; more: they miss it by more, on old processors
/// above all.
namespace between_looks {
constexpr std::uint64_t kNodePairs = 16;  ///< one or two microseconds; four without AVX2
constexpr unsigned kTests = 32;           ///< that are certain: less than a microsecond
constexpr unsigned kUncertainTests = 8;   ///< about a microsecond; twenty where all are decided exactly
}  // namespace between_looks

/// Rules of an exact query within limits. Clock: std::chrono::steady_clock, or one that a test turns.
template <class Clock = std::chrono::steady_clock>
struct LimitedRules {
  static constexpr bool kLimited = true, kWrappers = false, kTrial = false;
  /// What is left to do with each pair when all are found: to sort it.
  static constexpr std::chrono::nanoseconds kAfterwards{20};

  std::uint64_t max_tests = 0;
  bool has_deadline = false;
  typename Clock::time_point deadline;
  bool stopped = false;  ///< a limit was reached
  unsigned done = 0;     ///< since the last look at the clock, in certain tests

  bool time_is_up(std::size_t pairs = 0) {
    done = 0;
    return stopped |=
           has_deadline && Clock::now() + static_cast<std::int64_t>(pairs) * kAfterwards >= deadline;
  }
  /// Asked only when there is a test to be done: the last one that is allowed may be the last one needed.
  bool no_test_left(std::uint64_t tests, bool certain, std::size_t pairs) {
    if (max_tests > 0 && tests >= max_tests) stopped = true;
    if (stopped || !has_deadline) return stopped;
    done += certain ? 1 : between_looks::kTests / between_looks::kUncertainTests;
    return done >= between_looks::kTests && time_is_up(pairs);
  }
  /// Returns how many node pairs the kernel may have done when it comes back.
  std::uint64_t most_node_pairs(std::uint64_t pairs) const {
    return has_deadline ? pairs + between_looks::kNodePairs : kNoLimit;
  }
};

/// Rules of the exact query that comes first, for all pairs: it gives up once a pair crosses, unless little
/// is left to do. What is left is judged by the pairs of nodes that wait. There are few where bodies barely
/// cross; more may wait where it took long to find a pair that crosses, since those lie deep in the trees.
template <class Clock = std::chrono::steady_clock>
class TrialRules : public LimitedRules<Clock> {
 public:
  static constexpr bool kTrial = true;
  /// How few pairs of nodes may wait, for a query to a tolerance, and within limits, where levels come one
  /// after another and the exact query last. More: bodies that cross deeply pay for work that is given up;
  /// fewer: bodies that barely cross pay for levels.
  static constexpr std::uint32_t kFewToTolerance = 8, kFewWithinLimits = 24;

  std::uint32_t few_waiting = kFewToTolerance;

  /// Told where the walk is, before what it found there is tested.
  void came_to(std::uint64_t node_pairs, std::uint32_t waiting) {
    node_pairs_ = node_pairs;
    waiting_ = waiting;
  }
  /// Told of a pair that crosses. Returns true if the walk should end at once.
  bool crossed() {
    if (crossed_at_ == kNoLimit) crossed_at_ = node_pairs_;
    return gives_up(false);
  }
  /// Returns true if a pair crosses and the answer should be left to levels. too_many: of pairs that were
  /// found.
  bool gives_up(bool too_many) {
    if (crossed_at_ == kNoLimit) return false;
    const bool much = waiting_ > few_waiting + crossed_at_ / 4 || node_pairs_ >= crossed_at_ + kMostMore;
    gave_up_ = too_many || (waiting_ > 0 && much);
    return gave_up_;
  }
  bool gave_up() const { return gave_up_; }

  std::uint64_t most_node_pairs(std::uint64_t pairs) const {
    const std::uint64_t limit = LimitedRules<Clock>::most_node_pairs(pairs);
    return crossed_at_ == kNoLimit ? limit : std::min(limit, pairs + kBetween);
  }

 private:
  /// Pairs of nodes after the first pair that crosses, and those between two looks at how many wait.
  static constexpr std::uint64_t kMostMore = 192, kBetween = 16;

  std::uint64_t node_pairs_ = 0, crossed_at_ = kNoLimit;
  std::uint32_t waiting_ = 0;
  bool gave_up_ = false;
};

/// Rules of a query between wrappers, within limits.
template <class Clock = std::chrono::steady_clock>
struct WrapperRules : LimitedRules<Clock> {
  static constexpr bool kWrappers = true;

  double margin = 0;
  bool near = false;  ///< real faces do not meet, but come within the margin

  /// Returns how to count a pair that does not meet, which the kernel could not tell.
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
  CoarseQuery(QueryContext& ctx, const CollideRequest& request, CollideResult& result, Probe& probe)
      : ctx_(ctx), request_(request), result_(result), probe_{probe} {}

  void run() {
    // Looking at the clock takes as long as a pair of nodes.
    if (request_.max_time > 0) began_ = Clock::now();
    result_.relation = Relation::unresolved;
    result_.error_bound = kInfinity;
    result_.finished = false;
    const LrbRep &a = ctx_[Side::a].rep(), &b = ctx_[Side::b].rep();
    if (first_step(a, b, request_).exact())
      ask_exactly(0);
    else if (!first_walk_decides())
      climb(coarse_steps(a, b, request_));
    if constexpr (Probe::kEnabled)
      for (std::size_t i = 0; i < result_.pairs.size(); ++i)
        probe_.probe.contact(result_.pairs[i].a, result_.pairs[i].b, result_.meets[i]);
  }

 private:
  static constexpr double kLongest = 1e6;  ///< seconds: more does not fit the clock on every machine
  /// Room is made for so many pairs where a level is walked: most answers have no more.
  static constexpr std::size_t kLikelyPairs = 128;

  /// Keeps contacts from the probe: those of a step are part of the answer only if it is the last.
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

  /// Sorts the pairs that were found.
  void sort(CollideResult& found) {
    in_phase(probe_, Phase::sort, [&] {
      ctx_.pair_order.sort(found);
      return found.pairs.size();
    });
  }

  /// Sets the limits of a step: all that is left, or as much as leaves half of it.
  void limit(LimitedRules<Clock>& rules, bool half) const {
    rules.max_tests = half ? (request_.max_tests + 1) / 2 : request_.max_tests;
    rules.has_deadline = request_.max_time > 0;
    const double seconds = std::min(request_.max_time, kLongest);
    if (rules.has_deadline)
      rules.deadline = began_ + std::chrono::duration_cast<typename Clock::duration>(
                                    std::chrono::duration<double>(half ? seconds / 2 : seconds));
  }

  /// Walks what the bodies are set to. Returns false if a limit was reached before the end.
  template <class Rules>
  bool walk(const CollideRequest& request, CollideResult& found, Rules& rules) {
    found.counters = std::move(result_.counters);
    TreeQuery<WithoutContacts, Rules> query(ctx_, request, found, probe_, rules);
    query.run();
    result_.counters = std::move(found.counters);
    rules = query.rules();
    return !rules.stopped;
  }

  /// Returns what decide_relation() asks before it locates a point: whether there is time.
  static auto in_time(LimitedRules<Clock>& rules) {
    return [&rules] { return !rules.has_deadline || !rules.time_is_up(); };
  }

  /// Makes what was found the answer.
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
    if (decide_relation_watched(ctx_, found, probe_, in_time(rules))) answer(found, error_bound, true);
  }

  /// Asks the bodies as they are, until it has an answer of one pair, or one pair of many crosses. Returns
  /// true if that is the whole answer: also where they do not cross, or little was left to do.
  bool first_walk_decides() {
    CollideResult found;
    TrialRules<Clock> rules;
    limit(rules, true);
    if (is_limited(request_)) rules.few_waiting = TrialRules<Clock>::kFewWithinLimits;
    const bool whole = walk(request_, found, rules) && !rules.gave_up();
    if (!whole) keep_one_crossing(found);
    if (whole || !found.pairs.empty()) {
      sort(found);
      const bool known = decide_relation_watched(ctx_, found, probe_, in_time(rules));
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

  /// Takes back all regions: those that were refined show real faces.
  void take_back(Side side) {
    Wrapper& wrapper = *ctx_[side].wrapper;
    if constexpr (Probe::kEnabled)
      for (auto r = wrapper.excluded().rbegin(); r != wrapper.excluded().rend(); ++r)
        probe_.probe.coarsen(side, *r, static_cast<std::uint32_t>(ctx_[side].rep().floor(*r).size()));
    wrapper.reset();
  }

  /// Goes from level to level until a limit is reached or the answer is as fine as was asked for.
  void climb(const std::vector<CoarseStep>& steps) {
    for (std::size_t i = 0; i < steps.size() && !result_.finished; ++i) {
      if (steps[i].exact()) return ask_exactly(0);
      const bool last = i + 1 == steps.size(), crosses = result_.relation == Relation::crossing;
      if (!(crosses ? add_level(steps[i], last) : try_level(steps[i], last))) return;
    }
  }

  /// Walks a level of each body. Returns false if a limit was reached before its end.
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
    const double off = off_body(step.a, a.world.pose()) + off_body(step.b, b.world.pose());
    found.error_bound = (off + rules.margin) * (1 + kKernelRounding);
    return true;
  }

  /// Returns how far a level is off its body in the world at most. Not a product where it would be 0 times
  /// infinity.
  static double off_body(const WrapperLevel* level, const Pose& pose) {
    return level == nullptr || level->bound == 0 ? 0 : level->bound * stretch(pose);
  }

  /// Finds the pairs of a level, of bodies that cross. Returns false if a limit was reached before its end:
  /// the answer then stays that of the level before.
  bool add_level(const CoarseStep& step, bool last) {
    CollideResult found;
    WrapperRules<Clock> rules;
    if (!walk_level(step, found, rules)) return false;
    found.relation = result_.relation;
    found.interiors_overlap = result_.interiors_overlap;
    const bool nested = found.pairs.empty();
    const double bound = found.error_bound;
    answer(found, bound, last && !nested);
    // That the pairs are better than was asked for is luck: with less tolerance the bound would be larger.
    if (last && nested) ask_exactly(bound);
    return true;
  }

  /// Finds out what a level tells of bodies of which nothing is known. Returns false if a limit was reached
  /// before its end, or if there is no more to be found out.
  bool try_level(const CoarseStep& step, bool last) {
    CollideResult found;
    WrapperRules<Clock> rules;
    if (!walk_level(step, found, rules)) return false;
    double bound = found.error_bound;
    found.relation = Relation::unresolved;
    if (found.pairs.empty() && !rules.near) {
      // A wrapper in the other: nothing tells how far the bodies are from each other.
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
    locate_in_phase(probe_, [&](const auto& see) { nested = wrappers_nested(ctx_, in_time(rules), see); });
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
  CollideResult& result_;
  WithoutContacts probe_;
  typename Clock::time_point began_;  ///< only where time is limited
};

}  // namespace lrb
