#pragma once
/// Explanations for people, and as JSON: what `lrbscope why` prints.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <lrbscope/explain.hpp>

namespace lrb::run {

/// Return why two faces are in an answer, or are not, in lines of words, and as one object.
std::string explanation_text(const PairExplanation& e, const LrbRep& a, const LrbRep& b);
nlohmann::ordered_json explanation_json(const PairExplanation& e, const LrbRep& a, const LrbRep& b);

/// Return how a query went, and what proves two bodies apart.
std::string explanation_text(const WalkExplanation& e);
nlohmann::ordered_json explanation_json(const WalkExplanation& e);

// Explanations in words: the same in the program and on pages.

/// Returns what decided about two faces, so that "decided by" can stand before it.
std::string_view words(DecidedBy by);

}  // namespace lrb::run
