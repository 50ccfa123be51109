#include "trace/json_read.hpp"

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
