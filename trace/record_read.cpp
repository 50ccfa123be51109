/// Reads the records of traces, which trace_json_parts.cpp writes.

#include <limits>
#include <ranges>
#include <type_traits>
#include <vector>

#include "trace/json_read.hpp"
#include "trace/measured_json.hpp"
#include "trace/trace_node.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/record_fields.hpp>

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
                   "; the trace is damaged or was not written by lrbscope; record it again");
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
                     "\", found another file format");
  // Older versions are read; newer ones are rejected with the version that wrote them.
  const auto found = metadata.at("version").integer<std::uint32_t>();
  if (found > version)
    throw InputError(name + ": /metadata/version: written in format " + std::to_string(found) +
                     " by lrbscope " + printable_name(metadata.at("lrbscope").string()) +
                     ", expected at most format " + std::to_string(version) +
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

/// Reads a reason, also in the words of earlier versions.
ClashReason read_reason(const TraceNode& node) {
  const std::string word = node.string();
  if (word == "a face that meets the other body has no area in the world") return ClashReason::flat_face;
  if (word == "faces coincide, and no point beside them is proved to be inside both")  // language: keep
    return ClashReason::faces_coincide;
  return node.named<ClashReason>();
}

/// Reads the members of a record.
class MemberReader {
 public:
  explicit MemberReader(const TraceNode& node) : node_(node) {}

  /// The member of a std::optional may be absent.
  template <class T>
  void member(const char* key, T& value, Values values = Values::not_negative) {
    if constexpr (kIsOptional<T>) {
      if (node_.has(key)) read(node_.at(key), value.emplace(), values);
    } else {
      read(node_.at(key), value, values);
    }
  }
  template <class T>
  void member_unless(const T& /*usual*/, const char* key, T& value) {
    if (node_.has(key)) member(key, value);
  }
  /// Reads an array of rows of `columns` values; `what`: these, for messages.
  template <class Row, class Visit>
  void rows(const char* key, std::vector<Row>& rows, std::size_t columns, const char* what,
            const Visit& visit) {
    const TraceNode list = node_.at(key);
    for (std::size_t i = 0, count = list.array_size(); i < count; ++i) {
      const TraceNode item = list.at(i);
      if (item.array_size() != columns) item.fail(what);
      MemberReader row(item);
      visit(row, rows.emplace_back());
    }
  }
  template <class Row, class Visit>
  void rows_if_any(const char* key, std::vector<Row>& all, std::size_t columns, const char* what,
                   const Visit& visit) {
    if (node_.has(key)) rows(key, all, columns, what, visit);
  }
  template <class T>
  void cell(T& value, Values values = Values::not_negative) {
    if constexpr (std::ranges::range<T>)
      for (auto& x : value) cell(x, values);
    else
      read(node_.at(column_++), value, values);
  }

 private:
  template <class T>
  static void read(const TraceNode& node, T& value, Values values) {
    if constexpr (std::is_same_v<T, ClashReason>) {
      value = read_reason(node);
    } else if constexpr (std::is_enum_v<T>) {
      value = node.named<T>();
    } else if constexpr (std::is_same_v<T, bool>) {
      value = node.boolean();
    } else if constexpr (std::is_same_v<T, double>) {
      value = values == Values::or_infinite && node.is_null() ? std::numeric_limits<double>::infinity()
              : values == Values::any                         ? node.number()
                                                              : node.least(0);
    } else if constexpr (std::is_unsigned_v<T>) {
      value = node.integer<T>();
    } else if constexpr (std::ranges::range<T>) {
      if (node.array_size() != value.size()) node.fail(std::to_string(value.size()) + " numbers");
      for (std::size_t i = 0; i < value.size(); ++i) read(node.at(i), value[i], values);
    } else {
      value = T(node.integer<std::uint32_t>(kMaxId));
    }
  }

  const TraceNode& node_;
  std::size_t column_ = 0;
};

template <class Measured>
void read_value(const TraceNode& node, Measured& m) {
  MemberReader io(node);
  members(io, m);
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
  else if constexpr (kIsOptional<Value>)
    read_value(node, value.emplace());
  else if constexpr (std::is_same_v<Value, Counters>)
    read_record(node, value);
  else
    read_value(node, value);
}

/// Reads the fields that the record's table requires, and the optional ones that are present.
template <class Record>
void read_record(const TraceNode& node, Record& record, bool coarse) {
  for_each_field<Record>([&](const auto& field) {
    const char* const name = field.name.data();
    // The table of fields decides: absence is an error, or the default.
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

MeasuredApproach read_approach(const TraceNode& node) {
  MeasuredApproach m;
  read_value(node, m);
  return m;
}

Pose read_pose(const TraceNode& node) {
  if (node.array_size() != 12) node.fail("12 numbers (a 3x4 matrix, row by row)");
  std::array<double, 12> rows{};
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = node.at(i).number();
  return io::pose_of(rows);
}

}  // namespace lrb::trace
