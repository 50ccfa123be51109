#pragma once
/// The floors of a body's regions with boxes around them, for the paper's recursions with boxes
/// (paper_query.hpp).

#include <cstdint>
#include <span>
#include <vector>

#include "engine/collide/query_context.hpp"
#include "engine/core/geometry.hpp"
#include "engine/mesh/hubs.hpp"

namespace lrb {

/// The floors of one body that a query has reached so far. Boxes are fitted in the world, when a floor is
/// first asked for, so that they are tight at any pose.
class BoxedFloors {
 public:
  struct Floor {
    std::span<const FaceId> faces;
    OrientedBox box;  ///< contains the faces; in the unit cube
  };

  /// Begins with floor 0: the outermost faces. `cube`: contains both bodies in the world.
  BoxedFloors(QueryBody& body, const UnitCube& cube);

  const Floor& operator[](std::uint32_t i) const { return floors_[i]; }
  /// Returns the square of the box's half diagonal.
  double size(std::uint32_t i) const { return squared_norm3(floors_[i].box.half); }
  /// Returns the number of the floor of a region.
  std::uint32_t number_of(RegionId r);
  /// Returns the faces of floor i that may reach the box, of those for which is_used(f). Adds the number of
  /// tests.
  template <class IsUsed>
  std::vector<FaceId> reaching(std::uint32_t i, const OrientedBox& box, IsUsed is_used,
                               std::uint64_t& tests) {
    std::vector<FaceId> out;
    for (const FaceId f : floors_[i].faces) {
      if (!is_used(f)) continue;
      ++tests;
      if (may_reach(f, box)) out.push_back(f);
    }
    return out;
  }

 private:
  bool may_reach(FaceId f, const OrientedBox& box);
  void load(std::span<const FaceId> faces);
  void add(std::span<const FaceId> faces);

  QueryBody& body_;
  const UnitCube& cube_;
  std::vector<Floor> floors_;
  std::vector<std::uint32_t> number_;    ///< (|R|) of a region's floor; 0: none yet
  std::vector<Eigen::Vector3d> points_;  ///< corners of faces, in the unit cube
};

/// Returns the cube around the outermost wrappers of both bodies in the world.
UnitCube cube_around(QueryContext& context);

}  // namespace lrb
