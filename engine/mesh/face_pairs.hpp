#pragma once
/// Broad phase among the faces of one mesh: the pairs that may intersect, in less than quadratic time.

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "engine/mesh/hubs.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

// All pairs of intersecting boxes of one set: traversal of a balanced AABB tree against itself.

using Box = Eigen::AlignedBox3d;

/// Descends two nodes of a tree and calls at_leaves(a, b) for each pair of leaves beneath m and n, and prunes
/// pairs of nodes for which apart(a, b) is true. A node has the items [first, last); `right` is its right
/// child (0: leaf), and its left child follows it.
template <class Node, class Apart, class AtLeaves>
void descend(const std::vector<Node>& nodes, std::uint32_t m, std::uint32_t n, const Apart& apart,
             const AtLeaves& at_leaves) {
  const Node &a = nodes[m], &b = nodes[n];
  if (apart(a, b)) return;
  const bool a_is_leaf = a.right == 0, b_is_leaf = b.right == 0;
  if (a_is_leaf && b_is_leaf) {
    at_leaves(a, b);
  } else if (b_is_leaf || (!a_is_leaf && a.last - a.first >= b.last - b.first)) {
    // Descend the node with more items, so that both reach their leaves at about the same depth.
    descend(nodes, m + 1, n, apart, at_leaves);
    descend(nodes, a.right, n, apart, at_leaves);
  } else {
    descend(nodes, m, n + 1, apart, at_leaves);
    descend(nodes, m, b.right, apart, at_leaves);
  }
}

class BoxTree {
 public:
  /// Builds the tree. Empty boxes intersect nothing and are omitted.
  explicit BoxTree(const std::vector<Box>& boxes) : boxes_(boxes) {
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
      if (!boxes[i].isEmpty()) items_.push_back(i);
    if (!items_.empty()) build(0, static_cast<std::uint32_t>(items_.size()));
  }

  /// Returns the number of other boxes that intersect the i-th one. Stops counting at about `most`.
  std::uint32_t count_meeting(std::uint32_t i, std::uint32_t most) const {
    std::uint32_t count = 0;
    std::vector<std::uint32_t> stack;
    if (!nodes_.empty()) stack.push_back(0);
    while (!stack.empty() && count < most) {
      const std::uint32_t n = stack.back();
      const Node& node = nodes_[n];
      stack.pop_back();
      if (!node.box.intersects(boxes_[i])) continue;
      if (node.right != 0) {
        stack.push_back(node.right);
        stack.push_back(n + 1);
        continue;
      }
      for (std::uint32_t k = node.first; k < node.last; ++k)
        count += items_[k] != i && boxes_[items_[k]].intersects(boxes_[i]);
    }
    return count;
  }

  /// Calls visit(i, j), i < j, once for each pair of intersecting boxes (closed sets), in unspecified order.
  template <class Visit>
  void for_each_pair(Visit&& visit) const {
    if (!nodes_.empty()) within(0, visit);
  }
  /// The same, with concurrent calls from several threads.
  template <class Visit>
  void for_each_pair(Visit&& visit, Workers& workers) const {
    if (!nodes_.empty()) within_shared(0, visit, workers);
  }

 private:
  static constexpr std::uint32_t kLeafSize = 4;
  static constexpr std::uint32_t kWorthSharing = 2048;  ///< boxes
  struct Node {
    Box box;
    std::uint32_t first, last;  ///< items
    std::uint32_t right;        ///< right child; the left one follows its parent. 0: leaf
  };

  std::uint32_t build(std::uint32_t first, std::uint32_t last) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, first, last, 0});
    Box box;
    for (std::uint32_t i = first; i < last; ++i) box.extend(boxes_[items_[i]]);
    nodes_[index].box = box;
    if (last - first <= kLeafSize) return index;
    int axis = 0;
    box.sizes().maxCoeff(&axis);
    const std::uint32_t median = first + (last - first) / 2;
    std::nth_element(items_.begin() + first, items_.begin() + median, items_.begin() + last,
                     [&](std::uint32_t i, std::uint32_t j) {
                       // Divide before adding, to avoid overflow.
                       const double a = boxes_[i].min()[axis] / 2 + boxes_[i].max()[axis] / 2;
                       const double b = boxes_[j].min()[axis] / 2 + boxes_[j].max()[axis] / 2;
                       return a != b ? a < b : i < j;
                     });
    build(first, median);
    nodes_[index].right = build(median, last);
    return index;
  }

  template <class Visit>
  void within(std::uint32_t n, Visit& visit) const {
    const Node& node = nodes_[n];
    if (node.right == 0) {
      for (std::uint32_t i = node.first; i < node.last; ++i)
        for (std::uint32_t j = i + 1; j < node.last; ++j) try_pair(items_[i], items_[j], visit);
      return;
    }
    within(n + 1, visit);
    within(node.right, visit);
    between(n + 1, node.right, visit);
  }

  template <class Visit>
  void within_shared(std::uint32_t n, Visit& visit, Workers& workers) const {
    const Node& node = nodes_[n];
    if (node.last - node.first < kWorthSharing) return within(n, visit);
    workers.both(
        [&] {
          workers.both([&] { within_shared(n + 1, visit, workers); },
                       [&] { within_shared(node.right, visit, workers); });
        },
        [&] { between(n + 1, node.right, visit); });
  }

  template <class Visit>
  void between(std::uint32_t m, std::uint32_t n, Visit& visit) const {
    descend(
        nodes_, m, n, [](const Node& a, const Node& b) { return !a.box.intersects(b.box); },
        [&](const Node& a, const Node& b) {
          for (std::uint32_t i = a.first; i < a.last; ++i)
            if (boxes_[items_[i]].intersects(b.box))
              for (std::uint32_t j = b.first; j < b.last; ++j) try_pair(items_[i], items_[j], visit);
        });
  }

  template <class Visit>
  void try_pair(std::uint32_t i, std::uint32_t j, Visit& visit) const {
    if (boxes_[i].intersects(boxes_[j])) visit(std::min(i, j), std::max(i, j));
  }

  const std::vector<Box>& boxes_;
  std::vector<std::uint32_t> items_;
  std::vector<Node> nodes_;
};

/// The pairs of faces that may intersect, in about O(n log n) time for n faces, plus the number of pairs
/// found.
///
/// An AABB tree is sufficient for most meshes. Very many AABBs overlap if thousands of faces share one
/// vertex, if one face has thousands of corners, or if large faces are close in front of each other. Then the
/// faces of a high-valence vertex are compared by their directions from it (hubs.hpp), and all others in a
/// tree whose nodes have an OBB as well: for example, needles from two apexes to a common ring overlap as
/// AABBs, but not as OBBs.
class FacePairs {
 public:
  using Visit = std::function<void(FaceId, FaceId)>;

  /// Omits faces with a use below FaceUse::area.
  FacePairs(const Mesh& mesh, const std::vector<FaceUse>& use);
  FacePairs(const FacePairs&) = delete;
  FacePairs& operator=(const FacePairs&) = delete;

  /// Calls visit(f, g), f < g, once for each pair of faces with intersecting AABBs, except for pairs proven
  /// to intersect at most in one corner shared by index. In unspecified order, and concurrently if `workers`
  /// has several threads.
  void for_each(const Visit& visit, Workers& workers) const;

  const std::vector<Box>& boxes() const { return boxes_; }  ///< (|F|) empty for omitted faces
  const UnitCube& cube() const { return cube_; }
  /// Returns true if a face has very many corners (more than kFewNeighbours) and thus needs a tree of its own
  /// triangles.
  bool is_large(FaceId f) const { return is_large_[f]; }

 private:
  struct Node {
    Box box;
    OrientedBox slim;
    std::uint32_t first = 0, last = 0;  ///< into order_
    std::uint32_t right = 0;            ///< right child; the left one follows its parent. 0: leaf
    bool of_one_hub = false;            ///< its inner pairs are found by for_each_pair_at()
  };
  /// An indivisible item of the tree: the faces of a high-valence vertex, or one face.
  struct Unit {
    Eigen::Vector3d centre;
    std::uint32_t hub;  ///< kNull: one face
    FaceId face;
  };

  bool boxes_are_crowded() const;
  void build();
  std::vector<Unit> units() const;
  std::uint32_t build_units(std::vector<Unit>& units, std::size_t first, std::size_t last);
  std::uint32_t build_hub(std::vector<FaceId>& faces, std::size_t first, std::size_t last);
  std::uint32_t add_node();
  void close_node(std::uint32_t index);
  Eigen::Vector3d centre_of(FaceId f) const { return boxes_[f].min() / 2 + boxes_[f].max() / 2; }

  void within(std::uint32_t n, const Visit& visit, Workers& workers) const;
  void between(std::uint32_t m, std::uint32_t n, const Visit& visit) const;
  void try_pair(FaceId f, FaceId g, const Visit& visit) const;

  const Mesh& mesh_;
  std::vector<Box> boxes_;
  std::vector<bool> is_large_;  ///< (|F|)
  UnitCube cube_;
  Hubs hubs_;
  std::vector<FaceId> order_;  ///< in the order of the tree's leaves
  std::vector<Node> nodes_;
  std::optional<BoxTree> tree_;  ///< replaces the nodes if AABBs are sufficient
};

}  // namespace lrb
