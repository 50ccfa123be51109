#pragma once
/// Faults of a captured tree: violations of what traversals rely on.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "scenarios/profile/query_walk.hpp"
#include "scenarios/profile/volumes.hpp"
#include <lrbscope/enum_names.hpp>
#include <lrbscope/ids.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

enum class TreeFault : std::uint8_t {
  two_parents,             ///< a node is a child of several nodes, or twice of one
  no_parent,               ///< a node other than the root is a child of no node
  cycle,                   ///< a node is below itself
  nonexistent_triangle,    ///< a leaf has a triangle that the mesh does not have
  triangle_in_two_leaves,  ///
  triangle_twice_in_leaf,  ///
  triangle_in_no_leaf,     ///< in no leaf below the root
  corner_outside,          ///< a corner of a triangle lies outside the volume of a node above it
  part_outside,            ///< spatial splits: a part of a triangle lies in the volumes of none of its leaves
  empty_volume,            ///< a volume contains no point, e.g. for a negative radius
  inner_node_with_triangles,  ///
  leaf_without_triangles,
};
constexpr auto enum_names(TreeFault) {
  return std::array<EnumName<TreeFault>, 12>{{
      {TreeFault::two_parents, "two_parents"},
      {TreeFault::no_parent, "no_parent"},
      {TreeFault::cycle, "cycle"},
      {TreeFault::nonexistent_triangle, "nonexistent_triangle"},
      {TreeFault::triangle_in_two_leaves, "triangle_in_two_leaves"},
      {TreeFault::triangle_twice_in_leaf, "triangle_twice_in_leaf"},
      {TreeFault::triangle_in_no_leaf, "triangle_in_no_leaf"},
      {TreeFault::corner_outside, "corner_outside"},
      {TreeFault::part_outside, "part_outside"},
      {TreeFault::empty_volume, "empty_volume"},
      {TreeFault::inner_node_with_triangles, "inner_node_with_triangles"},
      {TreeFault::leaf_without_triangles, "leaf_without_triangles"},
  }};
}
inline constexpr std::size_t kTreeFaults = kEnumNames<TreeFault>.size();

/// A fault. Nodes are numbered as in capture::Tree.
struct FoundFault {
  TreeFault kind = TreeFault::two_parents;
  std::uint32_t node = kNull;
  /// two_parents: the parents. cycle: the nodes from `node` downward. triangle_in_two_leaves: both leaves.
  std::vector<std::uint32_t> nodes = {};
  std::uint32_t triangle = kNull;
  /// no_parent: the number of nodes below. corner_outside: the number of corners outside, counted by
  /// triangle.
  std::uint64_t count = 0;
  // corner_outside: the farthest corner. part_outside: `point`, the centre of the largest part.
  int corner = -1;
  std::uint32_t depth = 0;
  /// Distance from the volume, and relative to the mesh's diagonal. part_outside: area, and share of the
  /// triangle's.
  double by = 0, by_share = 0;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
};

struct TreeFaults {
  static constexpr std::size_t kShown = 30;         ///< maximum number listed for each kind
  std::array<std::uint64_t, kTreeFaults> totals{};  ///< by kind; corner_outside: number of nodes
  std::vector<FoundFault> first;                    ///< by kind, kShown at most of each

  std::uint64_t total() const;
};

/// Returns the sentence that describes a fault, with the engine's numbers of nodes.
std::string text_of(const FoundFault& fault, const capture::Tree& tree, const capture::Mesh& mesh);

/// The measures of the volumes of nodes below the root; 0 for others.
struct NodeMeasures {
  std::vector<double> area, volume;
  std::vector<char> empty;
  std::vector<double> beyond_parent;  ///< how far a volume extends beyond its parent's, unless one is empty

  NodeMeasures(const Volumes& volumes, const TreeIndex& index);
};

/// Returns the faults of a tree. A corner may lie outside by `tolerance`, relative to the mesh's diagonal.
TreeFaults find_faults(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index,
                       const NodeMeasures& measures, double tolerance);

}  // namespace lrb::profile
