#pragma once
/// Figures of a captured tree: quality measures without a query.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "scenarios/profile/query_walk.hpp"
#include "scenarios/profile/tree_faults.hpp"
#include "scenarios/profile/volumes.hpp"
#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

/// The subtrees of a tree as ranges: of nodes in preorder, and of triangles in the order of their leaves.
/// Nodes that the root does not reach, and triangles that do not exist, are left out.
struct Subtrees {
  std::vector<std::uint32_t> position, end;  ///< by node: its place in preorder, and that after its subtree
  std::vector<std::uint32_t> nodes;          ///< in preorder, each once
  std::vector<std::uint32_t> triangles;      ///< by leaf, in preorder
  std::vector<std::uint32_t> first_triangle, last_triangle;  ///< by node: its range in `triangles`

  Subtrees(const capture::Tree& tree, const TreeIndex& index, std::size_t triangle_count);

  bool contains(std::uint32_t node, std::uint32_t below) const {
    return position[node] <= position[below] && position[below] < end[node];
  }
  std::span<const std::uint32_t> triangles_of(std::uint32_t node) const {
    return {triangles.data() + first_triangle[node], triangles.data() + last_triangle[node]};
  }
};

/// Returns the diagonal of the box around the mesh's triangles.
double diagonal_of(const capture::Mesh& mesh);

/// Costs in SAH and EPO: the visit of an inner node, and the test of a triangle (Aila, Karras and Laine
/// 2013).
inline constexpr double kInnerCost = 1.2, kTriangleCost = 1;

/// End-point overlap (Aila, Karras and Laine, "On Quality Metrics of Bounding Volume Hierarchies", 2013): the
/// sum over nodes of the area of the surface in the node's volume that does not belong to its subtree, times
/// the node's cost, over the area of the surface. A node's cost is kInnerCost, or kTriangleCost for each
/// triangle of a leaf.
struct Epo {
  double value = 0;
  double error = 0;             ///< standard error of `value`; 0 if exact
  std::uint64_t samples = 0;    ///< points of the surface; 0: exact
  std::vector<double> by_node;  ///< their sum is `value`
};

/// Estimates EPO from points of the surface, uniform by area. Takes fewer than `samples` points if these
/// would need more than thirty million tests. nullopt: the surface has no area.
std::optional<Epo> sample_epo(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index,
                              std::uint64_t samples, std::uint64_t seed);
/// Computes EPO by clipping triangles to volumes. nullopt: the surface has no area, or the volumes are
/// spheres or RSS.
std::optional<Epo> exact_epo(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index);

/// Siblings: children of one node.
struct SiblingFigures {
  static constexpr std::size_t kMaxChildren = 64;  ///< wider nodes are left out
  std::uint64_t pairs = 0, overlapping = 0, nodes_left_out = 0;
  /// Mean over pairs of the volume of the intersection / that of the smaller volume; pairs with a flat volume
  /// are left out. nullopt: RSS, or no pairs.
  std::optional<double> shared;
};

/// Volume of a node / that of the tightest box of its triangles in the frame of Volumes::box(). Nodes whose
/// triangles lie in a plane along this frame are left out.
struct LoosenessFigures {
  double median = 0, p90 = 0, largest = 0;
  std::uint32_t node = kNull;  ///< of the largest
};

/// Children whose volumes extend beyond their parent's. No fault: trees of OBBs are fitted to triangles.
struct BeyondParent {
  std::uint64_t count = 0, of = 0;
  double share = 0;  ///< the largest excess, relative to the mesh's diagonal
  std::uint32_t node = kNull;
};

struct DepthFigures {
  std::uint64_t nodes = 0, leaves = 0;
  double area = 0;  ///< sum of the nodes' areas / the root's
  double epo = 0;
};

struct NodeFigures {
  std::uint32_t node = 0, depth = 0, triangles = 0;  ///< triangles below
  double area = 0;                                   ///< relative to the root's
  double epo = 0;
};

struct TreeFigures {
  std::uint32_t nodes = 0, leaves = 0,
                unreached = 0;                        ///< unreached: not below the root, not in other figures
  std::uint32_t depth = 0;                            ///< the greatest; 0: the root
  double mean_depth = 0;                              ///< of leaves
  std::map<std::uint64_t, std::uint64_t> leaf_sizes;  ///< number of leaves by number of triangles
  /// Sums of areas / the root's: of inner nodes, and of leaves times their numbers of triangles. nullopt: the
  /// root has no area.
  std::optional<double> sah_inner, sah_leaves;
  std::optional<Epo> epo;
  SiblingFigures siblings;
  std::optional<LoosenessFigures> looseness;
  BeyondParent beyond;
  std::uint64_t volume_bytes = 0;      ///< of the volumes' numbers as doubles
  std::vector<DepthFigures> by_depth;  ///< the root's first
  std::vector<NodeFigures> worst;      ///< by EPO, ten at most
  std::vector<double> area;            ///< by node

  /// Returns the cost by the surface area heuristic.
  std::optional<double> sah() const;
};

struct TreeReport {
  TreeFigures figures;
  TreeFaults faults;
};

struct TreeOptions {
  bool exact = false;  ///< EPO by clipping if possible
  std::uint64_t samples = 20'000, seed = 1;
  double tolerance = 1e-7;  ///< of corners outside volumes, relative to the mesh's diagonal
};

/// Measures a tree. Throws InputError for one without nodes, and as Volumes.
TreeReport report_tree(const capture::Tree& tree, const capture::Mesh& mesh, const TreeOptions& options = {});

/// Returns the faults alone, with the default tolerance.
TreeFaults faults_of(const Volumes& volumes, const capture::Mesh& mesh, const TreeIndex& index);

/// lrbscope's own tree in the form of a capture.
struct OwnTree {
  capture::Mesh mesh;  ///< the real simplices; a segment repeats its second corner
  capture::Tree tree;  ///< OBBs
};
OwnTree own_tree(const LrbRep& rep, const trace::TreeShape& shape);

}  // namespace lrb::profile
