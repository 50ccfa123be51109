#pragma once
/// Decides whether an answer is right.

#include <optional>
#include <string>
#include <vector>

#include "bench/cases/families.hpp"
#include "bench/methods/method.hpp"
#include "bench/stability/outcome_grid.hpp"
#include <lrbscope/collide.hpp>

namespace lrb::stability {

// The right answer to a case, by exact brute force.

struct RightAnswer {
  std::vector<SimplexPair> pairs;
  Relation relation = Relation::separate;
  /// For a number: the interval [least, most] that contains it. Without a first contact both are 2.
  std::optional<double> least = {}, most = {};
  std::string rejection;  ///< reason why the query has no answer; empty: it has one
};

RightAnswer expected_answer(const cases::Case& c);

/// Returns the answer on one line, for the workers that compare with it.
std::string to_line(const RightAnswer& e);
/// Reads such a line. Throws InputError, or nlohmann's exceptions if it is not JSON.
RightAnswer expected_from(const std::string& line);

/// Returns the relation with this name. Throws InputError for an unknown name.
Relation relation_from(const std::string& word);

/// Sets outcome, counts and relations of the record. For a method that lists no pairs, counts are of contacts
/// (0 or 1), and relations are "contact", "inside", "separate".
void judge(Record& record, const methods::MethodInfo& info, const methods::MethodAnswer& answer,
           const RightAnswer& expected);

/// Compares a method with itself for exchanged bodies: the answer to (B, A) must be the transpose of the
/// answer to (A, B). `several`: both bodies have several pieces. Each body may then contain a piece of the
/// other, and the relation names only one of these.
void judge_swapped(Record& record, const methods::MethodInfo& info, const methods::MethodAnswer& answer,
                   const methods::MethodAnswer& swapped, bool several);

}  // namespace lrb::stability
