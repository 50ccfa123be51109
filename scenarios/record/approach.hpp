#pragma once

#include <string>
#include <vector>

#include "scenarios/spec/scenario.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {

/// A straight motion of B towards a point, cut to the part worth seeing.
struct Approach {
  std::vector<Pose> poses;         ///< of B, one for each step
  std::size_t first_contact = 0;   ///< the first of `poses` at which the bodies meet
  trace::MeasuredApproach search;  ///< when the surfaces first meet, proved, in steps of `poses`
  bool met = false;  ///< false: B passed without contact, and poses are the whole motion, thinned out
};

/// Moves B until the bodies first meet (surfaces, or one inside the other), and on for motion.into steps. B
/// does not pass through A between two steps: the first contact is looked for in all of the motion
/// (first_contact()). With motion.exact, or where B only meets A between two steps, the step is at the
/// contact itself. watched: keeps the course of the search.
Approach find_approach(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& start,
                       const spec::Motion& motion, bool watched = false);

/// Returns where the first contact of an approach is among a run's steps, in words: "step 11.36"; empty: the
/// surfaces do not meet.
std::string contact_step(const trace::MeasuredApproach& search);
/// Returns how far B has moved by then: "after B has moved 0.25 from step 0".
std::string contact_way(const trace::MeasuredApproach& search);

/// Returns the diagonal of the box around a body's real faces, in body coordinates.
double diagonal_of(const LrbRep& rep);

}  // namespace lrb::run
