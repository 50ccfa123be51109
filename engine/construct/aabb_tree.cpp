// Dynamic AABB tree: built top down by median splits on the longest axis of the centroids, O(n log n).
// Afterwards it is only refitted: boxes grow along the path to the root.

#include "engine/construct/aabb_tree.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace lrb::construct {

AabbTree::AabbTree(const FrontMesh& front)
    : AabbTree(front.alive_slots(), front.slot_count(), [&](Slot s) { return construct::box_of(front, s); }) {
}

void AabbTree::rebuild(const FrontMesh& front) {
  *this = AabbTree();
  *this = AabbTree(front);
}

AabbTree::AabbTree(std::vector<Slot> slots, std::size_t slot_count, const std::function<Box(Slot)>& box_of)
    : slots_(std::move(slots)), centres_(slot_count), place_(slot_count, kNull) {
  // Step 1: the topology, from centroids alone.
  if (slots_.empty()) return;
  for (const Slot s : slots_) {
    const Box box = box_of(s);
    centres_[s] = box.min() / 2 + box.max() / 2;  // halved first: no overflow
  }
  leaf_.resize(slots_.size());
  // A leaf has at least two slots unless there is only one slot, so there are no more nodes than slots.
  nodes_.reserve(slots_.size());
  build(0, static_cast<std::uint32_t>(slots_.size()), kNull);
  boxes_.resize(slots_.size());
  // Step 2: the boxes in leaf order, and the position of each slot.
  for (std::uint32_t i = 0; i < slots_.size(); ++i) {
    place_[slots_[i]] = i;
    boxes_[i] = box_of(slots_[i]);
  }
  // Step 3: fit the boxes bottom up. Children have larger indices than their parents, so one backward pass
  // suffices.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    if (node.right == 0)
      for (std::uint32_t i = node.first; i < node.last; ++i) node.box.extend(boxes_[i]);
    if (node.parent != kNull) nodes_[node.parent].box.extend(node.box);
  }
  centres_ = decltype(centres_)();  // `= {}` would keep the memory
}

std::uint32_t AabbTree::build(std::uint32_t first, std::uint32_t last, std::uint32_t parent) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({Box(), first, last, 0, parent});
  if (last - first <= kLeafSize) {
    for (std::uint32_t i = first; i < last; ++i) leaf_[i] = index;
    return index;
  }
  // Split along the axis of largest extent of the centroids, not of the boxes.
  Box spread;
  for (std::uint32_t i = first; i < last; ++i) spread.extend(centres_[slots_[i]]);
  int axis = 0;
  spread.sizes().maxCoeff(&axis);
  const std::uint32_t median = first + (last - first) / 2;
  // Equal halves bound the depth by log2 n. Ties are broken by slot, so that the tree is deterministic.
  std::nth_element(slots_.begin() + first, slots_.begin() + median, slots_.begin() + last,
                   [&](Slot s, Slot t) {
                     const double a = centres_[s][axis], b = centres_[t][axis];
                     return a != b ? a < b : s < t;
                   });
  // Preorder: the left child follows its parent. The vector may be reallocated, so refer to the node by
  // index.
  build(first, median, index);
  const std::uint32_t right = build(median, last, index);
  nodes_[index].right = right;
  return index;
}

void AabbTree::update(Slot s, const Box& box) {
  // Refit upwards until an ancestor already contains the box. Boxes never shrink; fits() requests a rebuild
  // when too many slots are empty.
  const std::uint32_t place = place_[s];
  boxes_[place] = box;
  for (std::uint32_t n = leaf_[place]; n != kNull && !nodes_[n].box.contains(box); n = nodes_[n].parent)
    nodes_[n].box.extend(box);
}

}  // namespace lrb::construct
