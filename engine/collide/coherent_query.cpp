/// Coherent queries with a candidate cache, the idea of Verlet's neighbour lists (1967): keep all pairs that
/// may intersect within a margin, and test only these until the motion leaves the margin.
///
/// Steps of one query (answer()):
/// 1. Update the motion of B relative to A. If it is not nearly rigid, query from scratch.
/// 2. If B is within the cached sweep, test the cached pairs that may intersect at this pose.
/// 3. Else, if one pair is enough, test whether the last pair still crosses.
/// 4. Else make a new cache if the policy expects it to pay, or query from scratch.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/collide/candidate_cache.hpp"
#include "engine/collide/collide_into.hpp"
#include "engine/collide/relative_motion.hpp"
#include "engine/core/tolerances.hpp"
#include <lrbscope/coherent.hpp>

namespace lrb {
namespace {

/// Size of the candidate buffer: the number of pairs found between clock readings.
constexpr std::size_t kAtATime = 256;
/// The usual step is the maximum of recent steps, where each query multiplies earlier ones by kForgetStep. A
/// step more than kJump times as long is a jump and does not predict the next steps, unless another jump
/// follows.
constexpr double kForgetStep = 0.7, kJump = 8;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

}  // namespace

/// The implementation of CoherentQuery.
class CoherentQuery::Work {
 public:
  Work(const LrbRep& a, const LrbRep& b, const CollideRequest& request, CacheUse use);
  template <class Probe>
  const CollideResult& collide(const Pose& pose_a, const Pose& pose_b, Probe& probe);
  const Statistics& statistics() const { return statistics_; }

 private:
  template <class Probe>
  void answer(const Pose& pose_a, const Pose& pose_b, Probe& probe);
  template <class Probe>
  void query_from_scratch(Probe& probe);
  template <class Probe>
  void query_kept_wrappers(const Pose& pose_a, const Pose& pose_b, Probe& probe);
  template <class Probe>
  void finish(Probe& probe);
  template <class Probe>
  bool still_crosses(Probe& probe);
  template <class Probe>
  bool make_cache(const CachePolicy::Plan& plan, Probe& probe);
  template <class Probe>
  bool find_candidates(TreeKernel& k, Probe& probe);
  template <class Probe>
  void answer_from_cache(const SweepPoint& where, Probe& probe);
  template <class Probe>
  bool test_cached(const TreeKernel& k, Probe& probe);
  template <class Probe>
  void report_test(const SimplexPair& p, exact::Meet meet, TestedBy by, Probe& probe);
  template <class Probe>
  void report_kept(Probe& probe);
  template <class Probe>
  void report_reset(Probe& probe);
  std::uint32_t depth(Side side, SimplexId s) const;
  void collect_answer();
  template <class Probe>
  void describe(Probe& probe);
  void show_opened();
  void note_step(double step);
  std::optional<CachePolicy::Plan> next_plan();

  const LrbRep &a_, &b_;
  CollideRequest request_;
  CacheUse use_;
  QueryContext context_;
  CollideResult result_;
  Statistics statistics_;
  bool plain_;                    ///< the request can be answered from a cache
  std::optional<KeptGaps> gaps_;  ///< the request is answered on kept wrappers
  RelativeMotion motion_;

  bool at_work_ = false;   ///< a call began and did not return
  double usual_step_ = 0;  ///< the longest recent step, apart from jumps
  bool jumped_ = false;

  bool has_cache_ = false;
  Sweep sweep_;  ///< the range for which the cache is complete
  CandidateCache cache_;
  SweepPoint where_;         ///< position in the sweep at the last query answered from the cache
  bool has_answer_ = false;  ///< result_ is the answer of the last query from this cache

  CachePolicy policy_;
};

CoherentQuery::Work::Work(const LrbRep& a, const LrbRep& b, const CollideRequest& request, CacheUse use)
    : a_(a),
      b_(b),
      request_(request),
      use_(use),
      plain_(request.recursion == Recursion::complete && request.predicates == Predicates::exact &&
             !request.is_coarse() && !request.separation && !a.tree().empty() && !b.tree().empty()) {
  const FloatMode float_mode;
  if (plain_) motion_ = {a, b};
  if (request.recursion == Recursion::paper && request.predicates == Predicates::exact &&
      !request.separation && request.mode == Mode::all_pairs && request.wrapper == WrapperMode::regularised)
    gaps_.emplace(a, b);
}

template <class Probe>
const CollideResult& CoherentQuery::Work::collide(const Pose& pose_a, const Pose& pose_b, Probe& probe) {
  const FloatMode float_mode;
  // Requests that a cache cannot answer, and empty bodies, are passed on unchanged.
  if (!plain_ && !gaps_) {
    result_ = lrb::collide(a_, pose_a, b_, pose_b, request_, context_, probe);
    ++statistics_.from_scratch;
    return result_;
  }
  check_query(a_, pose_a, b_, pose_b);
  if (std::exchange(at_work_, true)) {  // the last call threw an exception and left an unknown state
    has_cache_ = false;
    motion_.forget();
    result_.pairs.clear();
    for (QueryBody& body : context_.body) body.wrapper.reset();
    if (gaps_) gaps_.emplace(a_, b_);
  }
  // The counter of fallbacks is cumulative: the difference is this query's.
  const std::uint64_t fallbacks = exact::exact_fallbacks();
  clear(result_.counters);
  gaps_ ? query_kept_wrappers(pose_a, pose_b, probe) : answer(pose_a, pose_b, probe);
  result_.counters.exact_fallbacks = exact::exact_fallbacks() - fallbacks;
  at_work_ = false;
  return result_;
}

template <class Probe>
void CoherentQuery::Work::answer(const Pose& pose_a, const Pose& pose_b, Probe& probe) {
  // No vertex is transformed yet: that happens when one is first needed.
  context_.body[0].world.begin(a_, pose_a);
  context_.body[1].world.begin(b_, pose_b);
  if (policy_.rests()) {
    // Paused: the motion is not tracked either, so that a query costs no more than one without coherence.
    motion_.forget();
    query_from_scratch(probe);
    return;
  }
  if (!motion_.record(pose_a, pose_b)) {
    // Not nearly rigid, or a reflection: the bounds on the relative motion do not hold.
    query_from_scratch(probe);
    return;
  }
  const auto began = Clock::now();
  note_step(motion_.step());
  // No point of B is further than where.offset from its position in the sweep.
  const SweepPoint where = has_cache_ ? motion_.along(sweep_) : SweepPoint{};
  if (policy_.must_wait()) {
    // The last queries of a pause: the motion is tracked again, but no cache is made.
    query_from_scratch(probe);
    policy_.scratch_took(seconds_since(began));
  } else if (has_cache_ && where.offset <= sweep_.width) {
    // B is within the sweep, for which the cache is complete.
    ++statistics_.from_cache;
    answer_from_cache(where, probe);
    policy_.step_took(seconds_since(began));
  } else if (request_.mode != Mode::all_pairs && still_crosses(probe)) {
    // B has left the sweep, but the pair of the last answer still answers the query.
    has_cache_ = false;
  } else if (const auto plan = next_plan()) {
    // A failed attempt counts as time spent on the cache.
    if (!make_cache(*plan, probe)) query_from_scratch(probe);
    policy_.build_took(plan->kind, seconds_since(began));
  } else {
    query_from_scratch(probe);
    policy_.scratch_took(seconds_since(began));
  }
}

/// Queries from scratch into the existing result.
template <class Probe>
void CoherentQuery::Work::query_from_scratch(Probe& probe) {
  has_cache_ = false;
  ++statistics_.from_scratch;
  // The poses are set already; the wrappers begin with all regions included.
  for (QueryBody& body : context_.body) body.begin_at_pose(request_.wrapper);
  result_.mode = request_.mode;
  // Clear the vectors one by one: they keep their memory.
  result_.pairs.clear();
  result_.meets.clear();
  result_.contacts.clear();
  result_.regions.clear();
  TreeQuery<Probe>(context_, request_, result_, probe).run();
  finish(probe);
}

/// Runs the paper's recursion on the wrappers of the last query: they are refined where faces meet, and
/// coarsened where none did. Pairs of faces whose gap B has not yet crossed are not tested again.
template <class Probe>
void CoherentQuery::Work::query_kept_wrappers(const Pose& pose_a, const Pose& pose_b, Probe& probe) {
  context_.body[0].world.begin(a_, pose_a);
  context_.body[1].world.begin(b_, pose_b);
  for (QueryBody& body : context_.body)
    body.wrapper ? body.query_body() : body.begin_at_pose(request_.wrapper);
  clear(result_);
  result_.recursion = request_.recursion;
  report_kept(probe);
  gaps_->begin(pose_a, pose_b);
  context_.gaps = &*gaps_;
  PaperQuery<Probe>(context_, request_, result_, probe).run();
  context_.gaps = nullptr;
  ++(gaps_->saved() > 0 ? statistics_.from_cache : statistics_.from_scratch);
  statistics_.tests_saved += gaps_->saved();
  for (const Side side : {Side::a, Side::b}) {
    Wrapper& wrapper = *context_[side].wrapper;
    // Backwards: a region inside another one is closed first.
    const std::vector<RegionId> excluded = wrapper.excluded();
    for (auto i = excluded.rbegin(); i != excluded.rend(); ++i) {
      const RegionId r = *i;
      if (gaps_->is_reached(side, r)) continue;
      wrapper.coarsen(r);
      ++statistics_.coarsened;
      if constexpr (Probe::kEnabled)
        probe.coarsen(side, r, static_cast<std::uint32_t>(wrapper.rep().floor(r).size()));
    }
  }
  finish(probe);
}

/// The steps of collide() after the search: sorts the pairs, decides the relation, describes the contact.
template <class Probe>
void CoherentQuery::Work::finish(Probe& probe) {
  in_phase(probe, Phase::sort, [&] {
    context_.pair_order.sort(result_);
    return result_.pairs.size();
  });
  decide_relation_watched(context_, result_, probe, [] { return true; });
  describe(probe);
  show_opened();
}

/// Describes the contact if requested.
template <class Probe>
void CoherentQuery::Work::describe(Probe& probe) {
  if (!request_.contacts && !request_.interiors_overlap) return;
  in_phase(probe, Phase::contacts, [&] {
    describe_contact(context_, request_, result_);
    return result_.regions.size();
  });
}

void CoherentQuery::Work::show_opened() {
  for (int side = 0; side < 2; ++side) {
    result_.opened[side] = context_.body[side].wrapper->excluded();
    result_.counters.regions_opened += result_.opened[side].size();
  }
}

/// Returns the number of regions between a simplex and the outside.
std::uint32_t CoherentQuery::Work::depth(Side side, SimplexId s) const {
  const LrbRep& rep = side == Side::a ? a_ : b_;
  const CellId outer = rep.outer_cell(rep.face_of_simplex(s));
  return is_region(outer) ? rep.depth(outer.as_region()) : 0;
}

template <class Probe>
void CoherentQuery::Work::report_test(const SimplexPair& p, exact::Meet meet, TestedBy by, Probe& probe) {
  probe.face_test(p.a, p.b, meet, depth(Side::a, p.a), depth(Side::b, p.b));
  if (reports_details(probe)) probe.tested_by(by);
}

/// Reports the regions that are still refined from earlier queries.
template <class Probe>
void CoherentQuery::Work::report_kept(Probe& probe) {
  if constexpr (Probe::kEnabled)
    in_phase(probe, Phase::kept, [&] {
      std::uint64_t count = 0;
      for (const Side side : {Side::a, Side::b}) {
        const Wrapper& wrapper = *context_[side].wrapper;
        count += wrapper.excluded().size();
        for (const RegionId r : wrapper.excluded())
          probe.refine(side, r, static_cast<std::uint32_t>(wrapper.rep().floor(r).size()));
      }
      return count;
    });
}

/// Reports that all regions will be included again.
template <class Probe>
void CoherentQuery::Work::report_reset(Probe& probe) {
  if constexpr (Probe::kEnabled)
    for (const Side side : {Side::b, Side::a}) {
      const Wrapper& wrapper = *context_[side].wrapper;
      const auto& open = wrapper.excluded();
      for (auto r = open.rbegin(); r != open.rend(); ++r)
        probe.coarsen(side, *r, static_cast<std::uint32_t>(wrapper.rep().floor(*r).size()));
    }
}

/// Returns true if the last pair still crosses: if one pair is enough, any crossing pair will do.
template <class Probe>
bool CoherentQuery::Work::still_crosses(Probe& probe) {
  // A pair that only touches is not reused: in first_pair mode another one may cross.
  if (result_.pairs.size() != 1 || result_.meets[0] != exact::Meet::cross) return false;
  ++result_.counters.face_tests;
  const SimplexPair p = result_.pairs[0];
  const std::uint64_t fallbacks = exact::exact_fallbacks();
  const exact::Meet meet = test_simplices(context_, p.a, p.b);
  const TestedBy by = exact::exact_fallbacks() == fallbacks ? TestedBy::filter : TestedBy::expansions;
  // The wrappers are unchanged, because they show this pair already.
  report_kept(probe);
  if constexpr (Probe::kEnabled) report_test(p, meet, by, probe);
  if (meet != exact::Meet::cross) {
    // The next attempt begins with all regions included: report the refined ones as coarsened.
    report_reset(probe);
    return false;
  }
  if constexpr (Probe::kEnabled) probe.contact(p.a, p.b, meet);
  ++statistics_.from_cache;
  return true;
}

void CoherentQuery::Work::note_step(double step) {
  // An infinite step means that no earlier pose is known.
  const bool jump = !std::isfinite(step) || (usual_step_ > 0 && step > kJump * usual_step_);
  // Two jumps in a row are a new usual step.
  if (!jump || (jumped_ && std::isfinite(step))) usual_step_ = std::max(step, kForgetStep * usual_step_);
  // The cache ended early because of the jump, not because of its length.
  if (jump) policy_.forgive();
  jumped_ = jump;
}

std::optional<CachePolicy::Plan> CoherentQuery::Work::next_plan() {
  // The next step cannot be predicted without a usual step, right after a jump, or from fewer than three
  // poses.
  if (!(usual_step_ > 0) || jumped_ || !motion_.is_seen()) return {};
  if (use_ == CacheUse::as_it_pays) return policy_.next(motion_.is_kept(), usual_step_, motion_.radius());
  return CachePolicy::Plan{motion_.is_kept() ? CachePolicy::Kind::swept : CachePolicy::Kind::fixed,
                           CachePolicy::kFirstSteps};
}

/// Makes a cache and answers from it. Returns false, without a cache, if that takes too long or lengths
/// overflow.
template <class Probe>
bool CoherentQuery::Work::make_cache(const CachePolicy::Plan& plan, Probe& probe) {
  const bool is_swept = plan.kind == CachePolicy::Kind::swept;
  sweep_ = is_swept ? motion_.ahead(plan.steps) : motion_.about(plan.steps * usual_step_);
  // The current pose must lie in its own sweep. It does not where lengths overflow.
  const SweepPoint where = motion_.along(sweep_);
  if (!(where.offset <= sweep_.width)) return false;
  const double rounding = 4 * motion_.rounding();
  for (QueryBody& body : context_.body) body.begin_at_pose(request_.wrapper);
  // Traverse on A's axes: A at the identity, B at the middle of the sweep.
  TreeKernel k = start_rigid_kernel(context_, Pose{}, {sweep_.mid_pose.m, sweep_.mid_pose.t}, kAtATime);
  aim_at(sweep_, rounding, query_unit(a_.tree(), b_.tree()), k);
  // Reject NaN as well, which infinite widths without a defect yield: the kernel would ignore such a margin.
  if (!(k.margin < std::numeric_limits<float>::infinity())) return false;
  bool complete = false;
  // Find all pairs within reach of the sweep, then drop those that cannot intersect anywhere in it.
  in_phase(probe, Phase::cache, [&] {
    complete = find_candidates(k, probe);
    if (complete) cache_.arrange(a_, b_, k, sweep_, rounding, context_.pair_order);
    return complete ? cache_.pairs().size() : 0;
  });
  // The traversal counts even if it was given up.
  result_.counters.node_pairs = k.node_pairs;
  result_.counters.box_tests = k.box_tests;
  result_.counters.prefilter_tests = k.prefilter_tests;
  if (!complete) return false;
  has_cache_ = true;
  has_answer_ = false;
  ++statistics_.caches_made;
  statistics_.swept_caches += is_swept;
  // Refine the wrappers once for all cached pairs: queries answered from the cache refine nothing.
  for (const SimplexPair& p : cache_.pairs()) {
    show_face(context_, Side::a, a_.face_of_simplex(p.a), result_, probe);
    show_face(context_, Side::b, b_.face_of_simplex(p.b), result_, probe);
  }
  show_opened();
  answer_from_cache(where, probe);
  return true;
}

/// Traverses the trees for the pairs to cache. Returns false if that takes too long or finds too many pairs.
template <class Probe>
bool CoherentQuery::Work::find_candidates(TreeKernel& k, Probe& probe) {
  const auto began = Clock::now();
  cache_.clear();
  while (!is_done(k)) {
    k.out_size = 0;
    // The kernel returns when its buffer is nearly full; limits are checked in between.
    reports_details(probe) ? NodeWatch<Probe>(context_, probe).run(k) : run_tree_kernel(k);
    for (std::uint32_t i = 0; i < k.out_size; ++i) cache_.add({k.out[i].a, k.out[i].b});
    if (cache_.pairs().size() > request_.pair_limit())
      return false;  // the query itself counts only pairs that intersect
    // A cache that takes this long is unlikely to pay (kTimeoutFactor).
    if (use_ == CacheUse::as_it_pays && seconds_since(began) > policy_.time_limit()) return false;
  }
  return true;
}

/// Tests the chosen pairs of the cache. Returns true if the result changed since the last update.
template <class Probe>
bool CoherentQuery::Work::test_cached(const TreeKernel& k, Probe& probe) {
  std::uint64_t fallbacks = exact::exact_fallbacks();
  const auto exactly = [&](const SimplexPair& p) { return test_simplices(context_, p.a, p.b); };
  // Without an observer, certainly disjoint pairs are skipped eight at a time.
  if constexpr (!Probe::kEnabled) return cache_.update(k, exactly);
  // Report as contacts only pairs that can be the answer, as collect_answer() chooses it.
  bool found = false, crossing = false;
  return cache_.update(k, exactly, [&](const SimplexPair& p, exact::Meet meet, bool is_certain) {
    const bool exact_needed = std::exchange(fallbacks, exact::exact_fallbacks()) != exact::exact_fallbacks();
    report_test(p, meet,
                is_certain     ? TestedBy::floats
                : exact_needed ? TestedBy::expansions
                               : TestedBy::filter,
                probe);
    if (meet == exact::Meet::disjoint) return;
    const bool is_better = request_.mode == Mode::first_pair && meet == exact::Meet::cross && !crossing;
    if (request_.mode == Mode::all_pairs || !found || is_better) probe.contact(p.a, p.b, meet);
    found = true;
    crossing = crossing || meet == exact::Meet::cross;
  });
}

/// Answers from the cache. B must be within the range for which it is complete.
template <class Probe>
void CoherentQuery::Work::answer_from_cache(const SweepPoint& where, Probe& probe) {
  if (has_answer_) report_kept(probe);  // otherwise the cache is new, and its regions were just reported
  // Float tests use the current pose, not the pose of the sweep.
  const TreeKernel k = set_up_kernel(a_, context_.body[0].world.pose(), b_, context_.body[1].world.pose());
  const bool has_answer = std::exchange(has_answer_, true);
  const SweepPoint before = std::exchange(where_, where);
  // Only pairs that may intersect at this position in the sweep are tested.
  const std::size_t tested = cache_.choose(where);
  bool changed = false;
  in_phase(probe, Phase::cached, [&] {
    changed = test_cached(k, probe);
    return cache_.pairs().size() - tested;
  });
  result_.counters.face_tests += tested;
  statistics_.tests_saved += cache_.pairs().size() - tested;
  // Otherwise result_ has the same pairs already.
  if (changed || !has_answer) collect_answer();
  // The relation of solids is unchanged if no surfaces intersected in between. For open surfaces world boxes
  // decide, which change with each pose.
  const bool solids = a_.closed() && b_.closed();
  if (!has_answer || tested > 0 || !cache_.none_between(before, where) || !solids)
    decide_relation_watched(context_, result_, probe, [] { return true; });
  result_.contacts.clear();
  result_.regions.clear();
  describe(probe);
}

void CoherentQuery::Work::collect_answer() {
  result_.mode = request_.mode;
  result_.pairs.clear();
  result_.meets.clear();
  // Ascending, because the cache is sorted.
  cache_.append_meeting(result_);
  if (request_.mode == Mode::all_pairs || result_.pairs.empty()) return;
  // One pair is the answer: in first_pair mode a crossing one, if any.
  const auto crossing = request_.mode == Mode::any_pair
                            ? result_.meets.begin()
                            : std::find(result_.meets.begin(), result_.meets.end(), exact::Meet::cross);
  const std::size_t i =
      crossing == result_.meets.end() ? 0 : static_cast<std::size_t>(crossing - result_.meets.begin());
  result_.pairs = {result_.pairs[i]};
  result_.meets = {result_.meets[i]};
}

CoherentQuery::CoherentQuery(const LrbRep& a, const LrbRep& b, const CollideRequest& request, CacheUse use)
    : work_(std::make_unique<Work>(a, b, request, use)) {}
CoherentQuery::~CoherentQuery() = default;
CoherentQuery::CoherentQuery(CoherentQuery&&) noexcept = default;
CoherentQuery& CoherentQuery::operator=(CoherentQuery&&) noexcept = default;

const CollideResult& CoherentQuery::collide(const Pose& pose_a, const Pose& pose_b) {
  NullProbe probe;
  return work_->collide(pose_a, pose_b, probe);
}

const CollideResult& CoherentQuery::collide(const Pose& pose_a, const Pose& pose_b, CollideProbe& probe) {
  ProbeAdapter adapter(probe);
  return work_->collide(pose_a, pose_b, adapter);
}

const CoherentQuery::Statistics& CoherentQuery::statistics() const {
  return work_->statistics();
}

}  // namespace lrb
