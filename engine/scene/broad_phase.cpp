/// Sort and sweep (Baraff 1992) along one axis.
///
/// 1. Choose the axis with the lowest density of boxes: crowding().
/// 2. Sort the boxes by their lower ends: by insertion, because bodies move little from step to step.
/// 3. Sweep: compare each box on the other axes with those that begin before it ends.
///
/// If few boxes have moved:
/// 1. Merge them into the order of the others.
/// 2. Keep the pairs of the others. Compare each moved box with those that begin before it ends, and with
/// those
///    before it in the order that are at most as far away as the longest box is long.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include <lrbscope/broad_phase.hpp>
#include <lrbscope/core/float_mode.hpp>

namespace lrb {
namespace {

using Box = Eigen::AlignedBox3d;

/// Maximum number of swaps per body, beyond which a full sort is faster.
constexpr std::uint64_t kSwapsOfABody = 32;

/// Returns the density of boxes on an axis: the sum of their lengths divided by the length that they cover,
/// which is the average number of boxes over a point, up to a factor common to all axes. Divides before
/// subtracting, to avoid overflow.
double crowding(std::span<const Box> boxes, int axis) {
  double low = 0, high = 0, lengths = 0;
  bool any = false;
  for (const Box& b : boxes) {
    if (b.isEmpty()) continue;
    const double from = b.min()[axis] / 2, to = b.max()[axis] / 2;
    // Infinite boxes are left out, because the density over an infinite length is undefined.
    if (!std::isfinite(from) || !std::isfinite(to)) continue;
    low = any ? std::min(low, from) : from;
    high = any ? std::max(high, to) : to;
    lengths += (to - from) / static_cast<double>(boxes.size());
    any = true;
  }
  return high > low ? lengths / (high - low) : 1;
}

}  // namespace

void SweepAndPrune::choose_axis(std::span<const Box> boxes) {
  constexpr double kWorthChanging = 2;
  const std::array<double, 3> crowded = {crowding(boxes, 0), crowding(boxes, 1), crowding(boxes, 2)};
  const auto best = static_cast<int>(std::min_element(crowded.begin(), crowded.end()) - crowded.begin());
  // Hysteresis: a new axis needs a full sort, so it must be at least twice as good.
  const bool change =
      kWorthChanging * crowded[static_cast<std::size_t>(best)] < crowded[static_cast<std::size_t>(axis_)];
  work_.sorted_afresh = order_.size() != boxes.size() || (change && best != axis_);
  if (work_.sorted_afresh) axis_ = best;
}

/// The order of the boxes. Ties are broken by index: it is strict and deterministic.
bool SweepAndPrune::before(Boxes boxes, std::uint32_t i, std::uint32_t j) const {
  const double x = boxes[i].min()[axis_], y = boxes[j].min()[axis_];
  return x != y ? x < y : i < j;
}

void SweepAndPrune::sort(std::span<const Box> boxes) {
  const auto before = [&](std::uint32_t i, std::uint32_t j) { return this->before(boxes, i, j); };
  if (work_.sorted_afresh) {
    order_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), 0u);
    std::sort(order_.begin(), order_.end(), before);
    return;
  }
  // Insertion sort of the last order: linear in the number of bodies and swaps.
  for (std::size_t k = 1; k < order_.size(); ++k) {
    if (work_.swaps > kSwapsOfABody * order_.size()) {  // bodies have jumped: the last order does not help
      std::sort(order_.begin(), order_.end(), before);
      return;
    }
    for (std::size_t l = k; l > 0 && before(order_[l], order_[l - 1]); --l) {
      std::swap(order_[l], order_[l - 1]);
      ++work_.swaps;
    }
  }
}

namespace {

/// Returns true if two boxes overlap on two axes; equal ends count as overlap.
bool overlap(const Box& a, const Box& b, int u, int v) {
  return a.min()[u] <= b.max()[u] && b.min()[u] <= a.max()[u] && a.min()[v] <= b.max()[v] &&
         b.min()[v] <= a.max()[v];
}

}  // namespace

const std::vector<BodyPair>& SweepAndPrune::update(std::span<const Box> boxes) {
  const FloatMode float_mode;
  work_ = {};
  moved_ = 0;
  longest_ = 0;
  choose_axis(boxes);
  sort(boxes);
  pairs_.clear();
  sweep(boxes);
  // Ascending: counting sorts by the second and then the first body, faster than comparisons.
  sort_by(&BodyPair::j, boxes.size());
  sort_by(&BodyPair::i, boxes.size());
  return pairs_;
}

/// Sorts the pairs by one of their bodies, stably.
void SweepAndPrune::sort_by(std::uint32_t BodyPair::*body, std::size_t bodies) {
  ends_.assign(bodies + 1, 0);
  for (const BodyPair& p : pairs_) ++ends_[p.*body + 1];
  std::partial_sum(ends_.begin(), ends_.end(), ends_.begin());
  found_.resize(pairs_.size());
  for (const BodyPair& p : pairs_) found_[ends_[p.*body]++] = p;
  pairs_.swap(found_);
}

namespace {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
constexpr std::size_t kBoxesAtOnce = 4;

// The nearest floats that are at most, and at least, a number.
float float_below(double x) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto f = static_cast<float>(x);
  return f > x ? std::nextafter(f, -kInfinity) : f;
}

float float_above(double x) {
  return -float_below(-x);
}

Float4 load(const float* from) {
  Float4 out;
  std::memcpy(&out, from, sizeof out);
  return out;
}

}  // namespace

/// Finds all pairs. The ends of the boxes are copied in the order of the sweep, so that they are read in
/// sequence. On the other two axes they are rounded outward to floats, and compared four boxes at a time; the
/// few that overlap there are compared again in doubles.
void SweepAndPrune::sweep(Boxes boxes) {
  const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
  swept_.clear();
  from_.clear();
  for (auto* ends : {&low_u_, &high_u_, &low_v_, &high_v_}) ends->clear();
  for (const std::uint32_t i : order_) {
    const Box& b = boxes[i];
    if (b.isEmpty()) continue;
    longest_ = std::max(longest_, b.max()[axis_] - b.min()[axis_]);
    swept_.push_back(i);
    from_.push_back(b.min()[axis_]);
    low_u_.push_back(float_below(b.min()[u]));
    high_u_.push_back(float_above(b.max()[u]));
    low_v_.push_back(float_below(b.min()[v]));
    high_v_.push_back(float_above(b.max()[v]));
  }
  // Fill the last group of lanes. The fill is never reported: its lanes are beyond the end of every range.
  for (auto* ends : {&low_u_, &high_u_, &low_v_, &high_v_}) ends->resize(swept_.size() + kBoxesAtOnce, 0);
  for (std::size_t k = 0, end = 0; k < swept_.size(); ++k) {
    const std::uint32_t i = swept_[k];
    const Box& a = boxes[i];
    // All boxes that begin before `a` ends overlap it on the axis.
    const double to = a.max()[axis_];
    end = std::max(end, k + 1);
    while (end < swept_.size() && from_[end] <= to) ++end;
    while (from_[end - 1] > to) --end;
    work_.box_tests += end - k - 1;
    const float low_u = low_u_[k], high_u = high_u_[k], low_v = low_v_[k], high_v = high_v_[k];
    for (std::size_t l = k + 1; l < end; l += kBoxesAtOnce) {
      const Int4 hit = (load(&low_u_[l]) <= high_u) & (low_u <= load(&high_u_[l])) &
                       (load(&low_v_[l]) <= high_v) & (low_v <= load(&high_v_[l]));
      std::uint64_t halves[2];
      std::memcpy(halves, &hit, sizeof halves);
      if ((halves[0] | halves[1]) == 0) continue;
      for (std::size_t lane = 0; lane < std::min(kBoxesAtOnce, end - l); ++lane) {
        const std::uint32_t j = swept_[l + lane];
        if (hit[lane] != 0 && overlap(a, boxes[j], u, v)) pairs_.push_back({std::min(i, j), std::max(i, j)});
      }
    }
  }
}

const std::vector<BodyPair>& SweepAndPrune::update(std::span<const Box> boxes,
                                                   std::span<const std::uint32_t> moved) {
  const FloatMode float_mode;
  // A moved box is compared with boxes on both sides, in a complete update with those on one: beyond a
  // quarter of the boxes, the complete update is faster. It also chooses the axis again, after as many moves
  // as bodies.
  constexpr std::size_t kIncrementalShare = 4;
  if (order_.size() != boxes.size() || kIncrementalShare * moved.size() > boxes.size() ||
      moved_ > boxes.size())
    return update(boxes);
  work_ = {};
  moved_ += moved.size();
  if (moved.empty()) return pairs_;
  has_moved_.assign(boxes.size(), false);
  for (const std::uint32_t i : moved) {
    has_moved_[i] = true;
    if (!boxes[i].isEmpty()) longest_ = std::max(longest_, boxes[i].max()[axis_] - boxes[i].min()[axis_]);
  }
  sort_moved(boxes, moved);
  // Keep the pairs of the others, and merge those of the moved boxes into them.
  std::erase_if(pairs_, [&](const BodyPair& p) { return has_moved_[p.i] || has_moved_[p.j]; });
  found_.clear();
  for (const std::uint32_t i : moved) sweep_moved(boxes, i);
  std::sort(found_.begin(), found_.end());
  const auto kept = static_cast<std::ptrdiff_t>(pairs_.size());
  pairs_.insert(pairs_.end(), found_.begin(), found_.end());
  std::inplace_merge(pairs_.begin(), pairs_.begin() + kept, pairs_.end());
  return pairs_;
}

/// Restores the order after some bodies have moved: sorts these, and merges them into the others.
void SweepAndPrune::sort_moved(Boxes boxes, std::span<const std::uint32_t> moved) {
  const auto earlier = [&](std::uint32_t i, std::uint32_t j) { return before(boxes, i, j); };
  rest_.clear();
  for (const std::uint32_t i : order_)
    if (!has_moved_[i]) rest_.push_back(i);
  std::vector<std::uint32_t> sorted(moved.begin(), moved.end());
  std::sort(sorted.begin(), sorted.end(), earlier);
  std::merge(rest_.begin(), rest_.end(), sorted.begin(), sorted.end(), order_.begin(), earlier);
}

/// Appends the pairs of a moved body. A pair of two moved bodies is found by the one with the lower number.
void SweepAndPrune::sweep_moved(Boxes boxes, std::uint32_t i) {
  const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
  const Box& a = boxes[i];
  if (a.isEmpty()) return;
  const auto compare = [&](std::uint32_t j) {
    const Box& b = boxes[j];
    if (b.isEmpty() || (has_moved_[j] && j < i)) return;
    ++work_.box_tests;
    if (a.min()[axis_] <= b.max()[axis_] && b.min()[axis_] <= a.max()[axis_] && overlap(a, b, u, v))
      found_.push_back({std::min(i, j), std::max(i, j)});
  };
  const auto current = static_cast<std::size_t>(
      std::lower_bound(order_.begin(), order_.end(), i,
                       [&](std::uint32_t x, std::uint32_t y) { return before(boxes, x, y); }) -
      order_.begin());
  for (std::size_t k = current + 1; k < order_.size() && !(boxes[order_[k]].min()[axis_] > a.max()[axis_]);
       ++k)
    compare(order_[k]);
  // Rounding is monotonic: the rounded distance of the lower ends of overlapping boxes is at most the rounded
  // length of the first one.
  for (std::size_t k = current; k-- > 0 && !(a.min()[axis_] - boxes[order_[k]].min()[axis_] > longest_);)
    compare(order_[k]);
}

}  // namespace lrb
