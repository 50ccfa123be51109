#include "engine/construct/patch_pass.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/tolerances.hpp"

namespace lrb::construct {
namespace {

using Slot = HullMesh::Slot;
using Corner = HullMesh::Corner;

/// Patches of a batch per thread. Longer batches would seldom come about before two of their patches touch.
constexpr std::size_t kBatchPerThread = 32;

/// See PatchCap::Limits::depth; where caps are to fit.
constexpr double kFittingDepth = 10;

/// Where no cap was found, none is tried before it may be this many times as far off, at least. Smaller: more time,
/// most of it in vain.
constexpr double kPatience = 1.2;
/// A pass of caps that fit ends when after this many patches fewer than one in kLeastCaps got a cap: the distance
/// is too small for most of the hull.
constexpr std::size_t kTries = 32, kLeastCaps = 24;

/// Returns the vertices in use at which a cap may be found, in random order.
std::vector<Corner> seeds_of(const HullMesh& hull, double off, Random& random) {
  std::vector<Corner> seeds;
  for (Corner v = 0; v < hull.point_count(); ++v)
    if (hull.degree(v) > 0 && (off == 0 || hull.point(v).patience <= off)) seeds.push_back(v);
  random.shuffle(seeds);
  return seeds;
}

}  // namespace

PatchPass::PatchPass(HullMesh& hull, AabbTree& tree, ComplexBuilder& complex, const BodyBounds& bounds,
                     const std::vector<bool>& frozen, const std::vector<Eigen::AlignedBox3d>& component_boxes,
                     Workers& workers)
    : hull_(hull), complex_(complex), frozen_(frozen), workers_(workers), tree_(tree) {
  for (unsigned w = 0; w < workers.count(); ++w)
    benches_.push_back(std::make_unique<Bench>(hull, tree_, bounds, component_boxes));
  jobs_.resize(workers.count() == 1 ? 1 : kBatchPerThread * workers.count());
}

void PatchPass::run(const GrowLimits& limits, const CapGoal& goal, std::uint16_t layer, Random& random) {
  PatchGrower grower(hull_, limits);
  for (Slot s = 0; s < hull_.slot_count(); ++s)
    if (hull_.alive(s) && ((hull_[s].face < frozen_.size() && frozen_[hull_[s].face]) || hull_.is_crowded(s)))
      grower.take(s);
  tried_.assign(hull_.point_count(), false);
  seeds_ = seeds_of(hull_, goal.off, random);
  next_seed_ = 0;
  std::size_t tried = 0, found = 0;
  while (next_seed_ < seeds_.size()) {
    grow_batch(grower);
    workers_.for_each(batch_,
                      [&](std::size_t i, unsigned worker) { make_cap(jobs_[i], goal, *benches_[worker]); });
    changed_.clear();
    for (std::size_t i = 0; i < batch_; ++i) {
      Job& job = jobs_[i];
      const auto touches = [&](const Eigen::AlignedBox3d& box) { return box.intersects(job.seen); };
      if (std::any_of(changed_.begin(), changed_.end(), touches)) make_cap(job, goal, *benches_[0]);
      if (job.has_cap) put_on(job, layer, grower);
      if (goal.off == 0) continue;
      ++tried;
      found += job.has_cap;
      if (!job.has_cap)
        for (const Corner v : job.patch.interior) hull_.set_patience(v, job.next_off);
      if (tried >= kTries && kLeastCaps * found < tried) return;
    }
  }
}

void PatchPass::grow_batch(PatchGrower& grower) {
  grower.begin_batch();
  batch_ = 0;
  for (; next_seed_ < seeds_.size() && batch_ < jobs_.size(); ++next_seed_) {
    const Corner seed = seeds_[next_seed_];
    if (tried_[seed] || hull_.degree(seed) == 0) continue;
    Patch& patch = jobs_[batch_].patch;
    const bool grown = grower.grow(seed, patch);
    if (grower.met_batch()) return;
    if (!grown) continue;
    for (const Corner v : patch.interior) tried_[v] = true;
    grower.add_to_batch(patch);
    ++batch_;
  }
}

void PatchPass::make_cap(Job& job, const CapGoal& goal, Bench& bench) const {
  bench.check.forget_seen();
  job.has_cap = find_cap(job.patch, goal, bench);
  if (goal.off > 0 && !job.has_cap) job.next_off = goal.off * patience(job.patch, bench.cap, goal.worth);
  job.seen = bench.check.seen();
  if (job.has_cap) job.sheet = make_sheet(hull_, job.patch, bench.cap);
}

/// Finds a cap, at first without looking at anything but the patch itself; if that cap turns out to hit
/// something, tries again with a proof for each collapse.
bool PatchPass::find_cap(const Patch& patch, const CapGoal& goal, Bench& bench) const {
  CapSurface& cap = bench.cap;
  for (const bool careful : {false, true}) {
    cap.load(hull_, patch, static_cast<VertexId>(complex_.vertices().size()));
    const double area = cap.patch_area();
    PatchCap::Limits limits;
    limits.volume = kCapVolumeLimit * area * std::sqrt(area);
    limits.check = careful ? &bench.check : nullptr;
    if (goal.off > 0) {
      bench.gauge.load(hull_, patch, cap, goal.off);
      limits.gauge = &bench.gauge;
      limits.depth = kFittingDepth;
    }
    bench.collapse.simplify(patch, limits);
    if (!cap.keep_polygons_whole(hull_, patch)) return false;
    const int kept = cap.alive_faces() - cap.new_faces();
    const int removed = static_cast<int>(patch.slots.size()) - kept;
    if (cap.new_faces() > goal.worth * removed || removed == 0) return false;
    if (limits.gauge && hull_.has_polygons() && !bench.gauge.measure_again(cap)) return false;
    if (bench.check.cap_is_clear(patch, cap)) return true;
  }
  return false;
}

/// Returns how many times as far off a cap must be allowed to be before there may be one where there is none now.
/// The faces that are needed fall about in proportion to the distance, so that is by how much those of the cap that
/// was not worth it are too many. (Trying at each distance takes a third more time for the same hulls.)
double PatchPass::patience(const Patch& patch, const CapSurface& cap, double worth) {
  return std::max(kPatience, cap.alive_faces() / (worth * static_cast<double>(patch.slots.size())));
}

void PatchPass::put_on(const Job& job, std::uint16_t layer, PatchGrower& grower) {
  Eigen::AlignedBox3d changed;
  for (const Slot s : job.patch.slots) changed.extend(box_of(hull_, s));
  const std::uint32_t component = hull_[job.patch.slots[0]].component;
  for (const Slot s : cover(hull_, complex_, job.sheet, layer, component)) {
    grower.take(s);
    const Eigen::AlignedBox3d box = box_of(hull_, s);
    tree_.update(s, box);
    changed.extend(box);
  }
  for (const Slot s : job.sheet.kept) grower.take(s);
  changed_.push_back(changed);
}

}  // namespace lrb::construct
