#pragma once
/// Decides whether an answer was right.

#include <optional>
#include <string>
#include <vector>

#include "bench/cases/families.hpp"
#include "bench/rivals/method.hpp"
#include "bench/stability/outcome_grid.hpp"
#include <lrbscope/collide.hpp>

namespace lrb::stability {

// The right answer to a case, by exact brute force.

struct RightAnswer {
  std::vector<SimplexPair> pairs;
  Relation relation = Relation::separate;
  /// Where a number is asked for: hold it. A first contact that there is none of is at 2.
  std::optional<double> least = {}, most = {};
  std::string rejection;  ///< if not empty, the question has no answer, and this says why
};

RightAnswer expected_answer(const cases::Case& c);

/// Writes it on one line, for the workers that compare with it.
std::string to_line(const RightAnswer& e);
/// Reads such a line. Throws InputError, or nlohmann's exceptions for what is no JSON.
RightAnswer expected_from(const std::string& line);

/// Returns the relation with this name. Throws InputError.
Relation relation_from(const std::string& word);

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
