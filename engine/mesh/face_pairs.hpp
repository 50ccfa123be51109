#pragma once
/// Broad phase among the faces of one mesh: the pairs that may intersect, in less than quadratic time.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "engine/mesh/box_tree.hpp"
#include "engine/mesh/hubs.hpp"
#include <lrbscope/mesh.hpp>
#include <lrbscope/mesh_check.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

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

  const UnitCube& cube() const { return cube_; }
  /// Returns true if a face has very many corners (more than kFewNeighbours) and thus needs a tree of its own
  /// triangles.
  bool is_large(FaceId f) const { return is_large_[f]; }

 private:
  struct Node : BoxTree::Node {  ///< first, last: into order_
    OrientedBox slim;
    bool of_one_hub = false;  ///< its inner pairs are found by for_each_pair_at()
  };
  /// An indivisible item of the tree: a face, or, from |F| on, all faces of a high-valence vertex.
  struct Unit {
    std::uint32_t id;
    Eigen::Vector3d centre;
    bool operator<(const Unit& other) const { return id < other.id; }
  };

  bool boxes_are_crowded() const;
  void build();
  std::vector<Unit> units() const;
  std::uint32_t build(std::span<Unit> units);
  void close_node(std::uint32_t index);
  void try_pair(FaceId f, FaceId g, const Visit& visit) const;

  const Mesh& mesh_;
  std::vector<Box> boxes_;      ///< (|F|) empty for omitted faces
  std::vector<bool> is_large_;  ///< (|F|)
  UnitCube cube_;
  Hubs hubs_;
  std::vector<FaceId> order_;  ///< in the order of the tree's leaves
  std::vector<Node> nodes_;
  std::optional<BoxTree> tree_;  ///< replaces the nodes if AABBs are sufficient
};

}  // namespace lrb
