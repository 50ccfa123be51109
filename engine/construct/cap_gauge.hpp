#pragma once
/// Measures how far a cap comes to stand off the body while it is made of a patch.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/cap_surface.hpp"
#include "engine/construct/patch_grow.hpp"

namespace lrb::construct {

// How far points over a patch are off the body.

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

/// Tells which collapses keep a cap within a limit, and keeps what the cap's vertices and triangles are off
/// up to date. It looks at the new vertex, at the patch's vertices that the new triangles cover, and at a few
/// points of each new triangle: estimates, in floating point, to choose by; see PatchFloor.
class CapGauge {
 public:
  /// Starts with a cap that is the patch itself. `most`: the largest distance from the body; mesh's unit.
  void load(const HullMesh& hull, const Patch& patch, const CapSurface& cap, double most);

  /// Returns true if the fan from w over the star's rim is within the limit at w and over the patch's
  /// vertices that it covers.
  bool may_stand(const CapSurface& cap, const CapSurface::Star& star, const Eigen::Vector3d& w);
  /// Returns true if it is at points in between, too.
  bool is_near(const CapSurface& cap, const CapSurface::Star& star, const Eigen::Vector3d& w);
  /// Prepares for settle(), before the star is replaced.
  bool prepare(const CapSurface& cap, const CapSurface::Star& star);
  /// Notes that vertex w now stands over the star that was prepared last.
  void settle(CapSurface& cap, const CapSurface::Star& star, int w);

  /// Measures all new triangles anew: for caps that were changed by something else than collapses. Returns
  /// false if one is beyond the limit.
  bool measure_again(CapSurface& cap) const;

 private:
  /// A point in the star's mean plane.
  struct Flat {
    double x, y;
  };

  void find_covered(const CapSurface& cap, const CapSurface::Star& star);
  bool flatten(const CapSurface& cap, const CapSurface::Star& star);
  Flat flat(const Eigen::Vector3d& q) const { return {q.dot(along_x_), q.dot(along_y_)}; }
  std::size_t sector(const Flat& q, const Flat& centre) const;
  void raise_extra(CapSurface& cap, int face, int covered) const;

  PatchFloor floor_;
  double most_ = 0;
  std::vector<int> under_;  ///< (faces) a triangle of the floor near to which a point of it was found to be
  std::vector<int> cover_;  ///< (old vertices) the cap's face over one; -1: it is in the cap itself
  std::vector<std::uint32_t> face_mark_;  ///< (faces) == marker_: in the star
  std::uint32_t marker_ = 0;
  std::vector<int> covered_;  ///< old vertices that the star covers or removes
  Eigen::Vector3d along_x_, along_y_;
  std::vector<Flat> flat_rim_, flat_covered_;
};

}  // namespace lrb::construct
