#pragma once
/// Tokenizer for text formats, and numbers in binary formats.

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace lrb {

/// Returns the number stored at `from`, which need not be aligned.
template <class T>
T load(const char* from, std::endian order) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), from, sizeof(T));
  if (order != std::endian::native) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

// Reads text token by token and line by line, with messages that name the line.

/// Syntax between tokens.
struct TextRules {
  bool hash_comments = false;  ///< `#` at the start of a token comments out the rest of its line
  /// A backslash at the end of a line (not of a comment) joins it with the next one.
  bool continuation = false;
};

/// A position in a text. Lines end with LF, CR LF or CR.
class TextCursor {
 public:
  TextCursor(std::string_view text, std::string_view name, TextRules rules, std::uint64_t first_line = 1)
      : at_(text.data()), end_(at_ + text.size()), line_(first_line), name_(name), rules_(rules) {}

  /// Read a token that is a finite number written without a plus sign, or an index from 1 of at most nine
  /// digits, before a blank or the end of the line. Otherwise return false and stay: integer() and number()
  /// read all others and name the faults.
  bool plain_number(double& value);
  bool plain_index(std::int64_t& value);

  std::uint64_t line() const { return line_; }
  std::uint64_t bytes_left() const { return static_cast<std::uint64_t>(end_ - at_); }

  /// Returns the next token of this line, or an empty one at its end.
  std::string_view token();
  /// Advances to the next line. Returns false if the text ends first.
  bool next_line();
  /// Returns the next token on this line or a later one, or an empty one at the end of the text.
  std::string_view any_token();

  /// Return a token of this line as a finite double, rounded to nearest, or as an integer. Throw InputError
  /// if it is not one. `what`: "coordinate x" or similar.
  double number(std::string_view what) { return number(token(), what); }
  double number(std::string_view token, std::string_view what) const;
  std::int64_t integer(std::string_view what) { return integer(token(), what); }
  std::int64_t integer(std::string_view token, std::string_view what) const;

  /// Throws InputError "name:line: found <found>, expected <expected>; <advice>".
  [[noreturn]] void fail(std::string_view found, std::string_view expected, std::string_view advice) const {
    fail_at(line_, found, expected, advice);
  }
  [[noreturn]] void fail_at(std::uint64_t line, std::string_view found, std::string_view expected,
                            std::string_view advice) const;
  /// Returns the description of a token for messages; an empty one is the end of the line or of the file.
  std::string shown(std::string_view token) const;

 private:
  bool ends_token(const char* at) const;
  bool skip_continuation();
  void skip_newline();

  const char* at_;
  const char* end_;
  std::uint64_t line_;
  std::string_view name_;
  TextRules rules_;
};

/// Throws InputError if the text contains a NUL byte: it is binary, or damaged.
void reject_nul(std::string_view text, std::string_view name);

}  // namespace lrb
