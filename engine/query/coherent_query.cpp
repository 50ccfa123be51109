#include "engine/query/coherent_query.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "engine/query/apart.hpp"
#include "engine/query/collide_impl.hpp"
#include "engine/query/pose_bounds.hpp"
#include "engine/tolerances.hpp"

namespace lrb {
namespace {

/// A list this many times as long as what the last query from scratch tested is given up.
constexpr std::size_t kMostListed = 6, kAlwaysListed = 64;
constexpr double kFewestSteps = 1.5, kMostSteps = 64, kStepsFactor = 1.5;
/// Where a longer list failed, the next ones stay shorter, by less and less.
constexpr double kCeilingFactor = 1.02;
constexpr std::uint32_t kLongestPause = 64, kPauseFactor = 4, kFirstPause = 4;
/// Steps shorter than this share of one for which a list did not pay are worth another try at once; others
/// only after so many pauses.
constexpr double kShorter = 0.7;
constexpr std::uint32_t kPausesBetween = 4;
/// The usual step is the longest of late: it shrinks by this from one query to the next. A step so many times
/// as long is a jump, which says nothing about the steps to come, unless another one follows.
constexpr double kForget = 0.7, kJump = 8;
constexpr std::uint32_t kProofsOffFor = 8;

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
  if (!plain_) return;
  const TreeNode& root = b.tree().nodes()[0];
  middle_ = Eigen::Vector3d(root.origin[0], root.origin[1], root.origin[2]) * b.tree().unit();
  radius_ = static_cast<double>(root.radius) * b.tree().unit();
}

const CollideResult& CoherentQuery::collide(const Pose& pose_a, const Pose& pose_b) {
  if (!plain_) {
    NullProbe probe;
    result_ = lrb::collide(a_, pose_a, b_, pose_b, request_, context_, probe);
    ++statistics_.from_scratch;
    return result_;
  }
  check_query(a_, pose_a, b_, pose_b);
  context_.body[0].world.begin(a_, pose_a);
  context_.body[1].world.begin(b_, pose_b);
  reset_counters(result_.counters);
  const auto began = Clock::now();
  const bool paused = pause_ > 0;
  if (paused) --pause_;
  if (paused || !is_rigid(pose_a, pose_b)) {
    has_list_ = has_last_ = false;
    query_from_scratch();
    if (paused && pause_ == 0) scratch_time_ = seconds_since(began);
    return result_;
  }
  rounding_ = wrapper_margin(pose_a, a_.tree(), pose_b, b_.tree());
  const Relative now{pose_a.r.transpose() * pose_b.r, pose_a.r.transpose() * (pose_b.t - pose_a.t)};
  const double step = has_last_ ? length_of_step(now) : std::numeric_limits<double>::infinity();
  last_ = now;
  has_last_ = true;
  note_step(step);
  path_ += step;
  if (has_list_ && path_ <= valid_to_) {
    query_list(step);
    step_time_ += seconds_since(began);
  } else if (request_.mode != Mode::all_pairs && still_crosses()) {
    has_list_ = false;
  } else if (list_pays() && make_list()) {
    list_time_ = seconds_since(began);
  } else {
    const auto scratch_began = Clock::now();
    query_from_scratch();
    scratch_time_ = seconds_since(scratch_began);
    if (gave_up_) list_time_ = seconds_since(began);
  }
  return result_;
}

bool CoherentQuery::is_rigid(const Pose& pose_a, const Pose& pose_b) const {
  return rotation_defect(pose_a.r) <= kRigid && rotation_defect(pose_b.r) <= kRigid &&
         pose_a.r.determinant() > 0 && pose_b.r.determinant() > 0;
}

/// An upper bound of how far any point of B has moved on A's axes.
double CoherentQuery::length_of_step(const Relative& now) const {
  const Eigen::Matrix3d dm = now.m - last_.m;
  const double turn = std::sqrt(dm.squaredNorm() / 2), shift = (dm * middle_ + (now.t - last_.t)).norm();
  return (shift + turn * radius_) * (1 + kWorldRounding) + rounding_;
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
  const std::uint64_t fallbacks = exact::exact_fallbacks();
  NullProbe probe;
  TreeQuery<NullProbe>(context_, request_.mode, result_, probe).run();
  context_.pair_order.sort(result_);
  decide_relation(context_, result_);
  describe_contact(context_, request_, result_);
  show_opened();
  result_.counters.exact_fallbacks = exact::exact_fallbacks() - fallbacks;
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
  const double margin = steps_a_list_ * usual_step_ + 4 * rounding_;
  for (QueryBody& body : context_.body) body.begin(body.rep(), body.world.pose(), request_.wrapper);
  TreeKernel k = start_kernel(context_, 1024);
  k.margin = static_cast<float>(margin / std::max(a_.tree().unit(), b_.tree().unit())) * (1 + 0x1p-20f);
  list_.clear();
  step_time_ = 0;
  steps_ = 0;
  while (k.stack_size != 0) {
    k.out_size = 0;
    run_tree_kernel(k);
    for (std::uint32_t i = 0; i < k.out_size; ++i) list_.push_back({k.out[i].a, k.out[i].b});
    if (lists_ == Lists::as_it_pays && list_.size() > kMostListed * (scratch_tests_ + kAlwaysListed)) {
      gave_up_ = true;
      return false;
    }
  }
  std::sort(list_.begin(), list_.end());
  has_list_ = true;
  path_ = 0;
  valid_to_ = margin - 4 * rounding_;
  due_.assign(list_.size(), -1);
  meets_.assign(list_.size(), exact::Meet::disjoint);
  hints_.assign(list_.size(), 0);
  relation_kept_ = false;
  for (Proofs* p : {&apart_, &crossing_}) {
    if (p->on && p->made > 0 && p->saved < p->made / 2) {
      p->on = false;
      p->off_for = kProofsOffFor;
    } else if (!p->on && --p->off_for == 0) {
      p->on = true;
    }
    p->made = p->saved = 0;
  }
  ++statistics_.lists_made;
  std::size_t kept = 0;
  NullProbe probe;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    const double *ca[3], *cb[3];
    context_[Side::a].world.corners(list_[i].a, ca);
    context_[Side::b].world.corners(list_[i].b, cb);
    if (likely_gap(4 * rounding_, margin, a_.dim(), ca, cb) > margin) continue;  // not before the next list
    list_[kept] = list_[i];
    test_pair(kept, 0);
    if (meets_[kept] == exact::Meet::disjoint && due_[kept] > valid_to_) continue;
    show_face(context_, Side::a, a_.face_of_simplex(list_[i].a), result_, probe);
    show_face(context_, Side::b, b_.face_of_simplex(list_[i].b), result_, probe);
    ++kept;
  }
  list_.resize(kept);
  due_.resize(kept);
  hints_.resize(kept);
  meets_.resize(kept);
  show_opened();
  result_.counters.node_pairs = k.node_pairs;
  answer_from_list();
  return true;
}

void CoherentQuery::query_list(double step) {
  ++statistics_.from_list;
  ++steps_;
  for (std::size_t i = 0; i < list_.size(); ++i) {
    if (path_ < due_[i]) {
      ++(meets_[i] == exact::Meet::disjoint ? apart_ : crossing_).saved;
      continue;
    }
    test_pair(i, step);
  }
  statistics_.tests_saved += list_.size() - result_.counters.face_tests;
  answer_from_list();
}

/// Tests a pair of the list: by the proof that held last time, if it still does for a step or more, else
/// exactly.
void CoherentQuery::test_pair(std::size_t i, double step) {
  const double *ca[3], *cb[3];
  context_[Side::a].world.corners(list_[i].a, ca);
  context_[Side::b].world.corners(list_[i].b, cb);
  const int dim = a_.dim();
  const double rounding = 4 * rounding_, aim = 2 * usual_step_;
  ++result_.counters.face_tests;
  const bool proves_gaps = apart_.on || result_.pairs.empty(), proves_depths = crossing_.on && dim == 3;
  const auto gap = [&] {
    ++apart_.made;
    return gap_between(rounding, aim, dim, ca, cb, hints_[i]);
  };
  const auto depth = [&] {
    ++crossing_.made;
    return crossing_depth(aim, ca, cb, hints_[i]);
  };
  const bool first = due_[i] < 0;
  const exact::Meet before = meets_[i];
  double hold = 0;
  if (!first && before == exact::Meet::disjoint && proves_gaps) hold = gap();
  if (!first && before == exact::Meet::cross && proves_depths) hold = depth();
  if (!(hold > rounding)) {
    hold = 0;
    meets_[i] = dim == 3 ? exact::meet_triangles(ca, cb) : exact::meet_segments(ca, cb);
    if (first || meets_[i] != before) {
      hints_[i] = 0;
      if (meets_[i] == exact::Meet::disjoint && proves_gaps) hold = gap();
      if (meets_[i] == exact::Meet::cross && proves_depths) hold = depth();
    }
  }
  // Where the bodies do not meet, the relation hangs on it: it need not be decided again.
  if (meets_[i] == exact::Meet::disjoint && !(hold > step + rounding)) relation_kept_ = false;
  due_[i] = path_ + std::max(hold - rounding, 0.0);
}

void CoherentQuery::answer_from_list() {
  relation_kept_ &= result_.pairs.empty();
  result_.mode = request_.mode;
  result_.pairs.clear();
  result_.meets.clear();
  for (std::size_t i = 0; i < list_.size(); ++i) {
    if (meets_[i] == exact::Meet::disjoint) continue;
    if (request_.mode == Mode::any_pair && !result_.pairs.empty()) break;
    if (request_.mode == Mode::first_pair && !result_.pairs.empty()) {
      if (meets_[i] != exact::Meet::cross || result_.meets[0] == exact::Meet::cross) continue;
      result_.pairs.clear();
      result_.meets.clear();
    }
    result_.pairs.push_back(list_[i]);
    result_.meets.push_back(meets_[i]);
  }
  if (!relation_kept_ || !result_.pairs.empty()) decide_relation(context_, result_);
  relation_kept_ = true;
  result_.contacts.clear();
  result_.regions.clear();
  describe_contact(context_, request_, result_);
}

}  // namespace lrb
