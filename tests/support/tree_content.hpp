#pragma once

#include <vector>

#include <lrbscope/obb_tree.hpp>

namespace lrb::test {

/// Appends the simplices beneath a node.
inline void simplices_under(const ObbTree& t, std::uint32_t node, std::vector<SimplexId>& out) {
  const TreeNode& n = t.nodes()[node];
  for (std::uint32_t k = 0; k < n.count; ++k) {
    if (n.is_leaf)
      out.push_back(t.blocks()[n.first].simplex[k]);
    else
      simplices_under(t, n.first + k, out);
  }
}

}  // namespace lrb::test
