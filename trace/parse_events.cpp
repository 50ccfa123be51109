// Streaming parser for traces, on nlohmann's SAX interface. Events are delivered one at a time and discarded,
// so its own memory is bounded by the largest event and the metadata, not by the length of the trace.

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/error.hpp"
#include "trace/json_read.hpp"

namespace lrb::trace {

namespace {

using Json = nlohmann::json;

/// Returns "line 3, column 17".
std::string line_and_column(std::string_view text, std::size_t offset) {
  const std::string_view before = text.substr(0, std::min(offset, text.size()));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const std::size_t break_at = before.rfind('\n');
  const std::size_t column =
      break_at == std::string_view::npos ? before.size() : before.size() - break_at - 1;
  return "line " + std::to_string(line) + ", column " + std::to_string(std::max<std::size_t>(column, 1));
}

/// The largest depth of nested containers; ours need six levels.
constexpr std::size_t kMaxDepth = 32;

/// Builds the tree of a document from what nlohmann's parser finds in its text, without the events: each
/// event is handed over when it is complete, and dropped. nlohmann's own builder with a callback could drop
/// them, too, but searches everything that an array holds whenever an object in it ends, so that the time for
/// an array of n objects would grow with n^2.
///
/// Limits the memory that it takes by the length of the text it has read. A "0," of two bytes becomes 16
/// bytes, an "[]," of three about 60; what we write takes more bytes as text than in memory, except for poses
/// of round numbers.
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
      throw InputError(name_ + ": a number is too large for a double; the trace is damaged: record it again");
    std::string what =
        error.what();  // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    const std::size_t colon = what.find(": ");
    if (colon != std::string::npos) what.erase(0, colon + 2);
    constexpr std::size_t kShown = 160;  // the parser quotes all of an unfinished string
    if (what.size() > kShown) what = what.substr(0, kShown) + "...";
    throw InputError(name_ + ": " + line_and_column(text_, offset) + ": this is not JSON: " + what +
                     "; is it a trace, and whole?");
  }

 private:
  static constexpr std::uint64_t kValue = 16, kContainer = 64, kMember = 80;  // bytes of the tree, about

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
                       " deep: this is not a trace of lrbscope");
    check_place(container);
    if (in_events_ && stack_.size() == 2) before_event_ = held_;
    hold(kContainer);
    stack_.push_back(insert(std::move(container)));
    return true;
  }

  /// Refuses a value that stands where the array of events, or an event, should.
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

  /// An event is held until it is complete, the rest to the end.
  void hold(std::uint64_t bytes) {
    constexpr std::uint64_t kLargestEvent = std::uint64_t{1} << 16;  // ours take less than 2000
    constexpr std::uint64_t kFree = std::uint64_t{16} << 20, kPerByte = 8;
    held_ += bytes;
    if (in_events_ && stack_.size() > 1 && held_ - before_event_ > kLargestEvent)
      throw InputError(name_ + ": /traceEvents/" + std::to_string(event_count_) +
                       ": is longer than any event of lrbscope; the trace is damaged: record it again");
    if (!in_events_ && held_ > kFree + kPerByte * text_.size())
      throw InputError(name_ + ": its values take more than " + std::to_string(kPerByte) +
                       " times the memory of its text, which no trace of lrbscope does: it is damaged");
  }

  std::string_view text_;
  const std::string& name_;
  const std::function<void(const TraceNode&)>& take_;
  Json root_;
  std::vector<Json*> stack_;  ///< the containers that are open, from the root
  Json* member_ = nullptr;    ///< where the value after a key goes
  bool in_events_ = false;    ///< within traceEvents
  std::size_t event_count_ = 0;
  std::uint64_t held_ = 0, before_event_ = 0;  ///< bytes, about
  const Json unfinished_ = Json::object();     ///< stands for the root in messages
  const TraceNode document_{unfinished_, name_};
  const TraceNode events_ = document_.at("traceEvents");
};

}  // namespace

Json parse_events(std::string_view text, const std::string& name,
                  const std::function<void(const TraceNode&)>& take) {
  return EventParser(text, name, take).run();
}

}  // namespace lrb::trace
