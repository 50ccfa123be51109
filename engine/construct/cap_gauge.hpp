#pragma once
/// Measures the deviation of a cap from the body while it is simplified.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/cap_surface.hpp"
#include "engine/construct/patch_grow.hpp"
#include "engine/core/geometry.hpp"

namespace lrb::construct {

// The deviation of points over a patch from the body.

/// A patch's triangles with their own known deviation from the body (FrontMesh::Point::off,
/// FrontMesh::Triangle::excess_deviation). The deviation of a point is at most its distance from a triangle
/// plus the triangle's deviation at the nearest point.
///
/// These estimates guide the builder; the bounds of lids are proven afterwards (region_thickness()).
class PatchFloor {
 public:
  /// `most`: the limit of is_within(); mesh units.
  void load(const FrontMesh& front, const Patch& patch, double most);

  /// Returns the deviation of q according to the triangles of the patch.
  double off(const Eigen::Vector3d& q) const;
  /// Returns true if the deviation of q is at most the limit. Tries the patch's triangle number `first`
  /// first, and sets it to the triangle that proves it.
  bool is_within(const Eigen::Vector3d& q, int& first) const;

 private:
  struct Triangle {
    std::array<Eigen::Vector3d, 3> x;
    Eigen::Vector3d normal, centroid;
    Eigen::Vector3d to_b, to_c;    ///< gradients of the weights of corners b and c in the triangle's plane
    double weight;                 ///< these weights at the centroid; negative for a degenerate triangle
    std::array<double, 3> height;  ///< of the corners above the opposite edges
    double radius;                 ///< of a ball about the centroid
    double off, off_b,
        off_c;     ///< deviation at corner a, `excess_deviation` included, and the increase to b and c
    double least;  ///< minimum over the corners
  };
  /// Contains all points that a triangle can prove to be within the limit.
  struct Ball {
    Eigen::Vector3d centre;
    double radius_sq;  ///< negative: empty
    bool holds(const Eigen::Vector3d& q) const { return squared_norm3(q - centre) <= radius_sq; }
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

/// Checks which edge collapses keep a cap within a maximum deviation, and tracks the deviation of the cap's
/// vertices and triangles. Samples the new vertex, the patch's vertices covered by the new triangles, and a
/// few points of each new triangle. Computed in floating point: guides the builder, proves nothing; see
/// PatchFloor.
class CapGauge {
 public:
  /// Starts with a cap that is the patch itself. `most`: maximum deviation from the body, mesh units.
  void load(const FrontMesh& front, const Patch& patch, const CapSurface& cap, double most);

  /// Returns true if the fan from w over the star's rim is within the limit at w and above the patch's
  /// vertices that it covers.
  bool may_stand(const CapSurface& cap, const CapSurface::Star& star, const Eigen::Vector3d& w);
  /// Returns true if the fan is also within the limit at sample points in between.
  bool is_near(const CapSurface& cap, const CapSurface::Star& star, const Eigen::Vector3d& w);
  /// Prepares for settle(), before the star is replaced.
  bool prepare(const CapSurface& cap, const CapSurface::Star& star);
  /// Updates the deviations after vertex w replaced the star that was prepared last.
  void settle(CapSurface& cap, const CapSurface::Star& star, int w);

  /// Measures all new triangles again, after changes other than collapses. Returns false if one is beyond the
  /// limit.
  bool measure_again(CapSurface& cap) const;

 private:
  /// A point in the star's mean plane.
  struct Flat {
    double x, y;
  };

  void find_covered(const CapSurface& cap, const CapSurface::Star& star);
  bool flatten(const CapSurface& cap, const CapSurface::Star& star);
  Flat flat(const Eigen::Vector3d& q) const { return {dot3(q, along_x_), dot3(q, along_y_)}; }
  std::size_t sector(const Flat& q, const Flat& centre) const;
  void raise_excess(CapSurface& cap, int face, int covered) const;

  PatchFloor floor_;
  double most_ = 0;
  std::vector<int> under_;  ///< (faces) floor triangle that last proved a point of it within the limit
  std::vector<int> cover_;  ///< (old vertices) the cap's face above it; -1: it is in the cap itself
  std::vector<std::uint32_t> face_mark_;  ///< (faces) == marker_: in the star
  std::uint32_t marker_ = 0;
  std::vector<int> covered_;  ///< old vertices that the star covers or removes
  Eigen::Vector3d along_x_, along_y_;
  std::vector<Flat> flat_rim_, flat_covered_;
};

}  // namespace lrb::construct
