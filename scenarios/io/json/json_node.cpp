#include "scenarios/io/json/json_node.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "scenarios/io/json/suggest.hpp"
#include "scenarios/io/number_text.hpp"

namespace lrb::io {
void JsonNode::fail(const std::string& message) const {
  throw InputError(text_->where(pointer_) + ": " +
                   printable_name((pointer_.empty() ? "" : pointer_ + ": ") + message));
}

void JsonNode::fail_key(const std::string& key, const std::string& message) const {
  const std::string member = pointer_ + "/" + pointer_part(key);
  throw InputError(text_->where(member + "#") + ": " + printable_name(member + ": " + message));
}

void JsonNode::fail_type(const char* expected) const {
  fail(std::string("expected ") + expected + ", found " + value_->type_name());
}

void JsonNode::fail_choice(const std::vector<std::string>& known) const {
  if (!value_->is_string()) fail_type("a word");
  const auto& word = value_->get_ref<const std::string&>();
  fail("\"" + word + "\" is not known here" + suggestion(word, known));
}

const JsonNode& JsonNode::object(const std::vector<std::string>& keys) const {
  if (!value_->is_object()) fail_type("an object");
  for (const auto& [key, value] : value_->items())
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      fail_key(key, "unknown key" + suggestion(key, keys));
  return *this;
}

JsonNode JsonNode::at(const std::string& key) const {
  if (!value_->is_object()) fail_type("an object");
  if (!value_->contains(key)) fail("the key \"" + key + "\" is missing: add it");
  return {*text_, (*value_)[key], pointer_ + "/" + pointer_part(key)};
}

std::optional<JsonNode> JsonNode::get(const std::string& key) const {
  if (!has(key)) return std::nullopt;
  return at(key);
}

std::vector<JsonNode> JsonNode::items(std::size_t least) const {
  if (!value_->is_array()) fail_type("an array");
  if (value_->size() < least)
    fail("expected at least " + std::to_string(least) + " items, found " + std::to_string(value_->size()));
  std::vector<JsonNode> out;
  for (std::size_t i = 0; i < value_->size(); ++i)
    out.push_back(JsonNode(*text_, (*value_)[i], pointer_ + "/" + std::to_string(i)));
  return out;
}

double JsonNode::number(double least, double most) const {
  if (!value_->is_number()) fail_type("a number");
  const double x = value_->get<double>();
  if (!std::isfinite(x) || x < least || x > most)
    fail("expected a number from " + number_text(least, 6) + " to " + number_text(most, 6) + ", found " +
         value_->dump());
  return x;
}

std::uint64_t JsonNode::integer(std::uint64_t least, std::uint64_t most) const {
  const bool whole = value_->is_number_unsigned();
  if (!value_->is_number()) fail_type("a whole number");
  if (!whole || value_->get<std::uint64_t>() < least || value_->get<std::uint64_t>() > most)
    fail("expected a whole number from " + std::to_string(least) + " to " + std::to_string(most) +
         ", found " + value_->dump());
  return value_->get<std::uint64_t>();
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) fail_type("true or false");
  return value_->get<bool>();
}

std::string JsonNode::string() const {
  if (!value_->is_string()) fail_type("a string");
  return value_->get<std::string>();
}

std::vector<double> JsonNode::numbers(std::size_t count) const {
  constexpr double kAny = std::numeric_limits<double>::max();
  if (!value_->is_array()) fail_type("an array of numbers");
  if (value_->size() != count)
    fail("expected " + std::to_string(count) + " numbers, found " + std::to_string(value_->size()));
  std::vector<double> out;
  for (const JsonNode& item : items()) out.push_back(item.number(-kAny, kAny));
  return out;
}

Eigen::Vector3d JsonNode::vector() const {
  const std::vector<double> x = numbers(3);
  return {x[0], x[1], x[2]};
}

}  // namespace lrb::io
