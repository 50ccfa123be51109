#pragma once
/// JSON that knows where in its file each value stands, so that a message can name file, line and column.

#include <cstddef>
#include <memory>
#include <string>
#include <unordered_map>

#include <nlohmann/json.hpp>

namespace lrb::io {

/// Line and column of a byte in a text, both from 1; columns count characters of UTF-8.
struct TextPosition {
  std::size_t line = 1, column = 1;
};
TextPosition position_in(const std::string& text, std::size_t offset);

/// Offsets of the values of a JSON text by JSON pointer (RFC 6901), and of each member's key by the pointer
/// with '#' behind it. Works on texts that a parser has accepted.
class JsonIndex {
 public:
  explicit JsonIndex(const std::string& text);
  std::size_t offset(const std::string& pointer) const;
  /// Pointer of the first member whose key occurs twice in its object; empty if there is none.
  const std::string& duplicate() const { return duplicate_; }

 private:
  std::unordered_map<std::string, std::size_t> offsets_;
  std::string duplicate_;
};

class JsonText {
 public:
  /// Parses; throws InputError "file:line:column: ..." for bad syntax and for repeated keys.
  JsonText(std::string text, std::string file);

  const nlohmann::json& root() const { return root_; }
  const std::string& file() const { return file_; }
  /// "file:line:column" of the value (or, with '#' behind it, the key) at a JSON pointer.
  std::string where(const std::string& pointer) const;

 private:
  std::string text_, file_;
  mutable TextPosition last_;  ///< of the place asked for last: asking in order costs one walk in all
  mutable std::size_t last_offset_ = 0;
  nlohmann::json root_;
  std::unique_ptr<JsonIndex> index_;
};

/// A member name or index as a part of a JSON pointer.
std::string pointer_part(const std::string& key);

}  // namespace lrb::io
