#include "engine/query/distance/far_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/query/distance/kernel_floats.hpp"

namespace lrb {
namespace {

/// Slots for pairs of nodes, of large bodies. Fewer: pairs take each other's place, and are opened again;
/// more: they do not fit a processor's second cache.
constexpr std::size_t kMostSlots = 4096;
/// How much B may have turned in all before planes are forgotten. More: the floats that add it up are off by
/// more, and planes hold less apart.
constexpr double kMostTurned = 0.5;
constexpr FarNodes kNone = {~0U, ~0U, {0, 0, 0}, 0, 0};

/// Returns the norm of what a map has changed by, and a little more.
double change(const double (&from)[3][4], const double (&to)[3][4]) {
  double square = 0;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) square += std::pow(to[column][row] - from[column][row], 2);
  constexpr double kUp = 1 + 0x1p-40;
  return std::sqrt(square) * kUp;
}

}  // namespace

void FarPairs::lend(DistanceKernel& k, std::size_t node_pairs) {
  nodes_.resize(std::bit_ceil(std::clamp<std::size_t>(node_pairs, 1, kMostSlots)), kNone);
  turned_ += change(m_, k.tree.m);
  if (!(turned_ <= kMostTurned)) {
    std::fill(nodes_.begin(), nodes_.end(), kNone);
    turned_ = 0;
  }
  for (int column = 0; column < 3; ++column) std::copy_n(k.tree.m[column], 4, m_[column]);
  k.far = nodes_.data();
  k.far_slots = static_cast<std::uint32_t>(nodes_.size());
  k.turned = rounded_up(turned_);
  k.least_turned = rounded_down(turned_);
}

}  // namespace lrb
