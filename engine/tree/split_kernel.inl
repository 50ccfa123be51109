// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_SPLIT_KERNEL_NAME.

#include "engine/tree/kernel_frames.inl"

namespace lrb {
namespace {

constexpr int kBins = 32;

inline Float8 load8(const FloatBox& box) {
  Float8 x;
  __builtin_memcpy(&x, &box, sizeof x);
  return x;
}
inline void store8(Float8 x, FloatBox& box) {
  __builtin_memcpy(static_cast<void*>(&box), &x, sizeof x);
}

/// Returns twice the centre, in the first three lanes. The lanes of whole numbers are left out: as floats
/// they are subnormal, which is slow.
inline Float8 centre_of(Float8 box) {
  return __builtin_shufflevector(box, box, 0, 1, 2, 2, 4, 5, 6, 6) -
         __builtin_shufflevector(box, box, 4, 5, 6, 6, 0, 1, 2, 2);
}

inline float cost_of_box(Float8 box) {
  const Float8 side = -box - __builtin_shufflevector(box, box, 4, 5, 6, 7, 0, 1, 2, 3);
  return box_cost_of(side[0], side[1], side[2]);
}

inline float leaves_of(std::uint32_t simplices) {
  return static_cast<float>((simplices + kTreeWidth - 1) / kTreeWidth);
}

}  // namespace

void LRB_SPLIT_KERNEL_NAME(SplitKernel& k) {
  const Float8 empty = splat(__builtin_inff());
  // Fewer bins for few simplices.
  const int bins = k.count > 2048 ? kBins : kBins / 2;
  // Step 1: the box and number of simplices of each bin, on all axes. Two at a time, in bins of their own, so
  // that neighbours, which are mostly in the same bin, do not wait for each other.
  Float8 from{}, per_unit{};
  for (int i = 0; i < 3; ++i) {
    // Twice the centres are compared.
    const float size = -2 * k.bounds[4 + i] - 2 * k.bounds[i],
                scale = static_cast<float>(bins) * (1 - 0x1p-20f) / size;
    from[i] = 2 * k.bounds[i];
    // The centres (nearly) coincide on this axis: no cut across it.
    per_unit[i] = size > 0 && scale < 1e30f ? scale : 0;
  }
  Float8 box[2][3][kBins];
  std::uint32_t count[2][3][kBins] = {};
  for (auto& set : box)
    for (auto& row : set)
      for (Float8& bin : row) bin = empty;
  const auto last = static_cast<float>(bins - 1);
  const auto add = [&](const FloatBox& one, Float8(&boxes)[3][kBins], std::uint32_t(&counts)[3][kBins]) {
    const Float8 x = load8(one), at = (centre_of(x) - from) * per_unit;
    const Int8 bin = __builtin_convertvector(smaller(larger(at, Float8{}), splat(last)), Int8);
    for (int axis = 0; axis < 3; ++axis) {
      boxes[axis][bin[axis]] = smaller(boxes[axis][bin[axis]], x);
      ++counts[axis][bin[axis]];
    }
  };
  for (std::uint32_t i = 0; i + 1 < k.count; i += 2) {
    add(k.boxes[i], box[0], count[0]);
    add(k.boxes[i + 1], box[1], count[1]);
  }
  if (k.count % 2 != 0) add(k.boxes[k.count - 1], box[0], count[0]);
  for (int axis = 0; axis < 3; ++axis)
    for (int b = 0; b < bins; ++b) {
      box[0][axis][b] = smaller(box[0][axis][b], box[1][axis][b]);
      count[0][axis][b] += count[1][axis][b];
    }
  // Step 2: the cost of each boundary, as box cost times number of leaves.
  float best = __builtin_inff();
  std::uint32_t left = k.count / 2;  // all centres coincide: any half is valid
  k.axis = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (per_unit[axis] == 0) continue;
    float right_cost[kBins];
    Float8 part = empty;
    std::uint32_t number = 0;
    for (int b = bins - 1; b > 0; --b) {
      part = smaller(part, box[0][axis][b]), number += count[0][axis][b];
      right_cost[b] = number > 0 ? cost_of_box(part) * leaves_of(number) : 0;
    }
    part = empty, number = 0;
    for (int b = 1; b < bins; ++b) {
      part = smaller(part, box[0][axis][b - 1]), number += count[0][axis][b - 1];
      if (number == 0 || number == k.count) continue;
      const float cost = cost_of_box(part) * leaves_of(number) + right_cost[b];
      if (cost < best) best = cost, k.axis = axis, left = number;
    }
  }
  // Round the cut to a multiple of kTreeWidth, so that all leaves except the last are full. Keep both halves
  // nonempty.
  left = (left + kTreeWidth / 2) / kTreeWidth * kTreeWidth;
  const std::uint32_t most = (k.count - 1) / kTreeWidth * kTreeWidth;
  k.left = left < kTreeWidth ? kTreeWidth : left > most ? most : left;
  int cut_bin = 0;
  for (std::uint32_t rank = k.left; rank >= count[0][k.axis][cut_bin]; ++cut_bin)
    rank -= count[0][k.axis][cut_bin];
  Float8 whole = empty, half[2] = {empty, empty};
  for (int b = 0; b < bins; ++b) {
    const Float8 x = box[0][k.axis][b];
    whole = smaller(whole, x);
    if (b <= cut_bin) half[0] = smaller(half[0], x);
    if (b >= cut_bin) half[1] = smaller(half[1], x);
  }
  k.cost = static_cast<double>(cost_of_box(whole));
  __builtin_memcpy(k.halves, half, sizeof half);
  // Step 3: move the boxes in one pass. Each is written to all three places, of which one moves: the bins
  // cannot be predicted.
  std::uint32_t before = 0, after = 0;
  FloatBox *const boxes = k.boxes, *const first = k.buffer, *inside = k.buffer + k.count - 1;
  const float* const low = boxes->low + k.axis;
  const float start = from[k.axis], scale = per_unit[k.axis];
  for (std::uint32_t i = 0, n = k.count; i < n; ++i) {
    const Float8 x = load8(boxes[i]);
    const float at = ((low[8 * i] - low[8 * i + 4]) - start) * scale;
    const int bin = static_cast<int>(at > 0 ? (at < last ? at : last) : 0);
    store8(x, first[after]);
    store8(x, *inside);
    store8(x, boxes[before]);
    before += bin < cut_bin;
    after += bin > cut_bin;
    inside -= bin == cut_bin;
  }
  k.before = before, k.after = after;
}

}  // namespace lrb
