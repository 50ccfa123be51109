#include "engine/build/patch_builder.hpp"

#include <algorithm>
#include <cmath>

#include "engine/build/body_bounds.hpp"
#include "engine/build/complex_builder.hpp"
#include "engine/build/embed_check.hpp"
#include "engine/build/hull_mesh.hpp"
#include "engine/build/patch_cap.hpp"
#include "engine/build/patch_grow.hpp"
#include "engine/build/random.hpp"
#include "engine/build/region_split.hpp"
#include "engine/build/slot_tree.hpp"
#include "engine/tolerances.hpp"

namespace lrb {
namespace {

using Slot = HullMesh::Slot;
using Corner = HullMesh::Corner;

class PatchBuilder {
 public:
  PatchBuilder(const Mesh& mesh, const std::vector<FaceId>& crossing, const BuildOptions& options)
      : options_(options), hull_(mesh), complex_(mesh), bounds_(mesh.vertices), cap_builder_(cap_, bounds_), random_(options.seed) {
    frozen_.assign(mesh.face_count(), false);
    for (const FaceId f : crossing) frozen_[f] = true;
    component_boxes_.resize(hull_.component_count());
    for (Slot s = 0; s < hull_.slot_count(); ++s) component_boxes_[hull_[s].component].extend(box_of(hull_, s));
  }

  LrbData run() {
    for (std::uint32_t before = hull_.triangle_count();; before = hull_.triangle_count()) {
      patch_pass();
      if (options_.progress) options_.progress(++pass_, hull_.triangle_count());
      if (hull_.triangle_count() > before * 0.85) break;
      if (hull_.triangle_count() < 120) break;
    }
    return complex_.finish(true, false);
  }

 private:
  void patch_pass() {
    const SlotTree tree(hull_);
    tree_ = const_cast<SlotTree*>(&tree);
    EmbedCheck check(hull_, tree);
    check.set_component_boxes(component_boxes_);
    PatchGrower grower(hull_, {options_.patch_interior, 4 * options_.patch_interior});
    for (Slot s = 0; s < hull_.slot_count(); ++s)
      if (hull_.alive(s) && hull_[s].face < frozen_.size() && frozen_[hull_[s].face]) grower.take(s);
    std::vector<Corner> seeds;
    for (Corner v = 0; v < hull_.point_count(); ++v)
      if (hull_.degree(v) > 0) seeds.push_back(v);
    random_.shuffle(seeds);
    std::vector<bool> tried(hull_.point_count(), false);
    Patch patch;
    for (const Corner seed : seeds) {
      if (hull_.degree(seed) == 0 || tried[seed]) continue;
      ++stats.grow;
      if (!grower.grow(seed, patch)) continue;
      ++stats.grown;
      stats.interior += patch.interior.size();
      for (const Corner v : patch.interior) tried[v] = true;
      if (!make_cap(patch, check)) continue;
      replace(patch, grower);
    }
    std::fprintf(stderr, "pass %u hull %u grow %d grown %d int %.1f good %d retried %d unclear %d old %ld new %ld  ratio %.3f\n", pass_, hull_.triangle_count(), stats.grow, stats.grown, double(stats.interior)/stats.grown,
      stats.good, stats.retried, stats.unclear, stats.old, stats.added, double(stats.added)/stats.old);
    stats={};
  }
  struct { int grow=0,grown=0,good=0,retried=0,unclear=0; long old=0,added=0,interior=0; } stats;

  bool make_cap(const Patch& patch, EmbedCheck& check) {
    for (const bool careful : {false, true}) {
      cap_.load(hull_, patch, static_cast<VertexId>(complex_.vertices().size()));
      const double area = cap_.patch_area();
      cap_builder_.simplify(patch, {kCapVolumeLimit * area * std::sqrt(area), 0, careful ? &check : nullptr});
      const int removed = static_cast<int>(patch.slots.size()) - (cap_.alive_faces() - cap_.new_faces());
      if (cap_.new_faces() > kWorth * removed) return false;
      if (check.cap_is_clear(patch, cap_)) { ++stats.good; stats.old+=removed; stats.added+=cap_.new_faces(); return true; }
      if (!careful) ++stats.retried; else ++stats.unclear;
    }
    return false;
  }

  void replace(const Patch& patch, PatchGrower& grower) {
    const RegionPieces pieces = split_region(hull_, patch, cap_);
    const RegionId first_region = complex_.region_count();
    for (std::uint32_t p = 0; p < pieces.count; ++p) complex_.add_region(static_cast<std::uint16_t>(pass_));
    std::vector<Corner> corners(cap_.vertex_count(), kNull);
    std::vector<VertexId> ids(cap_.vertex_count(), kNull);
    for (int v = 0; v < cap_.vertex_count(); ++v) {
      if (!cap_.is_used(v)) continue;
      if (v < cap_.first_new()) {
        corners[v] = cap_.corner(v);
        ids[v] = cap_.id(v);
      } else {
        ids[v] = complex_.add_vertex(cap_.x(v));
        corners[v] = hull_.add_point(cap_.x(v), ids[v]);
      }
    }
    const std::uint32_t component = hull_[patch.slots[0]].component;
    std::vector<Slot> free;
    for (std::size_t i = 0; i < patch.slots.size(); ++i) {
      if (pieces.of_old[i] == kNull) continue;
      free.push_back(patch.slots[i]);
      complex_.set_outer_cell(hull_[patch.slots[i]].face, first_region + pieces.of_old[i]);
    }
    hull_.remove(free);
    std::vector<Slot> slot_of(cap_.faces().size(), kNull);
    std::size_t next = 0;
    for (std::size_t f = 0; f < cap_.faces().size(); ++f) {
      const auto& face = cap_.faces()[f];
      if (face.alive) slot_of[f] = face.kept >= 0 ? patch.slots[face.kept] : free[next++];
    }
    for (std::size_t f = 0; f < cap_.faces().size(); ++f) {
      const auto& face = cap_.faces()[f];
      if (!face.alive) continue;
      HullMesh::Triangle t;
      for (int i = 0; i < 3; ++i) {
        t.v[i] = corners[face.v[i]];
        t.across[i] = face.across[i] >= 0 ? slot_of[face.across[i]] : patch.outside[-1 - face.across[i]];
      }
      if (face.kept >= 0) {
        for (int i = 0; i < 3; ++i) hull_.link(slot_of[f], t.v[i], t.across[i]);
      } else {
        const VertexId corner_ids[3] = {ids[face.v[0]], ids[face.v[1]], ids[face.v[2]]};
        t.face = complex_.add_pseudo_face(corner_ids, first_region + pieces.of_new[f], kOutside);
        t.component = component;
        hull_.add(slot_of[f], t);
        tree_->update(slot_of[f], box_of(hull_, slot_of[f]));
      }
      grower.take(slot_of[f]);
    }
    const int size = cap_.ring_size();
    for (int k = 0; k < size; ++k)
      hull_.link(patch.outside[k], patch.ring[(k + 1) % size], slot_of[cap_.face_at_ring(k)]);
  }

  static constexpr double kWorth = 0.8;

  const BuildOptions& options_;
  HullMesh hull_;
  ComplexBuilder complex_;
  BodyBounds bounds_;
  CapSurface cap_;
  PatchCap cap_builder_;
  Random random_;
  SlotTree* tree_ = nullptr;
  std::vector<bool> frozen_;  ///< (|real faces|)
  std::vector<Eigen::AlignedBox3d> component_boxes_;
  std::uint32_t pass_ = 0;
};

}  // namespace

LrbData build_by_patches(const Mesh& mesh, const std::vector<FaceId>& crossing, const BuildOptions& options) {
  return PatchBuilder(mesh, crossing, options).run();
}

}  // namespace lrb
