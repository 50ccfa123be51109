#pragma once
/// The boxes of tree nodes as they lie in the world, in double arithmetic: to be shown, and to tell how far
/// they are apart. The query compares them in floats and allows for all errors; these allow for none.

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "engine/core/enum_words.hpp"
#include "engine/core/pose.hpp"
#include "engine/tree/obb_tree.hpp"

namespace lrb {

/// The axes across the sides of two boxes. The query compares boxes along these, and those of whole nodes
/// also along directions across an edge of each.
enum class BoxAxis : std::uint8_t { a1, a2, a3, b1, b2, b3 };
constexpr auto words_of(BoxAxis) {
  return std::to_array<EnumWord<BoxAxis>>({{BoxAxis::a1, "axis 1 of A's box"},
                                           {BoxAxis::a2, "axis 2 of A's box"},
                                           {BoxAxis::a3, "axis 3 of A's box"},
                                           {BoxAxis::b1, "axis 1 of B's box"},
                                           {BoxAxis::b2, "axis 2 of B's box"},
                                           {BoxAxis::b3, "axis 3 of B's box"}});
}

/// Two boxes that the query compared, as they lie in the world.
struct BoxPair {
  /// Of A's tree and of B's: the nodes whose boxes they are; of the boxes of faces, the leaves that hold
  /// them.
  std::array<std::uint32_t, 2> node = {0, 0};
  /// The distance of the boxes along the axis on which they are furthest apart, mesh's unit; negative where
  /// they overlap on all axes.
  double gap = 0;
  BoxAxis axis = BoxAxis::a1;  ///< that axis
};

/// A box in the world: a parallelepiped, for poses that are no rotations.
struct WorldBox {
  Eigen::Vector3d centre;
  std::array<Eigen::Vector3d, 3> half;    ///< from the centre to the middle of a side
  std::array<Eigen::Vector3d, 3> across;  ///< unit vectors across the sides
};

constexpr int kWhole = -1;

/// Returns the box of a node's child or simplex, number 0 to 7 there, or with kWhole that of the whole node.
/// `pose`: body to world.
WorldBox box_of(const ObbTree& tree, std::uint32_t node, int child, const Pose& pose);

/// Sets the gap and the axis of two boxes.
void compare_boxes(const WorldBox& a, const WorldBox& b, BoxPair& out);

}  // namespace lrb
