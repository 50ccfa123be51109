#pragma once
/// Measures how far a cap comes to stand off the body while it is made of a patch.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "engine/construct/cap_surface.hpp"
#include "engine/construct/patch_floor.hpp"

namespace lrb::construct {

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
