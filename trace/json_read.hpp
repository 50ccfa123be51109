#pragma once
/// Reads JSON by stating the expected type of each value, with its location in the file for messages.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::io {

// JSON with the location of each value in its file, so that messages can name file, line and column.

/// The line and column of a byte in a text, both from 1; columns count characters of UTF-8.
struct TextPosition {
  std::size_t line = 1, column = 1;
};
TextPosition position_in(std::string_view text, std::size_t offset);
/// Moves a position from one byte of a text to a later one.
void advance(TextPosition& position, std::string_view text, std::size_t from, std::size_t to);

/// The offset of each value of a JSON text by its JSON pointer (RFC 6901), and of each member's key by the
/// pointer followed by '#'.
using JsonOffsets = std::unordered_map<std::string, std::size_t>;

class JsonText {
 public:
  /// Parses a text. Throws InputError "file:line:column: ..." for bad syntax, repeated keys, and more than 64
  /// levels.
  JsonText(std::string text, std::string file);
  ~JsonText();

  const nlohmann::json& root() const { return *root_; }
  const std::string& file() const { return file_; }
  /// Returns "file:line:column" of the value (or, with '#' appended, the key) at a JSON pointer.
  std::string where(const std::string& pointer) const;

 private:
  std::string text_, file_;
  mutable TextPosition last_;  ///< last location computed: requests in order scan the text once
  mutable std::size_t last_offset_ = 0;
  std::unique_ptr<nlohmann::json> root_;
  JsonOffsets offsets_;
};

/// Returns a message of nlohmann's without the exception's name, number and position.
std::string plain_reason(const std::string& what);

/// Returns a member's name or an index as a component of a JSON pointer.
std::string pointer_part(const std::string& key);

// Reads a JsonText by stating the expected type of each value. A wrong type, value or key throws InputError
// with its location.

class JsonNode {
 public:
  explicit JsonNode(const JsonText& text) : text_(&text), value_(&text.root()) {}

  /// Requires an object with these keys only. For an unknown key the error suggests the closest known one.
  const JsonNode& object(const std::vector<std::string>& keys) const;
  bool has(const std::string& key) const;
  JsonNode at(const std::string& key) const;  ///< requires that the member exists
  std::optional<JsonNode> get(const std::string& key) const;

  /// Requires an array of at least `least` values.
  std::vector<JsonNode> items(std::size_t least = 0) const;
  bool is_array() const;
  bool is_object() const;
  bool is_string() const;

  double number(double least, double most) const;
  std::uint64_t integer(std::uint64_t least, std::uint64_t most) const;
  bool boolean() const;
  std::string string() const;
  std::vector<double> numbers(std::size_t count) const;  ///< requires an array of exactly `count` numbers
  Eigen::Vector3d vector() const;                        ///< requires an array of three numbers
  /// Requires one of the given words.
  template <class T>
  T choice(const std::vector<std::pair<std::string, T>>& words) const {
    std::vector<std::string> known;
    for (const auto& [word, value] : words) known.push_back(word);
    return words[index_among(known)].second;
  }

  /// Requires one of the words of an enum.
  template <class Enum>
  Enum choice() const {
    std::vector<std::pair<std::string, Enum>> words;
    words.reserve(kEnumNames<Enum>.size());
    for (const EnumName<Enum>& entry : kEnumNames<Enum>) words.emplace_back(entry.name, entry.value);
    return choice(words);
  }

  /// Throws InputError: "file:line:column: pointer: message".
  [[noreturn]] void fail(const std::string& message) const;
  /// As above, with the location of the member's key.
  [[noreturn]] void fail_key(const std::string& key, const std::string& message) const;
  const nlohmann::json& json() const { return *value_; }
  const std::string& pointer() const { return pointer_; }

 private:
  JsonNode(const JsonText& text, const nlohmann::json& value, std::string pointer)
      : text_(&text), value_(&value), pointer_(std::move(pointer)) {}
  [[noreturn]] void fail_type(const char* expected) const;
  /// Requires one of the known words.
  std::size_t index_among(const std::vector<std::string>& known) const;

  const JsonText* text_;
  const nlohmann::json* value_;
  std::string pointer_;
};

/// Convert between a pose and 12 numbers row by row.
Pose pose_of(std::span<const double, 12> rows);
std::array<double, 12> rows_of(const Pose& pose);

/// Returns the number of edits (insert, delete, replace, swap neighbours) that transform one word into the
/// other.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// Returns the closest word of `known`, or an empty string if none is close.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

/// Returns the end of a message: "; did you mean \"x\"?" if a close word exists, then "; known: a, b, c".
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace lrb::io
