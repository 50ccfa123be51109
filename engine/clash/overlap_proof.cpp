/// Proves that two bodies overlap after all translations that are short enough.
///
/// If the open ball of radius r about x is in A, and the open ball of radius s about x - v is in B, then the
/// interiors overlap after all translations of B that differ from v by less than r + s, because B's ball then
/// reaches into A's. Translations are divided into cubes, nearest to 0 first. For each cube, a point x is
/// searched whose two balls are large enough for the entire cube; if none is found, the cube is divided into
/// eight. All translations shorter than the nearest remaining cube are proven. The closer these are to the
/// depth, the smaller are the cubes near separating translations; their number grows as the inverse of the
/// difference to the depth.
///
/// Branch and bound over the translations of B. Steps:
/// 1. Take the cube of translations nearest to 0. All shorter translations are proven.
/// 2. Search for a point whose clearances in A and, moved back, in B add up to more than the cube's half
///    diagonal: sample near known points, then climb to larger clearance.
/// 3. If such a point is found, the cube is proven; otherwise divide it into eight.
///
/// Rounding. Clearances are proven for the doubles x and x - v as computed (the latter is rounded by less
/// than kDifferenceRounding), and the bodies' points are within kUnitRounding of the exact ones; kRoomMargin
/// covers both. Centres and half sizes of cubes are multiples of a power of two, and therefore exact.

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/clash/clash_parts.hpp"
#include "engine/clash/clash_tolerances.hpp"

namespace lrb {
namespace {

/// At least sqrt(3).
constexpr double kDiagonal = 1.7320508076;
constexpr double kRoundedDown = 1 - 0x1p-50;
/// Ensures that separating translations near a power of two yield cubes of the same size whatever the
/// rounding.
constexpr double kAboveMost = 1 + 0x1p-20;

template <class Cube>
bool is_later(const Cube& x, const Cube& y) {
  return x.least > y.least;
}

}  // namespace

OverlapProof::OverlapProof(const SurfaceDistance& a, const SurfaceDistance& b, IsInside is_inside)
    : a_(a), b_(b), is_inside_(std::move(is_inside)) {}

/// Adds a cube, unless all its translations are longer than requested.
void OverlapProof::push(const Vector3d& centre, double half, const Common& near) {
  // Distance of 0 from the cube, rounded down.
  const double least = (centre.array().abs() - half).max(0).matrix().norm() * kRoundedDown;
  if (least >= most_) return;
  // Push to a binary min-heap by that distance.
  cubes_.push_back({least, centre, half, near});
  std::push_heap(cubes_.begin(), cubes_.end(), is_later<Cube>);
}

bool OverlapProof::begin(const std::vector<Vector3d>& common, double most) {
  most_ = most;
  // Seeds: points located exactly inside both bodies, with some clearance in each.
  for (const Vector3d& x : common) {
    Common at;
    at.x = at.of_b = x;
    at.clear_a = a_.at(x);
    at.clear_b = b_.at(x);
    if (std::min(at.clear_a, at.clear_b) > kRoomMargin && is_inside_(Side::a, x) && is_inside_(Side::b, x))
      found_.push_back(at);
  }
  first_ = found_.size();
  // One cube about 0 with all translations below `most`. A power of two, so that halving stays exact.
  if (first_ > 0) push(Vector3d::Zero(), std::exp2(std::floor(std::log2(most * kAboveMost)) + 1), found_[0]);
  return first_ > 0;
}

/// Returns true if x is inside. If one of two balls without surface points contains the centre of the other,
/// both are on the same side of the surface.
bool OverlapProof::is_in(Side side, const Vector3d& x, double radius, const Vector3d& known,
                         double known_radius) {
  if (!(radius > kRoomMargin)) return false;
  // A ball test often avoids the exact point location, which is far slower.
  return (x - known).norm() < std::max(radius, known_radius) - kRoomMargin || is_inside_(side, x);
}

/// Evaluates x for the translation v. Returns false unless x is in A and x - v in B, with more clearance than
/// `least`. near: a nearby common point.
bool OverlapProof::evaluate(const Vector3d& x, const Vector3d& v, const Common& near, const Common& least,
                            Common& out) {
  ++points_;
  out.x = x;
  out.shift = v;
  // B is translated by v: it contains x if the original B contains x - v.
  out.of_b = x - v;
  // An estimate from the way of the point: where it is wrong at() returns 0, which is no wrong clearance.
  const double enough = least.room() * (1 + kClearlyMore) - 64 * kRoomMargin;
  out.clear_a = a_.at(out.x, enough - least.clear_b - (out.of_b - least.of_b).norm());
  out.clear_b = b_.at(out.of_b, enough - out.clear_a);
  if (!has_more(out, least)) return false;
  // Inside with certainty: by the balls of the nearby point, or by exact location.
  return is_in(Side::a, out.x, out.clear_a, near.x, near.clear_a) &&
         is_in(Side::b, out.of_b, out.clear_b, near.of_b, near.clear_b);
}

/// Moves a point along the axes to larger clearance (compass search). It does not move away from the nearest
/// points of the surfaces, because the choice among equally near ones depends on the triangulation.
void OverlapProof::climb(double needed, bool thorough, Common& best) {
  // Halve the step until the clearance suffices, or until steps are too small to matter.
  for (double step = needed / 2; step > needed * kMinClimb && !(best.room() > needed); step /= 2) {
    // A large cube with little clearance is divided rather than searched.
    if (!thorough && !(best.room() > needed * kNearlyEnough)) return;
    for (int k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0}) {
        Common next;
        if (!evaluate(best.x + sign * step * Vector3d::Unit(k), best.shift, best, best, next)) continue;
        // Take the first gain on an axis.
        best = next;
        break;
      }
  }
}

/// Adds starting points of the search for a cube: those of the nearest proven cubes, and for a small cube
/// also samples of all known and of the initial points.
void OverlapProof::add_seeds(const Cube& cube, std::vector<Common>& out) const {
  // The kSeeds nearest translations, by insertion into a short sorted array.
  std::array<std::pair<double, const Common*>, kSeeds> nearest;
  nearest.fill({kUnitReach * kUnitReach, nullptr});
  for (const Common& known : found_) {
    const double far = (cube.centre - known.shift).squaredNorm();
    if (!(far < nearest.back().first)) continue;
    std::size_t at = kSeeds - 1;
    for (; at > 0 && far < nearest[at - 1].first; --at) nearest[at] = nearest[at - 1];
    nearest[at] = {far, &known};
  }
  for (const auto& [far, known] : nearest)
    if (known != nullptr) out.push_back(*known);
  // The remaining gap is small: search more before dividing, from samples of all known points.
  if (is_small(cube))
    for (std::size_t i = 0; i < kOtherSeeds; ++i) {
      out.push_back(found_[i * found_.size() / kOtherSeeds]);
      out.push_back(found_[i * first_ / kOtherSeeds]);
    }
}

/// Searches from a seed for a point with the clearance needed.
bool OverlapProof::find_room(const Cube& cube, double needed, const Common& seed, Common& best) {
  const Vector3d moved = cube.centre - seed.shift;
  bool found = false;
  Common start;
  // From the seed's translation to the cube's, the point moves by half, stays with A, or follows B.
  for (const double share : {0.5, 0.0, 1.0}) {
    Common at;
    if (!evaluate(seed.x + share * moved, cube.centre, seed, start, at)) continue;
    start = at;
    found = true;
    // Good enough to climb from.
    if (start.room() > needed * kNearlyEnough) break;
  }
  if (!found) return false;
  climb(needed, is_small(cube), start);
  // The best point is kept even if it does not suffice: the cube's parts start from it.
  if (has_more(start, best)) best = start;
  return start.room() > needed;
}

/// Proves that the bodies overlap for a cube of translations. best: set to the point with the largest
/// clearance found.
bool OverlapProof::prove(const Cube& cube, Common& best) {
  // Half of the cube's diagonal: the balls then overlap for every translation in the cube.
  const double needed = cube.half * kDiagonal + kRoomMargin;
  std::vector<Common> seeds{cube.near};  // the others only if this one does not suffice
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (find_room(cube, needed, seeds[i], best)) {
      // Proven cubes are seeds for their neighbours.
      found_.push_back(best);
      return true;
    }
    // A large cube with a fair point: its parts need only half the clearance, so divide.
    if (best.room() > needed * kNearlyEnough && !is_small(cube)) return false;
    if (i == 0) add_seeds(cube, seeds);
  }
  return false;
}

unsigned OverlapProof::grow(unsigned max_points) {
  const unsigned before = points_;
  while (!cubes_.empty() && points_ - before < max_points) {
    // The cube nearest to 0 bounds the proven translations.
    const Cube cube = cubes_.front();
    lower_ = std::max(lower_, cube.least);
    // Too small to be worth dividing: the proof ends.
    if (cube.half < kMinCube) return points_ - before;
    std::pop_heap(cubes_.begin(), cubes_.end(), is_later<Cube>);
    cubes_.pop_back();
    // The parent's point, with clearance 0: any point found for this cube counts as better.
    Common near = cube.near;
    near.clear_a = near.clear_b = 0;
    if (prove(cube, near)) continue;
    // If none was found, the parts start from the parent's point.
    if (!(near.room() > 0)) near = cube.near;
    // Eight cubes of half the size.
    for (unsigned i = 0; i < 8; ++i) {
      const double half = cube.half / 2;
      push(cube.centre + Vector3d(i & 1 ? half : -half, i & 2 ? half : -half, i & 4 ? half : -half), half,
           near);
    }
  }
  // Everything shorter than the nearest cube is proven; without cubes, everything below `most`.
  lower_ = std::max(lower_, std::min(cubes_.empty() ? most_ : cubes_.front().least, most_));
  return points_ - before;
}

}  // namespace lrb
