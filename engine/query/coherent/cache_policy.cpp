#include "engine/query/coherent/cache_policy.hpp"

#include <algorithm>
#include <utility>

namespace lrb {
namespace {

constexpr double kFewestSteps = 2, kMostSteps = 64;
constexpr double kLonger = 1.5;
/// A list that did not pay was longer than one that may.
constexpr double kMuchShorter = 0.4;
/// One may have been too long, or the clock's fault: with so many in a row there is a pause.
constexpr std::uint32_t kMostFailures = 2;
/// What the other kind of list cost is forgotten by this for every list, and so that kind tried again.
constexpr double kForget = 0.95;
/// And by this for every query, where only a list about a place could be made, and did not pay.
constexpr double kForgetSlowly = 0.99;
/// Queries from scratch that take no longer, in seconds, are not worth what it takes to watch B's course.
constexpr double kWorthWatching = 5e-7;
/// Most lists that pay are found in the time of two queries from scratch.
constexpr double kPatience = 3;
/// No list is for a way longer than this share of B's radius: it would hold much of both bodies.
/// And none where it could not be for so many steps.
constexpr double kLongestWay = 1.0 / 16, kWorthTrying = 4;
/// So many queries before the end of a pause B's course is watched again.
constexpr std::uint32_t kToSeeACourse = 3;
constexpr std::uint32_t kLongestPause = 64, kPauseFactor = 4, kFirstPause = 4;
/// Steps shorter than this share of one for which a list did not pay are worth another try at once; others
/// only after so many pauses.
constexpr double kShorter = 0.7;
constexpr std::uint32_t kPausesBetween = 4;

}  // namespace

bool CachePolicy::rests() {
  if (pause_ > 0) --pause_;
  return pause_ >= kToSeeACourse;
}

void CachePolicy::build_took(Kind kind, double time) {
  kind_ = kind;
  // The first one finds no memory: it does not count.
  build_time_ = std::exchange(has_memory_, true) ? time : 0;
  step_time_ = 0;
  steps_ = 0;
  is_fresh_ = false;
}

void CachePolicy::scratch_took(double time) {
  scratch_time_ = time;
  is_fresh_ = true;
}

void CachePolicy::step_took(double time) {
  step_time_ += time;
  ++steps_;
}

void CachePolicy::rest() {
  pause_ = next_pause_;
  next_pause_ = std::min(kPauseFactor * next_pause_, kLongestPause);
  pauses_ = 0;
}

std::optional<CachePolicy::Plan> CachePolicy::next(bool on_course, double step, double radius) {
  if (scratch_time_ == 0) return {};
  if (scratch_time_ < kWorthWatching) {
    build_time_ = 0;
    pause_ = kLongestPause / kPauseFactor;
    return {};
  }
  if (build_time_ > 0) {
    if (cost() >= 1 && !is_fresh_) return {};  // queries from scratch may take longer by now
    take_stock();
    if (failures_ == kMostFailures) {
      failures_ = kMostFailures - 1;
      too_long_ = step;
      rest();
      return {};
    }
  } else if (too_long_ > 0 && step >= kShorter * too_long_ && ++pauses_ < kPausesBetween) {
    pause_ = next_pause_;
    return {};
  }
  const double place = aim(Kind::fixed).cost;
  const Kind kind = on_course && (place >= 1 || aim(Kind::swept).cost <= place) ? Kind::swept : Kind::fixed;
  if (kind == Kind::fixed && place >= 1) {  // until there is a course, or that is forgotten
    aim(kind).cost *= kForgetSlowly;
    return {};
  }
  const double most = kLongestWay * radius / step;
  if (most >= kWorthTrying) return Plan{kind, std::min(aim(kind).steps, most)};
  pause_ = kLongestPause;
  return {};
}

double CachePolicy::patience() const {
  return kPatience * scratch_time_;
}

double CachePolicy::cost() const {
  return (build_time_ + step_time_) / ((1 + steps_) * scratch_time_);
}

/// How many times as many steps the next list is to serve for. A longer stretch costs about as much more as
/// it is longer: what is best is found by trying. A wider place costs more and more: it is wide enough where
/// B stays long enough for the list to be paid off.
double CachePolicy::growth(Aim& used, double now) const {
  if (kind_ == Kind::fixed) return build_time_ > step_time_ ? kLonger : 1;
  if (used.cost > 0 && now > used.cost) used.is_growing = !used.is_growing;
  return used.is_growing ? kLonger : 1 / kLonger;
}

void CachePolicy::take_stock() {
  Aim& used = aim(kind_);
  Aim& other = aim(kind_ == Kind::swept ? Kind::fixed : Kind::swept);
  const double now = cost();
  forgave_ = false;
  if (now < 1) {
    failures_ = 0;
    used.steps *= growth(used, now);
    next_pause_ = std::max(next_pause_ / kPauseFactor, kFirstPause);
    too_long_ = 0;
  } else {
    ++failures_;
    used.steps *= kMuchShorter;
  }
  used.steps = std::clamp(used.steps, kFewestSteps, kMostSteps);
  used.cost = used.cost > 0 && used.cost < 1 ? (used.cost + now) / 2 : now;
  build_time_ = 0;
  other.cost *= kForget;
}

}  // namespace lrb
