// A pass in batches: grow disjoint patches in order, make their caps in parallel, apply them in order. A cap
// is made again if an earlier one of its batch changed space that its proof depends on, so the result is
// identical to the serial algorithm.

#include "engine/construct/patch_pass.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "engine/core/tolerances.hpp"

namespace lrb::construct {
namespace {

using Slot = FrontMesh::Slot;
using Corner = FrontMesh::Corner;

/// Patches per batch and thread. Batches rarely get longer before two of their patches touch.
constexpr std::size_t kBatchPerThread = 32;

}  // namespace

PatchPass::PatchPass(FrontMesh& front, AabbTree& tree, ComplexBuilder& complex, const BodyBounds& bounds,
                     const std::vector<bool>& frozen, const std::vector<Eigen::AlignedBox3d>& component_boxes,
                     Workers& workers, ConstructProbe* probe)
    : front_(front), complex_(complex), frozen_(frozen), workers_(workers), tree_(tree), probe_(probe) {
  // Scratch memory per worker. One worker needs no batches.
  for (unsigned w = 0; w < workers.count(); ++w)
    benches_.push_back(std::make_unique<Bench>(front, tree_, bounds, component_boxes));
  jobs_.resize(workers.count() == 1 ? 1 : kBatchPerThread * workers.count());
}

/// Excludes the faces that no patch may contain. Returns their number.
std::uint32_t PatchPass::bar_faces(PatchGrower& grower) const {
  std::uint32_t excluded = 0;
  for (Slot s = 0; s < front_.slot_count(); ++s) {
    if (!front_.alive(s)) continue;
    const bool frozen = front_[s].face < frozen_.size() && frozen_[front_[s].face];
    if (!frozen && !front_.is_crowded(s)) continue;
    grower.take(s);
    ++excluded;
  }
  return excluded;
}

/// Returns the used vertices in random order.
std::vector<Corner> PatchPass::find_seeds(Random& random) const {
  std::vector<Corner> seeds;
  for (Corner v = 0; v < front_.point_count(); ++v)
    if (front_.degree(v) > 0) seeds.push_back(v);
  random.shuffle(seeds);
  return seeds;
}

PassEnd PatchPass::run(const GrowLimits& limits, double worth, std::uint16_t layer, Random& random) {
  PassEnd end;
  PatchGrower grower(front_, limits);
  end.excluded = bar_faces(grower);
  tried_.assign(front_.point_count(), false);
  seeds_ = find_seeds(random);
  next_seed_ = 0;
  no_patch_ = 0;
  while (next_seed_ < seeds_.size()) {
    // Step 1: a batch of disjoint patches, then all of their caps in parallel on the unchanged front.
    grow_batch(grower);
    workers_.for_each(batch_,
                      [&](std::size_t i, unsigned worker) { make_cap(jobs_[i], worth, *benches_[worker]); });
    // Step 2: apply them in order, repairing those whose proof is out of date.
    changed_.clear();
    for (std::size_t i = 0; i < batch_; ++i) {
      Job& job = jobs_[i];
      const auto touches = [&](const Eigen::AlignedBox3d& box) { return box.intersects(job.seen); };
      if (std::any_of(changed_.begin(), changed_.end(), touches)) make_cap(job, worth, *benches_[0]);
      end.no_patch += job.no_patch;
      if (probe_) notify(job);
      if (job.has_cap) put_on(job, layer, grower);
    }
  }
  end.no_patch += no_patch_;
  return end;
}

void PatchPass::grow_batch(PatchGrower& grower) {
  grower.begin_batch();
  batch_ = 0;
  for (; next_seed_ < seeds_.size() && batch_ < jobs_.size(); ++next_seed_) {
    const Corner seed = seeds_[next_seed_];
    if (tried_[seed] || front_.degree(seed) == 0) continue;
    Patch& patch = jobs_[batch_].patch;
    const bool grown = grower.grow(seed, patch);
    // Its growth depends on an earlier patch of the batch: it starts the next batch.
    if (grower.met_batch()) return;
    if (!grown) {
      ++no_patch_;
      continue;
    }
    for (const Corner v : patch.interior) tried_[v] = true;
    grower.add_to_batch(patch);
    jobs_[batch_].no_patch = std::exchange(no_patch_, 0);
    ++batch_;
  }
}

void PatchPass::make_cap(Job& job, double worth, Bench& bench) const {
  // Record what the proof reads, to detect conflicts within the batch.
  bench.check.forget_seen();
  find_cap(job, worth, bench);
  job.seen = bench.check.seen();
  if (job.has_cap) job.sheet = make_sheet(front_, job.patch, bench.cap);
}

/// Finds a cap, at first with a single proof for the finished cap. If that fails because of an intersection,
/// tries again with a proof for each collapse.
void PatchPass::find_cap(Job& job, double worth, Bench& bench) const {
  job.has_cap = false;
  job.tries = 0;
  // Optimistic first: one proof for the finished cap. The careful attempt proves each collapse, and costs
  // more.
  for (const bool careful : {false, true}) {
    CapVerdict verdict = simplify(job.patch, worth, bench, careful);
    const bool is_simple = verdict == CapVerdict::accepted;
    if (is_simple) verdict = bench.check.judge_cap(job.patch, bench.cap);
    const auto added = static_cast<std::uint32_t>(bench.cap.new_faces());
    const auto kept = static_cast<std::uint32_t>(bench.cap.alive_faces()) - added;
    const auto covered = static_cast<std::uint32_t>(job.patch.slots.size()) - kept;
    job.tried[job.tries++] = {added, covered, verdict, careful, -1};
    job.has_cap = verdict == CapVerdict::accepted;
    if (job.has_cap || !is_simple) break;
  }
}

/// Simplifies the patch into a cap that is worth a region. Intersections with the front are checked after
/// each collapse if `careful`, otherwise not at all.
CapVerdict PatchPass::simplify(const Patch& patch, double worth, Bench& bench, bool careful) const {
  CapSurface& cap = bench.cap;
  cap.load(front_, patch, static_cast<VertexId>(complex_.vertices().size()));
  const double area = cap.patch_area();
  // The volume limit scales with area^1.5, so it is independent of the body's size.
  PatchCap::Limits limits;
  limits.volume = kCapVolumeLimit * area * std::sqrt(area);
  limits.check = careful ? &bench.check : nullptr;
  bench.collapse.simplify(patch, limits);
  if (!cap.keep_polygons_whole(front_, patch)) return CapVerdict::splits_polygon;
  // Only triangles that were replaced count in the ratio.
  const int kept = cap.alive_faces() - cap.new_faces();
  const int removed = static_cast<int>(patch.slots.size()) - kept;
  if (cap.new_faces() > worth * removed || removed == 0)
    return probe_ ? bench.collapse.what_holds_back() : CapVerdict::too_many_faces;
  return CapVerdict::accepted;
}

void PatchPass::notify(const Job& job) const {
  const Patch& patch = job.patch;
  std::vector<VertexId> vertices;
  for (const Corner c : patch.interior) vertices.push_back(front_.point(c).id);
  probe_->patch({vertices.front(), static_cast<std::uint32_t>(patch.slots.size()),
                 static_cast<std::uint32_t>(vertices.size()), vertices});
  for (std::size_t i = 0; i < job.tries; ++i) probe_->cap(job.tried[i]);
}

void PatchPass::put_on(const Job& job, std::uint16_t layer, PatchGrower& grower) {
  // The box of all triangles that vanish or appear: later proofs of the batch that read from it are repeated.
  Eigen::AlignedBox3d changed;
  for (const Slot s : job.patch.slots) changed.extend(box_of(front_, s));
  const std::uint32_t component = front_[job.patch.slots[0]].component;
  for (const Slot s : cover(front_, complex_, job.sheet, layer, component, probe_)) {
    grower.take(s);
    const Eigen::AlignedBox3d box = box_of(front_, s);
    tree_.update(s, box);
    changed.extend(box);
  }
  for (const Slot s : job.sheet.kept) grower.take(s);
  changed_.push_back(changed);
}

}  // namespace lrb::construct
