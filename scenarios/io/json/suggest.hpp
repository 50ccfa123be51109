#pragma once

#include <string>
#include <vector>

namespace lrb::io {

/// Edits (insert, delete, replace, swap of neighbours) that turn one word into the other.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// The word of `known` that `word` was probably meant to be; empty if none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

/// "; did you mean \"x\"?" if there is such a word, then "; known: a, b, c".
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace lrb::io
