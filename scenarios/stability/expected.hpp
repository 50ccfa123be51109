#pragma once
/// The right answer to a case: exact brute force.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/query/collide.hpp"
#include "scenarios/cases/families.hpp"

namespace lrb::stability {

struct Expected {
  std::vector<SimplexPair> pairs;
  Relation relation = Relation::separate;
  std::string refusal;  ///< not empty: the question has no answer, and this says why
};

Expected expected_answer(const cases::Case& c);

nlohmann::ordered_json to_json(const std::vector<SimplexPair>& pairs);
std::vector<SimplexPair> pairs_from(const nlohmann::json& pairs);

/// On a line, for the workers that compare with it.
std::string to_line(const Expected& e);
/// Throws nlohmann's exceptions: nobody writes these lines but us.
Expected expected_from(const std::string& line);

/// The word of to_string(). Throws InputError.
Relation relation_from(const std::string& word);

}  // namespace lrb::stability
