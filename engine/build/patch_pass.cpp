#include "engine/build/patch_pass.hpp"

#include <cmath>

#include "engine/build/hull_update.hpp"
#include "engine/tolerances.hpp"

namespace lrb {
namespace {

using Slot = HullMesh::Slot;
using Corner = HullMesh::Corner;

/// Vertices in use, in random order.
std::vector<Corner> seeds_of(const HullMesh& hull, Random& random) {
  std::vector<Corner> seeds;
  for (Corner v = 0; v < hull.point_count(); ++v)
    if (hull.degree(v) > 0) seeds.push_back(v);
  random.shuffle(seeds);
  return seeds;
}

}  // namespace

PatchPass::PatchPass(HullMesh& hull, ComplexBuilder& complex, const BodyBounds& bounds,
                     const std::vector<bool>& frozen, const std::vector<Eigen::AlignedBox3d>& component_boxes)
    : hull_(hull),
      complex_(complex),
      frozen_(frozen),
      tree_(hull),
      check_(hull, tree_),
      collapse_(cap_, bounds) {
  check_.set_component_boxes(component_boxes);
}

void PatchPass::run(const GrowLimits& limits, double worth, std::uint16_t layer, Random& random) {
  PatchGrower grower(hull_, limits);
  for (Slot s = 0; s < hull_.slot_count(); ++s)
    if (hull_.alive(s) && hull_[s].face < frozen_.size() && frozen_[hull_[s].face]) grower.take(s);
  std::vector<bool> tried(hull_.point_count(), false);
  Patch patch;
  for (const Corner seed : seeds_of(hull_, random)) {
    if (tried[seed] || hull_.degree(seed) == 0 || !grower.grow(seed, patch)) continue;
    for (const Corner v : patch.interior) tried[v] = true;
    if (!make_cap(patch, worth)) continue;
    std::size_t new_count = 0;
    const std::vector<Slot> slots = cover(hull_, complex_, patch, cap_, layer, new_count);
    for (std::size_t i = 0; i < slots.size(); ++i) {
      grower.take(slots[i]);
      if (i < new_count) tree_.update(slots[i], box_of(hull_, slots[i]));
    }
  }
}

/// First without looking at anything but the patch itself; if that cap turns out to hit something, again with
/// a proof for each collapse.
bool PatchPass::make_cap(const Patch& patch, double worth) {
  for (const bool careful : {false, true}) {
    cap_.load(hull_, patch, static_cast<VertexId>(complex_.vertices().size()));
    const double area = cap_.patch_area();
    PatchCap::Limits limits;
    limits.volume = kCapVolumeLimit * area * std::sqrt(area);
    limits.check = careful ? &check_ : nullptr;
    collapse_.simplify(patch, limits);
    if (!cap_.keep_polygons_whole(hull_, patch)) return false;
    const int kept = cap_.alive_faces() - cap_.new_faces();
    const int removed = static_cast<int>(patch.slots.size()) - kept;
    if (cap_.new_faces() > worth * removed || removed == 0) return false;
    if (check_.cap_is_clear(patch, cap_)) return true;
  }
  return false;
}

}  // namespace lrb
