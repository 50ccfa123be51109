#include "trace/json_read.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"
#include "trace/record_fields.hpp"

namespace lrb::trace {

namespace {

using Json = nlohmann::json;

std::string type_of(const Json& j) {
  std::string name = j.is_null() ? "nothing" : j.type_name();
  if (j.is_primitive() && !j.is_null()) name += " " + j.dump(-1, ' ', true, Json::error_handler_t::replace);
  constexpr std::size_t kShown = 60;
  return name.size() <= kShown ? name : name.substr(0, kShown) + "...";
}

/// Returns the place of a byte: "at line 3, column 17".
std::string line_and_column(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t break_at = before.rfind('\n');
  const std::size_t column =
      break_at == std::string_view::npos ? before.size() : before.size() - break_at - 1;
  return "line " + std::to_string(line) + ", column " + std::to_string(std::max<std::size_t>(column, 1));
}

/// The largest depth of nested containers; ours need six levels.
constexpr int kMaxDepth = 32;

/// Limits the memory that the parser takes by the length of the text it has read. A "0," of two bytes becomes
/// 16 bytes, an "[]," of three about 60; what we write takes more bytes as text than in memory, except for
/// poses of round numbers. An event is held until it is complete, everything else to the end.
class MemoryBudget {
 public:
  explicit MemoryBudget(const std::string& name) : name_(name) {}

  void add(Json::parse_event_t event, const Json& j) {
    constexpr std::uint64_t kValue = 16, kContainer = 64, kMember = 80;  // bytes of nlohmann's tree, about
    switch (event) {
      case Json::parse_event_t::object_start:
      case Json::parse_event_t::array_start:
        held_ += kContainer;
        break;
      case Json::parse_event_t::key:
        held_ += kMember + j.get_ref<const std::string&>().size();
        break;
      case Json::parse_event_t::value:
        held_ += kValue + (j.is_string() ? j.get_ref<const std::string&>().size() : 0);
        break;
      case Json::parse_event_t::object_end:
      case Json::parse_event_t::array_end:
        break;
    }
  }
  /// Throws InputError if the parser holds more than a text of this length may need.
  void check(std::uint64_t text) const {
    constexpr std::uint64_t kFree = std::uint64_t{16} << 20, kPerByte = 8;
    if (held_ > kFree + kPerByte * text)
      throw InputError(name_ + ": its values take more than " + std::to_string(kPerByte) +
                       " times the memory of its text, which no trace of lrbscope does: it is damaged");
  }
  /// Discounts what was held last, an event, which has been dropped.
  void forget_from(std::uint64_t held) { held_ = held; }
  std::uint64_t held() const { return held_; }

 private:
  const std::string& name_;
  std::uint64_t held_ = 0;
};

}  // namespace

void TraceNode::fail(const std::string& expected) const {
  throw InputError(*file_ + ": " + pointer() + ": expected " + expected + ", found " + type_of(*j_) +
                   "; the trace is damaged or was not written by lrbscope: record it again");
}

TraceNode TraceNode::at(const char* key) const {
  static const Json nothing;
  if (!j_->is_object()) fail("an object");
  const auto it = j_->find(key);
  return {it == j_->end() ? nothing : *it, this, key, 0};
}

std::string TraceNode::pointer() const {
  if (!parent_) return "";
  return parent_->pointer() + "/" + (key_ ? std::string(key_) : std::to_string(index_));
}

Json parse_events(std::string_view text, const std::string& name,
                  const std::function<void(const TraceNode&)>& take) {
  constexpr std::uint64_t kLargestEvent = std::uint64_t{1} << 16;  // bytes; ours take less than 2000
  bool in_events = false;
  std::size_t elements = 0;
  std::uint64_t before_event = 0;
  MemoryBudget budget(name);
  static const Json unfinished = Json::object(), some_array = Json::array();
  const TraceNode root(unfinished, name);
  const TraceNode array = root.at("traceEvents");
  /// The parser's callback; returns false to drop a value that is no longer needed.
  const auto on_event = [&](int depth, Json::parse_event_t event, Json& j) {
    using Parsed = Json::parse_event_t;
    if (depth > kMaxDepth)
      throw InputError(name + ": containers nested more than " + std::to_string(kMaxDepth) +
                       " deep: this is not a trace of lrbscope");
    budget.add(event, j);
    if (event == Parsed::key && depth == 1) in_events = j == "traceEvents";
    if (!in_events) {
      budget.check(text.size());
      return true;
    }
    const bool is_value = event == Parsed::value, is_array = event == Parsed::array_start;
    if (depth == 1 && (is_value || event == Parsed::object_start)) array.fail("an array of events");
    if (depth == 2 && (is_value || is_array))
      TraceNode::element(is_array ? some_array : j, array, elements).fail("an event, {...}");
    if (depth == 2 && event == Parsed::object_start) before_event = budget.held();
    if (depth > 1 && budget.held() - before_event > kLargestEvent)
      throw InputError(name + ": /traceEvents/" + std::to_string(elements) +
                       ": is longer than any event of lrbscope; the trace is damaged: record it again");
    if (event != Parsed::object_end || depth != 2) return true;
    take(TraceNode::element(j, array, elements++));
    budget.forget_from(before_event);
    return false;
  };
  try {
    return Json::parse(text.begin(), text.end(), on_event);
  } catch (const Json::parse_error& error) {
    std::string what =
        error.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    const std::size_t colon = what.find(": ");
    if (colon != std::string::npos) what.erase(0, colon + 2);
    constexpr std::size_t kShown = 160;  // the parser quotes all of an unfinished string
    if (what.size() > kShown) what = what.substr(0, kShown) + "...";
    throw InputError(name + ": " + line_and_column(text, error.byte) + ": this is not JSON: " + what +
                     "; is it a trace, and whole?");
  } catch (const Json::out_of_range&) {
    throw InputError(name + ": a number is too large for a double; the trace is damaged: record it again");
  }
}

void check_format(const TraceNode& metadata, const std::string& name, std::string_view format,
                  std::uint32_t version) {
  if (!metadata.has("format") || metadata.at("format").string() != format)
    throw InputError(name + ": /metadata/format: expected \"" + std::string(format) +
                     "\"; this is some other file");
  const auto found = metadata.at("version").integer<std::uint32_t>();
  if (found > version)
    throw InputError(name + ": /metadata/version: written in format " + std::to_string(found) +
                     " by lrbscope " + printable_name(metadata.at("lrbscope").string()) +
                     ", but this one reads up to format " + std::to_string(version) +
                     "; use that version or a newer one");
  if (found == 0) metadata.at("version").fail("a version from 1");
}

namespace {

template <class Number>  // or an id
void read_value(const TraceNode& node, std::vector<Number>& values) {
  const std::size_t count = node.array_size();
  for (std::size_t i = 0; i < count; ++i) values.emplace_back(node.at(i).integer<std::uint32_t>());
}

void read_value(const TraceNode& node, Separation& s) {
  const TraceNode faces = node.at("faces"), refined = node.at("refined");
  if (faces.array_size() != 2) faces.fail("two numbers, of A and B");
  if (refined.array_size() != 2) refined.fail("two lists of regions, of A and B");
  for (std::size_t side = 0; side < 2; ++side) {
    s.face_count[side] = faces.at(side).integer<std::uint32_t>();
    read_value(refined.at(side), s.refined[side]);
  }
}

template <class Record>
void read_record(const TraceNode& node, Record& record, bool coarse = false);

template <class Record, class Value>
void read_field(const TraceNode& node, const Field<Record, Value>& field, Value& value) {
  if constexpr (std::is_enum_v<Value>)
    value = node.named<Value>();
  else if constexpr (std::is_same_v<Value, bool>)
    value = node.boolean();
  else if constexpr (std::is_same_v<Value, std::string>)
    value = node.string();
  else if constexpr (std::is_same_v<Value, std::uint32_t>)
    value = node.integer<std::uint32_t>(field.form == Form::id ? kMaxId : kNull);
  else if constexpr (std::is_same_v<Value, std::uint64_t>)
    value = field.form == Form::hash ? node.hash() : node.integer<std::uint64_t>();
  else if constexpr (std::is_same_v<Value, double>)
    value = field.form == Form::or_infinite && node.is_null() ? std::numeric_limits<double>::infinity()
                                                              : node.least(0);
  else if constexpr (std::is_same_v<Value, std::optional<Separation>>)
    read_value(node, value.emplace());
  else if constexpr (std::is_same_v<Value, Counters>)
    read_record(node, value);
  else
    read_value(node, value);
}

/// Reads the fields that the record's table says must be there, and of the others those that are.
template <class Record>
void read_record(const TraceNode& node, Record& record, bool coarse) {
  for_each_field<Record>([&](const auto& field) {
    const char* const name = field.name.data();
    const bool must_be = field.kept == Kept::always || (field.kept == Kept::if_coarse && coarse);
    if (!node.has(name) && (!must_be || field.form == Form::or_infinite)) {
      if (must_be) node.at(name).fail("a number of at least 0, or null");
      return;
    }
    if (field.kept == Kept::if_coarse && !coarse) return;
    read_field(node.at(name), field, record.*field.member);
  });
}

}  // namespace

BodyInfo read_body(const TraceNode& node) {
  BodyInfo b;
  read_record(node, b);
  if (b.dim != 2 && b.dim != 3) node.at("dim").fail("2 or 3");
  return b;
}

CollideRequest read_request(const TraceNode& node) {
  CollideRequest r;
  read_record(node, r);
  return r;
}

StepResult read_answer(const TraceNode& node, const CollideRequest& request) {
  StepResult r;
  read_record(node, r, request.is_coarse());
  return r;
}

Pose read_pose(const TraceNode& node) {
  if (node.array_size() != 12) node.fail("12 numbers (a 3x4 matrix, row by row)");
  Pose pose;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      pose.r(row, column) = node.at(static_cast<std::size_t>(4 * row + column)).number();
    pose.t(row) = node.at(static_cast<std::size_t>(4 * row + 3)).number();
  }
  return pose;
}

}  // namespace lrb::trace
