#pragma once
/// A dynamic AABB tree over the front's triangles, updated when caps replace patches.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/front_mesh.hpp"

namespace lrb::construct {

/// Must be rebuilt when fits() returns false. In between, a slot that gets a new triangle keeps its position
/// in the tree, and the boxes above it grow as necessary: caps are close to the patches whose slots they
/// reuse.
class AabbTree {
 public:
  using Slot = FrontMesh::Slot;
  using Box = Eigen::AlignedBox3d;

  explicit AabbTree(const FrontMesh& front);
  /// Builds a tree over any slots below `slot_count`.
  AabbTree(std::vector<Slot> slots, std::size_t slot_count, const std::function<Box(Slot)>& box_of);
  /// Builds the tree again. Releases the old one first, because large bodies need much memory.
  void rebuild(const FrontMesh& front);

  /// Returns true if the tree covers all of the front's slots, and most of the slots it was built over are
  /// still in use.
  bool fits(const FrontMesh& front) const {
    return place_.size() == front.slot_count() && 2 * std::size_t{front.triangle_count()} > slots_.size();
  }

  /// Grows the boxes above a slot that has a new triangle. Not called for slots that become empty: their
  /// boxes stay, and the caller must check FrontMesh::alive().
  void update(Slot s, const Box& box);

  /// Returns true if the boxes intersect (closed). Eigen's own test is not inlined.
  static bool intersect(const Box& a, const Box& b) {
    return a.min()[0] <= b.max()[0] && a.min()[1] <= b.max()[1] && a.min()[2] <= b.max()[2] &&
           b.min()[0] <= a.max()[0] && b.min()[1] <= a.max()[1] && b.min()[2] <= a.max()[2];
  }

  /// Calls visit(slot) for every slot whose box intersects `box` (closed).
  template <class Visit>
  void for_each_in(const Box& box, Visit&& visit) const {
    for_each_near(
        box, [](const Box&) { return true; }, visit);
  }

  /// Also culls boxes, of slots and of nodes, for which near(box) is false.
  template <class Near, class Visit>
  void for_each_near(const Box& box, Near&& near, Visit&& visit) const {
    if (nodes_.empty()) return;
    std::uint32_t stack[kMaxDepth];
    int top = 0;
    stack[top++] = 0;
    while (top > 0) {
      const std::uint32_t n = stack[--top];
      const Node& node = nodes_[n];
      if (!intersect(node.box, box) || !near(node.box)) continue;
      if (node.right == 0) {
        for (std::uint32_t i = node.first; i < node.last; ++i)
          if (intersect(boxes_[i], box) && near(boxes_[i])) visit(slots_[i]);
        continue;
      }
      stack[top++] = node.right;
      stack[top++] = n + 1;
    }
  }

  /// A tree that is halved at each level has a depth of 2 + log2 of the number of leaves.
  static constexpr int kMaxDepth = 64;
  struct Node {
    Box box;
    std::uint32_t first, last;  ///< into slots()
    std::uint32_t right;        ///< the right child; the left one follows its parent. 0: leaf
    std::uint32_t parent;
  };
  std::span<const Node> nodes() const { return nodes_; }  ///< the root first
  std::span<const Slot> slots() const { return slots_; }  ///< leaf by leaf

 private:
  static constexpr std::uint32_t kLeafSize = 4;

  AabbTree() = default;
  std::uint32_t build(std::uint32_t first, std::uint32_t last, std::uint32_t parent);

  std::vector<Slot> slots_;
  std::vector<Box> boxes_;                ///< parallel to slots_
  std::vector<Eigen::Vector3d> centres_;  ///< by slot, only while building
  std::vector<std::uint32_t> place_;      ///< (slots) position of a slot in slots_
  std::vector<std::uint32_t> leaf_;       ///< (|slots_|) leaf of a position
  std::vector<Node> nodes_;
};

inline Eigen::AlignedBox3d box_of(const FrontMesh& front, FrontMesh::Slot s) {
  Eigen::AlignedBox3d box(front.x(front[s].v[0]));
  box.extend(front.x(front[s].v[1]));
  box.extend(front.x(front[s].v[2]));
  return box;
}

}  // namespace lrb::construct
