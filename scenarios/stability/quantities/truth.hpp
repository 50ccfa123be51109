#pragma once
/// The right answer as an interval of doubles, by rational arithmetic: brute force over all pairs of
/// triangles, or over all planes that may part convex bodies. Shares no formula with the engine.

#include "scenarios/stability/expected.hpp"
#include "scenarios/stability/quantities/asked.hpp"

namespace lrb::stability {

using methods::kNever;

RightAnswer true_number(Quantity quantity, const cases::Case& c);

}  // namespace lrb::stability
