/// Rounding. Clearances are proved for the doubles x and x - v as they are computed (the last is rounded by
/// less than kDifferenceRounding), and the bodies' points are within kUnitRounding of the exact ones;
/// kRoomMargin covers both. Middles of cubes, and their halves, are multiples of a power of two: exact.

#include "engine/query/clash/overlap_proof.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/core/clash_tolerances.hpp"

namespace lrb::parting {
namespace {

/// At least sqrt(3).
constexpr double kDiagonal = 1.7320508076;
constexpr double kRoundedDown = 1 - 0x1p-50;
/// So that ways out that are a power of two, but for rounding, make cubes of one size.
constexpr double kAboveMost = 1 + 0x1p-20;

template <class Cube>
bool is_later(const Cube& x, const Cube& y) {
  return x.least > y.least;
}

}  // namespace

OverlapProof::OverlapProof(const SurfaceDistance& a, const SurfaceDistance& b, IsInside is_inside)
    : a_(a), b_(b), is_inside_(std::move(is_inside)) {}

/// Adds a cube, unless it lies further than is asked for.
void OverlapProof::push(const Vector3d& middle, double half, const Common& near) {
  const double least = (middle.array().abs() - half).max(0).matrix().norm() * kRoundedDown;
  if (least >= most_) return;
  cubes_.push_back({least, middle, half, near});
  std::push_heap(cubes_.begin(), cubes_.end(), is_later<Cube>);
}

bool OverlapProof::begin(const std::vector<Vector3d>& common, double most) {
  most_ = most;
  for (const Vector3d& x : common) {
    Common at;
    at.x = at.of_b = x;
    at.clear_a = a_.at(x);
    at.clear_b = b_.at(x);
    if (std::min(at.clear_a, at.clear_b) > kRoomMargin && is_inside_(Side::a, x) && is_inside_(Side::b, x))
      found_.push_back(at);
  }
  first_ = found_.size();
  if (first_ > 0) push(Vector3d::Zero(), std::exp2(std::floor(std::log2(most * kAboveMost)) + 1), found_[0]);
  return first_ > 0;
}

/// Two balls without a point of the surface, one of which holds the middle of the other, lie on the same side
/// of it.
bool OverlapProof::is_in(Side side, const Vector3d& x, double radius, const Vector3d& known,
                         double known_radius) {
  if (!(radius > kRoomMargin)) return false;
  return (x - known).norm() < std::max(radius, known_radius) - kRoomMargin || is_inside_(side, x);
}

bool OverlapProof::look(const Vector3d& x, const Vector3d& v, const Common& near, Common& out) {
  ++points_;
  out.x = x;
  out.shift = v;
  out.of_b = x - v;
  out.clear_a = a_.at(out.x);
  out.clear_b = b_.at(out.of_b);
  return is_in(Side::a, out.x, out.clear_a, near.x, near.clear_a) &&
         is_in(Side::b, out.of_b, out.clear_b, near.of_b, near.clear_b);
}

/// Moves a point along the axes to where there is more room. It is not moved away from the nearest points of
/// the surfaces, because which of several that are equally near is found depends on how these are divided.
void OverlapProof::climb(double needed, bool thorough, Common& best) {
  for (double step = needed / 2; step > needed * kLeastClimb && !(best.room() > needed); step /= 2) {
    if (!thorough && !(best.room() > needed * kNearlyEnough)) return;
    for (int k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0}) {
        Common next;
        if (!look(best.x + sign * step * Vector3d::Unit(k), best.shift, best, next) || !has_more(next, best))
          continue;
        best = next;
        break;
      }
  }
}

/// Returns points from which to look for one for a cube: that of the cube that it is a part of, those of the
/// nearest cubes that were proved, and, for a small one, some of all and some of the first.
std::vector<OverlapProof::Common> OverlapProof::seeds(const Cube& cube) const {
  std::array<std::pair<double, const Common*>, kSeeds> nearest;
  nearest.fill({kUnitReach * kUnitReach, nullptr});
  for (const Common& known : found_) {
    const double far = (cube.middle - known.shift).squaredNorm();
    if (!(far < nearest.back().first)) continue;
    std::size_t at = kSeeds - 1;
    for (; at > 0 && far < nearest[at - 1].first; --at) nearest[at] = nearest[at - 1];
    nearest[at] = {far, &known};
  }
  std::vector<Common> out{cube.near};
  for (const auto& [far, known] : nearest)
    if (known != nullptr) out.push_back(*known);
  if (is_small(cube))
    for (std::size_t i = 0; i < kOtherSeeds; ++i) {
      out.push_back(found_[i * found_.size() / kOtherSeeds]);
      out.push_back(found_[i * first_ / kOtherSeeds]);
    }
  return out;
}

/// Looks for a point with as much room as needed, starting from a seed.
bool OverlapProof::find_room(const Cube& cube, double needed, const Common& seed, Common& best) {
  const Vector3d moved = cube.middle - seed.shift;
  bool found = false;
  Common start;
  for (const double share : {0.5, 0.0, 1.0}) {
    Common at;
    if (!look(seed.x + share * moved, cube.middle, seed, at)) continue;
    if (!found || has_more(at, start)) start = at;
    found = true;
    if (start.room() > needed * kNearlyEnough) break;
  }
  if (!found) return false;
  climb(needed, is_small(cube), start);
  if (has_more(start, best)) best = start;
  return start.room() > needed;
}

/// Proves that the bodies overlap for a cube of translations. best: the point with the most room that was
/// found, if any.
bool OverlapProof::prove(const Cube& cube, Common& best) {
  const double needed = cube.half * kDiagonal + kRoomMargin;
  for (const Common& seed : seeds(cube)) {
    if (find_room(cube, needed, seed, best)) {
      found_.push_back(best);
      return true;
    }
    if (best.room() > needed * kNearlyEnough && !is_small(cube)) return false;
  }
  return false;
}

unsigned OverlapProof::grow(unsigned most_points) {
  const unsigned before = points_;
  while (!cubes_.empty() && points_ - before < most_points) {
    const Cube cube = cubes_.front();
    lower_ = std::max(lower_, cube.least);
    if (cube.half < kLeastCube) return points_ - before;
    std::pop_heap(cubes_.begin(), cubes_.end(), is_later<Cube>);
    cubes_.pop_back();
    Common near = cube.near;
    near.clear_a = near.clear_b = 0;
    if (prove(cube, near)) continue;
    if (!(near.room() > 0)) near = cube.near;
    for (unsigned i = 0; i < 8; ++i) {
      const double half = cube.half / 2;
      push(cube.middle + Vector3d(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half), half,
           near);
    }
  }
  lower_ = std::max(lower_, std::min(cubes_.empty() ? most_ : cubes_.front().least, most_));
  return points_ - before;
}

}  // namespace lrb::parting
