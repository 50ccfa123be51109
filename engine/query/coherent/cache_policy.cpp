/// Chooses the kind and length of caches by hill climbing on measured times: the length is changed by a
/// constant factor, and the direction of change is reversed when the cost per query has risen. Caches that
/// cost more than queries from scratch shorten the next one, then lead to pauses of increasing length.

#include "engine/query/coherent/cache_policy.hpp"

#include <algorithm>
#include <utility>

namespace lrb {
namespace {

constexpr double kFewestSteps = 2, kMostSteps = 64;
constexpr double kLonger = 1.5;
/// A cache that did not pay was made for too many steps: the next one is for this share of them.
constexpr double kMuchShorter = 0.4;
/// One failure may be due to too long a cache, or to the clock: after this many in a row there is a pause.
constexpr std::uint32_t kMostFailures = 2;
/// With every cache the remembered cost of the other kind is multiplied by this, so that it is tried again.
constexpr double kForget = 0.95;
/// The factor for queries in which only a fixed cache could be made and these did not pay.
constexpr double kForgetSlowly = 0.99;
/// Queries from scratch that take no longer than this, in seconds, are not worth the effort of watching B's
/// motion.
constexpr double kWorthWatching = 5e-7;
/// Making a cache is given up after this many times a query from scratch: most caches that pay are found in
/// two.
constexpr double kPatience = 3;
/// No cache is for a motion longer than this share of B's radius, because it would hold much of both bodies;
/// and none is made where that leaves fewer than kWorthTrying steps.
constexpr double kLongestMotion = 1.0 / 16, kWorthTrying = 4;
/// This many queries before the end of a pause, B's motion is watched again.
constexpr std::uint32_t kToSeeMotion = 3;
constexpr std::uint32_t kLongestPause = 64, kPauseFactor = 4, kFirstPause = 4;
/// After a step for which a cache did not pay, steps shorter than this share of it are worth another try at
/// once; others only after kPausesBetween pauses.
constexpr double kShorter = 0.7;
constexpr std::uint32_t kPausesBetween = 4;

}  // namespace

bool CachePolicy::rests() {
  if (pause_ > 0) --pause_;
  // A cache needs a few poses to foresee the motion: watch it for the last queries of a pause.
  return pause_ >= kToSeeMotion;
}

void CachePolicy::build_took(Kind kind, double time) {
  kind_ = kind;
  // The first cache has to allocate its memory, so its time does not count.
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

std::optional<CachePolicy::Plan> CachePolicy::next(bool is_steady, double step, double radius) {
  // No query from scratch was timed yet: there is nothing to compare with.
  if (scratch_time_ == 0) return {};
  if (scratch_time_ < kWorthWatching) {
    // Queries from scratch are so fast that watching the motion does not pay.
    build_time_ = 0;
    pause_ = kLongestPause / kPauseFactor;
    return {};
  }
  if (build_time_ > 0) {
    if (cost() >= 1 && !is_fresh_) return {};  // queries from scratch may take longer by now
    // Rate the last cache before the next one is planned.
    take_stock();
    if (failures_ == kMostFailures) {
      // Pause. One more failure afterwards is enough for the next pause.
      failures_ = kMostFailures - 1;
      too_long_ = step;
      rest();
      return {};
    }
  } else if (too_long_ > 0 && step >= kShorter * too_long_ && ++pauses_ < kPausesBetween) {
    // Caches failed for steps like this one: wait for several pauses before the next try.
    pause_ = next_pause_;
    return {};
  }
  const double fixed_cost = aim(Kind::fixed).cost;
  // The kind that cost less recently. A swept cache needs a steady motion.
  const Kind kind =
      is_steady && (fixed_cost >= 1 || aim(Kind::swept).cost <= fixed_cost) ? Kind::swept : Kind::fixed;
  if (kind == Kind::fixed && fixed_cost >= 1) {  // until the motion is steady, or that cost is forgotten
    aim(kind).cost *= kForgetSlowly;
    return {};
  }
  // The number of steps after which B would have moved by kLongestMotion of its radius.
  const double most = kLongestMotion * radius / step;
  if (most >= kWorthTrying) return Plan{kind, std::min(aim(kind).steps, most)};
  pause_ = kLongestPause;
  return {};
}

double CachePolicy::patience() const {
  return kPatience * scratch_time_;
}

double CachePolicy::cost() const {
  // The query that made the cache was answered as well: it counts as one of 1 + steps_.
  return (build_time_ + step_time_) / ((1 + steps_) * scratch_time_);
}

/// Returns the factor for the number of steps that the next cache is for. The cost of a swept cache grows
/// about as its length: the best length is found by trying. The cost of a fixed cache grows faster than its
/// width: it is wide enough if B stays in it long enough to pay it off.
double CachePolicy::growth(Aim& used, double now) const {
  // Widen until the queries answered from the cache take as long as making it did.
  if (kind_ == Kind::fixed) return build_time_ > step_time_ ? kLonger : 1;
  // Hill climbing: reverse the direction where the cost has risen.
  if (used.cost > 0 && now > used.cost) used.is_growing = !used.is_growing;
  return used.is_growing ? kLonger : 1 / kLonger;
}

void CachePolicy::take_stock() {
  Aim& used = aim(kind_);
  Aim& other = aim(kind_ == Kind::swept ? Kind::fixed : Kind::swept);
  const double now = cost();
  forgave_ = false;
  if (now < 1) {
    // The cache paid: adjust its length and shorten the next pause.
    failures_ = 0;
    used.steps *= growth(used, now);
    next_pause_ = std::max(next_pause_ / kPauseFactor, kFirstPause);
    too_long_ = 0;
  } else {
    // It did not pay: the next one serves far fewer steps.
    ++failures_;
    used.steps *= kMuchShorter;
  }
  used.steps = std::clamp(used.steps, kFewestSteps, kMostSteps);
  // Average the cost, but replace one that is unknown or did not pay.
  used.cost = used.cost > 0 && used.cost < 1 ? (used.cost + now) / 2 : now;
  build_time_ = 0;
  // Let the other kind look cheaper over time, so that it is tried again.
  other.cost *= kForget;
}

}  // namespace lrb
