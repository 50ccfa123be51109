#pragma once
/// Locale-independent conversion of numbers to text, and other text helpers.

#include <cstddef>
#include <string>
#include <string_view>

namespace lrb::io {

/// Returns a number with at most `digits` significant digits, as printf's %g writes it.
std::string number_text(double x, int digits = 7);

/// Returns a positive number as number_text() does, rounded down, so that a lower bound remains one.
std::string lower_text(double x, int digits = 3);

/// Returns a number with at most `decimals` decimals, without exponent and trailing zeros.
std::string fixed_text(double x, int decimals = 6);

/// Returns the shortest text that reads back as the same number.
std::string exact_text(double x);

/// Returns a snake_case name as words: "a_inside_b" as "a inside b".
std::string in_words(std::string_view name);

/// Returns the length of the UTF-8 sequence at the start of a text, or 0 if it is not valid (RFC 3629: no
/// surrogates, no overlong forms, nothing beyond U+10FFFF).
std::size_t utf8_length(std::string_view text);

/// Returns a text in which U+FFFD replaces each byte that is not UTF-8, and U+FFFE and U+FFFF, which XML
/// forbids.
std::string valid_utf8(std::string_view text);

/// Quotes a word, if necessary, for use in a shell command line.
std::string shell_word(const std::string& word);

/// Returns a path as a relative URL; other characters are percent-encoded.
std::string url_path(const std::string& path);

}  // namespace lrb::io
