#include "engine/query/coherent_query.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/query/collide_impl.hpp"
#include "engine/tolerances.hpp"

namespace lrb {
namespace {

/// A list this many times as long as what the last query from scratch tested is given up.
constexpr std::size_t kMostListed = 16, kAlwaysListed = 64;
constexpr double kFewestSteps = 1.5, kMostSteps = 64, kStepsFactor = 1.5;
/// Where a longer list failed, the next ones stay shorter, by less and less.
constexpr double kCeilingFactor = 1.02;
/// A list for a way longer than this share of B's radius would hold much of both bodies: it is not tried.
constexpr double kLongestWay = 1.0 / 16;
/// A gap on B's axes is longer than it is on A's by twice the defect at most, and little.
constexpr double kListDefects = 3;
/// So many queries before the end of a pause B's course is watched again.
constexpr std::uint32_t kToSeeACourse = 3;
constexpr std::uint32_t kLongestPause = 64, kPauseFactor = 4, kFirstPause = 4;
/// Steps shorter than this share of one for which a list did not pay are worth another try at once; others
/// only after so many pauses.
constexpr double kShorter = 0.7;
constexpr std::uint32_t kPausesBetween = 4;
/// The usual step is the longest of late: it shrinks by this from one query to the next. A step so many times
/// as long is a jump, which says nothing about the steps to come, unless another one follows.
constexpr double kForget = 0.7, kJump = 8;

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point began) {
  return std::chrono::duration<double>(Clock::now() - began).count();
}

/// Keeps the memory.
void reset_counters(Counters& c) {
  std::vector<std::uint32_t> levels = std::move(c.face_tests_by_level);
  levels.clear();
  c = {};
  c.face_tests_by_level = std::move(levels);
}

}  // namespace

CoherentQuery::CoherentQuery(const LrbRep& a, const LrbRep& b, const CollideRequest& request, Lists lists)
    : a_(a),
      b_(b),
      request_(request),
      lists_(lists),
      plain_(request.recursion == Recursion::complete && request.predicates == Predicates::exact &&
             !request.is_coarse() && !request.separation && !a.tree().empty() && !b.tree().empty()) {
  if (plain_) course_ = {a, b};
}

const CollideResult& CoherentQuery::collide(const Pose& pose_a, const Pose& pose_b) {
  if (!plain_) {
    NullProbe probe;
    result_ = lrb::collide(a_, pose_a, b_, pose_b, request_, context_, probe);
    ++statistics_.from_scratch;
    return result_;
  }
  check_query(a_, pose_a, b_, pose_b);
  if (std::exchange(at_work_, true)) {  // the last call ended by an exception, and left who knows what
    has_list_ = false;
    course_.forget();
    result_.pairs.clear();
  }
  const std::uint64_t fallbacks = exact::exact_fallbacks();
  reset_counters(result_.counters);
  answer(pose_a, pose_b);
  result_.counters.exact_fallbacks = exact::exact_fallbacks() - fallbacks;
  at_work_ = false;
  return result_;
}

void CoherentQuery::answer(const Pose& pose_a, const Pose& pose_b) {
  context_.body[0].world.begin(a_, pose_a);
  context_.body[1].world.begin(b_, pose_b);
  if (pause_ > 0) --pause_;
  if (pause_ >= kToSeeACourse) {
    course_.forget();
    query_from_scratch();
    return;
  }
  if (!course_.see(pose_a, pose_b)) {
    query_from_scratch();
    return;
  }
  const auto began = Clock::now();
  note_step(course_.step());
  const double moved = has_list_ ? course_.moved_since(list_at_) : 0;
  if (pause_ > 0) {
    time_scratch();
  } else if (has_list_ && moved <= valid_to_) {
    ++statistics_.from_list;
    ++steps_;
    answer_from_list(set_up_kernel(a_, pose_a, b_, pose_b), moved);
    step_time_ += seconds_since(began);
  } else if (request_.mode != Mode::all_pairs && still_crosses()) {
    has_list_ = false;
  } else if (list_pays() && make_list()) {
    list_time_ = seconds_since(began);
  } else {
    time_scratch();
    if (gave_up_) list_time_ = seconds_since(began);
  }
}

void CoherentQuery::time_scratch() {
  const auto began = Clock::now();
  query_from_scratch();
  scratch_time_ = seconds_since(began);
}

/// As collide() does it, but into the result that there is.
void CoherentQuery::query_from_scratch() {
  has_list_ = false;
  ++statistics_.from_scratch;
  for (QueryBody& body : context_.body) body.begin(body.rep(), body.world.pose(), request_.wrapper);
  result_.mode = request_.mode;
  reset_counters(result_.counters);
  result_.pairs.clear();
  result_.meets.clear();
  result_.contacts.clear();
  result_.regions.clear();
  NullProbe probe;
  TreeQuery<NullProbe>(context_, request_.mode, result_, probe).run();
  context_.pair_order.sort(result_);
  decide_relation(context_, result_);
  describe_contact(context_, request_, result_);
  show_opened();
  scratch_tests_ = result_.counters.face_tests;
}

void CoherentQuery::show_opened() {
  for (int side = 0; side < 2; ++side) {
    result_.opened[side] = context_.body[side].wrapper->excluded();
    result_.counters.regions_opened += result_.opened[side].size();
  }
}

/// Where one pair is enough: that found last time, if it crosses, is as good as any.
bool CoherentQuery::still_crosses() {
  if (result_.pairs.size() != 1 || result_.meets[0] != exact::Meet::cross) return false;
  ++result_.counters.face_tests;
  if (test_simplices(context_, result_.pairs[0].a, result_.pairs[0].b) != exact::Meet::cross) return false;
  ++statistics_.from_list;
  return true;
}

void CoherentQuery::note_step(double step) {
  const bool jump = !std::isfinite(step) || (usual_step_ > 0 && step > kJump * usual_step_);
  if (!jump || (jumped_ && std::isfinite(step))) usual_step_ = std::max(step, kForget * usual_step_);
  if (jump) list_time_ = 0;  // the list could not help it
  jumped_ = jump;
}

/// Whether a new list should be made now, from how the last one did.
bool CoherentQuery::list_pays() {
  gave_up_ = false;
  if (!(usual_step_ > 0) || jumped_) return false;
  if (lists_ == Lists::always) return true;
  if (steps_a_list_ * usual_step_ > kLongestWay * course_.radius()) {
    pause_ = kLongestPause / kPauseFactor;
    return false;
  }
  if (scratch_time_ == 0) return false;
  if (list_time_ > 0) {
    const bool paid = has_list_ && (list_time_ + step_time_) / (1 + steps_) < scratch_time_;
    const bool again = paid || last_paid_;  // one failure after a success: the list was too long, not useless
    if (paid) {
      ceiling_ = std::min(kCeilingFactor * ceiling_, kMostSteps);
      steps_a_list_ = list_time_ > step_time_ ? steps_a_list_ * kStepsFactor : steps_a_list_ / kStepsFactor;
      next_pause_ = kFirstPause;
    } else {
      steps_a_list_ /= kStepsFactor * kStepsFactor;
      if (last_paid_) ceiling_ = steps_a_list_ * kStepsFactor;
    }
    steps_a_list_ = std::clamp(steps_a_list_, kFewestSteps, std::max(ceiling_, kFewestSteps));
    list_time_ = 0;
    last_paid_ = paid;
    if (again) return true;
    pause_ = next_pause_;
    next_pause_ = std::min(kPauseFactor * next_pause_, kLongestPause);
    too_long_ = usual_step_;
    pauses_ = 0;
    return false;
  }
  if (too_long_ > 0 && usual_step_ >= kShorter * too_long_ && ++pauses_ < kPausesBetween) {
    pause_ = next_pause_;
    return false;
  }
  return true;
}

/// False if it grew too long: there is no list then.
bool CoherentQuery::make_list() {
  list_at_ = course_.ahead(static_cast<int>(steps_a_list_ / 2));
  const double moved = course_.moved_since(list_at_), rounding = 4 * course_.rounding();
  const bool ahead = moved > usual_step_ / 2;
  const double way = std::max(steps_a_list_ / (ahead ? 2 : 1) * usual_step_, moved);
  const double margin = (way + rounding) * (1 + 2 * kListDefects * list_at_.defect);
  for (QueryBody& body : context_.body) body.begin(body.rep(), body.world.pose(), request_.wrapper);
  TreeKernel k = start_kernel(context_, Pose{}, {list_at_.m, list_at_.t}, 1024);
  k.margin = static_cast<float>(margin / std::max(a_.tree().unit(), b_.tree().unit())) * kFloatUp;
  near_.clear();
  step_time_ = 0;
  steps_ = 0;
  while (k.stack_size != 0) {
    k.out_size = 0;
    run_tree_kernel(k);
    for (std::uint32_t i = 0; i < k.out_size; ++i) near_.add({k.out[i].a, k.out[i].b});
    if (lists_ == Lists::as_it_pays &&
        near_.pairs().size() > kMostListed * (scratch_tests_ + kAlwaysListed)) {
      gave_up_ = true;
      return false;
    }
  }
  near_.arrange(a_, b_, k, margin, rounding, context_.pair_order);
  has_list_ = true;
  valid_to_ = margin * (1 - kListDefects * list_at_.defect) - rounding;
  has_answer_ = false;
  ++statistics_.lists_made;
  NullProbe probe;
  for (const SimplexPair& p : near_.pairs()) {
    show_face(context_, Side::a, a_.face_of_simplex(p.a), result_, probe);
    show_face(context_, Side::b, b_.face_of_simplex(p.b), result_, probe);
  }
  show_opened();
  result_.counters.node_pairs = k.node_pairs;
  result_.counters.box_tests = k.box_tests;
  result_.counters.prefilter_tests = k.prefilter_tests;
  answer_from_list(set_up_kernel(a_, context_.body[0].world.pose(), b_, context_.body[1].world.pose()),
                   moved);
  return true;
}

/// At the pose of k, at which no point of B is further than `moved` from where it was when the list was made.
void CoherentQuery::answer_from_list(const TreeKernel& k, double moved) {
  const bool has_answer = std::exchange(has_answer_, true);
  const std::size_t before = std::exchange(tested_, near_.choose(moved));
  const bool changed =
      near_.update(k, [&](const SimplexPair& p) { return test_simplices(context_, p.a, p.b); });
  result_.counters.face_tests += tested_;
  statistics_.tests_saved += near_.pairs().size() - tested_;
  if (changed || !has_answer) list_answer();
  // Where no pair came near enough to be tested, now or before, no surfaces can have met in between.
  if (!has_answer || tested_ > 0 || before > 0) decide_relation(context_, result_);
  result_.contacts.clear();
  result_.regions.clear();
  describe_contact(context_, request_, result_);
}

void CoherentQuery::list_answer() {
  result_.mode = request_.mode;
  result_.pairs.clear();
  result_.meets.clear();
  near_.list_meeting(result_);
  if (request_.mode == Mode::all_pairs || result_.pairs.empty()) return;
  const auto crossing = request_.mode == Mode::any_pair
                            ? result_.meets.begin()
                            : std::find(result_.meets.begin(), result_.meets.end(), exact::Meet::cross);
  const std::size_t i =
      crossing == result_.meets.end() ? 0 : static_cast<std::size_t>(crossing - result_.meets.begin());
  result_.pairs = {result_.pairs[i]};
  result_.meets = {result_.meets[i]};
}

}  // namespace lrb
