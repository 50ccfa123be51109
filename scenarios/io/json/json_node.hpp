#pragma once
/// Reads a JsonText by naming what is expected at each place: a wrong type, value or key is an InputError
/// that tells where it stands.

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "engine/core/enum_words.hpp"
#include "scenarios/io/json/json_text.hpp"

namespace lrb::io {

class JsonNode {
 public:
  explicit JsonNode(const JsonText& text) : text_(&text), value_(&text.root()) {}

  /// Requires an object with no keys but these; for an unknown one the error names the nearest known word.
  const JsonNode& object(const std::vector<std::string>& keys) const;
  bool has(const std::string& key) const { return value_->is_object() && value_->contains(key); }
  JsonNode at(const std::string& key) const;  ///< requires the member to be there
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
  /// Requires one of these words.
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
    words.reserve(kWords<Enum>.size());
    for (const EnumWord<Enum>& entry : kWords<Enum>) words.emplace_back(entry.word, entry.value);
    return choice(words);
  }

  /// Throws InputError: "file:line:column: pointer: message".
  [[noreturn]] void fail(const std::string& message) const;
  /// Does the same, but names the place of the member's key.
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

}  // namespace lrb::io
