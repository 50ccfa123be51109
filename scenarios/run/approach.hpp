#pragma once

#include <functional>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::run {

/// A straight motion of B towards a point, cut to the part worth seeing.
struct Approach {
  std::vector<Pose> poses;        ///< of B, one for each step
  std::size_t first_contact = 0;  ///< index into poses
  bool met = false;  ///< false: B passed without contact, and poses are the whole motion, thinned out
};

/// Moves B until the bodies first meet (surfaces, or one inside the other), and on for motion.into steps.
Approach find_approach(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& start,
                       const spec::Motion& motion);

/// Returns the diagonal of the box around a body's real faces, in body coordinates.
double diagonal_of(const LrbRep& rep);

}  // namespace lrb::run
