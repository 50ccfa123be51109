#pragma once
/// Exact tests of whether new triangles leave the front embedded: they intersect others only in shared
/// vertices and edges, and turn to the outside at their boundary.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "engine/construct/aabb_tree.hpp"
#include "engine/construct/front_mesh.hpp"
#include "engine/construct/open_front.hpp"
#include "engine/exact/plane_side.hpp"
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
  double slack() const { return slack_; }

 private:
  Eigen::AlignedBox3d box_;
  Eigen::Vector3d corner_, normal_;
  double slack_;  ///< rounding slack, relative to distances from the corner
};

/// Returns true if a rotation about the edge a, b, from the old triangle (a, b, p) through the space in front
/// of it, reaches the new triangle (a, b, w) before the neighbour (b, a, q). Exact.
bool turns_outward(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& p,
                   const Eigen::Vector3d& w, const Eigen::Vector3d& q);

/// Proves, exactly, that the lid of a component can become part of the committed front.
class LidProof {
 public:
  /// `component_boxes`: boxes of the components of the mesh (in the front's numbering), so that a lid over
  /// one component never encloses another.
  LidProof(const OpenFront& open, const FrontMesh& front,
           const std::vector<Eigen::AlignedBox3d>& component_boxes)
      : open_(open), front_(front), component_boxes_(component_boxes) {}

  /// Returns CapVerdict::accepted if the lid's faces intersect neither the committed front nor its floor nor
  /// each other, and the rest of the front is outside the region between lid and floor; otherwise returns the
  /// obstacle. `tree`: over the committed front.
  CapVerdict judge(const OpenFront::Lid& lid, const AabbTree& tree);
  /// Checks the fan from w that is to replace a star, in the same way, against the committed front and the
  /// lids of the components `united`.
  CapVerdict judge_fan(const OpenFront::Star& star, std::span<const OpenFront::Index> united,
                       const Eigen::Vector3d& w, const AabbTree& tree);

 private:
  using Index = OpenFront::Index;

  /// Boxes in single precision, relative to OpenFront::unit() and rounded outward, by coordinate, so that one
  /// is compared with many at once.
  class Boxes {
   public:
    void clear();
    void add(const Eigen::AlignedBox3d& b, double unit);
    std::uint32_t size() const { return static_cast<std::uint32_t>(sides_[0].size()); }
    /// Lists those before number `last` that intersect box k of `other`.
    const std::vector<std::uint32_t>& meeting(const Boxes& other, std::uint32_t k, std::uint32_t last);

   private:
    std::vector<float> sides_[6];  ///< lower and upper ends
    std::vector<std::uint32_t> flags_, found_;
  };
  /// Corners of a triangle, with numbers that are equal for equal vertices.
  struct Corners {
    const double* x[3];
    VertexId id[3];
  };

  Corners corners_of(Index f) const;
  Corners corners_of_slot(FrontMesh::Slot s) const;
  static bool parts(const exact::PlaneSide& plane, const Corners& f, const Corners& g);
  static bool clear(const Corners& f, const Corners& g);
  bool rim_turns_outward(const OpenFront::Lid& lid) const;
  bool encloses_component(const OpenFront::Lid& lid, const AabbTree& tree) const;

  const OpenFront& open_;
  const FrontMesh& front_;
  const std::vector<Eigen::AlignedBox3d>& component_boxes_;
  std::vector<Corners> lid_, beneath_;
  std::vector<FrontMesh::Slot> slots_;
  std::vector<exact::PlaneSide> planes_;
  Boxes lid_boxes_, beneath_boxes_;
  std::vector<CheckedTriangle> added_, obstacles_;
  std::vector<TriangleReach> reach_;
  std::vector<std::uint32_t> marks_;  ///< (faces)
  std::uint32_t marker_ = 0;
  std::vector<Index> stack_;
};

}  // namespace lrb::construct
