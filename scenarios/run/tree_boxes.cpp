#include "scenarios/run/tree_boxes.hpp"

#include <algorithm>

namespace lrb::run {
namespace {

/// Returns what a node's own frame says: its children [first, end) in one box.
TreeBox box_of_children(const ObbTree& tree, const TreeNode& in, std::uint32_t first, std::uint32_t end) {
  TreeBox box;
  box.centre = Eigen::Vector3d(in.origin[0], in.origin[1], in.origin[2]) * tree.unit();
  for (int i = 0; i < 3; ++i) {
    const auto at = [&](int steps) {
      return static_cast<double>(in.base[i]) + static_cast<double>(in.scale[i]) * steps;
    };
    const double low = at(*std::min_element(in.lo[i] + first, in.lo[i] + end)),
                 high = at(*std::max_element(in.hi[i] + first, in.hi[i] + end));
    const Eigen::Vector3d axis(in.frame[i][0], in.frame[i][1], in.frame[i][2]);
    box.centre += axis * (0.5 * (low + high) * tree.unit());
    box.half.col(i) = axis * (0.5 * (high - low) * tree.unit());
  }
  return box;
}

}  // namespace

std::vector<TreeBox> tree_boxes(const ObbTree& tree, std::size_t most) {
  std::vector<TreeBox> out;
  if (tree.empty() || most == 0) return out;
  const std::vector<TreeNode>& nodes = tree.nodes();
  out.push_back(box_of_children(tree, nodes[0], 0, nodes[0].count));
  std::size_t level = 0;
  for (std::uint32_t depth = 1; level < out.size(); ++depth) {
    const std::size_t end = out.size();
    for (std::size_t i = level; i < end; ++i) {
      const TreeNode& node = nodes[out[i].node];
      for (std::uint32_t k = 0; node.is_leaf == 0 && k < node.count; ++k) {
        out.push_back(box_of_children(tree, node, k, k + 1));
        out.back().node = node.first + k;
        out.back().depth = depth;
      }
      if (out.size() <= most) continue;
      out.resize(end);
      return out;
    }
    level = end;
  }
  return out;
}

}  // namespace lrb::run
