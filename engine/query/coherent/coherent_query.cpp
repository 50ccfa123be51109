#include "engine/query/coherent/coherent_query.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "engine/core/tolerances.hpp"
#include "engine/query/coherent/cache_policy.hpp"
#include "engine/query/coherent/candidate_cache.hpp"
#include "engine/query/coherent/relative_motion.hpp"
#include "engine/query/collide_impl.hpp"

namespace lrb {
namespace {

/// Number of pairs to find before looking at the clock.
constexpr std::size_t kAtATime = 256;
/// The usual step is the longest of recent steps: from one query to the next it shrinks by the factor
/// kForget. A step more than kJump times as long is a jump, which says nothing about the steps to come,
/// unless another one follows.
constexpr double kForget = 0.7, kJump = 8;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

/// Resets the counters but keeps their memory.
void reset_counters(Counters& c) {
  std::vector<std::uint32_t> levels = std::move(c.face_tests_by_level);
  levels.clear();
  c = {};
  c.face_tests_by_level = std::move(levels);
}

}  // namespace

/// The implementation of CoherentQuery.
class CoherentQuery::Work {
 public:
  Work(const LrbRep& a, const LrbRep& b, const CollideRequest& request, CacheUse use);
  const CollideResult& collide(const Pose& pose_a, const Pose& pose_b);
  const Statistics& statistics() const { return statistics_; }

 private:
  void answer(const Pose& pose_a, const Pose& pose_b);
  void query_from_scratch();
  bool still_crosses();
  bool make_cache(const CachePolicy::Plan& plan);
  void answer_from_cache(const SweepPoint& where);
  void collect_answer();
  void show_opened();
  void note_step(double step);
  std::optional<CachePolicy::Plan> next_plan();

  const LrbRep &a_, &b_;
  CollideRequest request_;
  CacheUse use_;
  QueryContext context_;
  CollideResult result_;
  Statistics statistics_;
  bool plain_;  ///< the request is one that a cache can answer
  RelativeMotion motion_;

  bool at_work_ = false;   ///< a call has begun and not ended
  double usual_step_ = 0;  ///< the longest recent step, apart from jumps
  bool jumped_ = false;

  bool has_cache_ = false;
  Sweep sweep_;  ///< where the cache is complete
  CandidateCache cache_;
  SweepPoint where_;         ///< position in the sweep at the last query answered from the cache
  bool has_answer_ = false;  ///< result_ holds the answer of the last query from this cache

  CachePolicy policy_;
};

CoherentQuery::Work::Work(const LrbRep& a, const LrbRep& b, const CollideRequest& request, CacheUse use)
    : a_(a),
      b_(b),
      request_(request),
      use_(use),
      plain_(request.recursion == Recursion::complete && request.predicates == Predicates::exact &&
             !request.is_coarse() && !request.separation && !a.tree().empty() && !b.tree().empty()) {
  if (plain_) motion_ = {a, b};
}

const CollideResult& CoherentQuery::Work::collide(const Pose& pose_a, const Pose& pose_b) {
  if (!plain_) {
    NullProbe probe;
    result_ = lrb::collide(a_, pose_a, b_, pose_b, request_, context_, probe);
    ++statistics_.from_scratch;
    return result_;
  }
  check_query(a_, pose_a, b_, pose_b);
  if (std::exchange(at_work_, true)) {  // the last call ended with an exception, in an unknown state
    has_cache_ = false;
    motion_.forget();
    result_.pairs.clear();
  }
  const std::uint64_t fallbacks = exact::exact_fallbacks();
  reset_counters(result_.counters);
  answer(pose_a, pose_b);
  result_.counters.exact_fallbacks = exact::exact_fallbacks() - fallbacks;
  at_work_ = false;
  return result_;
}

void CoherentQuery::Work::answer(const Pose& pose_a, const Pose& pose_b) {
  context_.body[0].world.begin(a_, pose_a);
  context_.body[1].world.begin(b_, pose_b);
  if (policy_.rests()) {
    motion_.forget();
    query_from_scratch();
    return;
  }
  if (!motion_.see(pose_a, pose_b)) {
    query_from_scratch();
    return;
  }
  const auto began = Clock::now();
  note_step(motion_.step());
  const SweepPoint where = has_cache_ ? motion_.along(sweep_) : SweepPoint{};
  if (policy_.must_wait()) {
    query_from_scratch();
    policy_.scratch_took(seconds_since(began));
  } else if (has_cache_ && where.off <= sweep_.width) {
    ++statistics_.from_cache;
    answer_from_cache(where);
    policy_.step_took(seconds_since(began));
  } else if (request_.mode != Mode::all_pairs && still_crosses()) {
    has_cache_ = false;
  } else if (const auto plan = next_plan()) {
    if (!make_cache(*plan)) query_from_scratch();
    policy_.build_took(plan->kind, seconds_since(began));
  } else {
    query_from_scratch();
    policy_.scratch_took(seconds_since(began));
  }
}

/// Does what collide() does, but into the existing result.
void CoherentQuery::Work::query_from_scratch() {
  has_cache_ = false;
  ++statistics_.from_scratch;
  for (QueryBody& body : context_.body) body.begin_at_pose(request_.wrapper);
  result_.mode = request_.mode;
  result_.pairs.clear();
  result_.meets.clear();
  result_.contacts.clear();
  result_.regions.clear();
  NullProbe probe;
  TreeQuery<NullProbe>(context_, request_, result_, probe).run();
  context_.pair_order.sort(result_);
  decide_relation(context_, result_);
  describe_contact(context_, request_, result_);
  show_opened();
}

void CoherentQuery::Work::show_opened() {
  for (int side = 0; side < 2; ++side) {
    result_.opened[side] = context_.body[side].wrapper->excluded();
    result_.counters.regions_opened += result_.opened[side].size();
  }
}

/// Returns true if the pair found last time still crosses: where one pair is enough, it is as good as any.
bool CoherentQuery::Work::still_crosses() {
  if (result_.pairs.size() != 1 || result_.meets[0] != exact::Meet::cross) return false;
  ++result_.counters.face_tests;
  if (test_simplices(context_, result_.pairs[0].a, result_.pairs[0].b) != exact::Meet::cross) return false;
  ++statistics_.from_cache;
  return true;
}

void CoherentQuery::Work::note_step(double step) {
  const bool jump = !std::isfinite(step) || (usual_step_ > 0 && step > kJump * usual_step_);
  if (!jump || (jumped_ && std::isfinite(step))) usual_step_ = std::max(step, kForget * usual_step_);
  if (jump) policy_.forgive();
  jumped_ = jump;
}

std::optional<CachePolicy::Plan> CoherentQuery::Work::next_plan() {
  if (!(usual_step_ > 0) || jumped_ || !motion_.is_seen()) return {};
  if (use_ == CacheUse::as_it_pays) return policy_.next(motion_.is_kept(), usual_step_, motion_.radius());
  return CachePolicy::Plan{motion_.is_kept() ? CachePolicy::Kind::swept : CachePolicy::Kind::fixed,
                           CachePolicy::kFirstSteps};
}

/// Makes a cache and answers from it. Returns false, without a cache, if that takes too long or lengths
/// overflow.
bool CoherentQuery::Work::make_cache(const CachePolicy::Plan& plan) {
  const auto began = Clock::now();
  const bool is_swept = plan.kind == CachePolicy::Kind::swept;
  sweep_ = is_swept ? motion_.ahead(plan.steps) : motion_.about(plan.steps * usual_step_);
  const SweepPoint where = motion_.along(sweep_);
  if (!(where.off <= sweep_.width)) return false;
  const double rounding = 4 * motion_.rounding();
  for (QueryBody& body : context_.body) body.begin_at_pose(request_.wrapper);
  TreeKernel k = start_rigid_kernel(context_, Pose{}, {sweep_.middle.m, sweep_.middle.t}, kAtATime);
  aim_at(sweep_, rounding, query_unit(a_.tree(), b_.tree()), k);
  // A margin that is not a number, as infinite widths and no defect make it, would count as none.
  if (!(k.margin < std::numeric_limits<float>::infinity())) return false;
  cache_.clear();
  while (k.stack_size != 0) {
    k.out_size = 0;
    run_tree_kernel(k);
    for (std::uint32_t i = 0; i < k.out_size; ++i) cache_.add({k.out[i].a, k.out[i].b});
    if (cache_.pairs().size() > request_.pair_limit())
      return false;  // the query itself counts those that meet
    if (use_ == CacheUse::as_it_pays && seconds_since(began) > policy_.patience()) return false;
  }
  cache_.arrange(a_, b_, k, sweep_, rounding, context_.pair_order);
  has_cache_ = true;
  has_answer_ = false;
  ++statistics_.caches_made;
  statistics_.swept_caches += is_swept;
  NullProbe probe;
  for (const SimplexPair& p : cache_.pairs()) {
    show_face(context_, Side::a, a_.face_of_simplex(p.a), result_, probe);
    show_face(context_, Side::b, b_.face_of_simplex(p.b), result_, probe);
  }
  show_opened();
  result_.counters.node_pairs = k.node_pairs;
  result_.counters.box_tests = k.box_tests;
  result_.counters.prefilter_tests = k.prefilter_tests;
  answer_from_cache(where);
  return true;
}

/// Answers from the cache; B must be where it is complete.
void CoherentQuery::Work::answer_from_cache(const SweepPoint& where) {
  const TreeKernel k = set_up_kernel(a_, context_.body[0].world.pose(), b_, context_.body[1].world.pose());
  const bool has_answer = std::exchange(has_answer_, true);
  const SweepPoint before = std::exchange(where_, where);
  const std::size_t tested = cache_.choose(where);
  const bool changed =
      cache_.update(k, [&](const SimplexPair& p) { return test_simplices(context_, p.a, p.b); });
  result_.counters.face_tests += tested;
  statistics_.tests_saved += cache_.pairs().size() - tested;
  if (changed || !has_answer) collect_answer();
  if (!has_answer || tested > 0 || !cache_.none_between(before, where)) decide_relation(context_, result_);
  result_.contacts.clear();
  result_.regions.clear();
  describe_contact(context_, request_, result_);
}

void CoherentQuery::Work::collect_answer() {
  result_.mode = request_.mode;
  result_.pairs.clear();
  result_.meets.clear();
  cache_.append_meeting(result_);
  if (request_.mode == Mode::all_pairs || result_.pairs.empty()) return;
  const auto crossing = request_.mode == Mode::any_pair
                            ? result_.meets.begin()
                            : std::find(result_.meets.begin(), result_.meets.end(), exact::Meet::cross);
  const std::size_t i =
      crossing == result_.meets.end() ? 0 : static_cast<std::size_t>(crossing - result_.meets.begin());
  result_.pairs = {result_.pairs[i]};
  result_.meets = {result_.meets[i]};
}

CoherentQuery::CoherentQuery(const LrbRep& a, const LrbRep& b, const CollideRequest& request, CacheUse lists)
    : work_(std::make_unique<Work>(a, b, request, lists)) {}
CoherentQuery::~CoherentQuery() = default;
CoherentQuery::CoherentQuery(CoherentQuery&&) noexcept = default;
CoherentQuery& CoherentQuery::operator=(CoherentQuery&&) noexcept = default;

const CollideResult& CoherentQuery::collide(const Pose& pose_a, const Pose& pose_b) {
  return work_->collide(pose_a, pose_b);
}

const CoherentQuery::Statistics& CoherentQuery::statistics() const {
  return work_->statistics();
}

}  // namespace lrb
