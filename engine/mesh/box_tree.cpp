// Built top down by median splits, O(n log n); the boxes are fitted bottom up.
#include "engine/mesh/box_tree.hpp"

namespace lrb {
namespace {

std::vector<std::uint32_t> not_empty(const std::vector<BoxTree::Box>& boxes) {
  std::vector<std::uint32_t> items;
  for (std::uint32_t i = 0; i < boxes.size(); ++i)
    if (!boxes[i].isEmpty()) items.push_back(i);
  return items;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes, std::uint32_t leaf_size)
    : BoxTree(
          not_empty(boxes), [&](std::uint32_t i) { return boxes[i]; }, leaf_size) {}

BoxTree::BoxTree(std::vector<std::uint32_t> items, const BoxOf& box_of, std::uint32_t leaf_size)
    : items_(std::move(items)) {
  if (items_.empty()) return;
  {
    // Only while building, because large bodies need much memory.
    std::vector<Eigen::Vector3d> centres(1 + std::size_t{*std::max_element(items_.begin(), items_.end())});
    for (const std::uint32_t i : items_) centres[i] = box_centre(box_of(i));
    // A leaf has at least two items unless there is only one, or leaves have one each.
    nodes_.reserve(items_.size());
    build(items_, centres, leaf_size, kNull);
  }
  fit(box_of);
}

/// Builds a subtree over a part of the items in preorder. Returns its index.
std::uint32_t BoxTree::build(std::span<std::uint32_t> part, const std::vector<Eigen::Vector3d>& centres,
                             std::uint32_t leaf_size, std::uint32_t parent) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  const auto first = static_cast<std::uint32_t>(part.data() - items_.data());
  nodes_.push_back({Box(), first, first + static_cast<std::uint32_t>(part.size()), 0, parent});
  if (part.size() <= leaf_size) return index;
  const auto median =
      halve(part.begin(), part.end(), [&](std::uint32_t i) -> const Eigen::Vector3d& { return centres[i]; });
  const auto half = static_cast<std::size_t>(median - part.begin());
  // The left child follows its parent. The vector may be reallocated: the node by its index.
  build(part.first(half), centres, leaf_size, index);
  const std::uint32_t right = build(part.subspan(half), centres, leaf_size, index);
  nodes_[index].right = right;
  return index;
}

void BoxTree::fit(const BoxOf& box_of) {
  boxes_.resize(items_.size());
  for (std::size_t i = 0; i < items_.size(); ++i) boxes_[i] = box_of(items_[i]);
  for (Node& node : nodes_) node.box.setEmpty();
  // Children have larger indices than their parents, so one backward pass suffices.
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    if (node.right == 0)
      for (std::uint32_t i = node.first; i < node.last; ++i) node.box.extend(boxes_[i]);
    if (node.parent != kNull) nodes_[node.parent].box.extend(node.box);
  }
}

std::vector<std::uint32_t> BoxTree::leaves(std::size_t count) const {
  std::vector<std::uint32_t> leaves(count, kNull);
  for (std::uint32_t n = 0; n < nodes_.size(); ++n)
    if (nodes_[n].right == 0)
      for (std::uint32_t i = nodes_[n].first; i < nodes_[n].last; ++i) leaves[items_[i]] = n;
  return leaves;
}

}  // namespace lrb
