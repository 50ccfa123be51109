/// Reads what trace_json_write.cpp wrote. The only file of this folder that includes nlohmann-json.

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include <nlohmann/json.hpp>

#include "engine/error.hpp"
#include "engine/mesh/file_bytes.hpp"
#include "trace/hex.hpp"
#include "trace/names.hpp"
#include "trace/trace_json.hpp"

namespace lrb::trace {

namespace {

using Json = nlohmann::json;

std::string type_of(const Json& j) {
  std::string name = j.is_null() ? "nothing" : j.type_name();
  if (j.is_primitive() && !j.is_null()) name += " " + j.dump(-1, ' ', true, Json::error_handler_t::replace);
  constexpr std::size_t kShown = 60;
  return name.size() <= kShown ? name : name.substr(0, kShown) + "...";
}

/// A JSON value and where it stands, so that every complaint can name it. The path is a chain of the values
/// around it: it costs nothing until something is wrong.
class Node {
 public:
  Node(const Json& j, const std::string& file) : j_(&j), file_(&file) {}

  [[noreturn]] void fail(const std::string& expected) const {
    throw InputError(*file_ + ": " + pointer() + ": expected " + expected + ", found " + type_of(*j_) +
                     "; the trace is damaged or was not written by lrbscope: record it again");
  }

  bool has(const char* key) const { return j_->is_object() && j_->contains(key); }
  Node at(const char* key) const {
    static const Json nothing;
    if (!j_->is_object()) fail("an object");
    const auto it = j_->find(key);
    return {it == j_->end() ? nothing : *it, this, key, 0};
  }
  Node at(std::size_t i) const { return {(*j_)[i], this, nullptr, i}; }
  /// Where an element of a long array was, after the parser dropped those before it.
  static Node element(const Json& j, const Node& array, std::size_t i) { return {j, &array, nullptr, i}; }

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
  Node(const Json& j, const Node* parent, const char* key, std::size_t index)
      : j_(&j), file_(parent->file_), parent_(parent), key_(key), index_(index) {}

  /// RFC 6901; no key of ours needs escaping.
  std::string pointer() const {
    if (!parent_) return "";
    return parent_->pointer() + "/" + (key_ ? std::string(key_) : std::to_string(index_));
  }

  const Json* j_;
  const std::string* file_;
  const Node* parent_ = nullptr;
  const char* key_ = nullptr;
  std::size_t index_ = 0;
};

/// "at line 3, column 17".
std::string line_and_column(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t break_at = before.rfind('\n');
  const std::size_t column =
      break_at == std::string_view::npos ? before.size() : before.size() - break_at - 1;
  return "line " + std::to_string(line) + ", column " + std::to_string(std::max<std::size_t>(column, 1));
}

/// A simplex of the answer, under either of its two names.
std::uint32_t read_contact(const Node& args, Side side) {
  const char* pseudo = pseudo_simplex(side).data();
  const auto [a, b] = fields_of(EventKind::contact);
  return args.at(args.has(pseudo) ? pseudo : side == Side::a ? a.data() : b.data()).integer<std::uint32_t>();
}

void read_fields(const Node& args, Event& e) {
  const auto [a, b] = fields_of(e.kind);
  if (e.kind == EventKind::refine || e.kind == EventKind::coarsen) e.side = args.at("side").named<Side>();
  if (e.kind == EventKind::contact) {
    e.a = read_contact(args, Side::a);
    e.b = read_contact(args, Side::b);
  } else if (!a.empty()) {
    const Node node = args.at(a.data());
    e.a = e.kind == EventKind::result ? static_cast<std::uint32_t>(node.named<Relation>())
                                      : node.integer<std::uint32_t>();
  }
  if (!b.empty() && e.kind != EventKind::contact) e.b = args.at(b.data()).integer<std::uint32_t>();
  if (e.kind == EventKind::face_test || e.kind == EventKind::contact)
    e.meet = args.at("meet").named<exact::Meet>();
  if (e.kind == EventKind::face_test) {
    e.depth_a = args.at("depth of A").integer<std::uint16_t>();
    e.depth_b = args.at("depth of B").integer<std::uint16_t>();
  }
  if (args.has("wrapper faces")) e.boundary = args.at("wrapper faces").integer<std::uint32_t>();
  if (args.has("cause")) e.cause = args.at("cause").integer<std::uint32_t>();
}

/// Takes the events one by one as the parser completes them, so that they are never all in memory as JSON.
class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Trace run() {
    const Json document = parse();
    const Node root(document, name_);
    const Node metadata = root.at("metadata");
    check_format(metadata);
    read_header(metadata);
    read_steps(metadata.at("steps"));
    check_counts(metadata.at("events"));
    check_trace(t_, name_);
    return std::move(t_);
  }

 private:
  /// Containers may nest this deep; ours need six levels.
  static constexpr int kMaxDepth = 32;

  Json parse() {
    try {
      return Json::parse(text_.begin(), text_.end(), [this](int depth, Json::parse_event_t event, Json& j) {
        return take(depth, event, j);
      });
    } catch (const Json::parse_error& error) {
      std::string what =
          error.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
      const std::size_t colon = what.find(": ");
      if (colon != std::string::npos) what.erase(0, colon + 2);
      constexpr std::size_t kShown = 160;  // the parser quotes all of an unfinished string
      if (what.size() > kShown) what = what.substr(0, kShown) + "...";
      throw InputError(name_ + ": " + line_and_column(text_, error.byte) + ": this is not JSON: " + what +
                       "; is it a trace, and whole?");
    } catch (const Json::out_of_range&) {
      throw InputError(name_ + ": a number is too large for a double; the trace is damaged: record it again");
    }
  }

  /// The parser's callback; false drops a value that is no longer needed.
  bool take(int depth, Json::parse_event_t event, Json& j) {
    if (depth > kMaxDepth)
      throw InputError(name_ + ": containers nested more than " + std::to_string(kMaxDepth) +
                       " deep: this is not a trace of lrbscope");
    if (event == Json::parse_event_t::key && depth == 1) in_events_ = j == "traceEvents";
    if (event != Json::parse_event_t::object_end || depth != 2 || !in_events_) return true;
    static const Json unfinished = Json::object();
    const Node root(unfinished, name_);
    const Node array = root.at("traceEvents");
    return take_event(Node::element(j, array, elements_++));
  }

  bool take_event(const Node& node) {
    if (node.at("ph").string() != "X") return false;  // names, counters and flows follow from the rest
    if (t_.events.size() >= kMaxId) node.fail("fewer events");
    Event e;
    e.kind = node.at("name").named<EventKind>();
    const Node args = node.at("args");
    const auto number = args.at("event").integer<EventId>();
    if (number != t_.events.size())
      args.at("event").fail(std::to_string(t_.events.size()) + ", the next event");
    read_fields(args, e);
    if (args.has("ns")) t_.wall_ns.push_back(args.at("ns").integer<std::uint64_t>());
    t_.events.push_back(e);
    return false;
  }

  void check_format(const Node& metadata) const {
    if (!metadata.has("format") || metadata.at("format").string() != "lrbscope trace")
      throw InputError(name_ + ": /metadata/format: expected \"lrbscope trace\"; this is some other file");
    const auto version = metadata.at("version").integer<std::uint32_t>();
    if (version > kTraceVersion)
      throw InputError(name_ + ": /metadata/version: written in format " + std::to_string(version) +
                       " by lrbscope " + printable_name(metadata.at("lrbscope").string()) +
                       ", but this one reads up to format " + std::to_string(kTraceVersion) +
                       "; use that version or a newer one");
    if (version == 0) metadata.at("version").fail("a version from 1");
  }

  void read_header(const Node& metadata) {
    TraceHeader& h = t_.header;
    h.lrbscope = metadata.at("lrbscope").string();
    const Node scenario = metadata.at("scenario");
    h.scenario = scenario.at("name").string();
    h.scenario_hash = scenario.at("hash").hash();
    h.clock = metadata.at("clock").named<Clock>();
    const Node request = metadata.at("request");
    h.request.mode = request.at("mode").named<Mode>();
    h.request.recursion = request.at("recursion").named<Recursion>();
    h.request.predicates = request.at("predicates").named<Predicates>();
    h.request.wrapper = request.at("wrapper").named<WrapperMode>();
    h.request.contacts = request.at("contacts").boolean();
    h.request.interiors_overlap = request.at("interiors_overlap").boolean();
    if (request.has("tolerance")) h.request.tolerance = request.at("tolerance").least(0);
    if (request.has("max_tests")) h.request.max_tests = request.at("max_tests").integer<std::uint64_t>();
    if (request.has("max_time")) h.request.max_time = request.at("max_time").least(0);
    if (request.has("separation")) h.request.separation = request.at("separation").boolean();
    const Node bodies = metadata.at("bodies");
    const std::size_t count = bodies.array_size();
    if (count < 1 || count > 2) bodies.fail("one body or two");
    for (std::size_t i = 0; i < count; ++i) h.bodies.push_back(read_body(bodies.at(i)));
  }

  static BodyInfo read_body(const Node& node) {
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

  void read_steps(const Node& steps) {
    const std::size_t count = steps.array_size();
    t_.steps.reserve(count);
    for (std::size_t i = 0; i < count; ++i) t_.steps.push_back(read_step(steps.at(i)));
  }

  Step read_step(const Node& node) const {
    Step s;
    s.index = node.at("index").integer<std::uint32_t>();
    s.first_event = node.at("first_event").integer<std::uint32_t>();
    s.events_seen = node.at("events_seen").integer<std::uint64_t>();
    s.pose_a = read_pose(node.at("pose_a"));
    if (t_.header.bodies.size() > 1) s.pose_b = read_pose(node.at("pose_b"));
    s.finished = node.has("result");
    if (s.finished) read_result(node.at("result"), s.result);
    return s;
  }

  void read_coarse(const Node& node, StepResult& r) const {
    if (t_.header.request.is_coarse()) {
      const Node bound = node.at("error_bound");
      r.error_bound = bound.is_null() && node.has("error_bound") ? std::numeric_limits<double>::infinity()
                                                                 : bound.least(0);
      r.finished = node.at("finished").boolean();
    }
    if (!node.has("separation")) return;
    const Node separation = node.at("separation");
    const Node faces = separation.at("faces"), refined = separation.at("refined");
    if (faces.array_size() != 2) faces.fail("two numbers, of A and B");
    if (refined.array_size() != 2) refined.fail("two lists of regions, of A and B");
    r.separation.emplace();
    for (std::size_t side = 0; side < 2; ++side) {
      r.separation->face_count[side] = faces.at(side).integer<std::uint32_t>();
      const Node regions = refined.at(side);
      const std::size_t count = regions.array_size();
      for (std::size_t i = 0; i < count; ++i)
        r.separation->refined[side].push_back(regions.at(i).integer<std::uint32_t>());
    }
  }

  static Pose read_pose(const Node& node) {
    if (node.array_size() != 12) node.fail("12 numbers (a 3x4 matrix, row by row)");
    Pose pose;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        pose.r(row, column) = node.at(static_cast<std::size_t>(4 * row + column)).number();
      pose.t(row) = node.at(static_cast<std::size_t>(4 * row + 3)).number();
    }
    return pose;
  }

  void read_result(const Node& node, StepResult& r) const {
    r.relation = node.at("relation").named<Relation>();
    r.interiors_overlap = node.at("interiors_overlap").named<Answer>();
    r.pair_count = node.at("pairs").integer<std::uint64_t>();
    r.fingerprint = node.at("fingerprint").hash();
    read_coarse(node, r);
    const Node counters = node.at("counters");
    Counters& c = r.counters;
    c.face_tests = counters.at("face_tests").integer<std::uint64_t>();
    c.real_tests = counters.at("real_tests").integer<std::uint64_t>();
    c.exact_fallbacks = counters.at("exact_fallbacks").integer<std::uint64_t>();
    c.node_pairs = counters.at("node_pairs").integer<std::uint64_t>();
    c.box_tests = counters.at("box_tests").integer<std::uint64_t>();
    c.prefilter_tests = counters.at("prefilter_tests").integer<std::uint64_t>();
    c.refinements = counters.at("refinements").integer<std::uint64_t>();
    c.regions_opened = counters.at("regions_opened").integer<std::uint64_t>();
    const Node levels = counters.at("face_tests_by_level");
    const std::size_t count = levels.array_size();
    for (std::size_t i = 0; i < count; ++i)
      c.face_tests_by_level.push_back(levels.at(i).integer<std::uint32_t>());
  }

  void check_counts(const Node& node) {
    if (node.at("stored").integer<std::uint64_t>() != t_.events.size())
      node.at("stored").fail(std::to_string(t_.events.size()) + ", the number of events above");
    t_.events_seen = node.at("seen").integer<std::uint64_t>();
    t_.header.event_cap = node.at("cap").integer<std::uint32_t>();
    if (node.at("truncated").boolean() != t_.truncated()) node.at("truncated").fail("seen > stored");
  }

  std::string_view text_;
  const std::string& name_;
  Trace t_;
  bool in_events_ = false;
  std::size_t elements_ = 0;
};

}  // namespace

Trace trace_from_json(std::string_view text, const std::string& name) {
  return Reader(text, name).run();
}

}  // namespace lrb::trace
