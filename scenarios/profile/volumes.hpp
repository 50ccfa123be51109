#pragma once
/// Geometry of the bounding volumes of a captured tree.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/pose.hpp>
#include <lrbscope/trace/capture.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::profile {

/// The bounding volumes of a tree, in the frame and unit of its mesh. The tree must outlive this object.
class Volumes {
 public:
  explicit Volumes(const capture::Tree& tree) : tree_(&tree) {}

  /// Returns how far p lies outside the volume of a node; 0 inside. For a k-DOP, the largest excess along a
  /// direction, which is at most the distance.
  double outside(std::uint32_t node, const Eigen::Vector3d& p) const;
  /// Surface area. For a k-DOP, that of its polytope.
  double area(std::uint32_t node) const;
  double volume(std::uint32_t node) const;
  /// Returns the smallest box of the volume's own frame that contains it; an OBB's own box.
  trace::ShapeBox box(std::uint32_t node) const;
  /// Returns points whose convex hull contains the volume, and that lie on it except for spheres and RSS
  /// (there: corners of box()).
  std::vector<Eigen::Vector3d> corners(std::uint32_t node) const;

  const capture::Tree& tree() const { return *tree_; }

 private:
  const capture::Tree* tree_;
};

/// Returns true if two volumes overlap at these poses, computed in doubles: by separating axes for boxes, by
/// distance for spheres and RSS, in other cases by the boxes of both.
bool overlap(const Volumes& a, std::uint32_t node_a, const Pose& pose_a, const Volumes& b,
             std::uint32_t node_b, const Pose& pose_b);

}  // namespace lrb::profile
