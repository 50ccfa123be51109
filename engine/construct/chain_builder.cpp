#include "engine/construct/chain_builder.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/chain_cap.hpp"
#include "engine/construct/complex_builder.hpp"
#include "engine/construct/convex_polygon.hpp"
#include "engine/construct/fitting.hpp"
#include "engine/construct/hull_loops.hpp"
#include "engine/construct/hull_regions.hpp"
#include "engine/construct/pass_counter.hpp"
#include "engine/core/tolerances.hpp"
#include "engine/exact/simplex_test.hpp"
#include "engine/mesh/point_inside.hpp"
#include "engine/mesh/volume_sign.hpp"

namespace lrb::construct {
namespace {

using Slot = HullLoops::Slot;
using Vector3 = Eigen::Vector3d;
using Box = Eigen::AlignedBox3d;

class ChainBuilder {
 public:
  ChainBuilder(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options)
      : options_(options),
        max_outer_(std::min(options.max_outer_faces, kMostOuter)),
        hull_(mesh),
        complex_(mesh),
        frozen_(mesh.face_count(), false),
        boxes_(hull_.component_count()),
        passes_(options) {
    for (const FaceId f : meeting) frozen_[f] = true;
    for (Slot s = 0; s < hull_.slot_count(); ++s) boxes_[hull_[s].component].extend(box_of(hull_, s));
    find_nesting(mesh);
  }

  LrbData run() {
    plan_polygon();
    if (!options_.lean) fit();
    simplify(kCapWorth);
    simplify(kLastCapWorth);
    if (outer_size() > max_outer_ && bridge()) simplify(kLastCapWorth);
    fill_voids(hull_, home_, passes_.layer(), complex_);
    if (outer_size() > max_outer_) close();
    return complex_.finish(true, false);
  }

 private:
  bool is_outer(Slot s) const { return home_[hull_[s].component] == kNull; }

  std::vector<Slot> outer_slots() const {
    std::vector<Slot> slots = hull_.alive_slots();
    std::erase_if(slots, [&](Slot s) { return !is_outer(s); });
    return slots;
  }

  std::uint32_t outer_size() const { return static_cast<std::uint32_t>(outer_slots().size()); }

  std::vector<Vector3> outer_points() const {
    std::vector<Vector3> points;
    for (const Slot s : outer_slots()) points.push_back(hull_.start(s));
    return points;
  }

  /// Finds the hole in front of each component: the component itself if it is a hole, kNull for the outside.
  void find_nesting(const Mesh& mesh) {
    const std::uint32_t count = hull_.component_count();
    std::vector<std::vector<FaceId>> faces(count);
    for (Slot s = 0; s < hull_.slot_count(); ++s) faces[hull_[s].component].push_back(hull_[s].face);
    home_.assign(count, kNull);
    for (std::uint32_t c = 0; c < count; ++c)
      if (volume_sign(mesh, faces[c]) < 0) home_[c] = c;
    std::vector<std::uint32_t> component_of(mesh.face_count(), kNull);
    for (std::uint32_t c = 0; c < count; ++c)
      for (const FaceId f : faces[c]) component_of[f] = c;
    const SideFinder finder(mesh, std::move(component_of));
    std::vector<std::vector<std::uint32_t>> holders(count);  // of a component's first vertex, ascending
    for (std::uint32_t c = 0; c < count; ++c)
      for (const SideFinder::Side& s : finder.sides(mesh.vertices[mesh.face(faces[c][0])[0]]))
        if (s.side == PointSide::inside && boxes_[s.surface].contains(boxes_[c]))
          holders[c].push_back(s.surface);
    const auto is_inside = [&](std::uint32_t inner, std::uint32_t outer) {
      return std::binary_search(holders[inner].begin(), holders[inner].end(), outer);
    };
    const std::vector<std::uint32_t> holes = home_;
    for (std::uint32_t c = 0; c < count; ++c) {
      if (holes[c] != kNull) continue;
      for (const std::uint32_t h : holders[c])
        if (holes[h] == h && (home_[c] == kNull || is_inside(h, home_[c]))) home_[c] = h;
    }
  }

  /// Plans the outermost wrapper first, so that all hulls stay inside it.
  void plan_polygon() {
    const auto points = outer_points();
    polygon_ = enclosing_polygon(points, max_outer_, kPolytopeDistance);
    Box box;
    for (const Vector3& p : polygon_) box.extend(p);
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      const Vector3 &a = polygon_[i], &b = polygon_[(i + 1) % polygon_.size()];
      const Vector3 n = Vector3(a.y() - b.y(), b.x() - a.x(), 0).normalized();
      bounds_.push_back({n, n.dot(a) + kHullDistance * box.sizes().maxCoeff()});
    }
  }

  void fit() {
    Box box;
    for (const Box& b : boxes_) box.extend(b);
    fit_hulls(
        box.sizes().maxCoeff(), frozen_.size(), kFitDownTo, [&] { return hull_.segment_count(); },
        [&](const CapGoal& goal) { pass(goal); });
  }

  void simplify(double worth) {
    for (;;) {
      const std::uint32_t before = hull_.segment_count();
      if (before <= max_outer_) return;
      pass({worth});
      if (hull_.segment_count() > kLeastGain * before) return;
    }
  }

  /// Puts on the caps that add least area for each segment they save, on chains that do not overlap.
  void pass(const CapGoal& goal) {
    const std::vector<Slot> slots = hull_.alive_slots();
    std::vector<Box> slot_boxes(hull_.slot_count());
    for (const Slot s : slots) slot_boxes[s] = box_of(hull_, s);
    AabbTree tree(slots, slot_boxes);
    struct Proposal {
      double cost;
      ChainCap cap;
    };
    std::vector<Proposal> proposals;
    std::vector<bool> taken(hull_.slot_count(), false);
    for (const Slot s : slots) taken[s] = hull_[s].face < frozen_.size() && frozen_[hull_[s].face];
    const std::uint32_t longest = std::max(options_.patch_interior / 4, 1u) + 1;
    for (const Slot s : slots) {
      std::uint32_t length = 1;
      for (Slot t = s; length <= longest && !taken[t] && hull_[t].next != s; t = hull_[t].next, ++length) {
        if (length < 2) continue;
        auto cap = find_cap(hull_, s, length, bounds_, kCapVolumeLimit);
        if (!cap || (cap->apex && length < 3)) continue;
        const double saved = length - (cap->apex ? 2.0 : 1.0);
        if ((cap->apex ? 2.0 : 1.0) > goal.worth * length) continue;
        if (goal.off > 0 && !measure_cap(hull_, *cap, goal.off)) continue;
        proposals.push_back({cap->area / saved, *cap});
      }
    }
    std::stable_sort(proposals.begin(), proposals.end(),
                     [](const Proposal& p, const Proposal& q) { return p.cost < q.cost; });
    for (const Proposal& p : proposals) {
      const auto chain = chain_of_untaken(p.cap, taken);
      if (chain.empty() || !chain_cap_is_clear(hull_, tree, p.cap, boxes_)) continue;
      for (const Slot s : replace(p.cap, chain)) {
        taken[s] = true;
        tree.update(s, box_of(hull_, s));
      }
      for (const Slot s : chain) taken[s] = true;
    }
    end_pass();
  }

  /// Returns the cap's chain if all of it is still there and free, else nothing.
  std::vector<Slot> chain_of_untaken(const ChainCap& cap, const std::vector<bool>& taken) const {
    std::vector<Slot> chain;
    for (Slot s = cap.first; chain.size() < cap.length; s = hull_[s].next) {
      if (taken[s]) return {};
      chain.push_back(s);
    }
    return chain;
  }

  std::vector<Slot> replace(const ChainCap& cap, const std::vector<Slot>& chain) {
    const RegionId region = complex_.add_region(passes_.layer());
    for (const Slot s : chain) complex_.set_outer_cell(hull_[s].face, region);
    const VertexId a = hull_[chain.front()].a, b = hull_[chain.back()].b;
    std::vector<VertexId> corners = {a, b};
    if (cap.apex) corners = {a, hull_.add_point(*cap.apex, cap.apex_off), b};
    if (cap.apex) complex_.add_vertex(*cap.apex);
    std::vector<Slot> added = add_segments(chain, corners, region);
    for (std::size_t i = 0; i < added.size(); ++i) hull_.set_extra(added[i], cap.extra[i]);
    return added;
  }

  /// Puts the polyline in place of the chain, with the region behind it.
  std::vector<Slot> add_segments(const std::vector<Slot>& chain, const std::vector<VertexId>& corners,
                                 RegionId region) {
    const Slot before = hull_[chain.front()].prev, after = hull_[chain.back()].next;
    const std::uint32_t component = hull_[chain.front()].component;
    hull_.remove(chain);
    std::vector<Slot> added;
    Slot last = before;
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
      const VertexId ends[2] = {corners[i], corners[i + 1]};
      hull_.place(chain[i], ends[0], ends[1], complex_.add_pseudo_face(ends, region, kOutside), component);
      hull_.join(last, chain[i]);
      last = chain[i];
      added.push_back(last);
    }
    hull_.join(last, after);
    return added;
  }

  /// Makes regions of the pockets between a single outline and its convex hull.
  bool bridge() {
    const std::vector<Slot> slots = outer_slots();
    for (const Slot s : slots)
      if (hull_[s].component != hull_[slots[0]].component) return false;
    // Use positions along the outline, so that a side of the hull covers the chain between its ends.
    const std::vector<Slot> outline = chain_of(hull_, slots[0], static_cast<std::uint32_t>(slots.size()));
    std::vector<Vector3> points;
    for (const Slot s : outline) points.push_back(hull_.start(s));
    std::vector<std::uint32_t> corners = convex_outline(points);
    if (corners.size() < 3) return false;
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    if (!std::is_sorted(corners.begin(), corners.end())) return false;  // the outline crosses itself
    std::vector<ChainCap> caps;
    std::vector<Box> slot_boxes(hull_.slot_count());
    for (const Slot s : hull_.alive_slots()) slot_boxes[s] = box_of(hull_, s);
    const AabbTree tree(hull_.alive_slots(), slot_boxes);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t next =
          i + 1 < corners.size() ? corners[i + 1] : corners[0] + static_cast<std::uint32_t>(points.size());
      const ChainCap cap{outline[corners[i]], next - corners[i], std::nullopt, 0, 0, {0, 0}};
      if (cap.length < 2) continue;
      if (!chain_cap_is_clear(hull_, tree, cap, boxes_)) return false;
      caps.push_back(cap);
    }
    for (const ChainCap& cap : caps) replace(cap, chain_of(hull_, cap.first, cap.length));
    if (!caps.empty()) end_pass();
    return !caps.empty();
  }

  void close() {
    const auto points = outer_points();
    const auto holds_all = [&] {
      return !polygon_.empty() && std::all_of(points.begin(), points.end(),
                                              [&](const Vector3& p) { return holds_2d(polygon_, p); });
    };
    if (!holds_all()) polygon_ = enclosing_polygon(points, max_outer_, kPolytopeDistance);
    if (!holds_all()) return;
    enclose(hull_, home_, outline_mesh(polygon_), passes_.layer(), complex_);
    end_pass();
  }

  static Mesh outline_mesh(const std::vector<Vector3>& polygon) {
    Mesh mesh;
    mesh.dim = 2;
    mesh.vertices = polygon;
    const auto count = static_cast<std::uint32_t>(polygon.size());
    for (VertexId v = 0; v < count; ++v) mesh.add_face(std::array{v, VertexId((v + 1) % count)});
    return mesh;
  }

  void end_pass() { passes_.end_pass(complex_, hull_.segment_count()); }

  static constexpr std::uint32_t kMostOuter = 8;  ///< segments of the outermost wrapper
  /// Fitting ends when the hull has no more segments than this.
  static constexpr std::uint32_t kFitDownTo = 16;
  /// A pass that leaves a larger share of the segments is the last.
  static constexpr double kLeastGain = 0.95;

  const BuildOptions& options_;
  const std::uint32_t max_outer_;
  HullLoops hull_;
  ComplexBuilder complex_;
  std::vector<bool> frozen_;         ///< (|real faces|) true for faces that meet others
  std::vector<Box> boxes_;           ///< (components)
  std::vector<std::uint32_t> home_;  ///< (components)
  std::vector<Vector3> polygon_;
  std::vector<HalfSpace> bounds_;
  PassCounter passes_;
};

}  // namespace

LrbData build_by_chains(const Mesh& mesh, const std::vector<FaceId>& meeting, const BuildOptions& options) {
  return ChainBuilder(mesh, meeting, options).run();
}

}  // namespace lrb::construct
