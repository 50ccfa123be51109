#pragma once
/// The traversal of a captured query: which pair of nodes led to which.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include <lrbscope/ids.hpp>
#include <lrbscope/observe.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

/// The parents of a captured tree's nodes and the leaves of its triangles. Valid for broken trees, too: of
/// several parents or leaves the first one counts, and nodes that the root does not reach have no depth.
struct TreeIndex {
  std::vector<std::uint32_t> parent;           ///< by node; kNull: the root, or no parent
  std::vector<std::uint32_t> depth;            ///< by node; kNull: not below the root
  std::vector<std::uint32_t> from_root;        ///< the nodes below the root, breadth first, each once
  std::vector<std::uint32_t> leaf;             ///< by triangle; kNull: in no leaf
  std::vector<std::uint32_t> triangles_below;  ///< by node; 0 for nodes not below the root

  /// `triangles`: number of triangles of the tree's mesh.
  TreeIndex(const capture::Tree& tree, std::size_t triangles);
  /// A side without a tree: one leaf, node 0, that contains all triangles.
  explicit TreeIndex(std::size_t triangles);

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

/// Finds the predecessor of each test: the test of the parents, or of one parent and the other node.
class Descent {
 public:
  /// The indices must outlive this object.
  Descent(const TreeIndex& a, const TreeIndex& b) : trees_{&a, &b} {}

  /// Returns a visit for each event; those of counters and phases are unused. The visit of a triangle test
  /// has the test of its leaves as parent.
  std::vector<Visit> visits_of(std::span<const capture::Event> events);

  /// Returns the index of the last test of two nodes in the events given last, or Visit::kNone.
  std::size_t test_of(std::uint32_t a, std::uint32_t b) const;

 private:
  const TreeIndex* trees_[2];
  std::unordered_map<std::uint64_t, std::size_t> visited_;
};

}  // namespace lrb::profile
