/// Sort and sweep (Baraff 1992) along one axis.
///
/// 1. Choose the axis with the lowest density of boxes: crowding().
/// 2. Sort the boxes by their lower ends: by insertion, because bodies move little from step to step.
/// 3. Sweep: compare each box on the other axes with those that begin before it ends.

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <Eigen/Geometry>

#include <lrbscope/broad_phase.hpp>

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

void SweepAndPrune::sort(std::span<const Box> boxes) {
  // Ties are broken by index: the order is strict and deterministic.
  const auto before = [&](std::uint32_t i, std::uint32_t j) {
    const double x = boxes[i].min()[axis_], y = boxes[j].min()[axis_];
    return x != y ? x < y : i < j;
  };
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

const std::vector<BodyPair>& SweepAndPrune::update(std::span<const Box> boxes) {
  work_ = {};
  choose_axis(boxes);
  sort(boxes);
  pairs_.clear();
  const int u = (axis_ + 1) % 3, v = (axis_ + 2) % 3;
  for (std::size_t k = 0; k < order_.size(); ++k) {
    const std::uint32_t i = order_[k];
    const Box& a = boxes[i];
    if (a.isEmpty()) continue;
    // All boxes that begin before `a` ends overlap it on this axis.
    for (std::size_t l = k + 1; l < order_.size(); ++l) {
      const std::uint32_t j = order_[l];
      const Box& b = boxes[j];
      // The following boxes begin even later.
      if (b.min()[axis_] > a.max()[axis_]) break;
      if (b.isEmpty()) continue;
      ++work_.box_tests;
      // Compare the other two axes; equal ends count as overlap.
      if (a.min()[u] <= b.max()[u] && b.min()[u] <= a.max()[u] && a.min()[v] <= b.max()[v] &&
          b.min()[v] <= a.max()[v])
        pairs_.push_back({std::min(i, j), std::max(i, j)});
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
  return pairs_;
}

}  // namespace lrb
