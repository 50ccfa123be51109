#pragma once
/// A balanced tree of axis-aligned boxes around numbered items: faces, triangles, corners of a polygon. It
/// serves what is done once to a body; queries of two bodies use the OBB tree.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <lrbscope/ids.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

using Box = Eigen::AlignedBox3d;

/// Splits a range of items at the median along the longest extent of their centres, so that the depth is
/// logarithmic for any distribution. Equal coordinates are ordered by item: the tree is deterministic.
/// Returns the median.
template <class Iterator, class Centre>
Iterator halve(Iterator first, Iterator last, const Centre& centre) {
  Eigen::AlignedBox3d spread;
  for (Iterator i = first; i != last; ++i) spread.extend(centre(*i));
  int axis = 0;
  // Divided first, to avoid overflow.
  (spread.max() / 2 - spread.min() / 2).maxCoeff(&axis);
  const Iterator median = first + (last - first) / 2;
  std::nth_element(first, median, last, [&](const auto& i, const auto& j) {
    const double a = centre(i)[axis], b = centre(j)[axis];
    return a != b ? a < b : i < j;
  });
  return median;
}

/// Returns the centre of a box, without overflow.
inline Eigen::Vector3d box_centre(const Eigen::AlignedBox3d& box) {
  return box.min() / 2 + box.max() / 2;
}

// Traversals of nodes as those of BoxTree.

/// Descends from node m of one tree and node n of another, or of the same. Drops pairs of nodes for which
/// apart(m, n) is true. Stops and returns true as soon as at_leaves(m, n) is true for a pair of leaves.
template <class Nodes, class Apart, class AtLeaves>
bool descend(const Nodes& nodes_a, std::uint32_t m, const Nodes& nodes_b, std::uint32_t n, const Apart& apart,
             const AtLeaves& at_leaves) {
  if (apart(m, n)) return false;
  const auto &a = nodes_a[m], &b = nodes_b[n];
  const bool a_is_leaf = a.right == 0, b_is_leaf = b.right == 0;
  if (a_is_leaf && b_is_leaf) return at_leaves(m, n);
  // The node with more items, so that both reach their leaves at about the same depth.
  if (b_is_leaf || (!a_is_leaf && a.last - a.first >= b.last - b.first))
    return descend(nodes_a, m + 1, nodes_b, n, apart, at_leaves) ||
           descend(nodes_a, a.right, nodes_b, n, apart, at_leaves);
  return descend(nodes_a, m, nodes_b, n + 1, apart, at_leaves) ||
         descend(nodes_a, m, nodes_b, b.right, apart, at_leaves);
}

/// Calls at_leaves(m, n), which returns false, for each pair of leaves below a node, and for each leaf with
/// itself; concurrently if `workers` has several threads. Drops pairs of nodes that are apart, and subtrees
/// for which skip(n) is true.
template <class Nodes, class Skip, class Apart, class AtLeaves>
void descend_within(const Nodes& nodes, std::uint32_t n, const Skip& skip, const Apart& apart,
                    const AtLeaves& at_leaves, Workers& workers) {
  constexpr std::uint32_t kWorthSharing = 2048;  // items
  const auto& node = nodes[n];
  if (skip(n)) return;
  if (node.right == 0) {
    at_leaves(n, n);
    return;
  }
  // A pair is in the left child, in the right child, or across: three disjoint tasks.
  const auto left = [&] { descend_within(nodes, n + 1, skip, apart, at_leaves, workers); };
  const auto right = [&] { descend_within(nodes, node.right, skip, apart, at_leaves, workers); };
  const auto across = [&] { descend(nodes, n + 1, nodes, node.right, apart, at_leaves); };
  if (node.last - node.first < kWorthSharing) {
    left();
    right();
    across();
  } else {
    workers.both([&] { workers.both(left, right); }, across);
  }
}

class BoxTree {
 public:
  using Box = lrb::Box;
  using BoxOf = std::function<Box(std::uint32_t item)>;
  struct Node {
    Box box;
    std::uint32_t first = 0, last = 0;  ///< into items()
    std::uint32_t right = 0;            ///< the right child; the left one follows its parent. 0: leaf
    std::uint32_t parent = kNull;
  };
  /// A tree that is halved at each level has a depth of 2 + log2 of the number of leaves.
  static constexpr int kMaxDepth = 64;

  BoxTree() = default;
  /// Builds the tree. Asks for each box twice.
  BoxTree(std::vector<std::uint32_t> items, const BoxOf& box_of, std::uint32_t leaf_size = 4);
  /// The items are the indices of the boxes, except of empty ones, which intersect nothing.
  explicit BoxTree(const std::vector<Box>& boxes, std::uint32_t leaf_size = 4);

  /// Replaces the boxes of the items, and fits those of the nodes.
  void fit(const BoxOf& box_of);

  std::span<const Node> nodes() const { return nodes_; }           ///< the root first
  std::span<const std::uint32_t> items() const { return items_; }  ///< leaf by leaf
  /// Returns the leaf of each item below `count`; kNull: not in the tree.
  std::vector<std::uint32_t> leaves(std::size_t count) const;

  /// Returns true if the boxes intersect (closed). Eigen's own test is not inlined.
  static bool intersect(const Box& a, const Box& b) {
    return a.min()[0] <= b.max()[0] && a.min()[1] <= b.max()[1] && a.min()[2] <= b.max()[2] &&
           b.min()[0] <= a.max()[0] && b.min()[1] <= a.max()[1] && b.min()[2] <= a.max()[2];
  }

  /// Calls visit(item) for every item whose box intersects `box` (closed).
  template <class Visit>
  void for_each_in(const Box& box, Visit&& visit) const {
    for_each_near(
        box, [](const Box&) { return true; }, visit);
  }

  /// Also drops boxes, of items and of nodes, for which near(box) is false.
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
          if (intersect(boxes_[i], box) && near(boxes_[i])) visit(items_[i]);
        continue;
      }
      stack[top++] = node.right;
      stack[top++] = n + 1;
    }
  }

  /// Calls visit(i, j), i < j, once for each pair of items with intersecting boxes (closed), in unspecified
  /// order, and concurrently if `workers` has several threads.
  template <class Visit>
  void for_each_pair(Visit&& visit, Workers& workers) const {
    if (nodes_.empty()) return;
    const auto apart = [&](std::uint32_t m, std::uint32_t n) {
      return !intersect(nodes_[m].box, nodes_[n].box);
    };
    const auto at_leaves = [&](std::uint32_t m, std::uint32_t n) {
      const Node &a = nodes_[m], &b = nodes_[n];
      for (std::uint32_t i = a.first; i < a.last; ++i)
        if (intersect(boxes_[i], b.box))
          for (std::uint32_t j = m == n ? i + 1 : b.first; j < b.last; ++j)
            if (intersect(boxes_[i], boxes_[j]))
              visit(std::min(items_[i], items_[j]), std::max(items_[i], items_[j]));
      return false;
    };
    descend_within(
        nodes_, 0, [](std::uint32_t) { return false; }, apart, at_leaves, workers);
  }

 protected:
  std::vector<std::uint32_t> items_;
  std::vector<Box> boxes_;  ///< parallel to items_
  std::vector<Node> nodes_;

 private:
  std::uint32_t build(std::span<std::uint32_t> part, const std::vector<Eigen::Vector3d>& centres,
                      std::uint32_t leaf_size, std::uint32_t parent);
};

}  // namespace lrb
