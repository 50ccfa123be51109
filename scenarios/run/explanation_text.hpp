#pragma once
/// Explanations as text and as JSON: the output of `lrbscope why`.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <lrbscope/explain.hpp>

namespace lrb::run {

/// Explain why two faces are or are not in an answer, as lines of text and as a JSON object.
std::string explanation_text(const PairExplanation& e, const LrbRep& a, const LrbRep& b);
nlohmann::ordered_json explanation_json(const PairExplanation& e, const LrbRep& a, const LrbRep& b);

/// Explain the result of a query, including the proof that two bodies are separate.
std::string explanation_text(const WalkExplanation& e);
nlohmann::ordered_json explanation_json(const WalkExplanation& e);

// Phrases of explanations, common to the program and the pages.

/// Names the test that decided about two faces of bodies of `dim` dimensions, as a phrase that follows
/// "decided by".
std::string_view to_text(DecidedBy by, int dim);

}  // namespace lrb::run
