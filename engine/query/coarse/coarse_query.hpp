#pragma once
/// Queries that do no more than a scene needs: between wrappers as coarse as a tolerance allows, or coarsest
/// first until a limit is reached.
///
/// Why they never call bodies separate that meet. Each wrapper encloses its body (wrapper_level.hpp), so
/// bodies whose wrappers share no point share none. Two wrappers share no point if no two of their faces meet
/// and no connected piece of either one's boundary has a point in the other: pairs of faces are found as the
/// complete query finds them, and pieces are located exactly. In the world, rounding moves hidden vertices
/// and lids separately: faces therefore count as separate only if they keep wrapper_margin(), which is enough
/// for all of that.

#include <chrono>
#include <limits>
#include <vector>

#include "engine/core/tolerances.hpp"
#include "engine/query/coarse/separating_slab.hpp"
#include "engine/query/walk/relation.hpp"
#include "engine/query/walk/tree_query.hpp"
#include "engine/tree/pose_bounds.hpp"

namespace lrb {

/// Throws InputError if a coarse query is combined with a request that it cannot answer.
void check_coarse_request(const CollideRequest& request);

/// Returns the tolerances to be tried, coarsest first; the last is the one asked for.
std::vector<double> coarse_ladder(QueryContext& context, const CollideRequest& request);

/// Returns true if the boundary of either wrapper has a piece in the other. For wrappers whose faces do not
/// meet.
bool wrappers_nested(QueryContext& context);

struct CoarseRules {
  static constexpr bool kCoarse = true;
  using Clock = std::chrono::steady_clock;

  bool exact = false;  ///< the wrappers are the bodies themselves
  double margin = 0;
  std::uint64_t max_tests = 0;
  bool has_deadline = false;
  Clock::time_point deadline;
  bool stopped = false;  ///< a limit was reached
  bool near = false;     ///< real faces do not meet, but come within the margin

  bool must_stop() { return stopped |= has_deadline && Clock::now() >= deadline; }
  /// Asked only when there is a test to be done: the last one that is allowed may be the last one needed.
  bool no_test_left(std::uint64_t tests) { return stopped |= max_tests > 0 && tests >= max_tests; }
  bool one_is_enough() const { return !exact; }

  /// Returns how to count a pair that does not meet.
  exact::Meet meet_of_near(QueryContext& ctx, SimplexId a, SimplexId b) {
    if (exact) return exact::Meet::disjoint;
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

template <class Probe>
class CoarseQuery {
 public:
  CoarseQuery(QueryContext& ctx, const CollideRequest& request, CollideResult& result, Probe& probe)
      : ctx_(ctx), request_(request), result_(result), probe_(probe) {}

  void run() {
    const std::vector<double> ladder = coarse_ladder(ctx_, request_);
    CoarseRules rules;
    rules.max_tests = request_.max_tests;
    rules.has_deadline = request_.max_time > 0;
    if (rules.has_deadline)
      rules.deadline = CoarseRules::Clock::now() +
                       std::chrono::duration_cast<CoarseRules::Clock::duration>(
                           std::chrono::duration<double>(std::min(request_.max_time, kLongest)));
    result_.relation = Relation::unresolved;
    result_.error_bound = std::numeric_limits<double>::infinity();
    result_.finished = false;
    for (std::size_t i = 0; i < ladder.size() && !result_.finished; ++i)
      if (!step(ladder[i], rules, i + 1 == ladder.size())) break;
    if constexpr (Probe::kEnabled)
      for (std::size_t i = 0; i < result_.pairs.size(); ++i)
        probe_.contact(result_.pairs[i].a, result_.pairs[i].b, result_.meets[i]);
  }

 private:
  static constexpr double kLongest = 1e6;  ///< seconds: more does not fit the clock on every machine

  /// Keeps contacts from the probe: those of a level are part of the answer only if it is the last.
  struct WithoutContacts {
    static constexpr bool kEnabled = Probe::kEnabled;
    Probe& probe;
    void face_test(SimplexId a, SimplexId b, exact::Meet meet, std::uint32_t da, std::uint32_t db) {
      probe.face_test(a, b, meet, da, db);
    }
    void refine(Side side, RegionId r, std::uint32_t added) { probe.refine(side, r, added); }
    void contact(SimplexId, SimplexId, exact::Meet) {}
  };

  /// Queries one level. Returns false if a limit was reached before its end: the answer then stays that of
  /// the level before.
  bool step(double tolerance, CoarseRules rules, bool last) {
    QueryBody &a = ctx_[Side::a], &b = ctx_[Side::b];
    const WrapperLevel &la = a.levels().at(tolerance), &lb = b.levels().at(tolerance);
    rules.exact = la.bound == 0 && lb.bound == 0;
    la.bound == 0 ? a.query_body() : a.query_level(la);
    lb.bound == 0 ? b.query_body() : b.query_level(lb);
    rules.margin = wrapper_margin(a.world.pose(), a.tree(), b.world.pose(), b.tree());
    CollideResult level;
    level.counters = std::move(result_.counters);
    WithoutContacts probe{probe_};
    TreeQuery<WithoutContacts, CoarseRules> query(ctx_, request_, level, probe, rules);
    query.run();
    result_.counters = std::move(level.counters);
    if (query.rules().stopped) return false;
    ctx_.pair_order.sort(level);
    decide(level, query.rules(), off(la, a.world.pose()) + off(lb, b.world.pose()));
    result_.pairs.swap(level.pairs);
    result_.meets.swap(level.meets);
    result_.relation = level.relation;
    result_.interiors_overlap = level.interiors_overlap;
    result_.error_bound = level.error_bound;
    result_.finished = last || level.error_bound == 0;
    return true;
  }

  /// Returns how far a level is off its body in the world at most. Not a product where it would be 0 times infinity.
  static double off(const WrapperLevel& level, const Pose& pose) {
    return level.bound == 0 ? 0 : level.bound * stretch(pose);
  }

  void decide(CollideResult& level, const CoarseRules& rules, double bound) {
    if (rules.exact) {
      decide_relation(ctx_, level);
      return;
    }
    level.error_bound = (bound + rules.margin) * (1 + kKernelRounding);
    level.relation = Relation::unresolved;
    level.interiors_overlap = Answer::unknown;
    if (level.pairs.empty() && !rules.near && !wrappers_nested(ctx_)) {
      level.relation = Relation::separate;
      level.interiors_overlap = Answer::no;
      level.error_bound = 0;
      return;
    }
    for (std::size_t i = 0; i < level.pairs.size(); ++i) {
      if (level.meets[i] != exact::Meet::cross || !ctx_[Side::a].rep().is_real_simplex(level.pairs[i].a) ||
          !ctx_[Side::b].rep().is_real_simplex(level.pairs[i].b))
        continue;
      level.relation = Relation::crossing;
      level.interiors_overlap = Answer::yes;
      if (request_.mode != Mode::all_pairs) level.error_bound = 0;
      return;
    }
  }

  QueryContext& ctx_;
  const CollideRequest& request_;
  CollideResult& result_;
  Probe& probe_;
};

}  // namespace lrb
