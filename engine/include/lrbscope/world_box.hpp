#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

/// The vertices of one body that were farthest out the last time: lowest x, highest x, lowest y, ... They
/// make the next search short if the body has moved little, and cost nothing but time if it has not.
struct ExtremeVertices {
  std::array<VertexId, 6> vertex{kNull, kNull, kNull, kNull, kNull, kNull};
};

/// Returns the box around a body's real faces in the world: exactly the least and greatest world coordinates
/// (Pose::apply) of their corners, so that two bodies whose boxes have no point in common have none either. A
/// pose that may take the body beyond the range of doubles, which collide() refuses, gives a box that meets
/// everything.
///
/// Descends the body's OBB tree in each of six directions, best bound first, and only where a bound, with all
/// rounding added, is beyond what has been found: of large bodies it looks at few vertices (at all of those
/// that lie within rounding of the box, as on a flat side along an axis).
Eigen::AlignedBox3d world_box(const LrbRep& rep, const Pose& pose, ExtremeVertices* last = nullptr);

/// Returns true if the world boxes of two bodies have no point in common, exactly, whatever the size of their
/// coordinates, which must be finite. Ends as soon as that is known. A body without faces is apart from all.
bool world_boxes_are_apart(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);

/// Finds the box of world_box() in the way that is quicker for the body: of a small one it looks at every
/// corner. Made once per body, for all threads; the LRB-rep must outlive it.
class BodyExtent {
 public:
  explicit BodyExtent(const LrbRep& rep);
  Eigen::AlignedBox3d in_world(const Pose& pose, ExtremeVertices* last = nullptr) const;

 private:
  const LrbRep* rep_;
  /// Corners of the real faces, each once; none if the tree is quicker.
  std::vector<Eigen::Vector3d> corners_;
};

}  // namespace lrb
