#pragma once
/// The traversal of a captured query: which pair of nodes led to which.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <lrbscope/ids.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

/// The parents of a captured tree's nodes and the leaves of its triangles. Also valid for broken trees:
/// the first of several parents or leaves counts, and nodes that the root does not reach have no depth.
struct TreeIndex {
  std::vector<std::uint32_t> parent;           ///< by node; kNull: the root, or no parent
  std::vector<std::uint32_t> depth;            ///< by node; kNull: not below the root
  std::vector<std::uint32_t> from_root;        ///< the nodes below the root, breadth first, each once
  std::vector<std::uint32_t> leaf;             ///< by triangle; kNull: in no leaf
  std::vector<std::uint32_t> triangles_below;  ///< by node; 0 for nodes not below the root

  /// `triangles`: number of triangles of the tree's mesh.
  TreeIndex(const capture::Tree& tree, std::size_t triangles);

  bool is_leaf(std::uint32_t node) const { return !has_children[node]; }
  std::vector<char> has_children;
};

/// A test of bounding volumes with the one that led to it.
struct Visit {
  static constexpr std::size_t kNone = ~std::size_t{0};
  std::size_t parent = kNone;    ///< index of an event; kNone: the first pair, or unknown
  std::optional<NodeStep> step;  ///< the nodes that the engine descended from here; nullopt: none
  std::uint8_t children = 0;     ///< number of pairs visited from here; saturates at 255
};

/// Returns a visit for each event of a query of two trees: finds the predecessor of each test, which is the
/// test of the parents, or of one parent and the other node. The visit of a triangle test has the test of its
/// leaves as parent; visits of counters and phases are unused.
std::vector<Visit> visits_of(const TreeIndex& tree_a, const TreeIndex& tree_b,
                             std::span<const capture::Event> events);

}  // namespace lrb::profile
