#pragma once
/// Proves, exactly, that a cap can be accepted: its new triangles intersect others only in shared vertices
/// and edges.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/cap_surface.hpp"
#include "engine/construct/front_mesh.hpp"
#include <lrbscope/build.hpp>

namespace lrb::construct {

/// A triangle of the complex; refers to the coordinates of its corners.
struct CheckedTriangle {
  std::array<const double*, 3> x;
  std::array<VertexId, 3> id;
  Eigen::AlignedBox3d box;

  CheckedTriangle() = default;
  CheckedTriangle(const FrontMesh::Point& a, const FrontMesh::Point& b, const FrontMesh::Point& c);
  /// Returns true if the two triangles intersect only in shared vertices and edges.
  bool clear_of(const CheckedTriangle& other) const;
};

/// Culls boxes that a triangle cannot intersect, by the triangle's own box and by its plane.
class TriangleReach {
 public:
  explicit TriangleReach(const CheckedTriangle& t);
  /// Returns false only if the triangle is proven to be outside the box.
  bool may_meet(const Eigen::AlignedBox3d& other) const;

 private:
  Eigen::AlignedBox3d box_;
  Eigen::Vector3d corner_, normal_;
  double slack_;  ///< rounding slack, relative to distances from the corner
};

/// Returns true if a rotation about the edge a, b, from the old triangle (a, b, p) through the space in front
/// of it, reaches the new triangle (a, b, w) before the neighbour (b, a, q). Exact.
bool turns_outward(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& p,
                   const Eigen::Vector3d& w, const Eigen::Vector3d& q);

class EmbedCheck {
 public:
  EmbedCheck(const FrontMesh& front, const AabbTree& tree) : front_(front), tree_(tree) {}
  /// Sets the boxes of the components (in the front's numbering), so that a cap over a patch of one component
  /// never encloses another.
  void set_component_boxes(std::vector<Eigen::AlignedBox3d> boxes) { component_boxes_ = std::move(boxes); }

  /// Returns CapVerdict::accepted if the cap's new triangles intersect neither the front outside the patch
  /// nor the patch nor each other, and the entire front outside the patch is outside the region between patch
  /// and cap; otherwise returns the obstacle.
  CapVerdict judge_cap(const Patch& patch, const CapSurface& cap);
  /// Checks a fan from w that is to replace a star of the cap. Returns as judge_cap().
  CapVerdict judge_fan(const Patch& patch, const CapSurface& cap, const CapSurface::Star& star,
                       const FrontMesh::Point& w);

  /// Returns a box around all space that the checks have read, apart from triangles that share a vertex with
  /// the patch.
  const Eigen::AlignedBox3d& seen() const { return seen_; }
  void forget_seen() { seen_.setEmpty(); }

 private:
  void gather_front(const Patch& patch, const CapSurface& cap, const Eigen::AlignedBox3d& box);
  void gather_strangers(const Patch& patch, const Eigen::AlignedBox3d& box);
  void add_patch(const Patch& patch);
  bool added_meet_each_other() const;
  CapVerdict judge_added(std::size_t of_patch) const;
  bool ring_turns_outward(const Patch& patch, const CapSurface& cap) const;
  bool rim_turns_outward(const CapSurface& cap, const CapSurface::Star& star, const Eigen::Vector3d& w) const;
  bool encloses_component(const Patch& patch, const CapSurface& cap, const Eigen::AlignedBox3d& box);

  const FrontMesh& front_;
  const AabbTree& tree_;
  std::vector<Eigen::AlignedBox3d> component_boxes_;
  Eigen::AlignedBox3d seen_;
  std::vector<CheckedTriangle> obstacles_, added_;
  std::vector<TriangleReach> reach_;        ///< of `added_`
  std::vector<FrontMesh::Slot> strangers_;  ///< gathered triangles of other components, one of each
  std::vector<std::uint32_t> met_;          ///< (components) == stamp_: found while gathering
  std::uint32_t stamp_ = 0;
};

}  // namespace lrb::construct
