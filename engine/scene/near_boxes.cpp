#include "engine/scene/near_boxes.hpp"

#include <algorithm>
#include <limits>

namespace lrb::scene {
namespace {

/// More than differences, norms and products of a few doubles are off by, relative to them.
constexpr double kRoundedDown = 1 - 0x1p-48;

}  // namespace

double gap(const Box& a, const Box& b) {
  const Eigen::Vector3d gaps = (b.min() - a.max()).cwiseMax(a.min() - b.max()).cwiseMax(0);
  constexpr double kMost = std::numeric_limits<double>::max();
  if (!(gaps.maxCoeff() <= kMost / 2)) return kMost / 2;
  return gaps.stableNorm() * kRoundedDown;
}

SortedBoxes::SortedBoxes(std::span<const Box> boxes, int axis) : boxes_(boxes), axis_(axis) {
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].isEmpty()) order_.push_back(i);
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t x, std::uint32_t y) { return low(x) != low(y) ? low(x) < low(y) : x < y; });
}

bool SortedBoxes::is_beyond(double low, std::uint32_t box, double limit) const {
  return (low - boxes_[box].max()[axis_]) * kRoundedDown > limit;
}

std::size_t SortedBoxes::first_from(double from, bool above) const {
  const auto found = std::partition_point(
      order_.begin(), order_.end(), [&](std::uint32_t i) { return above ? low(i) <= from : low(i) < from; });
  return static_cast<std::size_t>(found - order_.begin());
}

int longest_axis(std::span<const Box> a, std::span<const Box> b) {
  Box whole;
  for (const std::span<const Box> boxes : {a, b})
    for (const Box& box : boxes) {
      // Boxes of bodies that leave the range of doubles are infinite, and tell nothing.
      if (!box.isEmpty() && box.min().allFinite() && box.max().allFinite()) whole.extend(box.center());
    }
  if (whole.isEmpty()) return 0;
  int axis = 0;
  (whole.max() / 2 - whole.min() / 2).maxCoeff(&axis);
  return axis;
}

}  // namespace lrb::scene
