#pragma once
/// The right answer to a case, by exact brute force.

#include <optional>
#include <string>
#include <vector>

#include "engine/query/collide.hpp"
#include "scenarios/cases/families.hpp"

namespace lrb::stability {

struct RightAnswer {
  std::vector<SimplexPair> pairs;
  Relation relation = Relation::separate;
  /// Where a number is asked for: hold it. A first contact that there is none of is at 2.
  std::optional<double> least = {}, most = {};
  std::string refusal;  ///< if not empty, the question has no answer, and this says why
};

RightAnswer expected_answer(const cases::Case& c);

/// Writes it on one line, for the workers that compare with it.
std::string to_line(const RightAnswer& e);
/// Reads such a line. Throws InputError, or nlohmann's exceptions for what is no JSON.
RightAnswer expected_from(const std::string& line);

/// Returns the relation with this name. Throws InputError.
Relation relation_from(const std::string& word);

}  // namespace lrb::stability
