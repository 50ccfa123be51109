/// See trace_json.hpp for the format.

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "trace/names.hpp"
#include "trace/trace_json.hpp"
#include "trace/trace_metadata.hpp"

namespace lrb::trace {

namespace {

enum class Thread : std::uint8_t { steps = 1, tests, wrapper_a, wrapper_b, answer };
constexpr std::pair<Thread, std::string_view> kThreads[] = {{Thread::steps, "time steps"},
                                                            {Thread::tests, "face tests"},
                                                            {Thread::wrapper_a, "wrapper A"},
                                                            {Thread::wrapper_b, "wrapper B"},
                                                            {Thread::answer, "answer"}};

/// The number of events from one "work" counter to the next: small enough for a smooth curve, large enough to
/// cost little.
constexpr EventId kWorkInterval = 16;

Thread thread_of(const Event& e) {
  switch (e.kind) {
    case EventKind::step:
    case EventKind::result:
      return Thread::steps;
    case EventKind::face_test:
      return Thread::tests;
    case EventKind::refine:
    case EventKind::coarsen:
      return e.side == Side::a ? Thread::wrapper_a : Thread::wrapper_b;
    case EventKind::contact:
      return Thread::answer;
  }
  return Thread::steps;
}

std::string_view category_of(EventKind kind) {
  switch (kind) {
    case EventKind::step:
    case EventKind::result:
      return "step";
    case EventKind::face_test:
      return "test";
    case EventKind::refine:
    case EventKind::coarsen:
      return "wrapper";
    case EventKind::contact:
      return "answer";
  }
  return "";
}

/// One end of an arrow: refinement `flow` has an arrow from or to `event`.
struct FlowEnd {
  EventId event, flow;
};

/// Where arrows begin and end, found in one pass before writing.
struct Flows {
  std::vector<FlowEnd> starts;    ///< at face tests that caused a refinement; ascending by event
  std::vector<FlowEnd> finishes;  ///< at the first face test that a refinement led to; ascending by event

  explicit Flows(const std::vector<Event>& events) {
    for (EventId i = 0; i < events.size(); ++i) {
      const Event& e = events[i];
      if (e.cause == kNull) continue;
      const EventKind cause = events[e.cause].kind;
      if (e.kind == EventKind::refine && cause == EventKind::face_test) starts.push_back({e.cause, i});
      if (e.kind == EventKind::face_test && cause == EventKind::refine) finishes.push_back({i, e.cause});
    }
    // Keeps the first of all tests that a refinement led to.
    std::sort(finishes.begin(), finishes.end(), [](const FlowEnd& x, const FlowEnd& y) {
      return std::pair(x.flow, x.event) < std::pair(y.flow, y.event);
    });
    finishes.erase(std::unique(finishes.begin(), finishes.end(),
                               [](const FlowEnd& x, const FlowEnd& y) { return x.flow == y.flow; }),
                   finishes.end());
    by_flow_ = finishes;
    const auto by_event = [](const FlowEnd& x, const FlowEnd& y) {
      return std::pair(x.event, x.flow) < std::pair(y.event, y.flow);
    };
    std::sort(starts.begin(), starts.end(), by_event);
    std::sort(finishes.begin(), finishes.end(), by_event);
  }

  bool goes_on(EventId refinement) const {
    const auto it = std::lower_bound(by_flow_.begin(), by_flow_.end(), refinement,
                                     [](const FlowEnd& x, EventId flow) { return x.flow < flow; });
    return it != by_flow_.end() && it->flow == refinement;
  }

 private:
  std::vector<FlowEnd> by_flow_;
};

class TraceWriter {
 public:
  TraceWriter(const Trace& trace, ByteSink& sink) : t_(trace), out_(sink), flows_(trace.events) {
    for (std::size_t k = 0; k < kEventKinds; ++k) prepare(static_cast<EventKind>(k));
  }

  void run() {
    out_.raw("{\"traceEvents\": [\n");
    write_names();
    for (EventId i = 0; i < t_.events.size(); ++i) write_event(i);
    out_.raw("\n],\n\"metadata\": ");
    write_metadata(t_, out_);
    out_.raw("\n}\n");
    out_.flush();
  }

 private:
  /// The constant parts of the lines for events of one kind.
  struct Parts {
    std::string head;  ///< up to the time
    std::string a, b;  ///< `, "name": ` of its two numbers; empty: not written
  };

  void prepare(EventKind kind) {
    Parts& p = parts_[static_cast<std::size_t>(kind)];
    p.head = ",\n{\"name\":\"" + std::string(name_of(kind)) + "\",\"cat\":\"" +
             std::string(category_of(kind)) + "\",\"ph\":\"X\",\"pid\":1,\"tid\":";
    const auto [a, b] = fields_of(kind);
    if (!a.empty()) p.a = ",\"" + std::string(a) + "\":";
    if (!b.empty()) p.b = ",\"" + std::string(b) + "\":";
  }

  void write_names() {
    out_.raw(
        "{\"name\":\"process_name\",\"cat\":\"__metadata\",\"ph\":\"M\",\"ts\":0,\"pid\":1,\"tid\":0,"
        "\"args\":{\"name\":");
    out_.string("lrbscope: " + t_.header.scenario);
    out_.raw("}}");
    for (const auto& [thread, name] : kThreads) {
      write_thread_field(thread, "thread_name", "name");
      out_.string(name);
      out_.raw("}}");
      write_thread_field(thread, "thread_sort_index", "sort_index");
      out_.number(static_cast<std::uint64_t>(thread));
      out_.raw("}}");
    }
  }

  void write_thread_field(Thread thread, std::string_view name, std::string_view field) {
    out_.raw(",\n{\"name\":\"");
    out_.raw(name);
    out_.raw("\",\"cat\":\"__metadata\",\"ph\":\"M\",\"ts\":0,\"pid\":1,\"tid\":");
    out_.number(static_cast<std::uint64_t>(thread));
    out_.raw(",\"args\":{\"");
    out_.raw(field);
    out_.raw("\":");
  }

  bool wall() const { return t_.header.clock == Clock::wall; }

  /// Returns when the slice of an event begins: event numbers, or nanoseconds.
  std::uint64_t begin_of(EventId i) const {
    if (!wall()) return i;
    return t_.events[i].kind == EventKind::step ? t_.wall_ns[i] : t_.wall_ns[i - 1];
  }

  /// Returns how long it lasts, in the same unit; never 0, because viewers drop such slices.
  std::uint64_t duration_of(EventId i) const {
    if (t_.events[i].kind != EventKind::step) return wall() ? t_.wall_ns[i] - begin_of(i) : 1;
    const std::size_t step = t_.step_of(i);
    const EventId last = i + static_cast<EventId>(t_.events_of(step).size()) - 1;
    return wall() ? std::max<std::uint64_t>(t_.wall_ns[last] - t_.wall_ns[i], 1) : last - i + 1;
  }

  /// Writes nanoseconds as microseconds, exactly.
  void write_time(std::uint64_t value) {
    if (!wall()) return out_.number(value);
    out_.number(value / 1000);
    const auto rest = static_cast<unsigned>(value % 1000);
    const char digits[] = {'.', static_cast<char>('0' + rest / 100), static_cast<char>('0' + rest / 10 % 10),
                           static_cast<char>('0' + rest % 10)};
    out_.raw({digits, 4});
  }

  void write_event(EventId i) {
    const Event& e = t_.events[i];
    const Parts& parts = parts_[static_cast<std::size_t>(e.kind)];
    out_.raw(parts.head);
    out_.number(static_cast<std::uint64_t>(thread_of(e)));
    out_.raw(",\"ts\":");
    write_time(begin_of(i));
    out_.raw(",\"dur\":");
    write_time(duration_of(i));
    out_.raw(",\"args\":{\"event\":");
    out_.number(std::uint64_t{i});
    write_fields(e, parts);
    if (wall()) {
      out_.raw(",\"ns\":");
      out_.number(t_.wall_ns[i]);
    }
    out_.raw("}}");
    write_flows(i);
    count(e, i);
  }

  void write_fields(const Event& e, const Parts& parts) {
    if (e.kind == EventKind::refine || e.kind == EventKind::coarsen)
      out_.raw(e.side == Side::a ? ",\"side\":\"A\"" : ",\"side\":\"B\"");
    if (e.kind == EventKind::contact) return write_contact(e, parts);
    if (!parts.a.empty()) {
      out_.raw(parts.a);
      if (e.kind == EventKind::result)
        out_.string(name_of(static_cast<Relation>(e.a)));
      else
        out_.number(std::uint64_t{e.a});
    }
    if (!parts.b.empty()) {
      out_.raw(parts.b);
      out_.number(std::uint64_t{e.b});
    }
    if (e.kind == EventKind::face_test) {
      write_meet(e.meet);
      out_.raw(",\"depth of A\":");
      out_.number(std::uint64_t{e.depth_a});
      out_.raw(",\"depth of B\":");
      out_.number(std::uint64_t{e.depth_b});
    }
    if (e.boundary != kNull) {
      out_.raw(",\"wrapper faces\":");
      out_.number(std::uint64_t{e.boundary});
    }
    write_cause(e.cause);
  }

  void write_contact(const Event& e, const Parts& parts) {
    write_simplex(Side::a, parts.a, e.simplex(Side::a));
    write_simplex(Side::b, parts.b, e.simplex(Side::b));
    write_meet(e.meet);
    write_cause(e.cause);
  }

  /// Writes a simplex of the answer; `name` is what a real one is called.
  void write_simplex(Side side, const std::string& name, SimplexId simplex) {
    if (simplex < t_.header.bodies[static_cast<std::size_t>(side)].real_simplices) {
      out_.raw(name);
    } else {
      out_.raw(",\"");
      out_.raw(pseudo_simplex(side));
      out_.raw("\":");
    }
    out_.number(std::uint64_t{simplex});
  }

  void write_meet(exact::Meet meet) {
    out_.raw(",\"meet\":\"");
    out_.raw(name_of(meet));
    out_.raw('"');
  }

  void write_cause(EventId cause) {
    if (cause == kNull) return;
    out_.raw(",\"cause\":");
    out_.number(std::uint64_t{cause});
  }

  void write_flow(char phase, EventId flow, EventId at) {
    out_.raw(",\n{\"name\":\"cause\",\"cat\":\"flow\",\"ph\":\"");
    out_.raw(phase);
    out_.raw("\",\"id\":");
    out_.number(std::uint64_t{flow});
    out_.raw(",\"bp\":\"e\",\"pid\":1,\"tid\":");
    out_.number(static_cast<std::uint64_t>(thread_of(t_.events[at])));
    out_.raw(",\"ts\":");
    write_time(begin_of(at));
    out_.raw(",\"args\":{}}");
  }

  void write_flows(EventId i) {
    if (t_.events[i].kind == EventKind::refine) {
      const EventId cause = t_.events[i].cause;
      const bool from = cause != kNull && t_.events[cause].kind == EventKind::face_test;
      const bool on = flows_.goes_on(i);
      if (from || on) write_flow(!from ? 's' : on ? 't' : 'f', i, i);
    }
    for (; next_start_ < flows_.starts.size() && flows_.starts[next_start_].event == i; ++next_start_)
      write_flow('s', flows_.starts[next_start_].flow, i);
    for (; next_finish_ < flows_.finishes.size() && flows_.finishes[next_finish_].event == i; ++next_finish_)
      write_flow('f', flows_.finishes[next_finish_].flow, i);
  }

  void count(const Event& e, EventId i) {
    switch (e.kind) {
      case EventKind::step:
        begin_counting();
        break;
      case EventKind::face_test:
        ++tests_;
        break;
      case EventKind::refine:
        ++refinements_;
        break;
      case EventKind::contact:
        ++contacts_;
        break;
      case EventKind::coarsen:
      case EventKind::result:
        break;
    }
    const bool change = e.kind == EventKind::refine || e.kind == EventKind::coarsen;
    if (change && e.boundary != kNull) faces_[static_cast<std::size_t>(e.side)] = e.boundary;
    if (change || e.kind == EventKind::step) write_wrapper_counter(i);
    if (i % kWorkInterval == 0 || e.kind == EventKind::step || e.kind == EventKind::result)
      write_work_counter(i);
  }

  void begin_counting() {
    tests_ = refinements_ = contacts_ = 0;
    for (std::size_t s = 0; s < t_.header.bodies.size(); ++s) faces_[s] = t_.header.bodies[s].outer_faces;
  }

  void begin_counter(std::string_view name, EventId i) {
    out_.raw(",\n{\"name\":\"");
    out_.raw(name);
    out_.raw("\",\"cat\":\"counter\",\"ph\":\"C\",\"pid\":1,\"tid\":0,\"ts\":");
    write_time(begin_of(i));
    out_.raw(",\"args\":{");
  }

  void write_wrapper_counter(EventId i) {
    begin_counter("wrapper", i);
    out_.raw("\"faces of A\":");
    out_.number(std::uint64_t{faces_[0]});
    if (t_.header.bodies.size() > 1) {
      out_.raw(",\"faces of B\":");
      out_.number(std::uint64_t{faces_[1]});
    }
    out_.raw(",\"refinements\":");
    out_.number(std::uint64_t{refinements_});
    out_.raw("}}");
  }

  void write_work_counter(EventId i) {
    begin_counter("work", i);
    out_.raw("\"face tests\":");
    out_.number(std::uint64_t{tests_});
    out_.raw(",\"contacts\":");
    out_.number(std::uint64_t{contacts_});
    out_.raw("}}");
  }

  const Trace& t_;
  JsonOut out_;
  Flows flows_;
  std::array<Parts, kEventKinds> parts_;
  std::size_t next_start_ = 0, next_finish_ = 0;
  std::array<std::uint32_t, 2> faces_{};
  std::uint32_t tests_ = 0, refinements_ = 0, contacts_ = 0;
};

}  // namespace

void write_trace(const Trace& trace, ByteSink& sink) {
  TraceWriter(trace, sink).run();
}

std::string trace_to_json(const Trace& trace) {
  StringSink sink;
  write_trace(trace, sink);
  return std::move(sink.text);
}

}  // namespace lrb::trace
