#pragma once
/// The geometry of contact: that of each pair, and the connected contact regions that the pairs form. All
/// points and vectors are in the world frame; lengths in the meshes' unit.

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "engine/core/ids.hpp"
#include "engine/exact/pair_contact.hpp"

namespace lrb {

/// The intersection of the simplices of one pair.
using PairContactRecord = exact::PairContact;

/// A chain of points along which the surfaces cross or touch.
struct ContactLoop {
  std::vector<Eigen::Vector3d> points;  ///< world frame; not repeated at the end of a closed loop
  bool closed = false;
};

/// A connected part of the intersection of the two surfaces.
struct ContactRegion {
  std::vector<std::uint32_t> pairs;  ///< indices into CollideResult::pairs, ascending
  std::vector<ContactLoop>
      loops;          ///< curves of the region; for coplanar contact, the outline of its polygons
  double length = 0;  ///< total length of the loops (unit: the mesh's)
  double area = 0;    ///< coplanar contact: its area; closed loops: the area they span (unit squared)
  Eigen::Vector3d centroid{
      0, 0, 0};  ///< centroid of the area for coplanar contact, of the curve's length, else of the points
  Eigen::Vector3d normal{0, 0, 0};  ///< unit length, from A to B, averaged; zero where it has no meaning
  double depth = 0;  ///< estimate: how far B must move along `normal` to leave this region; 0: touch
};

}  // namespace lrb
