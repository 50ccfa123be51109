/// See trace_json.hpp for the format.

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "trace/trace_json_parts.hpp"
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::trace {

namespace {

enum class Thread : std::uint8_t {
  steps = 1,
  tests,
  wrapper_a,
  wrapper_b,
  answer,
  phases,
  walk,
  passes,
  caps,
  hull
};
struct ThreadName {
  Thread thread;
  std::string_view name;
  EventLevel from = EventLevel::faces;  ///< lowest event level with events of this thread
};
constexpr ThreadName kThreads[] = {{Thread::steps, "time steps"},
                                   {Thread::tests, "face tests"},
                                   {Thread::wrapper_a, "wrapper A"},
                                   {Thread::wrapper_b, "wrapper B"},
                                   {Thread::answer, "answer"},
                                   {Thread::phases, "phases", EventLevel::nodes},
                                   {Thread::walk, "tree walk", EventLevel::nodes}};
constexpr ThreadName kBuildThreads[] = {{Thread::steps, "construction"},
                                        {Thread::passes, "passes"},
                                        {Thread::caps, "patches and caps"},
                                        {Thread::hull, "hull"}};

/// Number of events between "work" counters: small enough for a smooth curve, large enough to cost little.
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
    case EventKind::node_pair:
    case EventKind::plane_test:
      return Thread::walk;
    case EventKind::point:
    case EventKind::begin:
    case EventKind::end:
      return Thread::phases;
    case EventKind::pass:
    case EventKind::pass_end:
      return Thread::passes;
    case EventKind::patch:
    case EventKind::cap:
      return Thread::caps;
    case EventKind::region:
    case EventKind::merged:
    case EventKind::closed:
      return Thread::hull;
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
    case EventKind::node_pair:
    case EventKind::plane_test:
      return "walk";
    case EventKind::point:
      return "point";
    case EventKind::begin:
    case EventKind::end:
      return "phase";
    case EventKind::pass:
    case EventKind::pass_end:
      return "pass";
    case EventKind::patch:
    case EventKind::cap:
      return "cap";
    case EventKind::region:
    case EventKind::merged:
    case EventKind::closed:
      return "hull";
  }
  return "";
}

class TraceWriter {
 public:
  TraceWriter(const Trace& trace, ByteSink& sink) : t_(trace), out_(sink) {
    // First scan: everything that a line needs from later events. The writing itself is a single pass.
    for (const PassSummary& p : passes_of(t_)) passes_[p.first] = p;
    find_ends();
    find_arrows();
    for (std::size_t k = 0; k < kEventKinds; ++k) prepare(static_cast<EventKind>(k));
  }

  void run() {
    // The events come before the metadata, so that a reader can process them while it parses.
    // The process and its threads get names and an order by metadata events ("M").
    out_.raw("{\"traceEvents\": [\n");
    write_names();
    for (EventId i = 0; i < t_.events.size(); ++i) write_event(i);
    if (t_.has_engine_reports()) write_engine();
    out_.raw("\n],\n\"metadata\": ");
    write_metadata(t_, out_);
    out_.raw("\n}\n");
    out_.flush();
  }

 private:
  /// The constant parts of the lines for events of one kind.
  struct Parts {
    std::string head;  ///< from the name to the thread
    std::string a, b;  ///< `, "name": ` of the event's two numbers; empty: not written
  };

  void prepare(EventKind kind) {
    Parts& p = parts_[static_cast<std::size_t>(kind)];
    p.head = "\",\"cat\":\"" + std::string(category_of(kind)) + "\",\"ph\":\"X\",\"pid\":1,\"tid\":";
    const auto [a, b] = fields_of(kind);
    if (!a.empty()) p.a = ",\"" + std::string(a) + "\":";
    if (!b.empty()) p.b = ",\"" + std::string(b) + "\":";
  }

  /// Finds the ends of the phases and passes by their first events.
  void find_ends() {
    for (EventId i = 0; i < t_.events.size(); ++i) {
      const Event& e = t_.events[i];
      const bool ends = e.kind == EventKind::end || e.kind == EventKind::pass_end;
      if (ends && e.cause != kNull) ends_[e.cause] = i;
    }
  }

  void write_names() {
    out_.raw(
        "{\"name\":\"process_name\",\"cat\":\"__metadata\",\"ph\":\"M\",\"ts\":0,\"pid\":1,\"tid\":0,"
        "\"args\":{\"name\":");
    out_.string("lrbscope: " + t_.header.scenario);
    out_.raw("}}");
    const std::span<const ThreadName> threads =
        t_.header.construction ? std::span<const ThreadName>(kBuildThreads) : kThreads;
    for (const auto& [thread, name, from] : threads) {
      // Threads without events at this detail would show as empty tracks.
      if (t_.header.level < from) continue;
      write_thread_field(thread, "thread_name", "name");
      out_.string(name);
      out_.raw("}}");
      write_thread_field(thread, "thread_sort_index", "sort_index");
      out_.number(static_cast<std::uint64_t>(thread));
      out_.raw("}}");
    }
  }

  // Another engine's queries in its own time, as a second process with a track for each of its threads; its
  // phases and counters among the events.

  void write_engine() {
    constexpr int kQueries = 2;
    write_engine_name("process_name", kQueries, 0, t_.header.engine + ": queries, in its own time");
    std::set<std::uint32_t> threads;
    for (const Step& s : t_.steps)
      if (s.result.engine) threads.insert(s.result.engine->thread);
    for (const std::uint32_t thread : threads)
      write_engine_name("thread_name", kQueries, thread, "thread " + std::to_string(thread));
    for (std::size_t i = 0; i < t_.steps.size(); ++i) {
      if (!t_.steps[i].result.engine) continue;
      const EngineReport& r = *t_.steps[i].result.engine;
      begin_engine_slice(report_name(t_.steps[i].index, r), kQueries, r.thread);
      write_ns(r.begin_ns);
      out_.raw(",\"dur\":");
      write_ns(std::max<std::uint64_t>(r.duration_ns, 1));
      out_.raw(",\"args\":{\"time step\":");
      out_.number(std::uint64_t{t_.steps[i].index});
      write_word("query", name_of(r.query));
      write_word("verdict", name_of(r.verdict));
      write_number("pairs", r.pairs);
      for (std::size_t k = 0; k < r.counts.size(); ++k)
        if (is_last_of_name(r.counts, k)) write_named(t_.header.names[r.counts[k].name], r.counts[k].value);
      out_.raw("}}");
      write_marks(i, r);
    }
  }

  static std::string report_name(std::uint32_t index, const EngineReport& r) {
    std::string out = "query " + std::to_string(index) + ": " + std::string(name_of(r.verdict));
    if (r.pairs > 0) out += ", " + std::to_string(r.pairs) + (r.pairs == 1 ? " pair" : " pairs");
    return out;
  }
  static bool is_last_of_name(const std::vector<EngineReport::Mark>& marks, std::size_t k) {
    return std::none_of(marks.begin() + static_cast<std::ptrdiff_t>(k) + 1, marks.end(),
                        [&](const EngineReport::Mark& m) { return m.name == marks[k].name; });
  }

  /// Writes phases as slices up to the next one, and values of counters, in the order of the events.
  void write_marks(std::size_t step, const EngineReport& r) {
    const std::size_t stored = t_.events_of(step).size();
    const EventId first = t_.steps[step].first_event;
    const auto time_of = [&](std::size_t at) {
      const EventId event = first + static_cast<EventId>(std::min(at, stored - 1));
      return wall() ? begin_of(event) : first + std::min(at, stored);
    };
    if (stored == 0) return;
    for (std::size_t k = 0; k < r.phases.size(); ++k) {
      const std::uint64_t begin = time_of(r.phases[k].at);
      const std::uint64_t end = time_of(k + 1 < r.phases.size() ? r.phases[k + 1].at : stored);
      if (end <= begin) continue;
      begin_engine_slice(t_.header.names[r.phases[k].name], 1, static_cast<std::uint32_t>(Thread::phases));
      write_time(begin);
      out_.raw(",\"dur\":");
      write_time(end - begin);
      out_.raw(",\"args\":{}}");
    }
    for (const EngineReport::Mark& mark : r.counts) {
      out_.raw(",\n{\"name\":");
      out_.string("engine: " + t_.header.names[mark.name]);
      out_.raw(",\"cat\":\"counter\",\"ph\":\"C\",\"pid\":1,\"tid\":0,\"ts\":");
      write_time(time_of(mark.at));
      out_.raw(",\"args\":{\"value\":");
      out_.number(std::uint64_t{mark.value});
      out_.raw("}}");
    }
  }

  void begin_engine_slice(std::string_view name, int process, std::uint32_t thread) {
    out_.raw(",\n{\"name\":");
    out_.string(name);
    out_.raw(",\"cat\":\"");
    out_.raw(kEngineCategory);
    out_.raw("\",\"ph\":\"X\",\"pid\":");
    out_.number(static_cast<std::uint64_t>(process));
    out_.raw(",\"tid\":");
    out_.number(std::uint64_t{thread});
    out_.raw(",\"ts\":");
  }

  void write_engine_name(std::string_view field, int process, std::uint32_t thread, const std::string& name) {
    out_.raw(",\n{\"name\":\"");
    out_.raw(field);
    out_.raw("\",\"cat\":\"__metadata\",\"ph\":\"M\",\"ts\":0,\"pid\":");
    out_.number(static_cast<std::uint64_t>(process));
    out_.raw(",\"tid\":");
    out_.number(std::uint64_t{thread});
    out_.raw(",\"args\":{\"name\":");
    out_.string(name);
    out_.raw("}}");
  }

  void write_named(const std::string& name, std::uint64_t value) {
    out_.raw(",");
    out_.string(name);
    out_.raw(":");
    out_.number(value);
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

  /// Returns true if an event's slice contains the events up to a later one.
  static bool lasts(const Event& e) {
    return e.kind == EventKind::step || e.kind == EventKind::begin || e.kind == EventKind::pass;
  }

  /// Returns the last event of a step, a phase or a pass; that of the step if the end was truncated.
  EventId last_of(EventId i) const {
    const auto end = ends_.find(i);
    if (end != ends_.end()) return end->second;
    const std::size_t step = t_.step_of(i);
    return t_.steps[step].first_event + static_cast<EventId>(t_.events_of(step).size()) - 1;
  }

  /// Returns the start of an event's slice: event numbers, or nanoseconds.
  std::uint64_t begin_of(EventId i) const {
    if (!wall()) return i;
    return lasts(t_.events[i]) ? t_.wall_ns[i] : t_.wall_ns[i - 1];
  }

  /// Returns its duration in the same unit; never 0, because viewers drop such slices.
  std::uint64_t duration_of(EventId i) const {
    if (!lasts(t_.events[i])) return wall() ? t_.wall_ns[i] - begin_of(i) : 1;
    const EventId last = last_of(i);
    return wall() ? std::max<std::uint64_t>(t_.wall_ns[last] - t_.wall_ns[i], 1) : last - i + 1;
  }

  /// Writes a time of the trace's clock; nanoseconds as microseconds, exactly.
  void write_time(std::uint64_t value) { wall() ? write_ns(value) : out_.number(value); }
  void write_ns(std::uint64_t value) {
    out_.number(value / 1000);
    const auto rest = static_cast<unsigned>(value % 1000);
    const char digits[] = {'.', static_cast<char>('0' + rest / 100), static_cast<char>('0' + rest / 10 % 10),
                           static_cast<char>('0' + rest % 10)};
    out_.raw({digits, 4});
  }

  void write_event(EventId i) {
    const Event& e = t_.events[i];
    // Each event is a complete slice ("X") with its number and fields as arguments.
    const Parts& parts = parts_[static_cast<std::size_t>(e.kind)];
    out_.raw(",\n{\"name\":\"");
    write_name(e, i);
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
    // Then the records attached to it: arrows, counters, convergence curves.
    write_flows(i);
    count(e, i);
    if (e.kind == EventKind::result) write_measured(i);
    // On the wall clock, the search for the first contact has no time range of its own.
    if (i == 0 && t_.header.first_contact && !wall()) write_first_contact(*t_.header.first_contact);
  }

  /// Steps and passes are named after their results, phases after themselves, all others after their kind.
  void write_name(const Event& e, EventId i) {
    if (e.kind == EventKind::begin) return out_.raw(name_of(e.phase()));
    if (e.kind == EventKind::pass) return write_pass_name(passes_.at(i));
    if (e.kind == EventKind::step && t_.header.construction) return out_.raw("construction");
    out_.raw(name_of(e.kind));
    if (e.kind != EventKind::step) return;
    const Step& step = t_.steps[t_.step_of(i)];
    out_.raw(" ");
    out_.number(std::uint64_t{step.index});
    if (!step.finished) return;
    out_.raw(": ");
    out_.raw(name_of(step.result.relation));
    if (step.result.pair_count == 0) return;
    out_.raw(", ");
    out_.number(step.result.pair_count);
    out_.raw(step.result.pair_count == 1 ? " pair" : " pairs");
  }

  void write_pass_name(const PassSummary& p) {
    out_.raw("pass ");
    out_.number(std::uint64_t{p.number()});
    out_.raw(": ");
    out_.raw(name_of(p.stage));
    out_.raw(", ");
    out_.number(std::uint64_t{p.regions});
    out_.raw(p.regions == 1 ? " region, " : " regions, ");
    out_.number(std::uint64_t{p.faces_before});
    out_.raw(" to ");
    out_.number(std::uint64_t{p.faces_after});
    out_.raw(" faces");
  }

  void write_fields(const Event& e, const Parts& parts) {
    if (e.kind == EventKind::refine || e.kind == EventKind::coarsen)
      out_.raw(e.side == Side::a ? ",\"side\":\"A\"" : ",\"side\":\"B\"");
    // The order of the fields is fixed, so that equal traces give equal files.
    if (e.kind == EventKind::contact) return write_contact(e, parts);
    if (!parts.a.empty()) {
      out_.raw(parts.a);
      if (e.kind == EventKind::result)
        out_.string(name_of(static_cast<Relation>(e.a)));
      else if (e.kind == EventKind::begin || e.kind == EventKind::end)
        out_.string(name_of(e.phase()));
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
      out_.number(std::uint64_t{e.face_test().depth_a});
      out_.raw(",\"depth of B\":");
      out_.number(std::uint64_t{e.face_test().depth_b});
      if (e.tested_by() != TestedBy::unreported) write_word("decided by", name_of(e.tested_by()));
    }
    // From here on, fields that depend on the kind of the event and on the detail of the trace.
    if (e.kind == EventKind::node_pair) return write_node_pair(e);
    if (e.kind == EventKind::plane_test) write_word("plane of", name_of(e.side));
    if (e.kind == EventKind::pass || e.kind == EventKind::cap) return write_built(e);
    if (e.kind == EventKind::patch) return write_patch(e);
    if (e.kind == EventKind::pass_end && e.pass_end().given_up) out_.raw(",\"given up\":true");
    if (e.kind == EventKind::point) {
      write_word("of", name_of(e.side));
      write_word("where", name_of(e.where()));
    }
    if (e.kind == EventKind::begin && walks_trees(e.phase())) {
      write_number("level of A", e.phase_begin().walked_a);
      write_number("level of B", e.phase_begin().walked_b);
    }
    // The size of the wrapper after the event; not every event has one.
    if (e.boundary != kNull) {
      out_.raw(",\"wrapper faces\":");
      out_.number(std::uint64_t{e.boundary});
    }
    write_cause(e.cause);
  }

  void write_word(std::string_view name, std::string_view word) {
    out_.raw(",\"");
    out_.raw(name);
    out_.raw("\":");
    out_.string(word);
  }
  void write_number(std::string_view name, std::uint64_t number) {
    out_.raw(",\"");
    out_.raw(name);
    out_.raw("\":");
    out_.number(number);
  }

  void write_patch(const Event& e) {
    write_number("interior vertices", e.patch().interior);
    if (const std::span<const VertexId> vertices = t_.vertices_of(e); !vertices.empty()) {
      char before = '[';
      out_.raw(",\"vertices\":");
      for (const VertexId v : vertices) {
        out_.raw({&before, 1});
        out_.number(std::uint64_t{v});
        before = ',';
      }
      out_.raw("]");
    }
    write_cause(e.cause);
  }

  void write_node_pair(const Event& e) {
    const auto [a, b, work, end, pairs_above, engine_axis] = e.node_pair();
    write_word("step", name_of(end.step));
    write_number("box tests", work.box_tests);
    write_number("boxes that meet", work.met);
    if (end.step == NodeStep::leaves) {
      write_number("parted by planes", work.rejected);  // language: keep
      write_number("certain", work.certain);
    }
    if (engine_axis > 0)
      write_number("axis", engine_axis - 1u);
    else if (work.met == 0)
      write_word(end.apart ? "apart along" : "overlap least along", name_of(end.axis));
    write_number("pairs above", pairs_above);
    write_cause(e.cause);
  }

  /// Writes the limits of a pass, or the verdict on a cap.
  void write_built(const Event& e) {
    if (e.kind == EventKind::pass)
      write_word("stage", name_of(e.stage()));
    else
      write_word("verdict", name_of(e.verdict()));
    if (e.kind == EventKind::cap && e.cap().careful) out_.raw(",\"careful\":true");
    if (e.kind == EventKind::pass ? e.off() > 0 : e.boundary != kNull) {
      out_.raw(e.kind == EventKind::pass ? ",\"distance allowed\":" : ",\"distance\":");
      out_.number(e.off());
    }
    write_cause(e.cause);
  }

  void write_contact(const Event& e, const Parts& parts) {
    write_simplex(Side::a, parts.a, e.simplex(Side::a));
    write_simplex(Side::b, parts.b, e.simplex(Side::b));
    write_meet(e.meet);
    write_cause(e.cause);
  }

  /// Writes a simplex of the answer; `name` is the name of a real one.
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

  /// Writes one end of the arrow to an event from its cause.
  void write_flow(char phase, EventId effect, EventId at) {
    out_.raw(",\n{\"name\":\"cause\",\"cat\":\"flow\",\"ph\":\"");
    out_.raw(phase);
    out_.raw("\",\"id\":");
    out_.number(std::uint64_t{effect});
    // bp "e": the arrow binds to the slice that encloses its time.
    out_.raw(",\"bp\":\"e\",\"pid\":1,\"tid\":");
    out_.number(static_cast<std::uint64_t>(thread_of(t_.events[at])));
    out_.raw(",\"ts\":");
    write_time(begin_of(at));
    out_.raw(",\"args\":{}}");
  }

  /// Returns true if an arrow leads to an event from its cause: to each face test from the refinement that
  /// exposed its face, and to a refinement from the test that caused it.
  bool has_arrow(const Event& e) const {
    if (e.cause == kNull) return false;
    const EventKind cause = t_.events[e.cause].kind;
    return (e.kind == EventKind::refine && cause == EventKind::face_test) ||
           (e.kind == EventKind::face_test && cause == EventKind::refine);
  }

  void find_arrows() {
    for (EventId i = 0; i < t_.events.size(); ++i)
      // Sorted by cause, so that writing needs one advancing index instead of a search.
      if (has_arrow(t_.events[i])) arrows_.push_back({t_.events[i].cause, i});
    std::sort(arrows_.begin(), arrows_.end());
  }

  /// Writes the ends of arrows at an event; times must not decrease.
  void write_flows(EventId i) {
    if (has_arrow(t_.events[i])) write_flow('f', i, i);
    for (; next_arrow_ < arrows_.size() && arrows_[next_arrow_].first == i; ++next_arrow_)
      write_flow('s', arrows_[next_arrow_].second, i);
  }

  void count(const Event& e, EventId i) {
    // Step 1: update the running totals of the time step.
    switch (e.kind) {
      case EventKind::step:
        begin_counting();
        break;
      case EventKind::face_test:
        ++tests_;
        if (pending_tests_ > 0) --pending_tests_;
        break;
      case EventKind::node_pair:
        count_pending(e);
        break;
      case EventKind::begin:
        if (walks_trees(e.phase())) pending_pairs_ = 1, pending_tests_ = 0;
        break;
      case EventKind::refine:
        ++refinements_;
        break;
      case EventKind::contact:
        ++contacts_;
        break;
      case EventKind::coarsen:
      case EventKind::result:
      case EventKind::plane_test:
      case EventKind::point:
      case EventKind::pass:
      case EventKind::patch:
      case EventKind::cap:
      case EventKind::merged:
      case EventKind::pass_end:
      case EventKind::closed:
        break;
      case EventKind::region:
        ++regions_;
        break;
      case EventKind::end:  // a query that stops early leaves the rest pending
        pending_pairs_ = pending_tests_ = 0;
        break;
    }
    // Step 2: the size of the wrapper that the event changed.
    const bool change = e.changes_wrapper();
    if (const std::uint32_t faces = e.wrapper_change().wrapper_faces; change && faces != kNull)
      faces_[static_cast<std::size_t>(e.side)] = faces;
    // Step 3: emit counters ("C"). Wrapper sizes at each change, work at regular intervals and at both ends
    // of a step.
    if (t_.header.construction) {
      if (change || e.kind == EventKind::step) write_hull_counter(i);
      return;
    }
    if (change || e.kind == EventKind::step) write_wrapper_counter(i);
    if (i % kWorkInterval != 0 && e.kind != EventKind::step && e.kind != EventKind::result) return;
    write_work_counter(i);
    if (t_.header.level != EventLevel::faces) write_pending_counter(i);
  }

  /// Updates the pending work after a pair of nodes.
  void count_pending(const Event& e) {
    const NodeWork work = e.work();
    // The pair itself is done. It adds its overlapping child pairs or, at leaves, face pairs.
    if (pending_pairs_ > 0) --pending_pairs_;
    if (e.node_end().step == NodeStep::leaves)
      pending_tests_ += work.met - std::min(work.met, work.rejected);
    else
      pending_pairs_ += work.met;
  }

  void begin_counting() {
    tests_ = refinements_ = contacts_ = 0;
    pending_pairs_ = pending_tests_ = 0;
    regions_ = 0;
    for (std::size_t s = 0; s < t_.header.bodies.size(); ++s)
      faces_[s] = t_.header.construction ? t_.header.bodies[s].real_faces : t_.header.bodies[s].outer_faces;
  }

  void begin_counter(std::string_view name, EventId i) {
    out_.raw(",\n{\"name\":\"");
    out_.raw(name);
    out_.raw("\",\"cat\":\"counter\",\"ph\":\"C\",\"pid\":1,\"tid\":0,\"ts\":");
    write_time(begin_of(i));
    out_.raw(",\"args\":{");
  }

  /// Begins a counter within an event's slice, at `share` of its duration. An event on the event clock takes
  /// 1.
  void begin_counter_within(std::string_view name, EventId i, double share) {
    out_.raw(",\n{\"name\":\"");
    out_.raw(name);
    out_.raw("\",\"cat\":\"counter\",\"ph\":\"C\",\"pid\":1,\"tid\":0,\"ts\":");
    if (wall())
      write_time(begin_of(i) + static_cast<std::uint64_t>(share * static_cast<double>(duration_of(i))));
    else
      out_.number(static_cast<double>(i) + share);
    out_.raw(",\"args\":{");
  }

  void write_ends(double lower, double upper) {
    out_.raw("\"lower\":");
    out_.number(lower);
    if (std::isfinite(upper)) {
      out_.raw(",\"upper\":");
      out_.number(upper);
    }
    out_.raw("}}");
  }

  /// Writes the convergence of bounds, spread by work over the half of an event's slice that begins at
  /// `begin`.
  void write_history(std::string_view name, EventId i, double begin, const std::vector<Bounds>& history) {
    for (const Bounds& b : history) {
      const double all = static_cast<double>(history.back().work) + 1;
      begin_counter_within(name, i, begin + 0.5 * static_cast<double>(b.work) / all);
      write_ends(b.lower, b.upper);
    }
  }

  void write_count(std::string_view name, EventId i, std::string_view unit, std::uint64_t count) {
    begin_counter_within(name, i, 1);
    out_.raw("\"");
    out_.raw(unit);
    out_.raw("\":");
    out_.number(count);
    out_.raw("}}");
  }

  /// Writes the measurements of a step before its result, which is its last event.
  void write_measured(EventId i) {
    const StepResult& r = t_.steps[t_.step_of(i)].result;
    if (r.distance) write_history("distance", i, 0, r.distance->history);
    if (r.clash) write_history("depth", i, 0.5, r.clash->history);
    if (r.near) write_count("near pairs", i, "pairs", r.near->pairs);
    if (r.manifold) write_count("manifold points", i, "points", r.manifold->found);
    if (r.points) write_count("points inside", i, "points", r.points->inside);
  }

  /// Writes the search for the first contact, which precedes all steps, within the first event.
  void write_first_contact(const MeasuredApproach& m) {
    for (const ContactBounds& b : m.history) {
      const double share = static_cast<double>(b.work) / (static_cast<double>(m.history.back().work) + 1);
      begin_counter_within("first contact", 0, share);
      out_.raw("\"t0\":");
      out_.number(b.t0);
      if (std::isfinite(b.t1)) {
        out_.raw(",\"t1\":");
        out_.number(b.t1);
      }
      out_.raw("}}");
      begin_counter_within("distance at t0", 0, share);
      write_ends(b.lower, b.upper);
    }
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

  void write_hull_counter(EventId i) {
    begin_counter("hull", i);
    out_.raw("\"faces\":");
    out_.number(std::uint64_t{faces_[0]});
    out_.raw(",\"regions\":");
    out_.number(std::uint64_t{regions_});
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

  void write_pending_counter(EventId i) {
    begin_counter("pending", i);
    out_.raw("\"node pairs\":");
    out_.number(pending_pairs_);
    out_.raw(",\"face tests\":");
    out_.number(pending_tests_);
    out_.raw("}}");
  }

  const Trace& t_;
  JsonOut out_;
  std::unordered_map<EventId, EventId> ends_;        ///< the end of each phase or pass, by its beginning
  std::vector<std::pair<EventId, EventId>> arrows_;  ///< from, to; ascending
  std::size_t next_arrow_ = 0;
  std::array<Parts, kEventKinds> parts_;
  std::array<std::uint32_t, 2> faces_{};
  std::unordered_map<EventId, PassSummary> passes_;  ///< by their first event
  std::uint32_t tests_ = 0, refinements_ = 0, contacts_ = 0, regions_ = 0;
  std::uint64_t pending_pairs_ = 0, pending_tests_ = 0;
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
