/// A list of the simplex pairs that may intersect while B moves along a sweep, as in Verlet's neighbour lists
/// (1967), which contain the pairs of particles within a margin.
///
/// 1. arrange() sorts the pairs that the tree kernel found, packs their simplices for eight-wide floats, and
///    computes the interval of the sweep in which each pair may intersect.
/// 2. choose() selects the pairs whose interval contains B's position in the sweep.
/// 3. update() tests these pairs, eight at a time in floats, and exactly where floats do not decide.

#include "engine/collide/candidate_cache.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/collide/tree_query.hpp"
#include "engine/core/tolerances.hpp"

namespace lrb {

// Chooses the kind and length of caches by hill climbing on measured times: the length is changed by a
// constant factor, and the direction of change is reversed when the cost per query has risen. A cache that
// costs more than queries from scratch shortens the next one; repeated failures lead to pauses of increasing
// length.

namespace {

constexpr double kFewestSteps = 2, kMaxSteps = 64;
constexpr double kLonger = 1.5;
/// After a cache that did not pay, the number of steps is multiplied by this.
constexpr double kMuchShorter = 0.4;
/// Number of successive failures before a pause. A single one may be due to too long a cache, or to the
/// clock.
constexpr std::uint32_t kMaxFailures = 2;
/// The remembered cost of the other kind is multiplied by this with every cache, so that it is tried again
/// eventually.
constexpr double kForget = 0.95;
/// The same factor for queries in which only a fixed cache was possible and fixed caches did not pay.
constexpr double kForgetSlowly = 0.99;
/// Queries from scratch that take no longer than this, in seconds, are not worth tracking B's motion.
constexpr double kWorthWatching = 5e-7;
/// Making a cache is given up after this many times the time of a query from scratch. Most caches that pay
/// are made within twice that time.
constexpr double kTimeoutFactor = 3;
/// A cache covers a motion of at most kLongestMotion of B's radius, because a longer one would contain many
/// pairs of both bodies. No cache is made if that leaves fewer than kWorthTrying steps.
constexpr double kLongestMotion = 1.0 / 16, kWorthTrying = 4;
/// Tracking of B's motion resumes this many queries before the end of a pause.
constexpr std::uint32_t kToSeeMotion = 3;
constexpr std::uint32_t kLongestPause = 64, kPauseFactor = 4, kFirstPause = 4;
/// After a cache did not pay, a step shorter than this share of the step then is worth another attempt at
/// once; longer steps only after kPausesBetween pauses.
constexpr double kShorter = 0.7;
constexpr std::uint32_t kPausesBetween = 4;

}  // namespace

bool CachePolicy::rests() {
  if (pause_ > 0) --pause_;
  // A cache needs a few poses to extrapolate the motion: track it for the last queries of a pause.
  return pause_ >= kToSeeMotion;
}

void CachePolicy::build_took(Kind kind, double time) {
  kind_ = kind;
  // The first cache also allocates its memory, so its time does not count.
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
  // No query from scratch was timed yet: there is no basis for comparison.
  if (scratch_time_ == 0) return {};
  if (scratch_time_ < kWorthWatching) {
    // Queries from scratch are so fast that tracking the motion does not pay.
    build_time_ = 0;
    pause_ = kLongestPause / kPauseFactor;
    return {};
  }
  if (build_time_ > 0) {
    if (cost() >= 1 && !is_fresh_) return {};  // queries from scratch may have become slower since
    // Rate the last cache before the next one is planned.
    take_stock();
    if (failures_ == kMaxFailures) {
      // Pause. One more failure afterwards is enough for the next pause.
      failures_ = kMaxFailures - 1;
      too_long_ = step;
      rest();
      return {};
    }
  } else if (too_long_ > 0 && step >= kShorter * too_long_ && ++pauses_ < kPausesBetween) {
    // Caches failed for steps like this one: wait for several pauses before the next attempt.
    pause_ = next_pause_;
    return {};
  }
  const double fixed_cost = aim(Kind::fixed).cost;
  // Choose the kind that cost less recently. A swept cache needs a steady motion.
  const Kind kind =
      is_steady && (fixed_cost >= 1 || aim(Kind::swept).cost <= fixed_cost) ? Kind::swept : Kind::fixed;
  if (kind == Kind::fixed && fixed_cost >= 1) {  // until the motion is steady, or that cost has decayed
    aim(kind).cost *= kForgetSlowly;
    return {};
  }
  // The number of steps after which B would have moved by kLongestMotion of its radius.
  const double most = kLongestMotion * radius / step;
  if (most >= kWorthTrying) return Plan{kind, std::min(aim(kind).steps, most)};
  pause_ = kLongestPause;
  return {};
}

double CachePolicy::time_limit() const {
  return kTimeoutFactor * scratch_time_;
}

double CachePolicy::cost() const {
  // The query that made the cache was answered as well: it counts as one of 1 + steps_.
  return (build_time_ + step_time_) / ((1 + steps_) * scratch_time_);
}

/// Returns the factor for the number of steps of the next cache. The cost of a swept cache grows about as its
/// length, so the best length is found by hill climbing. The cost of a fixed cache grows faster than its
/// width: it is wide enough if B stays in it long enough to repay it.
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
  used.steps = std::clamp(used.steps, kFewestSteps, kMaxSteps);
  // Average the cost, but replace one that is unknown or did not pay.
  used.cost = used.cost > 0 && used.cost < 1 ? (used.cost + now) / 2 : now;
  build_time_ = 0;
  // Decrease the other kind's cost over time, so that it is tried again.
  other.cost *= kForget;
}

namespace {

using Eigen::Vector3d;

/// Factor on the defect: a gap is longer on B's axes than on A's by a relative error of at most twice the
/// defect, plus rounding.
constexpr double kGapDefects = 3;

/// Pads to a multiple of eight by repeating an existing pair.
void fill_up(std::vector<CachedPair>& pairs, std::size_t count) {
  for (std::size_t i = count; i % 8 != 0; ++i) pairs[i] = pairs[0];
}

std::size_t up_to_eights(std::size_t count) {
  return (count + 7) / 8 * 8;
}

}  // namespace

void aim_at(const Sweep& sweep, double rounding, double unit, TreeKernel& k) {
  // All possible displacements of B from the straight sweep: its width, rounding, and the defect of the
  // rotation.
  const double margin =
      sweep.width + rounding + kGapDefects * sweep.mid_pose.defect * (sweep.length + sweep.width + rounding);
  k.margin = static_cast<float>(margin / unit) * kFloatUp;
  k.sweep_turn = static_cast<float>(sweep.turn) * kFloatUp;
  for (int i = 0; i < 3; ++i) {
    // Stored by columns, as m is. dm is a ratio of lengths: only dt depends on the unit.
    for (int j = 0; j < 3; ++j) k.sweep[j][i] = sweep.dm(i, j);
    k.sweep_t[i] = sweep.dt[i] / unit;
  }
}

void CandidateSimplices::begin(const LrbRep& rep, double unit) {
  rep_ = &rep;
  per_unit_ = 1 / unit;  // a power of two, as the unit is
  written_.clear();
  farthest_sq_ = 0;
  if (slots_.size() < rep.simplex_count()) slots_.resize(rep.simplex_count());
  // A new epoch empties all slots at once. They are cleared only when the counter wraps around.
  if (++epoch_ != 0) return;
  std::fill(slots_.begin(), slots_.end(), Slot{});
  epoch_ = 1;
}

std::uint32_t CandidateSimplices::place_of(SimplexId s) {
  Slot& slot = slots_[s];
  if (slot.epoch != epoch_) {
    slot = {epoch_, static_cast<std::uint32_t>(written_.size())};
    write(s);
  }
  return slot.place;
}

void CandidateSimplices::write(SimplexId s) {
  VertexId v[3] = {};
  rep_->simplex(s, v);
  // A segment is stored as a triangle that repeats its second corner.
  if (rep_->simplex_size() == 2) v[2] = v[1];
  const Vector3d x = rep_->vertices()[v[0]] * per_unit_;
  // Coordinates relative to a nearby corner lose less precision when rounded to float.
  if (written_.empty()) origin_ = x;
  const Vector3d first = x - origin_;
  double longest_sq = 0;
  CachedSimplex to{};
  for (int axis = 0; axis < 3; ++axis) to.corner[axis] = static_cast<float>(first[axis]);
  for (int end = 0; end < 2; ++end) {
    // Subtract in double: the edges of small simplices then have small errors in float.
    const Vector3d edge = rep_->vertices()[v[1 + end]] * per_unit_ - x;
    for (int axis = 0; axis < 3; ++axis) to.edge[end][axis] = static_cast<float>(edge[axis]);
    longest_sq = std::max(longest_sq, edge.squaredNorm());
  }
  // Rounded up: kFloatUp covers the conversion to float, kKernelTiny underflow.
  to.longest = static_cast<float>(std::sqrt(longest_sq)) * kFloatUp + kKernelTiny;
  farthest_sq_ = std::max(farthest_sq_, first.squaredNorm());
  written_.push_back(to);
}

float CandidateSimplices::radius() const {
  return static_cast<float>(std::sqrt(farthest_sq_)) * kFloatUp + kKernelTiny;
}

void CandidateCache::arrange(const LrbRep& a, const LrbRep& b, const TreeKernel& k, const Sweep& sweep,
                             double rounding, PairOrder& order) {
  unit_ = query_unit(a.tree(), b.tree());
  rounding_ = rounding;
  is_swept_ = sweep.length > 0;
  // Sort once: answers from the cache are then ascending without further sorting.
  order.sort(pairs_);
  place_pairs(a, b);
  find_spans(k, sweep);
  // Keep intervals that overlap [-1, 1]. An interval that ends before it begins means that the pair is never
  // in contact.
  if (is_swept_)
    drop_unless([](float from, float to) {
      return unsigned{from <= 1 + kSpanRounding} & unsigned{to >= -1 - kSpanRounding} &
             unsigned{from <= to + kSpanRounding};
    });
  else
    // At a fixed pose `from` is the displacement below which the pair cannot intersect.
    drop_unless([most = length_of(sweep.width)](float from, float) { return unsigned{from <= most}; });
  // Allocate for all pairs here: queries from the cache allocate nothing.
  chosen_.resize(pairs_.size());
  chosen_places_.resize(up_to_eights(pairs_.size()));
  verdicts_.resize(chosen_places_.size() / 8);
  meeting_.clear();
  chosen_count_ = 0;
}

void CandidateCache::place_pairs(const LrbRep& a, const LrbRep& b) {
  of_[0].begin(a, unit_);
  of_[1].begin(b, unit_);
  places_.resize(up_to_eights(pairs_.size()));
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    places_[i] = {of_[0].place_of(pairs_[i].a), of_[1].place_of(pairs_[i].b)};
  // The pair kernel reads blocks of eight.
  fill_up(places_, pairs_.size());
}

void CandidateCache::find_spans(const TreeKernel& k, const Sweep& sweep) {
  from_.resize(places_.size());
  to_.resize(places_.size());
  PairKernel kernel = kernel_at(k, places_);
  kernel.block_count = static_cast<std::uint32_t>(places_.size() / 8);
  kernel.from = from_.data();
  kernel.to = to_.data();
  kernel.is_swept = is_swept_;
  kernel.sweep_turn = k.sweep_turn;
  kernel.margin = k.margin;
  // Cached corners of B are relative to of_[1].origin(), so the constant term is the displacement of that
  // origin.
  const Vector3d direction = sweep.dm * of_[1].origin() + sweep.dt / unit_;
  for (int i = 0; i < 3; ++i) {
    kernel.sweep_t[i] = static_cast<float>(direction[i]);
    for (int j = 0; j < 3; ++j) kernel.sweep[i][j] = static_cast<float>(sweep.dm(i, j));
  }
  run_pair_kernel(kernel);
}

/// Drops pairs without branches, because the outcome cannot be predicted; choose() does the same.
template <class Keep>
void CandidateCache::drop_unless(Keep&& keep) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    // Copy first, then advance: an unwanted pair is overwritten by the next one.
    pairs_[kept] = pairs_[i];
    places_[kept] = places_[i];
    from_[kept] = from_[i];
    to_[kept] = to_[i];
    kept += keep(from_[kept], to_[kept]);
  }
  pairs_.resize(kept);
}

float CandidateCache::length_of(double distance) const {
  return static_cast<float>((distance + rounding_) / unit_) * kFloatUp;
}

/// Returns a position in the sweep in the units of the pairs' intervals.
float CandidateCache::position_of(const SweepPoint& where) const {
  return is_swept_ ? static_cast<float>(where.at) : length_of(where.offset);
}

std::size_t CandidateCache::choose(const SweepPoint& where) {
  const float at = position_of(where), spare = span_rounding();
  std::size_t count = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    // A pair whose interval does not contain the position is overwritten by the next one.
    chosen_[count] = static_cast<std::uint32_t>(i);
    chosen_places_[count] = places_[i];
    count += unsigned{from_[i] <= at + spare} & unsigned{to_[i] >= at - spare};
  }
  fill_up(chosen_places_, count);
  chosen_count_ = count;
  return count;
}

/// If two maps of B are in the sweep, so is every linear interpolation between them. If no surfaces intersect
/// on that path, none has passed through another.
bool CandidateCache::none_between(const SweepPoint& current, const SweepPoint& there) const {
  const float x = position_of(current), y = position_of(there), spare = span_rounding();
  // Compare intervals, grown by their rounding: linear in the number of pairs, without any geometry.
  const float first = std::min(x, y) - spare, last = std::max(x, y) + spare;
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    if (from_[i] <= last && to_[i] >= first) return false;
  return true;
}

PairKernel CandidateCache::kernel_at(const TreeKernel& k, const std::vector<CachedPair>& pairs) const {
  PairKernel p{};
  p.a = of_[0].data();
  p.b = of_[1].data();
  p.pairs = pairs.data();
  p.radius_a = of_[0].radius();
  p.radius_b = of_[1].radius();
  p.slack = k.slack;
  p.m_size = k.m_size;
  for (int i = 0; i < 3; ++i) {
    std::copy(std::begin(k.m_rows[i]), std::end(k.m_rows[i]), p.r[i]);
    // Offset between the cached origins, computed in double and rounded to float once.
    double t = k.t[i] - of_[0].origin()[i];  // B's origin, relative to A's
    for (int j = 0; j < 3; ++j) t += k.m[j][i] * of_[1].origin()[j];
    p.t[i] = static_cast<float>(t);
  }
  return p;
}

void CandidateCache::append_meeting(CollideResult& result) const {
  for (const Meeting& m : meeting_) {
    result.pairs.push_back(pairs_[m.pair]);
    result.meets.push_back(m.meet);
  }
}

}  // namespace lrb
