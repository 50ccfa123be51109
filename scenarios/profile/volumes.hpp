#pragma once
/// Geometry of the bounding volumes of a captured tree.

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/pose.hpp>
#include <lrbscope/trace/capture.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::profile {

/// The points x with normal.dot(x) <= offset. The normal has unit length.
struct HalfSpace {
  Eigen::Vector3d normal;
  double offset;
};

/// Clips a convex polygon to a half-space (Sutherland and Hodgman 1974). It becomes empty if it lies outside.
void clip(std::vector<Eigen::Vector3d>& polygon, const HalfSpace& half);
/// Returns the area of a planar polygon.
double area_of(const std::vector<Eigen::Vector3d>& polygon);

/// A k-DOP as a solid. Flat ones have two coincident sides; empty ones have no corners.
struct Polytope {
  std::vector<Eigen::Vector3d> corners;  ///< corners shared by several faces occur several times
  double area = 0, volume = 0;
};

/// The surface area and the volume of a bounding volume.
struct VolumeSize {
  double area = 0, volume = 0;
  bool is_empty = false;  ///< it contains no point, e.g. for a negative radius
};

/// The bounding volumes of a tree, in the frame and unit of its mesh. The tree must outlive this object.
class Volumes {
 public:
  /// Throws InputError for k-DOPs whose directions do not span space.
  explicit Volumes(const capture::Tree& tree);

  /// Returns how far p lies outside the volume of a node; 0 inside. For a k-DOP, the largest excess along a
  /// direction, which is at most the distance.
  double outside(std::uint32_t node, const Eigen::Vector3d& p) const;
  /// Returns how far the volume of a node extends beyond that of another; 0 if it lies inside. Measured by
  /// outside(); for a sphere or RSS within a box or k-DOP, between the boxes of both.
  double excess(std::uint32_t node, std::uint32_t beyond) const;
  /// Returns the volume of the intersection with another volume; nullopt for RSS.
  std::optional<double> shared_volume(std::uint32_t node, std::uint32_t other) const;
  /// Returns area and volume. For a k-DOP, those of its polytope; zeros if it is empty.
  VolumeSize size(std::uint32_t node) const;
  bool empty(std::uint32_t node) const { return size(node).is_empty; }
  /// Returns the smallest box of the volume's own frame that contains it; an OBB's own box. For a k-DOP, the
  /// frame is three of its directions if these are orthogonal, else the coordinate axes.
  trace::ShapeBox box(std::uint32_t node) const;
  /// Returns points whose convex hull contains the volume, and that lie on it except for spheres and RSS
  /// (there: corners of box()).
  std::vector<Eigen::Vector3d> corners(std::uint32_t node) const;
  /// Returns the half-spaces whose intersection is the volume: of an AABB, OBB or k-DOP; none for others.
  std::vector<HalfSpace> half_spaces(std::uint32_t node) const;
  /// Returns the solid of a k-DOP.
  Polytope polytope(std::uint32_t node) const;

  const capture::Tree& tree() const { return *tree_; }

 private:
  /// Finds the centre and half of the extent of a k-DOP along its three independent directions.
  void products(std::uint32_t node, Eigen::Vector3d& centre, Eigen::Vector3d& reach) const;

  const capture::Tree* tree_;
  std::array<std::size_t, 3> spanning_{};  ///< k-DOPs: indices of three independent directions
  Eigen::Matrix3d from_products_;          ///< k-DOPs: a point from its products with these
};

/// Returns true if two volumes overlap at these poses, computed in doubles: by separating axes for boxes, by
/// distance for two spheres or RSS, in other cases by the boxes of both.
bool overlap(const Volumes& a, std::uint32_t node_a, const Pose& pose_a, const Volumes& b,
             std::uint32_t node_b, const Pose& pose_b);

/// Returns the distance of two volumes at these poses, computed in doubles: of two spheres or RSS, otherwise
/// of the boxes of both. 0 if they overlap; infinite if one is empty.
double gap(const Volumes& a, std::uint32_t node_a, const Pose& pose_a, const Volumes& b, std::uint32_t node_b,
           const Pose& pose_b);

}  // namespace lrb::profile
