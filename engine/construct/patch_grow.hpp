#pragma once
/// Patches: disks of the front's triangles, which a pass covers with caps.

#include <cstdint>
#include <vector>

#include "engine/construct/front_mesh.hpp"

namespace lrb::construct {

/// A topological disk (or, without a ring, a whole closed component).
struct Patch {
  std::vector<FrontMesh::Slot> slots;
  std::vector<FrontMesh::Corner> interior;  ///< vertices all of whose triangles are in the patch
  /// The vertices on the boundary in order, so that the patch lies on the left of ring[i] -> ring[i + 1].
  std::vector<FrontMesh::Corner> ring;
  std::vector<FrontMesh::Slot> outside;  ///< (|ring|) the triangle beyond the edge ring[i], ring[i + 1]
};

struct GrowLimits {
  std::uint32_t interior = 16;  ///< number of interior vertices to aim at
  std::uint32_t triangles = 64;
};

/// Grows patches one after the other. Triangles that are taken never become part of a patch again.
class PatchGrower {
 public:
  PatchGrower(const FrontMesh& front, const GrowLimits& limits);

  /// Grows a disk around the seed: first the star of the seed, then the star of the ring vertex that needs
  /// the fewest new triangles (with a penalty on its distance from the seed), while the patch remains a disk.
  /// Polygons of the mesh are added entirely. Returns false if the seed's star cannot be added.
  bool grow(FrontMesh::Corner seed, Patch& patch);
  void take(FrontMesh::Slot s) { taken_[s] = true; }
  bool is_taken(FrontMesh::Slot s) const { return taken_[s]; }

  /// Starts a batch: from now on, growth records whether it reads triangles with a vertex of a patch in the
  /// batch.
  void begin_batch();
  void add_to_batch(const Patch& patch);
  /// Returns true if the last call of grow() read such triangles: its result may then depend on the caps of
  /// the batch.
  bool met_batch() const { return met_batch_; }

 private:
  bool add_star(FrontMesh::Corner v, Patch& patch);
  bool mark_star(FrontMesh::Corner v);
  void unmark_star();
  std::size_t add_corners();
  void take_back_corners(std::size_t new_points);
  std::int64_t euler_change(std::size_t new_points) const;
  FrontMesh::Corner best_candidate(FrontMesh::Corner seed, double reach_sq, const Patch& patch) const;
  void find_ring(Patch& patch) const;
  bool is_in_batch(FrontMesh::Corner v) const;
  void look_for_batch();

  bool in_patch(FrontMesh::Slot s) const { return slot_stamp_[s] == stamp_; }

  const FrontMesh& front_;
  GrowLimits limits_;
  std::vector<bool> taken_;                 ///< (slots)
  std::vector<std::uint32_t> slot_stamp_;   ///< == stamp_: in the patch that is growing
  std::vector<std::uint32_t> point_stamp_;  ///< == stamp_: a vertex of the patch that is growing
  std::vector<std::uint32_t> inside_;       ///< number of the patch's triangles at a vertex, if it is stamped
  std::vector<std::uint32_t> rejected_;     ///< == stamp_: the vertex's star cannot be added
  std::uint32_t stamp_ = 0;
  std::vector<std::uint32_t> batch_stamp_;  ///< == batch_: a vertex of a patch of the batch
  std::uint32_t batch_ = 0;
  bool batch_is_empty_ = true, met_batch_ = false;
  std::vector<FrontMesh::Slot> added_;
  std::vector<FrontMesh::Corner> rim_;  ///< vertices of the patch, some of them interior by now
};

}  // namespace lrb::construct
