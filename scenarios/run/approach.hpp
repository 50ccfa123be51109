#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/lrb/lrb_rep.hpp"
#include "engine/query/motion/first_contact.hpp"
#include "scenarios/spec/scenario.hpp"

namespace lrb::run {

/// A straight motion of B towards a point, cut to the part worth seeing.
struct Approach {
  std::vector<Pose> poses;        ///< of B, one for each step
  std::size_t first_contact = 0;  ///< index into poses
  /// Holds the first contact of the surfaces, proved, in steps from the motion's start; none if it was not
  /// found out.
  std::optional<TimeSpan> steps_to_contact;
  std::optional<trace::MeasuredApproach> search;  ///< how it was found, if asked for
  bool met = false;  ///< false: B passed without contact, and poses are the whole motion, thinned out
};

/// Moves B until the bodies first meet (surfaces, or one inside the other), and on for motion.into steps. B
/// does not pass through A between two steps: the first contact is looked for in all of the motion
/// (first_contact()). With motion.exact, or where B only meets A between two steps, the step is at the
/// contact itself. watched: fills in Approach::search.
Approach find_approach(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& start,
                       const spec::Motion& motion, bool watched = false);

/// Returns the diagonal of the box around a body's real faces, in body coordinates.
double diagonal_of(const LrbRep& rep);

}  // namespace lrb::run
