#pragma once
/// Was an answer right?

#include "scenarios/methods/method.hpp"
#include "scenarios/stability/expected.hpp"
#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

/// Fills in outcome, counts and relations. A method that lists no pairs has missed the contact or not: counts
/// are of contacts then, and relations are "contact", "inside", "separate".
void judge(Record& record, const methods::MethodInfo& info, const methods::MethodAnswer& answer,
           const Expected& expected);

/// The same for a method against itself with the bodies exchanged: the answer to (B, A) must be the transpose
/// of that to (A, B). `several`: both bodies have several pieces, and then each may hold a piece of the
/// other, of which the relation names one.
void judge_swapped(Record& record, const methods::MethodInfo& info, const methods::MethodAnswer& answer,
                   const methods::MethodAnswer& swapped, bool several);

}  // namespace lrb::stability
