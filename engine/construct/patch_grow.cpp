#include "engine/construct/patch_grow.hpp"

#include <algorithm>

#include "engine/core/geometry.hpp"

namespace lrb::construct {
namespace {

using Slot = FrontMesh::Slot;
using Corner = FrontMesh::Corner;

/// Number of new triangles added to the cost of a candidate at one reach from the seed: keeps patches round.
constexpr double kDistancePenalty = 1.0;

}  // namespace

PatchGrower::PatchGrower(const FrontMesh& front, const GrowLimits& limits)
    : front_(front),
      limits_(limits),
      taken_(front.slot_count(), false),
      slot_stamp_(front.slot_count(), 0),
      point_stamp_(front.point_count(), 0),
      inside_(front.point_count(), 0),
      rejected_(front.point_count(), 0),
      batch_stamp_(front.point_count(), 0) {}

void PatchGrower::begin_batch() {
  ++batch_;
  batch_is_empty_ = true;
}

void PatchGrower::add_to_batch(const Patch& patch) {
  // Stamps mark the vertices of the batch; raising the stamp clears them all at once.
  for (const auto* list : {&patch.ring, &patch.interior})
    for (const Corner v : *list) batch_stamp_[v] = batch_;
  batch_is_empty_ = false;
}

/// Returns true if v is a vertex of a patch of the batch. Vertices newer than the stamps are under caps,
/// which growth never enters.
bool PatchGrower::is_in_batch(Corner v) const {
  return v < batch_stamp_.size() && batch_stamp_[v] == batch_;
}

void PatchGrower::look_for_batch() {
  for (const Slot s : added_)
    for (const Corner v : front_[s].v) met_batch_ = met_batch_ || is_in_batch(v);
}

bool PatchGrower::grow(Corner seed, Patch& patch) {
  patch.slots.clear();
  patch.interior.clear();
  patch.ring.clear();
  patch.outside.clear();
  rim_.clear();
  ++stamp_;
  // Start with the seed's star, then add the star of the best boundary vertex until the patch has enough
  // interior vertices.
  met_batch_ = is_in_batch(seed);
  if (!add_star(seed, patch)) return false;
  double reach_sq = 0;
  for (const Corner v : rim_) reach_sq = std::max(reach_sq, squared_norm3(front_.x(v) - front_.x(seed)));
  // A star that does not fit now is not tried again for this patch.
  while (patch.interior.size() < limits_.interior) {
    const Corner v = best_candidate(seed, reach_sq, patch);
    if (v == kNull) break;
    if (!add_star(v, patch)) rejected_[v] = stamp_;
  }
  find_ring(patch);
  return true;
}

/// Adds the polygons at v that are not in the patch yet, if the patch remains a disk. The new triangles are
/// connected around v and share an edge with the patch, so it remains a disk if and only if its Euler
/// characteristic is unchanged (or, for the first star, becomes 1).
bool PatchGrower::add_star(Corner v, Patch& patch) {
  // Mark first and undo on failure: the Euler characteristic is counted with the new triangles in place.
  const bool free = mark_star(v);
  if (!batch_is_empty_) look_for_batch();
  const std::size_t limit = patch.slots.empty() ? added_.size() : limits_.triangles;
  if (!free || patch.slots.size() + added_.size() > limit) {
    unmark_star();
    return false;
  }
  const std::size_t new_points = add_corners();
  if (euler_change(new_points) != (patch.slots.empty() ? 1 : 0)) {
    take_back_corners(new_points);
    unmark_star();
    return false;
  }
  patch.slots.insert(patch.slots.end(), added_.begin(), added_.end());
  // A vertex with all of its triangles in the patch has become interior.
  std::erase_if(rim_, [&](Corner u) {
    if (inside_[u] < front_.degree(u)) return false;
    patch.interior.push_back(u);
    return true;
  });
  return true;
}

/// Marks the triangles of the polygons at v that are not in the patch yet, and lists them in added_. Returns
/// false if one of them is taken; the list may then be incomplete.
bool PatchGrower::mark_star(Corner v) {
  added_.clear();
  bool free = true;
  front_.for_each_around(v, [&](Slot s, int) {
    if (!free || in_patch(s)) return;
    const auto unit = front_.unit(s);
    for (Slot t = unit.first; t < unit.last && free; ++t) {
      free = !taken_[t];  // taken triangles stay taken
      slot_stamp_[t] = stamp_;
      added_.push_back(t);
    }
  });
  return free;
}

void PatchGrower::unmark_star() {
  for (const Slot s : added_) slot_stamp_[s] = 0;
}

/// Adds the new triangles to the counts at their corners. Returns the number of new corners, which are at the
/// end of rim_.
std::size_t PatchGrower::add_corners() {
  const std::size_t before = rim_.size();
  for (const Slot s : added_) {
    for (const Corner u : front_[s].v) {
      if (point_stamp_[u] != stamp_) {
        point_stamp_[u] = stamp_;
        inside_[u] = 0;
        rim_.push_back(u);
      }
      ++inside_[u];
    }
  }
  return rim_.size() - before;
}

void PatchGrower::take_back_corners(std::size_t new_points) {
  for (const Slot s : added_)
    for (const Corner u : front_[s].v) --inside_[u];
  for (; new_points > 0; --new_points) {
    point_stamp_[rim_.back()] = 0;
    rim_.pop_back();
  }
}

/// Returns the change of the patch's vertices - edges + faces by the new triangles.
std::int64_t PatchGrower::euler_change(std::size_t new_points) const {
  std::size_t among_new = 0, to_old = 0;  // an edge among the new triangles counts twice, from both sides
  for (const Slot s : added_) {
    for (const Slot t : front_[s].across) {
      if (!in_patch(t)) continue;
      const bool is_new = std::find(added_.begin(), added_.end(), t) != added_.end();
      ++(is_new ? among_new : to_old);
    }
  }
  // Euler characteristic: each new triangle brings three edges, less those that are shared.
  const std::size_t new_edges = 3 * added_.size() - among_new / 2 - to_old;
  return static_cast<std::int64_t>(new_points + added_.size()) - static_cast<std::int64_t>(new_edges);
}

Corner PatchGrower::best_candidate(Corner seed, double reach_sq, const Patch& patch) const {
  Corner best = kNull;
  double least = 0;
  for (const Corner v : rim_) {
    if (rejected_[v] == stamp_) continue;
    // The fewest new triangles first; the distance penalty keeps the patch round. Ties go to the lower
    // vertex.
    const std::uint32_t missing = front_.degree(v) - inside_[v];
    if (patch.slots.size() + missing > limits_.triangles) continue;
    const double score =
        missing + kDistancePenalty * (squared_norm3(front_.x(v) - front_.x(seed)) / reach_sq);
    if (best == kNull || score < least || (score == least && v < best)) {
      best = v;
      least = score;
    }
  }
  return best;
}

void PatchGrower::find_ring(Patch& patch) const {
  // Start at any boundary edge and rotate about its end to the next one.
  Slot s = kNull;
  int i = 0;
  for (const Slot t : patch.slots)
    for (int j = 0; j < 3 && s == kNull; ++j)
      if (!in_patch(front_[t].across[j])) s = t, i = j;
  if (s == kNull) return;
  const Corner first = front_[s].v[i];
  do {
    patch.ring.push_back(front_[s].v[i]);
    patch.outside.push_back(front_[s].across[i]);
    const Corner end = front_[s].v[(i + 1) % 3];
    i = (i + 1) % 3;
    while (in_patch(front_[s].across[i])) {
      s = front_[s].across[i];
      i = front_.index_of(s, end);
    }
  } while (front_[s].v[i] != first);
}

}  // namespace lrb::construct
