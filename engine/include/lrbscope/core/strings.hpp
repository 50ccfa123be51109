#pragma once
/// Locale-independent conversion of numbers to text, and other text helpers.

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

/// Quotes a word, if necessary, for use in a shell command line.
std::string shell_word(const std::string& word);

/// Returns a path as a relative URL; other characters are percent-encoded.
std::string url_path(const std::string& path);

}  // namespace lrb::io
