#pragma once
/// Explanations of the complete query's answers: the path from the roots of both trees to two faces and the
/// test that decides them, and the proof that two bodies are separate. Every step is computed by the query's
/// own kernel, one pair of tree nodes at a time, so the explanation matches the query.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/collide.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

// The boxes of tree nodes in the world, in double arithmetic, for display and distances. The query compares
// them in floats and accounts for all rounding errors; these functions do not.

/// The face normals of two boxes. The query tests boxes along these axes, and the OBBs of nodes also along
/// cross products of their edges.
enum class BoxAxis : std::uint8_t { a1, a2, a3, b1, b2, b3 };
constexpr auto enum_names(BoxAxis) {
  return std::to_array<EnumName<BoxAxis>>({{BoxAxis::a1, "axis 1 of A's box"},
                                           {BoxAxis::a2, "axis 2 of A's box"},
                                           {BoxAxis::a3, "axis 3 of A's box"},
                                           {BoxAxis::b1, "axis 1 of B's box"},
                                           {BoxAxis::b2, "axis 2 of B's box"},
                                           {BoxAxis::b3, "axis 3 of B's box"}});
}

/// Two boxes compared by the query, in the world.
struct BoxPair {
  /// Nodes of A's tree and of B's that the boxes belong to. For boxes of faces: the leaves that contain them.
  std::array<std::uint32_t, 2> node = {0, 0};
  /// Largest distance of the boxes along one of the axes, mesh units; negative if they overlap on all axes.
  double gap = 0;
  BoxAxis axis = BoxAxis::a1;  ///< the axis of that distance
};

/// A box in the world. A parallelepiped if the pose is not a rotation.
struct WorldBox {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> half;    ///< from the centre to the centre of a side
  std::array<Eigen::Vector3d, 3> across;  ///< unit normals of the sides
};

/// Value of `child` that selects the box of the node itself.
constexpr int kWhole = -1;

/// Returns the box of a node's child or simplex (`child` 0 to 7), or with kWhole of the node itself. `pose`:
/// body to world.
WorldBox box_of(const ObbTree& tree, std::uint32_t node, int child, const Pose& pose);

/// Computes the gap of two boxes and its axis. With `dim` 2 only the axes in the plane are compared: boxes of
/// 2D bodies have a small thickness.
void compare_boxes(const WorldBox& a, const WorldBox& b, BoxPair& out, int dim = 3);

/// The test that decided a pair of faces.
enum class DecidedBy : std::uint8_t {
  node_boxes,  ///< boxes of nodes above them are disjoint
  node_edges,  ///< the same, along a cross product of an edge of each
  face_boxes,  ///< the boxes of the faces themselves are disjoint
  planes,      ///< the plane of one separates it from the other, in floats with bounded errors
  floats,      ///< other tests in floats with bounded errors
  exact,       ///< the exact test, because floats could not decide
};
constexpr auto enum_names(DecidedBy) {
  return std::to_array<EnumName<DecidedBy>>({{DecidedBy::node_boxes, "node_boxes"},
                                             {DecidedBy::node_edges, "node_edges"},
                                             {DecidedBy::face_boxes, "face_boxes"},
                                             {DecidedBy::planes, "planes"},
                                             {DecidedBy::floats, "floats"},
                                             {DecidedBy::exact, "exact"}});
}

/// The sides of a face's plane (2D: line) on which the other face's corners are: 1 in front, -1 behind, 0 in
/// the plane.
struct PlaneSides {
  std::array<int, 3> exact = {0, 0, 0};
  std::array<int, 3> in_double = {0, 0, 0};    ///< by plain double arithmetic, which may be wrong
  std::array<double, 3> distance = {0, 0, 0};  ///< signed, mesh units, in double; 0 if the face spans no
                                               ///< plane
};

struct PairExplanation {
  SimplexPair pair;
  exact::Meet meet = exact::Meet::disjoint;
  DecidedBy decided_by = DecidedBy::exact;
  /// From the roots down: boxes as stored in their parents. The last pair are the leaves of both faces, or
  /// the boxes that are disjoint. If those are the nodes' own OBBs, their nodes are listed twice.
  std::vector<BoxPair> nodes;
  bool reaches_faces = false;  ///< the query reached the boxes of the faces
  BoxPair face_boxes;          ///< valid if reaches_faces
  /// The regions that hide the faces of A and B in the outermost wrapper, from the outside inward.
  std::array<std::vector<RegionId>, 2> hidden_by;
  std::array<PlaneSides, 2> sides;  ///< A's corners relative to B's plane, B's corners relative to A's
  exact::PairContact contact;       ///< if the faces intersect
  /// If they do not: closest points (world) and distance (mesh units), in double. The perpendicular bisecting
  /// plane of the closest points separates the faces.
  std::array<Eigen::Vector3d, 2> nearest;
  double distance = 0;
  double ulp = 0;  ///< unit in the last place of the largest world coordinate of the two faces
};

/// Explains several pairs of faces of the same two bodies.
class PairExplainer {
 public:
  /// The bodies must outlive this object.
  PairExplainer(const LrbRep& a, const LrbRep& b);
  ~PairExplainer();
  PairExplainer(const PairExplainer&) = delete;
  PairExplainer& operator=(const PairExplainer&) = delete;

  /// Sets the poses. Must be called before the first explain(). Throws as collide() does.
  void place(const Pose& pose_a, const Pose& pose_b);
  /// Explains the test of two real simplices. Throws InputError if a simplex is not real or does not exist.
  PairExplanation explain(const SimplexPair& pair);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Explains one pair, as PairExplainer does.
PairExplanation explain_pair(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                             const SimplexPair& pair);

/// The pairs of nodes at one depth of the traversal.
struct WalkDepth {
  std::uint64_t node_pairs = 0;  ///< pairs compared
  std::uint64_t ended = 0;       ///< pairs without intersecting child boxes
};

/// A separating plane: n.x <= of_a for all points of A, n.x >= of_b > of_a for all points of B.
struct SeparatingPlane {
  Eigen::Vector3d normal{0, 0, 0};       ///< unit length, world frame, from A to B
  double of_a = 0, of_b = 0;             ///< mesh units
  std::array<Eigen::Vector3d, 2> reach;  ///< a vertex of A and one of B that attain these bounds; world frame

  double gap() const { return of_b - of_a; }
};

/// Two boxes that the query compared and found disjoint.
struct SeparatingBoxes {
  BoxPair pair;  ///< the nodes of these boxes; for boxes of faces, their leaves
  std::array<WorldBox, 2> boxes;
  bool of_faces = false;  ///< both are boxes of faces
};

/// The traversal of the complete query over two bodies.
struct WalkExplanation {
  CollideResult result;           ///< as collide() returns it, with a separation if there is one
  BoxPair roots;                  ///< the root boxes of both bodies
  std::vector<WalkDepth> depths;  ///< indexed by distance from the roots
  std::uint64_t leaf_pairs = 0;   ///< pairs of leaves whose faces were compared
  std::uint64_t face_pairs = 0;   ///< pairs of faces whose boxes intersect
  std::uint64_t left = 0;         ///< pairs among these that planes do not separate; tested one by one
  std::uint64_t certain = 0;      ///< pairs among these that are decided in floats
  /// If the bodies do not intersect: the closest two boxes among those found disjoint along a face normal.
  /// Nodes rejected only along a cross product of edges are not considered.
  std::optional<SeparatingBoxes> nearest_boxes;
  std::optional<SeparatingPlane> plane;  ///< for separate bodies: the best separating plane found; often none
                                         ///< exists
  /// If the bodies do not intersect: the closest pairs among those tested one by one, closest first, at most
  /// kMaxNear.
  std::vector<SimplexPair> near;
  static constexpr std::size_t kMaxNear = 5;
};

/// Traverses both trees as the complete query for all pairs does, and records its steps. Throws as collide()
/// does.
WalkExplanation explain_walk(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);

}  // namespace lrb
