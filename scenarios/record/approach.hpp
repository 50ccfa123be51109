#pragma once

#include <string>
#include <vector>

#include "scenarios/spec/scenario.hpp"
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {

/// A straight motion of B towards a point, cut to the steps around the first contact.
struct Approach {
  std::vector<Pose> poses;         ///< of B, one for each step
  std::size_t first_contact = 0;   ///< index of the first of `poses` in contact
  trace::MeasuredApproach search;  ///< proven time of first contact, in steps of `poses`
  bool met = false;                ///< false: B passed without contact, and `poses` sample the whole motion
};

/// Moves B until the first contact (of the surfaces, or one body inside the other), and then for another
/// motion.into steps. B does not pass through A between two steps: the first contact is searched for in the
/// whole motion (first_contact()). With motion.exact, or if contact occurs only between two steps, a step is
/// at the contact itself. `watched`: records the convergence of the search.
Approach find_approach(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& start,
                       const spec::Motion& motion, bool watched = false);

/// Returns the time of first contact in a run's steps as text: "step 11.36". Empty if the surfaces do not
/// intersect.
std::string contact_step(const trace::MeasuredApproach& search);
/// Returns the distance that B has moved by then: "after B has moved 0.25 from step 0".
std::string contact_way(const trace::MeasuredApproach& search);

/// Returns the diagonal of the box of a body's real faces, in body coordinates.
double diagonal_of(const LrbRep& rep);

}  // namespace lrb::run
