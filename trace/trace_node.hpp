#pragma once
/// Reads the JSON of traces by stating the expected type of each value.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <lrbscope/enum_names.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>

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
