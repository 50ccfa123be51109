#pragma once

#include <array>
#include <vector>

#include <Eigen/Geometry>

#include <lrbscope/ids.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

/// The extreme vertices of a body in its previous pose: lowest x, highest x, lowest y, ... They speed up the
/// next search if the body has moved little, and do not affect its result.
struct ExtremeVertices {
  std::array<VertexId, 6> vertex{kNull, kNull, kNull, kNull, kNull, kNull};
};

/// Returns the world AABB of a body's real faces: exactly the minima and maxima of the world coordinates
/// (Pose::apply) of their corners. Bodies whose boxes are disjoint are therefore disjoint. For a pose that
/// may move the body beyond the range of doubles, which collide() rejects, returns a box that intersects
/// every box.
///
/// Descends the OBB tree in each of six directions, best bound first, and prunes nodes whose bound, including
/// all rounding errors, is within the extremes found. Visits few vertices of a large body (all those that are
/// within rounding of the box, as on a flat side perpendicular to an axis).
Eigen::AlignedBox3d world_box(const LrbRep& rep, const Pose& pose, ExtremeVertices* last = nullptr);

/// Returns true if the world AABBs of two bodies are disjoint. Exact for any finite coordinates. Stops as
/// soon as that is decided. A body without faces is disjoint from every body.
bool world_boxes_are_disjoint(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b);

/// Computes world_box() by the faster method for the body: for a small one, transforms every corner. Create
/// one per body and share it between threads. The LRB-rep must outlive it.
class BodyExtent {
 public:
  explicit BodyExtent(const LrbRep& rep);
  /// Returns world_box() of the body.
  Eigen::AlignedBox3d in_world(const Pose& pose, ExtremeVertices* last = nullptr) const;

 private:
  const LrbRep* rep_;
  /// Distinct corners of the real faces; empty if the tree is faster.
  std::vector<Eigen::Vector3d> corners_;
};

}  // namespace lrb
