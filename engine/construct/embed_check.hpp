#pragma once
/// Exact tests of whether new triangles leave the front embedded: they intersect others only in shared
/// vertices and edges, and turn to the outside at their boundary.

#include <array>

#include <Eigen/Geometry>

#include "engine/construct/front_mesh.hpp"

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

}  // namespace lrb::construct
