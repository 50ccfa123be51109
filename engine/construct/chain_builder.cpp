// The builder in 2D. The front is a set of closed polylines, at first the mesh itself:
// 1. Plan the outermost wrapper, so that no front grows beyond it.
// 2. Passes: propose a cap over every short chain of segments, sort by added area per saved segment, and
//    apply them greedily where they are proven to keep the front embedded.
// 3. Fit first (the maximum deviation grows from pass to pass), then simplify without a limit on the
//    deviation.
// 4. Bridge the pockets to the convex hull if too many segments are left.
// 5. Fill each hole with one region, and close with the wrapper of step 1.

#include <algorithm>
#include <array>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/builders.hpp"
#include "engine/construct/chain_cap.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/construct/convex_hull.hpp"
#include "engine/construct/whole_fronts.hpp"
#include "engine/core/geometry.hpp"
#include "engine/core/tolerances.hpp"
#include <lrbscope/contact.hpp>

namespace lrb::construct {
namespace {

using Slot = FrontLoops::Slot;
using Vector3 = Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

class ChainBuilder : WholeFronts<FrontLoops> {
 public:
  ChainBuilder(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options)
      : WholeFronts(mesh, meeting, options), max_outer_(std::min(options.max_outer_faces, kMaxOuter)) {}

  LrbData run() {
    plan_polygon();
    // Lean bodies skip the fitted levels and start with the largest savings.
    if (!options_.lean) fit();
    // First only caps that save much, then all that save enough to be worth a region.
    simplify(kCapWorth);
    simplify(kLastCapWorth);
    // Bridging changes the shape, so that chains without a cap may have one now.
    if (outer_size() > max_outer_ && bridge()) simplify(kLastCapWorth);
    return finish(max_outer_);
  }

 private:
  std::vector<Slot> outer_slots() const {
    std::vector<Slot> slots = front_.alive_slots();
    std::erase_if(slots, [&](Slot s) { return !is_outer(s); });
    return slots;
  }

  std::vector<Vector3> outer_points() const override {
    std::vector<Vector3> points;
    for (const Slot s : outer_slots()) points.push_back(front_.start(s));
    return points;
  }
  Mesh wrapper_around(std::span<const Vector3> points) override {
    Mesh mesh;
    mesh.dim = 2;
    mesh.vertices = enclosing_polygon(points, max_outer_, kPolytopeDistance);
    // One face for each side, counter-clockwise: the inside is on the left.
    const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
    for (VertexId v = 0; v < count; ++v) mesh.add_face(std::array{v, VertexId((v + 1) % count)});
    return mesh;
  }
  bool wrapper_holds(const Vector3& point) const override { return holds_2d(wrapper_.vertices, point); }

  /// Plans the outermost wrapper first, so that all fronts stay inside it.
  void plan_polygon() {
    // The front is still the mesh itself, so the wrapper is as tight as possible.
    wrapper_ = wrapper_around(outer_points());
    const std::vector<Vector3>& polygon = wrapper_.vertices;
    Box box;
    for (const Vector3& p : polygon) box.extend(p);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vector3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      // The inward normal of a side. The front keeps a small distance, so that rounding cannot move it
      // outside.
      const Vector3 n = normalized3(Vector3(a.y() - b.y(), b.x() - a.x(), 0));
      bounds_.push_back({n, dot3(n, a) + kFrontDistance * box.sizes().maxCoeff()});
    }
  }

  void fit() {
    // The deviations of the schedule are relative to the largest side of the body's box.
    Box box;
    for (const Box& b : component_boxes_) box.extend(b);
    // Later passes at a deviation limit would gain too little.
    constexpr double kGain = 0.8;
    fit_fronts(
        box.sizes().maxCoeff(), kFitDownTo, kGain, [&] { return front_.segment_count(); },
        [&](std::uint32_t before, double deviation) {
          pass(BuildStage::fit, {fitting_worth(before, frozen_.size()), deviation});
        });
  }

  void simplify(double worth) {
    for (;;) {
      const std::uint32_t before = front_.segment_count();
      // Few enough segments.
      if (before <= max_outer_) return;
      pass(BuildStage::simplify, {worth});
      // Diminishing returns.
      if (front_.segment_count() > kMinGain * before) return;
    }
  }

  struct Proposal {
    double cost;
    ChainCap cap;
    CapVerdict verdict;
    VertexId start;  ///< of the chain
  };

  /// Applies the caps that add least area for each saved segment, on chains that do not overlap.
  void pass(BuildStage stage, const CapGoal& goal) {
    // Step 1: an AABB tree over the front, updated with the caps of this pass.
    const std::vector<Slot> slots = front_.alive_slots();
    AabbTree tree(slots, front_.slot_count(), [&](Slot s) { return box_of(front_, s); });
    passes_.report_begin(stage, front_.segment_count(), goal.deviation);
    PassEnd end;
    // Step 2: exclude frozen segments, and below all segments that this pass has covered or made.
    std::vector<bool> taken(front_.slot_count(), false);
    for (const Slot s : slots) {
      taken[s] = front_[s].face < frozen_.size() && frozen_[front_[s].face];
      end.excluded += taken[s];
    }
    // Step 3: greedy selection. An earlier cap may have taken part of the chain, or may be in the way now.
    for (const Proposal& p : find_proposals(slots, taken, goal)) {
      const auto chain = chain_of_untaken(p.cap, taken);
      // Prove against the current front, not the front at the time of the proposal.
      const CapVerdict verdict =
          chain.empty() ? CapVerdict::overlaps : judge_chain_cap(front_, tree, p.cap, component_boxes_);
      report_cap(p, verdict, goal.deviation);
      if (verdict != CapVerdict::accepted) continue;
      for (const Slot s : replace(p.cap, chain)) {
        // New segments are not covered again in this pass, so that a region and the one above it differ in
        // layer.
        taken[s] = true;
        tree.update(s, box_of(front_, s));
      }
      // Also the slots that are empty now.
      for (const Slot s : chain) taken[s] = true;
    }
    end.front_faces = front_.segment_count();
    passes_.report_end(end);
    end_pass();
  }

  /// Returns caps over all chains that are worth it, in ascending order of added area per saved segment.
  std::vector<Proposal> find_proposals(const std::vector<Slot>& slots, const std::vector<bool>& taken,
                                       const CapGoal& goal) const {
    std::vector<Proposal> proposals;
    // The patch size counts vertices in 3D. In 2D a quarter of it, plus one, is the longest chain: O(longest)
    // proposals for each segment.
    const std::uint32_t longest = std::max(options_.patch_interior / 4, 1u) + 1;
    // All chains that start at each segment. They must not overlap taken segments, nor cover the entire loop.
    for (const Slot s : slots) {
      std::uint32_t length = 1;
      std::optional<Proposal> rejected;
      const std::size_t before = proposals.size();
      for (Slot t = s; length <= longest && !taken[t] && front_[t].next != s; t = front_[t].next, ++length) {
        // A single segment cannot be simplified.
        if (length < 2) continue;
        const Proposal p = propose(s, length, goal);
        if (p.verdict == CapVerdict::accepted) proposals.push_back(p);
        // For the probe: of all lengths that failed, the reason that comes first in CapVerdict.
        if (!rejected || p.verdict < rejected->verdict) rejected = p;
      }
      if (rejected && proposals.size() == before) report_cap(*rejected, rejected->verdict, 0);
    }
    // Stable, so that equal costs keep the order of the slots: the result is deterministic.
    std::stable_sort(proposals.begin(), proposals.end(),
                     [](const Proposal& p, const Proposal& q) { return p.cost < q.cost; });
    return proposals;
  }

  /// Finds a cap over a chain. Its verdict is `accepted` if it is worth it, whether or not it intersects the
  /// front.
  Proposal propose(Slot first, std::uint32_t length, const CapGoal& goal) const {
    CapVerdict why = CapVerdict::accepted;
    // The geometry, without regard to the rest of the front.
    auto cap = find_cap(front_, first, length, bounds_, kCapVolumeLimit, why);
    const VertexId start = front_[first].a;
    if (!cap) return {0, ChainCap{first, length, std::nullopt, 0, 0, {0, 0}}, why, start};
    // It must save segments, and enough of them to be worth a region.
    if (cap->segments() >= length || cap->segments() > goal.worth * length)
      return {0, *cap, CapVerdict::too_many_faces, start};
    // Fitting: the deviation must be within this pass's limit.
    if (goal.deviation > 0 && !measure_cap(front_, *cap, goal.deviation))
      return {0, *cap, CapVerdict::too_thick, start};
    // The price of a saved segment.
    return {cap->area / (length - cap->segments()), *cap, CapVerdict::accepted, start};
  }

  /// Reports a proposal. `max_deviation`: maximum deviation of the cap, or 0 if it was not measured.
  void report_cap(const Proposal& p, CapVerdict verdict, double max_deviation) const {
    if (!options_.probe) return;
    const ChainCap& cap = p.cap;
    // Rejected caps have no deviation to report.
    const bool measured = verdict == CapVerdict::accepted && max_deviation > 0;
    // Where another cap took part of the chain, its vertices can no longer be told.
    std::vector<VertexId> vertices;
    if (verdict != CapVerdict::overlaps)
      for (Slot s = front_[cap.first].next; vertices.size() + 1 < cap.length; s = front_[s].next)
        vertices.push_back(front_[s].a);
    options_.probe->patch({p.start, cap.length, cap.length - 1, vertices});
    options_.probe->cap({cap.segments(), cap.length, verdict, false,
                         measured ? std::min(max_deviation, off_of(front_, cap)) : -1});
  }

  /// Returns the cap's chain if all of it still exists and is free, otherwise an empty chain.
  std::vector<Slot> chain_of_untaken(const ChainCap& cap, const std::vector<bool>& taken) const {
    std::vector<Slot> chain;
    for (Slot s = cap.first; chain.size() < cap.length; s = front_[s].next) {
      // The links of taken slots may have changed, but the first taken one ends the traversal.
      if (taken[s]) return {};
      chain.push_back(s);
    }
    return chain;
  }

  std::vector<Slot> replace(const ChainCap& cap, const std::vector<Slot>& chain) {
    // The chain becomes the floor of the new region, which is on its outer side now.
    const RegionId region = complex_.add_region(passes_.layer());
    for (const Slot s : chain) complex_.set_outer_cell(front_[s].face, region);
    // The cap's polyline, with or without an apex. Front and complex number their vertices alike.
    const VertexId a = front_[chain.front()].a, b = front_[chain.back()].b;
    std::vector<VertexId> corners = {a, b};
    if (cap.apex) corners = {a, front_.add_point(*cap.apex, cap.apex_off), b};
    if (cap.apex) complex_.add_vertex(*cap.apex);
    std::vector<Slot> added = add_segments(chain, corners, region);
    for (std::size_t i = 0; i < added.size(); ++i)
      front_.set_excess_deviation(added[i], cap.excess_deviation[i]);
    if (options_.probe) options_.probe->region(region);
    return added;
  }

  /// Replaces the chain by the polyline, with the region behind it.
  std::vector<Slot> add_segments(const std::vector<Slot>& chain, const std::vector<VertexId>& corners,
                                 RegionId region) {
    // Read the neighbours before the chain's slots are emptied.
    const Slot before = front_[chain.front()].prev, after = front_[chain.back()].next;
    const std::uint32_t component = front_[chain.front()].component;
    front_.remove(chain);
    std::vector<Slot> added;
    Slot last = before;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      // The new segments reuse the chain's first slots: a cap has fewer segments than its chain.
      const VertexId ends[2] = {corners[i], corners[i + 1]};
      front_.place(chain[i], ends[0], ends[1], complex_.add_pseudo_face(ends, region, kOutside), component);
      front_.join(last, chain[i]);
      last = chain[i];
      added.push_back(last);
    }
    // Close the loop.
    front_.join(last, after);
    return added;
  }

  /// Makes regions of the pockets between a single outline and its convex hull.
  bool bridge() {
    // Find all pockets first: bridging is accepted or rejected as a whole.
    passes_.report_begin(BuildStage::bridge, front_.segment_count());
    std::vector<ChainCap> caps;
    const CapVerdict verdict = find_bridge(caps);
    std::uint32_t covered = 0;
    for (const ChainCap& cap : caps) covered += cap.length;
    report_whole_cap(static_cast<std::uint32_t>(caps.size()), covered, verdict);
    const bool accepted = verdict == CapVerdict::accepted;
    if (accepted)
      for (const ChainCap& cap : caps) replace(cap, chain_of(front_, cap.first, cap.length));
    passes_.report_end({.front_faces = front_.segment_count()});
    if (accepted) end_pass();
    return accepted;
  }

  /// Finds the sides of the convex hull that are not the outline's own. Returns `accepted` if all can be
  /// accepted.
  CapVerdict find_bridge(std::vector<ChainCap>& caps) const {
    const std::vector<Slot> slots = outer_slots();
    // Pockets between several outlines would connect them, which is not supported in 2D.
    for (const Slot s : slots)
      if (front_[s].component != front_[slots[0]].component) return CapVerdict::several_outlines;
    // Vertices are numbered along the outline, so that a hull side from i to j covers the chain between them.
    const std::vector<Slot> outline = chain_of(front_, slots[0], static_cast<std::uint32_t>(slots.size()));
    std::vector<Vector3> points;
    for (const Slot s : outline) points.push_back(front_.start(s));
    std::vector<std::uint32_t> corners = convex_outline(points);
    if (corners.size() < 3) return CapVerdict::flat;
    // Along a simple polygon, the hull's vertices occur in order.
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    if (!std::is_sorted(corners.begin(), corners.end()))
      return CapVerdict::flat;  // the outline crosses itself
    // An AABB tree over all components for the exact tests.
    const AabbTree tree(front_.alive_slots(), front_.slot_count(), [&](Slot s) { return box_of(front_, s); });
    for (std::size_t i = 0; i < corners.size(); ++i) {
      // The last side wraps around to the first corner.
      const std::uint32_t next =
          i + 1 < corners.size() ? corners[i + 1] : corners[0] + static_cast<std::uint32_t>(points.size());
      const ChainCap cap{outline[corners[i]], next - corners[i], std::nullopt, 0, 0, {0, 0}};
      // A hull side that is a segment of the outline already.
      if (cap.length < 2) continue;
      // The caps cannot intersect each other, as sides of one convex hull, so each is tested alone.
      caps.push_back(cap);
      const CapVerdict verdict = judge_chain_cap(front_, tree, cap, component_boxes_);
      if (verdict != CapVerdict::accepted) return verdict;
    }
    return caps.empty() ? CapVerdict::too_many_faces : CapVerdict::accepted;
  }

  static constexpr std::uint32_t kMaxOuter = 8;  ///< maximum number of segments of the outermost wrapper
  /// Fitting ends when the front has no more segments than this.
  static constexpr std::uint32_t kFitDownTo = 16;
  /// A pass that leaves more than this share of the segments is the last.
  static constexpr double kMinGain = 0.95;

  const std::uint32_t max_outer_;
  std::vector<HalfSpace> bounds_;
};

}  // namespace

LrbData build_by_chains(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options) {
  return ChainBuilder(mesh, meeting, options).run();
}

}  // namespace lrb::construct
