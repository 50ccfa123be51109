#pragma once
/// JSON that remembers where in its file each value stands, so that a message can name file, line and column.

#include <cstddef>
#include <memory>
#include <string>
#include <unordered_map>

#include <nlohmann/json.hpp>

namespace lrb::io {

/// The line and column of a byte in a text, both from 1; columns count characters of UTF-8.
struct TextPosition {
  std::size_t line = 1, column = 1;
};
TextPosition position_in(const std::string& text, std::size_t offset);
/// Moves a position from one byte of a text to a later one.
void advance(TextPosition& position, const std::string& text, std::size_t from, std::size_t to);

/// Finds the offset of each value of a JSON text by its JSON pointer (RFC 6901), and of each member's key by
/// the pointer followed by '#'. The text must be one that a parser has accepted, and not nested deeply.
class JsonIndex {
 public:
  explicit JsonIndex(const std::string& text);
  std::size_t offset(const std::string& pointer) const;
  /// Returns the pointer of the first member whose key occurs twice in its object; empty if there is none.
  const std::string& duplicate() const { return duplicate_; }

 private:
  std::unordered_map<std::string, std::size_t> offsets_;
  std::string duplicate_;
};

class JsonText {
 public:
  /// Parses a text; throws InputError "file:line:column: ..." for bad syntax and for repeated keys, and for
  /// more than 64 levels.
  JsonText(std::string text, std::string file);

  const nlohmann::json& root() const { return root_; }
  const std::string& file() const { return file_; }
  /// Returns "file:line:column" of the value (or, with '#' behind it, the key) at a JSON pointer.
  std::string where(const std::string& pointer) const;

 private:
  std::string text_, file_;
  mutable TextPosition last_;  ///< the place asked for last: asking in order walks the text once
  mutable std::size_t last_offset_ = 0;
  nlohmann::json root_;
  std::unique_ptr<JsonIndex> index_;
};

/// Throws InputError if a text has a NUL byte: nlohmann-json takes one for the end of the text, and would not
/// look at what follows.
void refuse_nul(const std::string& text, const std::string& file);
/// Throws the InputError "file:line:column: ..." of a text that nlohmann-json gave up on; the arguments are
/// those of nlohmann::json_sax::parse_error().
[[noreturn]] void fail_json(const std::string& text, const std::string& file, std::size_t position,
                            const std::string& token, const nlohmann::json::exception& error);

/// Parses a text; `seen` is where the parser has come to whenever it calls `handler`.
void parse_with(const std::string& text, const char*& seen, nlohmann::json_sax<nlohmann::json>& handler);

/// Returns a member's name or an index as a part of a JSON pointer.
std::string pointer_part(const std::string& key);

}  // namespace lrb::io
