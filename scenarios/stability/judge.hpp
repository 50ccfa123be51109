#pragma once
/// Decides whether an answer was right.

#include "scenarios/methods/method.hpp"
#include "scenarios/stability/expected.hpp"
#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

/// Fills in outcome, counts and relations. For a method that lists no pairs, counts are of contacts (0 or 1),
/// and relations are "contact", "inside", "separate".
void judge(Record& record, const methods::MethodInfo& info, const methods::MethodAnswer& answer,
           const RightAnswer& expected);

/// Does the same for a method against itself with the bodies exchanged: the answer to (B, A) must be the
/// transpose of that to (A, B). `several`: both bodies have several pieces; each may then hold a piece of the
/// other, of which the relation names only one.
void judge_swapped(Record& record, const methods::MethodInfo& info, const methods::MethodAnswer& answer,
                   const methods::MethodAnswer& swapped, bool several);

}  // namespace lrb::stability
