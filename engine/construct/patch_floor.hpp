#pragma once
/// How far points over a patch are off the body.

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/patch_grow.hpp"

namespace lrb::construct {

/// A patch's triangles, with what is known of how far they are off the body themselves (HullMesh::Point::off,
/// HullMesh::Triangle::extra). A point is off the body by no more than its distance from a triangle plus what
/// the triangle is off at the nearest point.
///
/// Estimates to guide the builder: what is proved of lids is proved afterwards (region_thickness()).
class PatchFloor {
 public:
  void load(const HullMesh& hull, const Patch& patch);

  /// Returns how far q is off, as the triangles of the patch show it.
  double off(const Eigen::Vector3d& q) const;
  /// Returns true if q is off by no more than `most`. Starts at the triangle that showed it last.
  bool is_within(const Eigen::Vector3d& q, double most) const;

 private:
  struct Triangle {
    std::array<Eigen::Vector3d, 3> x;
    std::array<double, 3> off;  ///< at the corners, `extra` included
    double least;               ///< of these
    Eigen::Vector3d middle, normal;
    double radius;  ///< of a ball about the middle
  };

  static double off_by(const Triangle& t, const Eigen::Vector3d& q);

  std::vector<Triangle> triangles_;
  mutable std::size_t last_ = 0;  ///< the triangle that showed last that a point is within
};

}  // namespace lrb::construct
