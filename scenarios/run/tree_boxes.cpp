#include "scenarios/run/tree_boxes.hpp"

#include "engine/query/node_boxes.hpp"

namespace lrb::run {
namespace {

/// Returns the box of a node's child, as the node holds it, or with kWhole its own.
TreeBox box_in_body(const ObbTree& tree, std::uint32_t node, int child) {
  const WorldBox box = box_of(tree, node, child, Pose{});
  TreeBox out;
  out.centre = box.centre;
  for (int i = 0; i < 3; ++i) out.half.col(i) = box.half[static_cast<std::size_t>(i)];
  return out;
}

}  // namespace

std::vector<TreeBox> tree_boxes(const ObbTree& tree, std::size_t most) {
  std::vector<TreeBox> out;
  if (tree.empty() || most == 0) return out;
  const std::vector<TreeNode>& nodes = tree.nodes();
  out.push_back(box_in_body(tree, 0, kWhole));
  std::size_t level = 0;
  for (std::uint32_t depth = 1; level < out.size(); ++depth) {
    const std::size_t end = out.size();
    for (std::size_t i = level; i < end; ++i) {
      const TreeNode& node = nodes[out[i].node];
      for (std::uint32_t k = 0; node.is_leaf == 0 && k < node.count; ++k) {
        out.push_back(box_in_body(tree, out[i].node, static_cast<int>(k)));
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
