#pragma once
/// How much two bodies can approach each other from one step of a motion to the next.

#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// The poses of two bodies.
struct PosePair {
  Pose a, b;
};

/// Returns a bound on the decrease of the distance between any point of A and any point of B from `from` to
/// `to`, for points at most `reach` apart at `from`. It holds for all poses between, too, if the motion of B
/// relative to A is interpolated evenly. Infinite if a pose is no rotation or B becomes mirrored.
double nearer_by(const LrbRep& a, const LrbRep& b, const PosePair& from, const PosePair& to, double reach);

}  // namespace lrb
