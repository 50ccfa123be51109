#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "engine/query/explain.hpp"

namespace lrb::run {

/// Returns the corners of a square in the middle of the gap that a plane parts, as large as the smaller of
/// the two bodies, before its middle. World. In the plane (2D) it is a strip: corners 0 and 1 end its line.
using Square = std::array<Eigen::Vector3d, 4>;
Square parting_square(const PartingPlane& plane, const LrbRep& a, const Pose& pose_a, const LrbRep& b,
                      const Pose& pose_b);

/// Returns the same for two boxes, as large as the smaller of them.
Square parting_square(const PartedBoxes& boxes, int dim);

/// Returns that of the plane that was found, else of the boxes; nothing where neither was.
std::optional<Square> parting_square(const WalkExplanation& walk, const LrbRep& a, const Pose& pose_a,
                                     const LrbRep& b, const Pose& pose_b);

}  // namespace lrb::run
