#pragma once
/// Reads the JSON of traces by stating the expected type of each value. No other header of this folder
/// includes nlohmann-json.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <unordered_map>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <lrbscope/core/fields.hpp>
#include <lrbscope/enum_names.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::io {

// JSON with the location of each value in its file, so that messages can name file, line and column.

/// The line and column of a byte in a text, both from 1; columns count characters of UTF-8.
struct TextPosition {
  std::size_t line = 1, column = 1;
};
TextPosition position_in(const std::string& text, std::size_t offset);
/// Moves a position from one byte of a text to a later one.
void advance(TextPosition& position, const std::string& text, std::size_t from, std::size_t to);

/// Finds the offset of each value of a JSON text by its JSON pointer (RFC 6901), and of each member's key by
/// the pointer followed by '#'. The text must have been accepted by a parser, and its nesting must be
/// limited.
class JsonIndex {
 public:
  explicit JsonIndex(const std::string& text);
  std::size_t offset(const std::string& pointer) const;
  /// Returns the pointer of the first duplicate key, or an empty string if all keys are unique.
  const std::string& duplicate() const { return duplicate_; }

 private:
  std::unordered_map<std::string, std::size_t> offsets_;
  std::string duplicate_;
};

class JsonText {
 public:
  /// Parses a text. Throws InputError "file:line:column: ..." for bad syntax, repeated keys, and more than 64
  /// levels.
  JsonText(std::string text, std::string file);

  const nlohmann::json& root() const { return root_; }
  const std::string& file() const { return file_; }
  /// Returns "file:line:column" of the value (or, with '#' appended, the key) at a JSON pointer.
  std::string where(const std::string& pointer) const;

 private:
  std::string text_, file_;
  mutable TextPosition last_;  ///< last location computed: requests in order scan the text once
  mutable std::size_t last_offset_ = 0;
  nlohmann::json root_;
  std::unique_ptr<JsonIndex> index_;
};

/// Throws InputError if a text has a NUL byte: nlohmann-json would take it for the end of the text and ignore
/// the rest.
void reject_nul(const std::string& text, const std::string& file);
/// Throws InputError "file:line:column: ..." for a text that nlohmann-json rejected. The arguments are those
/// of nlohmann::json_sax::parse_error().
[[noreturn]] void fail_json(const std::string& text, const std::string& file, std::size_t position,
                            const std::string& token, const nlohmann::json::exception& error);

/// Parses a text. `seen` is the parser's current position whenever it calls `handler`.
void parse_with(const std::string& text, const char*& seen, nlohmann::json_sax<nlohmann::json>& handler);

/// Returns a member's name or an index as a component of a JSON pointer.
std::string pointer_part(const std::string& key);

// Reads a JsonText by stating the expected type of each value. A wrong type, value or key throws InputError
// with its location.

class JsonNode {
 public:
  explicit JsonNode(const JsonText& text) : text_(&text), value_(&text.root()) {}

  /// Requires an object with these keys only. For an unknown key the error suggests the closest known one.
  const JsonNode& object(const std::vector<std::string>& keys) const;
  bool has(const std::string& key) const { return value_->is_object() && value_->contains(key); }
  JsonNode at(const std::string& key) const;  ///< requires that the member exists
  std::optional<JsonNode> get(const std::string& key) const;

  /// Requires an array of at least `least` values.
  std::vector<JsonNode> items(std::size_t least = 0) const;
  bool is_array() const { return value_->is_array(); }
  bool is_object() const { return value_->is_object(); }
  bool is_string() const { return value_->is_string(); }

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
    for (const auto& [word, value] : words) {
      if (value_->is_string() && value_->get_ref<const std::string&>() == word) return value;
      known.push_back(word);
    }
    fail_choice(known);
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
  [[noreturn]] void fail_choice(const std::vector<std::string>& known) const;

  const JsonText* text_;
  const nlohmann::json* value_;
  std::string pointer_;
};

// Writes records as JSON objects and reads them, by their field tables
// (engine/include/lrbscope/core/fields.hpp).

template <class Record>
nlohmann::ordered_json record_to_json(const Record& record);
template <class Record>
Record record_from_json(const nlohmann::json& value);

/// JSON form of a field's value: numbers, strings and lists of them directly, enumerators by name, records as
/// objects. Specialise it for other types.
template <class Value>
struct JsonOf {
  static nlohmann::ordered_json write(const Value& value) {
    if constexpr (std::is_enum_v<Value>)
      return name_of(value);
    else if constexpr (kFieldCount<Value> > 0)
      return record_to_json(value);
    else
      return value;
  }
  static Value read(const nlohmann::json& value) {
    if constexpr (std::is_enum_v<Value>) {
      const auto word = value.get<std::string>();
      if (const auto found = from_name<Value>(word)) return *found;
      throw InputError("'" + word + "': expected " + all_names<Value>());
    } else if constexpr (kFieldCount<Value> > 0) {
      return record_from_json<Value>(value);
    } else {
      return value.get<Value>();
    }
  }
};
/// Only for fields that are written if set.
template <class Value>
struct JsonOf<std::optional<Value>> {
  static nlohmann::ordered_json write(const std::optional<Value>& value) {
    return JsonOf<Value>::write(value.value());
  }
  static std::optional<Value> read(const nlohmann::json& value) { return JsonOf<Value>::read(value); }
};

/// Returns the record as an object, with its members in the order of the table.
template <class Record>
nlohmann::ordered_json record_to_json(const Record& record) {
  nlohmann::ordered_json out = nlohmann::ordered_json::object();
  for_each_field<Record>([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(record.*field.member)>;
    if (is_kept(field, record)) out[field.name.data()] = JsonOf<Value>::write(record.*field.member);
  });
  return out;
}

/// Reads a record. Throws InputError that states what is wrong with the value. Keys that are not fields are
/// ignored.
template <class Record>
Record record_from_json(const nlohmann::json& value) {
  Record record;
  for_each_field<Record>([&](const auto& field) {
    using Value = std::remove_cvref_t<decltype(record.*field.member)>;
    const char* key = field.name.data();
    if (field.kept != Kept::always && !value.contains(key)) return;
    try {
      record.*field.member = JsonOf<Value>::read(value.at(key));
    } catch (const nlohmann::json::exception& e) {
      throw InputError(std::string(key) + ": " + e.what());
    }
  });
  return record;
}

/// Returns the number of edits (insert, delete, replace, swap neighbours) that transform one word into the
/// other.
std::size_t edit_distance(const std::string& a, const std::string& b);

/// Returns the closest word of `known`, or an empty string if none is close.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

/// Returns the end of a message: "; did you mean \"x\"?" if a close word exists, then "; known: a, b, c".
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace lrb::io

namespace lrb::trace {

/// A JSON value with its location in the document, so that every error can name it. The location is a chain
/// of the enclosing values, which must outlive it; it is formatted only if there is an error.
class TraceNode {
 public:
  using Json = nlohmann::json;
  TraceNode(const Json& j, const std::string& file) : j_(&j), file_(&file) {}

  /// Throws InputError: "file: pointer: expected ..., found ...; remedy".
  [[noreturn]] void fail(const std::string& expected) const;

  bool has(const char* key) const { return j_->is_object() && j_->contains(key); }
  TraceNode at(const char* key) const;
  TraceNode at(std::size_t i) const { return {(*j_)[i], this, nullptr, i}; }
  /// Returns element `i` of a long array whose earlier elements the parser has discarded.
  static TraceNode element(const Json& j, const TraceNode& array, std::size_t i) {
    return {j, &array, nullptr, i};
  }

  std::size_t array_size() const {
    if (!j_->is_array()) fail("an array");
    return j_->size();
  }

  template <class T>
  T integer(std::uint64_t max = std::numeric_limits<T>::max()) const {
    if (j_->is_number_unsigned() && j_->get<std::uint64_t>() <= max)
      return static_cast<T>(j_->get<std::uint64_t>());
    fail("an integer from 0 to " + std::to_string(max));
  }
  double number() const {
    if (!j_->is_number()) fail("a number");
    return j_->get<double>();
  }
  double least(double least) const {
    if (!j_->is_number() || !(number() >= least)) fail("a number of at least " + std::to_string(least));
    return number();
  }
  bool is_null() const { return j_->is_null(); }
  bool boolean() const {
    if (!j_->is_boolean()) fail("true or false");
    return j_->get<bool>();
  }
  const std::string& string() const {
    if (!j_->is_string()) fail("a string");
    return j_->get_ref<const std::string&>();
  }
  /// Returns an object as text, its keys in alphabetical order.
  std::string object_text() const {
    if (!j_->is_object()) fail("an object");
    return j_->dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  std::uint64_t hash() const {
    const auto value = j_->is_string() ? from_hex(string()) : std::nullopt;
    if (!value) fail("a hash of 16 hexadecimal digits");
    return *value;
  }
  template <class Enum>
  Enum named() const {
    const auto value = j_->is_string() ? from_name<Enum>(string()) : std::nullopt;
    if (!value) fail(all_names<Enum>());
    return *value;
  }

 private:
  TraceNode(const Json& j, const TraceNode* parent, const char* key, std::size_t index)
      : j_(&j), file_(parent->file_), parent_(parent), key_(key), index_(index) {}

  /// Returns the location as a JSON pointer (RFC 6901). No key of lrbscope's formats needs escaping.
  std::string pointer() const;

  const Json* j_;
  const std::string* file_;
  const TraceNode* parent_ = nullptr;
  const char* key_ = nullptr;
  std::size_t index_ = 0;
};

/// Calls `take` with each event (element of traceEvents) as soon as it is parsed, so that the events are
/// never all in memory as JSON. Returns the rest of the document. Throws InputError, also for text that is
/// not JSON.
nlohmann::json parse_events(std::string_view text, const std::string& name,
                            const std::function<void(const TraceNode&)>& take);

/// Throws InputError unless `metadata` names `format`, in a version from 1 to `version`.
void check_format(const TraceNode& metadata, const std::string& name, std::string_view format,
                  std::uint32_t version);

BodyInfo read_body(const TraceNode& node);
CollideRequest read_request(const TraceNode& node);
/// Reads the answer to `request` as written by write_answer().
StepResult read_answer(const TraceNode& node, const CollideRequest& request);
MeasuredApproach read_approach(const TraceNode& node);
Pose read_pose(const TraceNode& node);

}  // namespace lrb::trace
