/// The cache of separating planes of a motion: lent to the kernel at each step, forgotten when the relative
/// rotation since they were stored, which weakens each plane, adds up to too much.

#include "engine/query/distance/far_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/query/distance/kernel_floats.hpp"

namespace lrb {
namespace {

/// Largest number of cache slots. Fewer: pairs evict each other and are expanded again; more: the cache
/// exceeds a processor's second-level cache.
constexpr std::size_t kMostSlots = 4096;
/// Accumulated rotation of B at which all planes are forgotten. Larger: the float sum has larger errors, and
/// planes separate less.
constexpr double kMostTurned = 0.5;
constexpr FarNodes kNone = {~0U, ~0U, {0, 0, 0}, 0, 0};

/// Returns the Frobenius norm of the change of a map, rounded up.
double change(const double (&from)[3][4], const double (&to)[3][4]) {
  double square = 0;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) square += std::pow(to[column][row] - from[column][row], 2);
  constexpr double kUp = 1 + 0x1p-40;
  return std::sqrt(square) * kUp;
}

}  // namespace

void FarPairs::lend(DistanceKernel& k, std::size_t node_pairs) {
  // A power of two, because the slot is the masked hash.
  nodes_.resize(std::bit_ceil(std::clamp<std::size_t>(node_pairs, 1, kMostSlots)), kNone);
  // The length of the path of the relative rotation bounds its change since any earlier step.
  turned_ += change(m_, k.tree.m);
  // Too much rotation, or NaN. The first step, which starts from a zero map, counts as such.
  if (!(turned_ <= kMostTurned)) {
    std::fill(nodes_.begin(), nodes_.end(), kNone);
    turned_ = 0;
  }
  for (int column = 0; column < 3; ++column) std::copy_n(k.tree.m[column], 4, m_[column]);
  k.far = nodes_.data();
  k.far_slots = static_cast<std::uint32_t>(nodes_.size());
  // One rounded up, one down: their difference is never less than the true one.
  k.turned = rounded_up(turned_);
  k.least_turned = rounded_down(turned_);
}

}  // namespace lrb
