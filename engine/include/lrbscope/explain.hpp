#pragma once
/// Explains answers of the complete query: how it comes from the roots of both trees to two faces and what
/// decides between these, and what proves two bodies apart. Everything is asked of the query's own kernel,
/// one pair of tree nodes at a time, so that what is told is what happens.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/collide.hpp>
#include <lrbscope/enum_words.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

// The boxes of tree nodes as they lie in the world, in double arithmetic: to be shown, and to tell how far
// they are apart. The query compares them in floats and allows for all errors; these allow for none.

/// The axes across the sides of two boxes. The query compares boxes along these, and those of whole nodes
/// also along directions across an edge of each.
enum class BoxAxis : std::uint8_t { a1, a2, a3, b1, b2, b3 };
constexpr auto words_of(BoxAxis) {
  return std::to_array<EnumWord<BoxAxis>>({{BoxAxis::a1, "axis 1 of A's box"},
                                           {BoxAxis::a2, "axis 2 of A's box"},
                                           {BoxAxis::a3, "axis 3 of A's box"},
                                           {BoxAxis::b1, "axis 1 of B's box"},
                                           {BoxAxis::b2, "axis 2 of B's box"},
                                           {BoxAxis::b3, "axis 3 of B's box"}});
}

/// Two boxes that the query compared, as they lie in the world.
struct BoxPair {
  /// Of A's tree and of B's: the nodes whose boxes they are; of the boxes of faces, the leaves that hold
  /// them.
  std::array<std::uint32_t, 2> node = {0, 0};
  /// The distance of the boxes along the axis on which they are furthest apart, mesh's unit; negative where
  /// they overlap on all axes.
  double gap = 0;
  BoxAxis axis = BoxAxis::a1;  ///< that axis
};

/// A box in the world: a parallelepiped, for poses that are no rotations.
struct WorldBox {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> half;    ///< from the centre to the middle of a side
  std::array<Eigen::Vector3d, 3> across;  ///< unit vectors across the sides
};

constexpr int kWhole = -1;

/// Returns the box of a node's child or simplex, number 0 to 7 there, or with kWhole that of the whole node.
/// `pose`: body to world.
WorldBox box_of(const ObbTree& tree, std::uint32_t node, int child, const Pose& pose);

/// Sets the gap and the axis of two boxes.
void compare_boxes(const WorldBox& a, const WorldBox& b, BoxPair& out);

/// What decided about two faces.
enum class DecidedBy : std::uint8_t {
  node_boxes,  ///< boxes of nodes above them are apart
  node_edges,  ///< so are these, along a direction across an axis of each
  face_boxes,  ///< the boxes of the faces themselves are apart
  planes,      ///< the plane of one has all of the other on one side, in floats with bounded errors
  floats,      ///< other tests in floats with bounded errors
  exact,       ///< the exact test, because floats were not certain
};
constexpr auto words_of(DecidedBy) {
  return std::to_array<EnumWord<DecidedBy>>({{DecidedBy::node_boxes, "node_boxes"},
                                             {DecidedBy::node_edges, "node_edges"},
                                             {DecidedBy::face_boxes, "face_boxes"},
                                             {DecidedBy::planes, "planes"},
                                             {DecidedBy::floats, "floats"},
                                             {DecidedBy::exact, "exact"}});
}

/// On which sides of a face's plane (2D: line) the corners of the other face lie: 1 in front, -1 behind, 0 in
/// it.
struct PlaneSides {
  std::array<int, 3> exact = {0, 0, 0};
  std::array<int, 3> in_double = {0, 0, 0};    ///< as plain double arithmetic has it, right or wrong
  std::array<double, 3> distance = {0, 0, 0};  ///< signed, mesh's unit, in double; 0 where there is no plane
};

struct PairExplanation {
  SimplexPair pair;
  exact::Meet meet = exact::Meet::disjoint;
  DecidedBy decided_by = DecidedBy::exact;
  /// From the roots down: boxes as their parents have them. The last ones are the leaves of both faces, or
  /// the boxes that are apart; where these are the nodes' own, their nodes come twice.
  std::vector<BoxPair> nodes;
  bool reaches_faces = false;  ///< the query came to the boxes of the faces
  BoxPair face_boxes;          ///< valid if it did
  /// The regions that hide A's and B's face in the outermost wrapper, from the outside inward.
  std::array<std::vector<RegionId>, 2> hidden_by;
  std::array<PlaneSides, 2> sides;  ///< A's corners by B's plane, B's corners by A's
  exact::PairContact contact;       ///< of faces that meet
  /// Of faces that do not meet: their nearest points (world) and distance (mesh's unit), in double. The plane
  /// across the line between these points, at its middle, has the faces on different sides.
  std::array<Eigen::Vector3d, 2> nearest;
  double distance = 0;
  double ulp = 0;  ///< of the largest world coordinate of the two faces
};

/// Explains pairs of two bodies, one after the other.
class PairExplainer {
 public:
  /// The bodies must outlive this object.
  PairExplainer(const LrbRep& a, const LrbRep& b);
  ~PairExplainer();
  PairExplainer(const PairExplainer&) = delete;
  PairExplainer& operator=(const PairExplainer&) = delete;

  /// Puts the bodies where they stand; comes before the first explain(). Throws as collide() does.
  void place(const Pose& pose_a, const Pose& pose_b);
  /// Explains how two real simplices come out. Throws InputError if a simplex is not real or does not exist.
  PairExplanation explain(const SimplexPair& pair);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Explains one pair, as PairExplainer does.
PairExplanation explain_pair(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                             const SimplexPair& pair);

/// The pairs of nodes at one depth.
struct WalkDepth {
  std::uint64_t node_pairs = 0;  ///< compared
  std::uint64_t ended = 0;       ///< those of them of which no two boxes meet
};

/// A plane that has one body on each side: n.x <= of_a for all of A, n.x >= of_b > of_a for all of B.
struct PartingPlane {
  Eigen::Vector3d normal{0, 0, 0};       ///< length 1, world, from A to B
  double of_a = 0, of_b = 0;             ///< mesh's unit
  std::array<Eigen::Vector3d, 2> reach;  ///< a vertex of A, and one of B, that reach so far; world

  double gap() const { return of_b - of_a; }
};

/// Two boxes that the query compared and found apart.
struct PartedBoxes {
  BoxPair pair;  ///< the nodes that are these boxes' own; of boxes of faces, the leaves
  std::array<WorldBox, 2> boxes;
  bool of_faces = false;  ///< both are boxes of faces
};

/// The walk of the complete query over two bodies.
struct WalkExplanation {
  CollideResult result;           ///< as collide() gives it, with a separation where there is one
  BoxPair roots;                  ///< the boxes round both bodies
  std::vector<WalkDepth> depths;  ///< by the number of steps from the roots
  std::uint64_t leaf_pairs = 0;   ///< pairs of leaves whose faces were compared
  std::uint64_t face_pairs = 0;   ///< pairs of faces whose boxes meet
  std::uint64_t left = 0;         ///< those of them that planes do not part; these are compared one by one
  std::uint64_t certain = 0;      ///< those of them about which floats are certain
  /// Of bodies that do not meet: the two boxes that are nearest to each other among those found apart along
  /// an axis across their sides. Nodes that are apart only along a direction across an edge of each are left
  /// out.
  std::optional<PartedBoxes> nearest_boxes;
  std::optional<PartingPlane> plane;  ///< of separate bodies: the best that was found; often none exists
  /// The pairs among those left that are nearest to each other, of bodies that do not meet: nearest first, at
  /// most kMostNear.
  std::vector<SimplexPair> near;
  static constexpr std::size_t kMostNear = 5;
};

/// Walks both trees as the complete query for all pairs does, and tells what it did. Throws as collide()
/// does.
WalkExplanation explain_walk(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);

}  // namespace lrb
