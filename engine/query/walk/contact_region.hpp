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

/// A connected part of the intersection of the two surfaces. Vertices that stand twice in one place (seams of
/// textures) count as one if their coordinates in the file are the same. A length or an area that is too
/// large for a double is infinity, which can happen to areas of bodies of 1e155 units and more, and to
/// lengths of 1e307 and more. Points, centroid and normal stay finite.
struct ContactRegion {
  std::vector<std::uint32_t> pairs;  ///< indices into CollideResult::pairs, ascending
  std::vector<ContactLoop>
      loops;          ///< curves of the region; for coplanar contact, the outline of its polygons
  double length = 0;  ///< total length of the loops (unit: the mesh's)
  double area = 0;    ///< coplanar contact: its area; closed loops: the area they span (unit squared)
  Eigen::Vector3d centroid{
      0, 0, 0};  ///< of the area for coplanar contact, of the curve's length, else of the points
  Eigen::Vector3d normal{0, 0, 0};  ///< unit, from A to B, averaged; zero where it has no meaning
  /// An estimate of how far B must move along `normal` to leave this region; 0: it only touches, or the
  /// bodies are flush. It is measured along `normal`: from the nearest point of the part of B that the region
  /// encloses in A to the farthest point of the part of A that it encloses in B, contact points included.
  /// Once B has moved that far a plane parts the two. Nothing but these two parts is considered; convex
  /// bodies have nothing else. Concave bodies may still meet in other regions, each with its own depth, or
  /// come to meet on the way; and parts that lie beside each other may be free after less.
  double depth_estimate = 0;
};

}  // namespace lrb
