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
  /// `most`: the limit that is_within() asks about; mesh's unit.
  void load(const HullMesh& hull, const Patch& patch, double most);

  /// Returns how far q is off, as the triangles of the patch show it.
  double off(const Eigen::Vector3d& q) const;
  /// Returns true if q is off by no more than the limit. Looks at the patch's triangle number `first` first,
  /// and sets it to the one that shows it.
  bool is_within(const Eigen::Vector3d& q, int& first) const;

 private:
  struct Triangle {
    std::array<Eigen::Vector3d, 3> x;
    Eigen::Vector3d normal, middle;
    Eigen::Vector3d to_b, to_c;    ///< by how much the weights of corners b and c grow along the triangle
    double weight;                 ///< what they are in the middle; negative for a triangle without area
    std::array<double, 3> height;  ///< of the corners over the opposite edges
    double radius;                 ///< of a ball about the middle
    double off, off_b, off_c;      ///< at the corners, `extra` included: a, and how much more b and c
    double least;                  ///< the least at a corner
  };
  /// Holds all points that a triangle may show to be within the limit.
  struct Ball {
    Eigen::Vector3d middle;
    double radius_sq;  ///< negative: there are none
    bool holds(const Eigen::Vector3d& q) const { return (q - middle).squaredNorm() <= radius_sq; }
  };

  static void set_weights(Triangle& t);
  static double off_by(const Triangle& t, const Eigen::Vector3d& q, double most);
  bool shows(std::size_t t, const Eigen::Vector3d& q) const {
    return balls_[t].holds(q) && off_by(triangles_[t], q, most_) <= most_;
  }

  std::vector<Triangle> triangles_;
  std::vector<Ball> balls_;  ///< (|triangles_|)
  double most_ = 0;
};

}  // namespace lrb::construct
