#include "trace/json_read.hpp"

#include <algorithm>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"

namespace lrb::trace {

namespace {

using Json = nlohmann::json;

std::string type_of(const Json& j) {
  std::string name = j.is_null() ? "nothing" : j.type_name();
  if (j.is_primitive() && !j.is_null()) name += " " + j.dump(-1, ' ', true, Json::error_handler_t::replace);
  constexpr std::size_t kShown = 60;
  return name.size() <= kShown ? name : name.substr(0, kShown) + "...";
}

/// "at line 3, column 17".
std::string line_and_column(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t break_at = before.rfind('\n');
  const std::size_t column =
      break_at == std::string_view::npos ? before.size() : before.size() - break_at - 1;
  return "line " + std::to_string(line) + ", column " + std::to_string(std::max<std::size_t>(column, 1));
}

/// Containers may nest this deep; ours need six levels.
constexpr int kMaxDepth = 32;

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
  bool in_events = false;
  std::size_t elements = 0;
  /// The parser's callback; false drops a value that is no longer needed.
  const auto on_event = [&](int depth, Json::parse_event_t event, Json& j) {
    if (depth > kMaxDepth)
      throw InputError(name + ": containers nested more than " + std::to_string(kMaxDepth) +
                       " deep: this is not a trace of lrbscope");
    if (event == Json::parse_event_t::key && depth == 1) in_events = j == "traceEvents";
    if (event != Json::parse_event_t::object_end || depth != 2 || !in_events) return true;
    static const Json unfinished = Json::object();
    const TraceNode root(unfinished, name);
    const TraceNode array = root.at("traceEvents");
    take(TraceNode::element(j, array, elements++));
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

BodyInfo read_body(const TraceNode& node) {
  BodyInfo b;
  b.name = node.at("name").string();
  b.source = node.at("source").string();
  b.hash = node.at("hash").hash();
  b.dim = node.at("dim").integer<std::uint32_t>();
  if (b.dim != 2 && b.dim != 3) node.at("dim").fail("2 or 3");
  b.closed = node.at("closed").boolean();
  b.real_faces = node.at("real_faces").integer<std::uint32_t>(kMaxId);
  b.total_faces = node.at("total_faces").integer<std::uint32_t>(kMaxId);
  b.outer_faces = node.at("outer_faces").integer<std::uint32_t>(kMaxId);
  b.regions = node.at("regions").integer<std::uint32_t>(kMaxId);
  b.layers = node.at("layers").integer<std::uint32_t>(kMaxId);
  b.real_simplices = node.at("real_simplices").integer<std::uint32_t>(kMaxId);
  b.simplices = node.at("simplices").integer<std::uint32_t>(kMaxId);
  return b;
}

CollideRequest read_request(const TraceNode& node) {
  CollideRequest r;
  r.mode = node.at("mode").named<Mode>();
  r.recursion = node.at("recursion").named<Recursion>();
  r.predicates = node.at("predicates").named<Predicates>();
  r.wrapper = node.at("wrapper").named<WrapperMode>();
  r.contacts = node.at("contacts").boolean();
  r.interiors_overlap = node.at("interiors_overlap").boolean();
  if (node.has("tolerance")) r.tolerance = node.at("tolerance").least(0);
  if (node.has("max_tests")) r.max_tests = node.at("max_tests").integer<std::uint64_t>();
  if (node.has("max_time")) r.max_time = node.at("max_time").least(0);
  if (node.has("separation")) r.separation = node.at("separation").boolean();
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
