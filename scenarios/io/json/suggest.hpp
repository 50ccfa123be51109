#pragma once

#include <string>
#include <vector>

namespace lrb::io {

/// Returns the number of edits (insert, delete, replace, swap neighbours) that turn one word into the other.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// Returns the word of `known` that `word` was probably meant to be; empty if none is near.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

/// Returns the end of a message: "; did you mean \"x\"?" if there is such a word, then "; known: a, b, c".
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace lrb::io
