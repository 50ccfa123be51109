#pragma once
/// Writes numbers as text, the same in any locale.

#include <string>
#include <string_view>

namespace lrb::io {

/// Returns a number with `digits` significant digits at most, as printf's %g writes it.
std::string number_text(double x, int digits = 7);

/// Returns a positive number as number_text() does, but rounded down: where it is a lower bound, what is
/// printed is one, too.
std::string lower_text(double x, int digits = 3);

/// Returns a number with `decimals` decimals at most: no exponent, no zeros at the end.
std::string fixed_text(double x, int decimals = 6);

/// Returns the shortest text that reads back as the same number.
std::string exact_text(double x);

/// Returns a name in snake_case as words: "a_inside_b" as "a inside b".
std::string in_words(std::string_view name);

/// Quotes a word, if need be, so that it can stand in a shell's command line.
std::string shell_word(const std::string& word);

/// Returns a path as a relative address: what addresses do not take as it is becomes %XX.
std::string url_path(const std::string& path);

}  // namespace lrb::io
