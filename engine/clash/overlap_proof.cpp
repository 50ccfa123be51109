/// Proves that two bodies overlap after all translations that are short enough.
///
/// Let C be a box about 0. If x + r C is in A, and x - v + s C is in B, then the interiors overlap after all
/// translations of B in the interior of v + (r + s) C, because C is convex and symmetric. Translations are
/// divided into cells: a range of lengths in a rectangle of directions. For the box around a cell, a point x
/// with r + s > 1 is searched; if none is found, the cell is divided in two. All translations shorter than
/// the remaining cells are proven. Near the shortest separating translation, cells are flat across it, as its
/// neighbours are.
///
/// Branch and bound over the translations of B. Steps:
/// 1. Take the cell of the shortest translations. All shorter ones are proven.
/// 2. Search for a point whose clearances in A and, moved back, in B add up to more than the cell's box:
///    sample near known points, then climb to larger clearance.
/// 3. If such a point is found, the cell is proven; otherwise divide it, across the axis that counts most for
///    the clearances.
///
/// Rounding. Clearances are proven for the doubles x and x - v as computed (the latter is rounded by less
/// than kDifferenceRounding), and the bodies' points are within kUnitRounding of the exact ones; kRoomMargin
/// covers both. Boxes are larger than cells by more than the rounding of their sides.

#include <algorithm>
#include <array>
#include <utility>

#include "engine/clash/clash_parts.hpp"
#include "engine/clash/clash_tolerances.hpp"

namespace lrb {
namespace {

/// Relative excess of a box over its cell.
constexpr double kBoxExcess = 1 + 0x1p-40;

template <class Cell>
bool is_later(const Cell& x, const Cell& y) {
  return x.low[0] > y.low[0];
}

}  // namespace

OverlapProof::OverlapProof(const SurfaceDistance& a, const SurfaceDistance& b, IsInside is_inside)
    : a_(a), b_(b), is_inside_(std::move(is_inside)) {}

/// Adds a cell, with the box around it.
void OverlapProof::push(Cell cell) {
  const int axis = static_cast<int>(cell.face / 2);
  const auto ray = [&](double s, double t) {
    Vector3d g;
    g[axis] = cell.face % 2 == 0 ? 1 : -1;
    g[(axis + 1) % 3] = s;
    g[(axis + 2) % 3] = t;
    return g;
  };
  // The box's axes: the direction in the middle, along the longer side of the rectangle, and across both.
  cell.longer = cell.high[1] - cell.low[1] > cell.high[2] - cell.low[2] ? 1 : 2;
  Eigen::Matrix3d axes;
  axes.col(0) = ray((cell.low[1] + cell.high[1]) / 2, (cell.low[2] + cell.high[2]) / 2).normalized();
  axes.col(2) = axes.col(0).cross(Vector3d::Unit((axis + cell.longer) % 3)).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  // The cell is between two planes across the middle, inside the rays through the corners of its rectangle.
  Vector3d rays[4];
  double cosine = 1;
  for (int i = 0; i < 4; ++i) {
    const Vector3d g = ray(i & 1 ? cell.high[1] : cell.low[1], i & 2 ? cell.high[2] : cell.low[2]);
    const double along = axes.col(0).dot(g);
    cosine = std::min(cosine, along / g.norm());
    rays[i] = axes.transpose() * g / along;
  }
  Eigen::AlignedBox3d box;
  for (const Vector3d& g : rays)
    for (const double length : {cell.low[0] * cosine, cell.high[0]}) box.extend(length * g);
  cell.bulge = cell.low[0] * (1 - cosine);
  cell.centre = axes * box.center();
  const Vector3d half = (0.5 * kBoxExcess * box.sizes()).array() + kRoomMargin;
  cell.norm = {axes * half.asDiagonal(), half.cwiseInverse().asDiagonal() * axes.transpose(),
               half.minCoeff()};
  // Push to a binary min-heap by the least length.
  cells_.push_back(std::move(cell));
  std::push_heap(cells_.begin(), cells_.end(), is_later<Cell>);
}

/// Divides a cell in two. near: a point for its centre, or for another translation if none was found.
void OverlapProof::split(const Cell& cell, const Common& near) {
  // Without a point, across the longest axis.
  Vector3d share = cell.norm.edges.colwise().norm();
  if (near.room() > 0) share = near.blocked;
  int axis = 0;
  share.maxCoeff(&axis);
  // Directions from 0 would be needles, and shorter lengths do not make a box flatter that bulges.
  if (cell.high[0] > 2 * cell.low[0])
    axis = 0;
  else if (axis == 0 && cell.high[0] - cell.low[0] < cell.bulge)
    axis = 1;
  const int along = axis == 0 ? 0 : axis == 1 ? cell.longer : 3 - cell.longer;
  Cell parts[2] = {cell, cell};
  parts[0].high[along] = parts[1].low[along] = 0.5 * (cell.low[along] + cell.high[along]);
  for (Cell& part : parts) {
    part.near = near;
    push(std::move(part));
  }
}

bool OverlapProof::begin(const std::vector<Vector3d>& common, double most) {
  most_ = most;
  // Seeds: points located exactly inside both bodies, with some clearance in each.
  for (const Vector3d& x : common) {
    Common at;
    at.x = at.of_b = x;
    if (std::min(a_.at(x, {}), b_.at(x, {})) > kRoomMargin && is_inside_(Side::a, x) &&
        is_inside_(Side::b, x))
      found_.push_back(at);
  }
  first_ = found_.size();
  // All directions, by the faces of a cube.
  for (unsigned face = 0; face < 6 && first_ > 0; ++face)
    push({face, {0, -1, -1}, {most, 1, 1}, found_[0], {}, {}});
  return first_ > 0;
}

/// Returns true if x is inside. If one of two boxes without surface points contains the centre of the other,
/// both are on the same side of the surface.
bool OverlapProof::is_in(Side side, const Cell& cell, const Vector3d& x, double clear, const Vector3d& known,
                         double known_clear) {
  const double margin = kRoomMargin / cell.norm.least_half;
  if (!(clear > margin)) return false;
  // A box often avoids the exact point location, which is far slower.
  return cell.norm(x - known) < std::max(clear, known_clear) - margin || is_inside_(side, x);
}

/// Evaluates x for the centre v of a cell. Returns false unless x is in A and x - v in B, with more clearance
/// than `least`. near: a nearby common point.
bool OverlapProof::evaluate(const Cell& cell, const Vector3d& x, const Common& near, const Common& least,
                            Common& out) {
  ++points_;
  out.x = x;
  out.shift = cell.centre;
  // B is translated by v: it contains x if the original B contains x - v.
  out.of_b = x - cell.centre;
  // An estimate from the way of the point: where it is wrong at() returns 0, which is no wrong clearance.
  const double enough = least.room() * (1 + kClearlyMore) - 64 * kRoomMargin / cell.norm.least_half;
  Vector3d normal_a = Vector3d::Zero(), normal_b = normal_a;
  out.clear_a = a_.at(out.x, cell.norm, enough - least.clear_b - cell.norm(out.of_b - least.of_b), &normal_a);
  out.clear_b = b_.at(out.of_b, cell.norm, enough - out.clear_a, &normal_b);
  if (!has_more(out, least)) return false;
  out.blocked = normal_a + normal_b;
  // Inside with certainty: by the boxes of the nearby point, or by exact location.
  return is_in(Side::a, cell, out.x, out.clear_a, near.x, near.clear_a) &&
         is_in(Side::b, cell, out.of_b, out.clear_b, near.of_b, near.clear_b);
}

/// Moves a point along the axes to larger clearance (compass search). It does not move away from the nearest
/// points of the surfaces, because the choice among equally near ones depends on the triangulation.
void OverlapProof::climb(const Cell& cell, double needed, Common& best) {
  // Halve the step until the clearance suffices, or until steps are too small to matter.
  for (double step = needed / 2; step > needed * kMinClimb && !(best.room() > needed); step /= 2) {
    // A large cell with little clearance is divided rather than searched.
    if (!is_small(cell) && !(best.room() > needed * kNearlyEnough)) return;
    for (int k = 0; k < 3; ++k)
      for (const double sign : {1.0, -1.0}) {
        Common next;
        if (!evaluate(cell, best.x + sign * step * cell.norm.edges.col(k), best, best, next)) continue;
        // Take the first gain on an axis.
        best = next;
        break;
      }
  }
}

/// Adds starting points of the search for a cell: those of the nearest proven cells, and for a small cell
/// also samples of all known and of the initial points.
void OverlapProof::add_seeds(const Cell& cell, std::vector<Common>& out) const {
  // The kSeeds nearest translations, by insertion into a short sorted array.
  std::array<std::pair<double, const Common*>, kSeeds> nearest;
  nearest.fill({kUnitReach * kUnitReach, nullptr});
  for (const Common& known : found_) {
    const double far = (cell.centre - known.shift).squaredNorm();
    if (!(far < nearest.back().first)) continue;
    std::size_t at = kSeeds - 1;
    for (; at > 0 && far < nearest[at - 1].first; --at) nearest[at] = nearest[at - 1];
    nearest[at] = {far, &known};
  }
  for (const auto& [far, known] : nearest)
    if (known != nullptr) out.push_back(*known);
  // The remaining gap is small: search more before dividing, from samples of all known points.
  if (is_small(cell))
    for (std::size_t i = 0; i < kOtherSeeds; ++i) {
      out.push_back(found_[i * found_.size() / kOtherSeeds]);
      out.push_back(found_[i * first_ / kOtherSeeds]);
    }
}

/// Searches from a seed for a point with the clearance needed.
bool OverlapProof::find_room(const Cell& cell, double needed, const Common& seed, Common& best) {
  const Vector3d moved = cell.centre - seed.shift;
  bool found = false;
  // The seed's clearances are in another norm.
  Common start, from = seed;
  from.clear_a = from.clear_b = 0;
  // From the seed's translation to the cell's, the point moves by half, stays with A, or follows B.
  for (const double share : {0.5, 0.0, 1.0}) {
    Common at;
    if (!evaluate(cell, seed.x + share * moved, from, start, at)) continue;
    start = at;
    found = true;
    // Good enough to climb from.
    if (start.room() > needed * kNearlyEnough) break;
  }
  if (!found) return false;
  climb(cell, needed, start);
  // The best point is kept even if it does not suffice: the cell's parts start from it.
  if (has_more(start, best)) best = start;
  return start.room() > needed;
}

/// Proves that the bodies overlap for a cell. best: set to the point with the largest clearance found.
bool OverlapProof::prove(const Cell& cell, Common& best) {
  const double needed = 1 + kRoomMargin / cell.norm.least_half;
  std::vector<Common> seeds{cell.near};  // the others only if this one does not suffice
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    if (find_room(cell, needed, seeds[i], best)) {
      // Proven cells are seeds for their neighbours.
      found_.push_back(best);
      return true;
    }
    // A large cell with a fair point: its parts need less clearance, so divide.
    if (best.room() > needed * kNearlyEnough && !is_small(cell)) return false;
    if (i == 0) add_seeds(cell, seeds);
  }
  return false;
}

unsigned OverlapProof::grow(unsigned max_points) {
  const unsigned before = points_;
  while (!cells_.empty() && points_ - before < max_points) {
    // The cell nearest to 0 bounds the proven translations.
    const Cell cell = cells_.front();
    lower_ = std::max(lower_, cell.low[0]);
    // Too small to be worth dividing: the proof ends.
    if (cell.norm.least_half < kMinCell) return points_ - before;
    std::pop_heap(cells_.begin(), cells_.end(), is_later<Cell>);
    cells_.pop_back();
    // The parent's point, with clearance 0: any point found for this cell counts as better.
    Common near = cell.near;
    near.clear_a = near.clear_b = 0;
    if (prove(cell, near)) continue;
    split(cell, near);
  }
  // Everything shorter than the nearest cell is proven; without cells, everything below `most`.
  lower_ = std::max(lower_, std::min(cells_.empty() ? most_ : cells_.front().low[0], most_));
  return points_ - before;
}

}  // namespace lrb
