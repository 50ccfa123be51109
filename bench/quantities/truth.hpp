#pragma once
/// The right answer as an interval of doubles, by rational arithmetic: brute force over all pairs of
/// triangles, or over all planes that may part convex bodies. Shares no formula with the engine.

#include <string>

#include "bench/cases/families.hpp"
#include "bench/rivals/method.hpp"
#include "bench/stability/judge.hpp"
#include <lrbscope/lrb_rep.hpp>

namespace lrb::stability {

// A case as it is put to methods that answer with a number: both bodies where they are in the world, so that
// all methods get the same doubles.

using methods::Quantity;

struct Asked {
  LrbRep a, b;
  /// Where a motion of B has it at t = 0 and t = 1, beside where it is; at t = 3/4 it is there, but for the
  /// rounding of methods: these are exact.
  Eigen::Vector3d from{0, 0, 0}, to{0, 0, 0};
  double size = 0;  ///< of the larger body: its box's diagonal
};

/// Returns why this is not asked about a case: bodies in the plane, coordinates that are no doubles, too many
/// faces for rational arithmetic; empty if it is.
std::string why_not_asked(Quantity quantity, const cases::Case& c);

/// Makes the question. B comes from the side of A on which it is, from far enough to be apart there.
Asked asked(const cases::Case& c);

using methods::kNever;

RightAnswer true_number(Quantity quantity, const cases::Case& c);

}  // namespace lrb::stability
