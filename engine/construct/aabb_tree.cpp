// Dynamic AABB tree: built top down by median splits on the longest axis of the centroids, O(n log n).
// Afterwards it is only refitted: boxes grow along the path to the root.

#include "engine/construct/aabb_tree.hpp"

#include <algorithm>

#include <Eigen/Geometry>

namespace lrb::construct {

namespace {

std::vector<Eigen::AlignedBox3d> boxes_of(const FrontMesh& front) {
  std::vector<Eigen::AlignedBox3d> boxes(front.slot_count());
  for (FrontMesh::Slot s = 0; s < front.slot_count(); ++s)
    if (front.alive(s)) boxes[s] = box_of(front, s);
  return boxes;
}

}  // namespace

AabbTree::AabbTree(const FrontMesh& front) : AabbTree(front.alive_slots(), boxes_of(front)) {}

AabbTree::AabbTree(std::vector<Slot> slots, std::span<const Box> boxes)
    : slots_(std::move(slots)), centres_(boxes.size()), place_(boxes.size(), kNull) {
  // Step 1: the topology, from centroids alone.
  if (slots_.empty()) return;
  for (const Slot s : slots_)
    centres_[s] = boxes[s].min() / 2 + boxes[s].max() / 2;  // halved first: no overflow
  leaf_.resize(slots_.size());
  // A leaf has at least two slots unless there is only one slot, so there are no more nodes than slots.
  nodes_.reserve(slots_.size());
  build(0, static_cast<std::uint32_t>(slots_.size()), kNull);
  boxes_.resize(slots_.size());
  // Step 2: the boxes in leaf order, and the position of each slot.
  for (std::uint32_t i = 0; i < slots_.size(); ++i) {
    place_[slots_[i]] = i;
    boxes_[i] = boxes[slots_[i]];
  }
  // Step 3: fit the boxes bottom up. Children have larger indices than their parents, so one backward pass
  // suffices.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    if (node.right == 0)
      for (std::uint32_t i = node.first; i < node.last; ++i) node.box.extend(boxes_[i]);
    if (node.parent != kNull) nodes_[node.parent].box.extend(node.box);
  }
  centres_ = {};
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
