#pragma once
/// The pairs of a mesh's faces that may meet, without looking at all of them.

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "engine/core/parallel.hpp"
#include "engine/mesh/box_pairs.hpp"
#include "engine/mesh/face_checks.hpp"
#include "engine/mesh/hubs.hpp"
#include "engine/mesh/mesh.hpp"
#include "engine/mesh/oriented_box.hpp"

namespace lrb {

/// Takes about n log n steps for n faces, plus the number of pairs that do meet.
///
/// Most meshes need no more than a tree of boxes along the axes. Where thousands of faces meet in one vertex,
/// where one face has thousands of corners, or where large faces lie close in front of each other, very many
/// such boxes overlap. Then the faces of a hub are compared by their
/// directions from it (hubs.hpp), and all others in a tree whose nodes have a box that is turned to fit as
/// well: needles from two apexes to a common ring overlap in boxes along the axes, and do not in turned ones.
class FacePairs {
 public:
  using Visit = std::function<void(FaceId, FaceId)>;

  /// Faces that are not at least FaceUse::area are left out.
  FacePairs(const Mesh& mesh, const std::vector<FaceUse>& use);
  FacePairs(const FacePairs&) = delete;
  FacePairs& operator=(const FacePairs&) = delete;

  /// Calls visit(f, g), f < g, once for every two faces whose boxes along the axes meet, but for pairs that
  /// are proved to have nothing in common except perhaps one corner by index. In no order to rely on, and
  /// from several threads at once if `workers` has them.
  void for_each(const Visit& visit, Workers& workers) const;

  const std::vector<Box>& boxes() const { return boxes_; }  ///< (|F|) empty for faces left out
  const UnitCube& cube() const { return cube_; }
  /// Returns true if a face has so many corners that it should be searched through a tree of its own.
  bool is_large(FaceId f) const { return is_large_[f]; }

 private:
  struct Node {
    Box box;
    OrientedBox slim;
    std::uint32_t first = 0, last = 0;  ///< into order_
    std::uint32_t right = 0;            ///< child; the left one follows its parent. 0: leaf
    bool of_one_hub = false;            ///< pairs within the hub are found by other means
  };
  /// What stays together in the tree: the faces of a hub, or one face.
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
  std::vector<FaceId> order_;  ///< by leaves of the tree
  std::vector<Node> nodes_;
  std::optional<BoxTree> tree_;  ///< in place of the nodes, where boxes along the axes are enough
};

}  // namespace lrb
