#pragma once
/// A dynamic AABB tree over the front's triangles, updated when caps replace patches.

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/front_mesh.hpp"
#include "engine/mesh/box_tree.hpp"

namespace lrb::construct {

/// Must be rebuilt when fits() returns false. In between, a slot that gets a new triangle keeps its position
/// in the tree, and the boxes above it grow as necessary: caps are close to the patches whose slots they
/// reuse.
class AabbTree : public BoxTree {
 public:
  using Slot = FrontMesh::Slot;

  explicit AabbTree(const FrontMesh& front);
  /// Builds a tree over any slots below `slot_count`.
  AabbTree(std::vector<Slot> slots, std::size_t slot_count, const BoxOf& box_of);
  /// Builds the tree again. Releases the old one first, because large bodies need much memory.
  void rebuild(const FrontMesh& front);

  /// Returns true if the tree covers all of the front's slots, and most of the slots it was built over are
  /// still in use.
  bool fits(const FrontMesh& front) const {
    return place_.size() == front.slot_count() && 2 * std::size_t{front.triangle_count()} > items().size();
  }

  /// Grows the boxes above a slot that has a new triangle. Not called for slots that become empty: their
  /// boxes stay, and the caller must check FrontMesh::alive().
  void update(Slot s, const Box& box);

 private:
  AabbTree() = default;

  std::vector<std::uint32_t> place_;  ///< (slots) position of a slot in items()
  std::vector<std::uint32_t> leaf_;   ///< (slots)
};

inline Eigen::AlignedBox3d box_of(const FrontMesh& front, FrontMesh::Slot s) {
  Eigen::AlignedBox3d box(front.x(front[s].v[0]));
  box.extend(front.x(front[s].v[1]));
  box.extend(front.x(front[s].v[2]));
  return box;
}

}  // namespace lrb::construct
