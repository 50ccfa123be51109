#pragma once
/// How much nearer two bodies can have come to each other from one step of a motion to the next.

#include "engine/core/pose.hpp"
#include "engine/lrb/lrb_rep.hpp"

namespace lrb {

/// The poses of two bodies.
struct PosePair {
  Pose a, b;
};

/// Returns how much nearer to each other a point of A and one of B may be at `to` than at `from`, where they
/// were no more than `reach` apart: a bound for all of them, and for all places between, if what B does seen
/// from A is divided evenly. Infinite where none is known: A or B is no rotated body, or is mirrored.
double nearer_by(const LrbRep& a, const LrbRep& b, const PosePair& from, const PosePair& to, double reach);

}  // namespace lrb
