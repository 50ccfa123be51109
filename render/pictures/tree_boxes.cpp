#include "render/pictures/tree_boxes.hpp"

#include "render/pictures/panel.hpp"
#include <lrbscope/explain.hpp>

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

namespace {

/// Where a node stands: its parent, and as which child.
struct Place {
  std::uint32_t parent = kNull, depth = 0;
  int child = kWhole;
};

/// Returns the places of all nodes. Children come after their parents.
std::vector<Place> places_of(const ObbTree& tree) {
  const std::vector<TreeNode>& nodes = tree.nodes();
  std::vector<Place> out(nodes.size());
  std::vector<std::uint32_t> open;
  if (!nodes.empty()) open.push_back(0);
  while (!open.empty()) {
    const std::uint32_t n = open.back();
    open.pop_back();
    if (nodes[n].is_leaf != 0) continue;
    for (std::uint32_t k = 0; k < nodes[n].count; ++k) {
      out[nodes[n].first + k] = {n, out[n].depth + 1, static_cast<int>(k)};
      open.push_back(nodes[n].first + k);
    }
  }
  return out;
}

/// Returns the leaf of each real simplex.
std::vector<std::uint32_t> leaves_of(const ObbTree& tree) {
  std::vector<std::uint32_t> out;
  for (std::uint32_t n = 0; n < tree.nodes().size(); ++n) {
    const TreeNode& node = tree.nodes()[n];
    for (std::uint32_t k = 0; node.is_leaf != 0 && k < node.count; ++k) {
      const SimplexId s = tree.blocks()[node.first].simplex[k];
      if (s >= out.size()) out.resize(s.value() + 1, kNull);
      out[s.value()] = n;
    }
  }
  return out;
}

}  // namespace

std::vector<std::uint32_t> nodes_by_depth(const ObbTree& tree) {
  std::vector<std::uint32_t> out;
  for (const Place& p : places_of(tree)) {
    if (p.depth >= out.size()) out.resize(p.depth + 1);
    ++out[p.depth];
  }
  return out;
}

std::vector<TreeBox> boxes_on_ways(const ObbTree& tree, std::uint32_t below, const std::vector<SimplexId>& to,
                                   std::size_t most) {
  std::vector<TreeBox> out;
  const std::vector<Place> places = places_of(tree);
  const std::vector<std::uint32_t> leaves = leaves_of(tree);
  std::vector<bool> taken(places.size());
  for (const SimplexId s : to) {
    if (s >= leaves.size()) continue;  // of a pseudo face: the tree holds real ones
    for (std::uint32_t n = leaves[s.value()]; n != kNull && places[n].depth > below; n = places[n].parent) {
      if (taken[n]) break;
      if (out.size() == most) return out;
      taken[n] = true;
      out.push_back(box_in_body(tree, places[n].parent, places[n].child));
      out.back().node = n;
      out.back().depth = places[n].depth;
    }
  }
  return out;
}

}  // namespace lrb::run
