#pragma once
/// All pairs of simplices that may meet in a span of time.

#include <vector>

#include "engine/query/motion/first_contact.hpp"
#include "engine/query/motion/motion_bounds.hpp"
#include "engine/query/walk/query_context.hpp"

namespace lrb {

/// Tells whether the kernel for rotations can look for pairs: it is right for any maps, but keeps all pairs
/// of bodies that are scaled or sheared.
bool suits_sweeps(const MovingBody& a, const MovingBody& b);

/// Finds a list of pairs in which all are that meet at any t of the span, which lies in one piece of both
/// motions; both for the exact motions and for their doubles. The two trees are walked once, with B swept
/// through the span: at t, B is displaced from where it is at the middle by (t - middle) times its points'
/// velocities there, and by no more than half of (t - middle)^2 times their accelerations. How A turns
/// meanwhile is allowed for in every direction. Returns false if there are more than `most` pairs, or it
/// takes too long to find them (`most` at kNoLimit: never).
bool find_swept_pairs(QueryContext& ctx, const MovingBody& a, const MovingBody& b, TimeSpan span,
                      std::uint64_t most, std::vector<SimplexPair>& pairs);

}  // namespace lrb
