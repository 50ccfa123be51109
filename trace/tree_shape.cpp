#include "trace/tree_shape.hpp"

#include <stdexcept>

#include <Eigen/Geometry>

#include "engine/query/node_boxes.hpp"

namespace lrb::trace {

double ShapeBox::area() const {
  constexpr int kSides = 2, kSquareOfHalf = 4;
  // Three pairs of sides; each is a parallelogram spanned by two full axes, twice the half axes.
  return kSides * kSquareOfHalf *
         (half[0].cross(half[1]).norm() + half[1].cross(half[2]).norm() + half[2].cross(half[0]).norm());
}

TreeShape::TreeShape(const ObbTree& tree) {
  for (std::uint32_t i = 0; i < tree.nodes().size(); ++i) {
    const TreeNode& n = tree.nodes()[i];
    const WorldBox box = box_of(tree, i, kWhole, Pose{});
    if (n.is_leaf) {
      add({}, {tree.blocks()[n.first].simplex, n.count}, {box.centre, box.half});
    } else {
      std::array<std::uint32_t, kTreeWidth> children{};
      for (std::uint32_t k = 0; k < n.count; ++k) children[k] = n.first + k;
      add({children.data(), n.count}, {}, {box.centre, box.half});
    }
  }
  finish();
}

void TreeShape::add(std::span<const std::uint32_t> children, std::span<const SimplexId> simplices,
                    const ShapeBox& box) {
  children_.insert(children_.end(), children.begin(), children.end());
  simplices_.insert(simplices_.end(), simplices.begin(), simplices.end());
  first_child_.push_back(static_cast<std::uint32_t>(children_.size()));
  first_simplex_.push_back(static_cast<std::uint32_t>(simplices_.size()));
  boxes_.push_back(box);
}

void TreeShape::finish() {
  depth_.assign(size(), 0);
  beneath_.assign(size(), 0);
  order_.clear();
  if (size() > 0) order_.push_back(0);
  // Breadth-first order from the root. More nodes than exist means a node with two parents, or a cycle.
  for (std::size_t i = 0; i < order_.size(); ++i)
    for (const std::uint32_t child : children(order_[i])) {
      if (child == 0 || child >= size() || order_.size() >= size())
        throw std::invalid_argument("TreeShape: the nodes are no tree");
      depth_[child] = depth_[order_[i]] + 1;
      order_.push_back(child);
    }
  if (order_.size() != size())
    throw std::invalid_argument("TreeShape: there are nodes that no other leads to");
  // In reverse order children come first: sum the simplices bottom up.
  for (auto i = order_.rbegin(); i != order_.rend(); ++i) {
    beneath_[*i] += static_cast<std::uint32_t>(simplices(*i).size());
    for (const std::uint32_t child : children(*i)) beneath_[*i] += beneath_[child];
  }
}

}  // namespace lrb::trace
