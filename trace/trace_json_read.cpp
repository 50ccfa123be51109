/// Parses the output of trace_json_write.cpp.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "trace/event_fields.hpp"
#include "trace/json_read.hpp"
#include "trace/trace_json_parts.hpp"
#include "trace/trace_node.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::trace {

// Streaming parser for traces, on nlohmann's SAX interface. Events are delivered one at a time and discarded,
// so its own memory is bounded by the largest event and the metadata, not by the length of the trace.

namespace {

using Json = nlohmann::json;

/// Maximum depth of nested containers; traces need six levels.
constexpr std::size_t kMaxDepth = 32;

/// Builds the document tree from nlohmann's SAX calls, without the events: each event is passed on when it is
/// complete, and discarded. nlohmann's own builder with a callback could discard them as well, but it
/// searches all elements of an array whenever an object in it ends, so that an array of n objects would take
/// O(n^2) time.
///
/// Memory is limited by the length of the text read so far. A "0," of two bytes becomes 16 bytes, an "[]," of
/// three about 60. In files written by lrbscope the text is longer than the tree, except for poses of round
/// numbers.
class EventParser final : public nlohmann::json_sax<Json> {
 public:
  EventParser(std::string_view text, const std::string& name,
              const std::function<void(const TraceNode&)>& take)
      : text_(text), name_(name), take_(take) {}

  Json run() {
    Json::sax_parse(text_.begin(), text_.end(), this);
    return std::move(root_);
  }

  bool null() override { return add_value(nullptr); }
  bool boolean(bool v) override { return add_value(v); }
  bool number_integer(number_integer_t v) override { return add_value(v); }
  bool number_unsigned(number_unsigned_t v) override { return add_value(v); }
  bool number_float(number_float_t v, const string_t& /*text*/) override { return add_value(v); }
  bool string(string_t& v) override { return add_value(std::move(v)); }
  bool binary(binary_t& /*none in a text*/) override { return false; }

  bool start_object(std::size_t /*size*/) override { return open(Json::object()); }
  bool start_array(std::size_t /*size*/) override { return open(Json::array()); }
  bool key(string_t& v) override {
    // A key at the top level: only the array under "traceEvents" is streamed.
    if (stack_.size() == 1) in_events_ = v == "traceEvents";
    hold(kMember + v.size());
    member_ = &(*stack_.back())[v];
    return true;
  }
  bool end_object() override {
    // Depth 3: the document, the array, the event.
    const bool is_event = in_events_ && stack_.size() == 3;
    if (is_event) take_(TraceNode::element(*stack_.back(), events_, event_count_++));
    stack_.pop_back();
    if (!is_event) return true;
    // Drop the event from the array, and its bytes from the account.
    stack_.back()->get_ref<Json::array_t&>().pop_back();
    held_ = before_event_;
    return true;
  }
  bool end_array() override {
    stack_.pop_back();
    return true;
  }

  [[noreturn]] bool parse_error(std::size_t offset, const std::string& /*token*/,
                                const Json::exception& error) override {
    // nlohmann's exception id out_of_range.406: the number exceeds the range of double.
    constexpr int kNumberTooLarge = 406;
    if (error.id == kNumberTooLarge)
      throw InputError(name_ + ": a number is too large for a double; the trace is damaged; record it again");
    std::string what = io::plain_reason(error.what());
    constexpr std::size_t kShown = 160;  // the parser quotes an unfinished string completely
    if (what.size() > kShown) what = what.substr(0, kShown) + "...";
    const io::TextPosition at = io::position_in(text_, std::max<std::size_t>(offset, 1) - 1);
    throw InputError(name_ + ": line " + std::to_string(at.line) + ", column " + std::to_string(at.column) +
                     ": not valid JSON: " + what + "; check that the file is a complete trace");
  }

 private:
  static constexpr std::uint64_t kValue = 16, kContainer = 64, kMember = 80;  // approximate bytes of the tree

  template <class Value>
  bool add_value(Value&& value) {
    Json j(std::forward<Value>(value));
    check_place(j);
    hold(kValue + (j.is_string() ? j.get_ref<const std::string&>().size() : 0));
    insert(std::move(j));
    return true;
  }

  bool open(Json container) {
    // Bounds the recursion of later traversals of the tree.
    if (stack_.size() > kMaxDepth)
      throw InputError(name_ + ": containers nested more than " + std::to_string(kMaxDepth) +
                       " levels deep, so this is not a trace of lrbscope");
    check_place(container);
    if (in_events_ && stack_.size() == 2) before_event_ = held_;
    hold(kContainer);
    stack_.push_back(insert(std::move(container)));
    return true;
  }

  /// Rejects any other value where the array of events or an event is expected.
  void check_place(const Json& j) const {
    if (!in_events_) return;
    if (stack_.size() == 1 && !j.is_array()) {
      const Json document = {{"traceEvents", j}};
      TraceNode(document, name_).at("traceEvents").fail("an array of events");
    }
    if (stack_.size() == 2 && !j.is_object())
      TraceNode::element(j, events_, event_count_).fail("an event, {...}");
  }

  Json* insert(Json j) {
    if (stack_.empty()) return &(root_ = std::move(j));
    if (Json& parent = *stack_.back(); parent.is_array())
      return &parent.get_ref<Json::array_t&>().emplace_back(std::move(j));
    return &(*member_ = std::move(j));
  }

  /// Limits memory. An event is kept until it is complete, all other values until the end.
  void hold(std::uint64_t bytes) {
    constexpr std::uint64_t kLargestEvent = std::uint64_t{1} << 16;  // written events take less than 2000
    constexpr std::uint64_t kFree = std::uint64_t{16} << 20, kPerByte = 8;
    held_ += bytes;
    if (in_events_ && stack_.size() > 1 && held_ - before_event_ > kLargestEvent)
      throw InputError(name_ + ": /traceEvents/" + std::to_string(event_count_) +
                       ": longer than any event of lrbscope; the trace is damaged; record it again");
    if (!in_events_ && held_ > kFree + kPerByte * text_.size())
      throw InputError(name_ + ": its values take more than " + std::to_string(kPerByte) +
                       " times the memory of its text; the trace is damaged; record it again");
  }

  std::string_view text_;
  const std::string& name_;
  const std::function<void(const TraceNode&)>& take_;
  Json root_;
  std::vector<Json*> stack_;  ///< the open containers, from the root
  Json* member_ = nullptr;    ///< destination of the value after a key
  bool in_events_ = false;    ///< within traceEvents
  std::size_t event_count_ = 0;
  std::uint64_t held_ = 0, before_event_ = 0;  ///< approximate bytes
  const Json unfinished_ = Json::object();     ///< represents the root in messages
  const TraceNode document_{unfinished_, name_};
  const TraceNode events_ = document_.at("traceEvents");
};

}  // namespace

Json parse_events(std::string_view text, const std::string& name,
                  const std::function<void(const TraceNode&)>& take) {
  return EventParser(text, name, take).run();
}

namespace {

/// Returns the kind of an event. Steps and phases have more specific names, and a category.
EventKind kind_of(const TraceNode& node) {
  const std::string& category = node.at("cat").string();
  const std::string& name = node.at("name").string();
  if (category == "step" && name != name_of(EventKind::result)) return EventKind::step;
  if (category == "pass" && name != name_of(EventKind::pass_end)) return EventKind::pass;
  if (category == "phase" && name != name_of(EventKind::end)) return EventKind::begin;
  return node.at("name").named<EventKind>();
}

/// Reads the fields of an event.
struct FieldReader {
  const TraceNode& args;

  bool has(std::string_view name, bool) const { return args.has(name.data()); }
  template <class Number>
  void number(std::string_view name, Number& value) const {
    value = args.at(name.data()).integer<Number>();
  }
  template <class Enum>
  void word(std::string_view name, Enum& value) const {
    const TraceNode node = args.at(name.data());
    if constexpr (std::is_same_v<Enum, NodeStep>)
      value = node.string() == "needles" ? NodeStep::whole : node.named<Enum>();  // the word of version 1
    else
      value = node.named<Enum>();
  }
  void flag(std::string_view name, std::uint16_t& value) const {
    value = has(name, false) && args.at(name.data()).boolean();
  }
  void real(std::string_view name, std::uint32_t& bits) const {
    bits = std::bit_cast<std::uint32_t>(static_cast<float>(args.at(name.data()).least(0)));
  }
  void simplex(Side side, std::string_view name, std::uint32_t& value) const {
    number(has(pseudo_simplex(side), false) ? pseudo_simplex(side) : name, value);
  }
  static void vertices(const Event& /*read by Reader*/) {}
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  Trace run() {
    reject_other_formats();
    // Events are consumed during parsing; only the rest of the document is kept as JSON.
    const nlohmann::json document =
        parse_events(text_, name_, [this](const TraceNode& event) { take_event(event); });
    const TraceNode root(document, name_);
    const TraceNode metadata = root.at("metadata");
    // The version first, so that a newer format is reported as such and not as damage.
    check_format(metadata, name_, kTraceFormat, kTraceVersion);
    read_header(metadata);
    read_steps(metadata.at("steps"));
    // Cross-check the counts, then all invariants of the trace.
    check_counts(metadata.at("events"));
    check_trace(t_, name_);
    return std::move(t_);
  }

 private:
  /// Rejects the trace of a crowd by its format, before its events are read and taken for damaged ones.
  void reject_other_formats() const {
    // The metadata come last. Inside a string the quotes would be escaped.
    constexpr std::size_t kNear = 256;
    const std::size_t at = text_.rfind("\"metadata\"");
    if (at == std::string_view::npos) return;
    const std::string_view begin = text_.substr(at, kNear);
    if (begin.find("\"lrbscope crowd\"") != std::string_view::npos)
      throw InputError(
          name_ +
          ": expected a run of one or two bodies, found the trace of a crowd, which 2.0 does not read; "
          "record two of its bodies with lrbscope crowd FILE --pair");
  }

  void take_event(const TraceNode& node) {
    // Names, counters, flows and slices of another engine's queries can be derived from the rest.
    if (node.at("ph").string() != "X" || node.at("cat").string() == kEngineCategory) return;
    // Event numbers are 32-bit ids, and must be consecutive.
    if (t_.events.size() >= kMaxId) node.fail("fewer events");
    Event e;
    e.kind = kind_of(node);
    const TraceNode args = node.at("args");
    const auto number = args.at("event").integer<EventId>();
    if (number != t_.events.size())
      args.at("event").fail(std::to_string(t_.events.size()) + ", the next event");
    FieldReader fields{args};
    event_fields(fields, e);
    if (args.has("vertices")) read_vertices(args.at("vertices"), e);
    if (args.has("ns")) t_.wall_ns.push_back(args.at("ns").integer<std::uint64_t>());
    t_.events.push_back(e);
  }

  /// Reads the interior vertices of a patch.
  void read_vertices(const TraceNode& node, Event& e) {
    const std::size_t count = node.array_size();
    if (e.kind != EventKind::patch) node.fail("vertices of patches only");
    if (count != e.depth_a) node.fail(std::to_string(e.depth_a) + " vertices, those inside the patch");
    if (t_.patch_vertices.size() + count > kMaxId) node.fail("fewer vertices of patches");
    e.boundary = static_cast<std::uint32_t>(t_.patch_vertices.size());
    for (std::size_t i = 0; i < count; ++i)
      t_.patch_vertices.emplace_back(node.at(i).integer<std::uint32_t>());
  }

  void read_header(const TraceNode& metadata) {
    TraceHeader& h = t_.header;
    // Optional keys were added by later versions: if absent, the defaults of TraceHeader apply.
    h.lrbscope = metadata.at("lrbscope").string();
    const TraceNode scenario = metadata.at("scenario");
    h.scenario = scenario.at("name").string();
    h.scenario_hash = scenario.at("hash").hash();
    h.clock = metadata.at("clock").named<Clock>();
    if (metadata.has("level")) h.level = metadata.at("level").named<EventLevel>();
    if (metadata.has("engine")) h.engine = metadata.at("engine").string();
    if (metadata.has("names")) {
      const TraceNode names = metadata.at("names");
      for (std::size_t i = 0, n = names.array_size(); i < n; ++i) h.names.push_back(names.at(i).string());
    }
    if (metadata.has("coherent")) h.coherent = metadata.at("coherent").boolean();
    if (metadata.has("construction")) h.construction = metadata.at("construction").boolean();
    if (metadata.has("pictures")) h.pictures = metadata.at("pictures").object_text();
    if (metadata.has("first_contact")) h.first_contact = read_approach(metadata.at("first_contact"));
    h.request = read_request(metadata.at("request"));
    const TraceNode bodies = metadata.at("bodies");
    const std::size_t count = bodies.array_size();
    if (count < 1 || count > 2) bodies.fail("one body or two");
    for (std::size_t i = 0; i < count; ++i) h.bodies.push_back(read_body(bodies.at(i)));
  }

  void read_steps(const TraceNode& steps) {
    const std::size_t count = steps.array_size();
    t_.steps.reserve(count);
    for (std::size_t i = 0; i < count; ++i) t_.steps.push_back(read_step(steps.at(i)));
  }

  Step read_step(const TraceNode& node) const {
    Step s;
    s.index = node.at("index").integer<std::uint32_t>();
    s.first_event = node.at("first_event").integer<std::uint32_t>();
    s.events_seen = node.at("events_seen").integer<std::uint64_t>();
    s.pose_a = read_pose(node.at("pose_a"));
    if (t_.header.bodies.size() > 1) s.pose_b = read_pose(node.at("pose_b"));
    s.finished = node.has("result");
    if (s.finished) s.result = read_answer(node.at("result"), t_.header.request);
    return s;
  }

  void check_counts(const TraceNode& node) {
    if (node.at("stored").integer<std::uint64_t>() != t_.events.size())
      node.at("stored").fail(std::to_string(t_.events.size()) + ", the number of events above");
    t_.events_seen = node.at("seen").integer<std::uint64_t>();
    t_.header.event_cap = node.at("cap").integer<std::uint32_t>();
    if (node.at("truncated").boolean() != t_.truncated()) node.at("truncated").fail("seen > stored");
  }

  std::string_view text_;
  const std::string& name_;
  Trace t_;
};

}  // namespace

Trace trace_from_json(std::string_view text, const std::string& name) {
  return Reader(text, name).run();
}

}  // namespace lrb::trace
