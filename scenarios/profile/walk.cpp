#include "scenarios/profile/walk.hpp"

#include <limits>

#include "scenarios/profile/pair_map.hpp"

namespace lrb::profile {
TreeIndex::TreeIndex(const capture::Tree& tree, std::size_t triangles)
    : parent(tree.size(), kNull),
      depth(tree.size(), kNull),
      leaf(triangles, kNull),
      triangles_below(tree.size(), 0),
      has_children(tree.size(), 0) {
  for (std::uint32_t n = 0; n < tree.size(); ++n) has_children[n] = !tree.is_leaf(n);
  // Breadth first from the root. A node that was reached before keeps its first parent, so that this ends for
  // graphs with cycles.
  from_root.push_back(0);
  depth[0] = 0;
  for (std::size_t i = 0; i < from_root.size(); ++i) {
    const std::uint32_t n = from_root[i];
    for (const std::uint32_t child : tree.children(n)) {
      if (depth[child] != kNull) continue;
      parent[child] = n;
      depth[child] = depth[n] + 1;
      from_root.push_back(child);
    }
    for (const std::uint32_t t : tree.triangles(n))
      if (t < triangles && leaf[t] == kNull) leaf[t] = n;
  }
  // Sums from the leaves upward.
  for (std::size_t i = from_root.size(); i-- > 0;) {
    const std::uint32_t n = from_root[i];
    triangles_below[n] += static_cast<std::uint32_t>(tree.triangles(n).size());
    if (parent[n] != kNull) triangles_below[parent[n]] += triangles_below[n];
  }
}

std::vector<Visit> visits_of(const TreeIndex& tree_a, const TreeIndex& tree_b,
                             std::span<const capture::Event> events) {
  std::vector<Visit> out(events.size());
  PairMap tests;  // the last test of each pair of nodes
  // Links visit i, of nodes a and b, to its predecessor. All children of a pair are reached by the same step.
  const auto link = [&](std::uint32_t a, std::uint32_t b, std::uint32_t i) {
    const std::uint32_t up_a = tree_a.parent[a], up_b = tree_b.parent[b];
    const struct {
      std::uint32_t a, b;
      NodeStep step;
    } above[] = {
        {up_a, b, NodeStep::descend_a}, {a, up_b, NodeStep::descend_b}, {up_a, up_b, NodeStep::descend_both}};
    for (const auto& pair : above) {
      if (pair.a == kNull || pair.b == kNull) continue;
      const std::uint32_t* const found = tests.find(pair.a, pair.b);
      if (found == nullptr) continue;
      Visit& from = out[*found];
      if (from.step && *from.step != pair.step) continue;
      out[i].parent = *found;
      from.step = pair.step;
      if (from.children < std::numeric_limits<std::uint8_t>::max()) ++from.children;
      return;
    }
  };
  for (std::uint32_t i = 0; i < events.size(); ++i) {
    const capture::Event& e = events[i];
    if (e.kind == capture::EventKind::triangles) {
      const std::uint32_t a = tree_a.leaf[e.a], b = tree_b.leaf[e.b];
      if (a == kNull || b == kNull) continue;
      if (const std::uint32_t* const found = tests.find(a, b); found != nullptr)
        out[i].parent = *found;
      else
        link(a, b, i);  // an engine without a test of the leaves' volumes
    } else if (e.kind == capture::EventKind::nodes) {
      tests.insert(e.a, e.b, i) = i;
      if (tree_a.is_leaf(e.a) && tree_b.is_leaf(e.b)) out[i].step = NodeStep::leaves;
      link(e.a, e.b, i);
    }
  }
  return out;
}

}  // namespace lrb::profile
