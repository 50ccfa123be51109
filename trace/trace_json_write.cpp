/// See trace_json.hpp for the format.

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "trace/event_fields.hpp"
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

/// A counter's line between its name and its time.
constexpr std::string_view kCounter = ",\"cat\":\"counter\",\"ph\":\"C\",\"pid\":1,\"tid\":0,\"ts\":";

/// Number of events between "work" counters: small enough for a smooth curve, large enough to cost little.
constexpr EventId kWorkInterval = 16;

/// The thread and the category of events of a kind.
struct Place {
  Thread thread;
  std::string_view category;
};

constexpr Place kPlaces[] = {
    {Thread::steps, "step"},         // step
    {Thread::tests, "test"},         // face_test
    {Thread::wrapper_a, "wrapper"},  // refine
    {Thread::wrapper_a, "wrapper"},  // coarsen
    {Thread::answer, "answer"},      // contact
    {Thread::steps, "step"},         // result
    {Thread::walk, "walk"},          // node_pair
    {Thread::walk, "walk"},          // plane_test
    {Thread::phases, "point"},       // point
    {Thread::phases, "phase"},       // begin
    {Thread::phases, "phase"},       // end
    {Thread::passes, "pass"},        // pass
    {Thread::caps, "cap"},           // patch
    {Thread::caps, "cap"},           // cap
    {Thread::hull, "hull"},          // region
    {Thread::hull, "hull"},          // merged
    {Thread::passes, "pass"},        // pass_end
    {Thread::hull, "hull"},          // closed
};
static_assert(std::size(kPlaces) == kEventKinds);
const Place& place_of(EventKind kind) {
  return kPlaces[static_cast<std::size_t>(kind)];
}

Thread thread_of(const Event& e) {
  const Thread thread = place_of(e.kind).thread;
  return thread == Thread::wrapper_a && e.side == Side::b ? Thread::wrapper_b : thread;
}

class TraceWriter {
 public:
  TraceWriter(const Trace& trace, ByteSink& sink) : t_(trace), out_(sink) {
    // First scan: everything that a line needs from later events. The writing itself is a single pass.
    for (const PassSummary& p : passes_of(t_)) passes_[p.first] = p;
    find_ends();
    find_arrows();
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
  /// Finds the ends of the phases and passes by their first events.
  void find_ends() {
    for (EventId i = 0; i < t_.events.size(); ++i) {
      const Event& e = t_.events[i];
      const bool ends = e.kind == EventKind::end || e.kind == EventKind::pass_end;
      if (ends && e.cause != kNull) ends_[e.cause] = i;
    }
  }

  /// Writes parts in order: text as it is, numbers, and quoted strings.
  template <class... Parts>
  void put(const Parts&... parts) {
    (put_part(parts), ...);
  }
  struct Quoted {
    std::string_view text;
  };
  void put_part(std::string_view text) { out_.raw(text); }
  void put_part(const Quoted& string) { out_.string(string.text); }
  void put_part(std::unsigned_integral auto number) { out_.number(std::uint64_t{number}); }
  void put_part(double number) { out_.number(number); }
  void put_part(Thread thread) { put_part(static_cast<std::uint64_t>(thread)); }

  /// Names or sorts a process or one of its threads.
  template <class Value>
  void write_label(std::string_view event, std::uint64_t process, std::uint64_t thread,
                   std::string_view field, const Value& value) {
    put(std::exchange(separator_, ",\n"), "{\"name\":\"", event,
        "\",\"cat\":\"__metadata\",\"ph\":\"M\",\"ts\":0,\"pid\":", process, ",\"tid\":", thread,
        ",\"args\":{\"", field, "\":", value, "}}");
  }

  void write_names() {
    write_label("process_name", 1, 0, "name", Quoted{"lrbscope: " + t_.header.scenario});
    const std::span<const ThreadName> threads =
        t_.header.construction ? std::span<const ThreadName>(kBuildThreads) : kThreads;
    for (const auto& [thread, name, from] : threads) {
      // Threads without events at this detail would show as empty tracks.
      if (t_.header.level < from) continue;
      const auto number = static_cast<std::uint64_t>(thread);
      write_label("thread_name", 1, number, "name", Quoted{name});
      write_label("thread_sort_index", 1, number, "sort_index", number);
    }
  }

  // Another engine's queries in its own time, as a second process with a track for each of its threads; its
  // phases and counters among the events.

  void write_engine() {
    constexpr std::uint64_t kQueries = 2;
    write_label("process_name", kQueries, 0, "name", Quoted{t_.header.engine + ": queries, in its own time"});
    std::set<std::uint32_t> threads;
    for (const Step& s : t_.steps)
      if (s.result.engine) threads.insert(s.result.engine->thread);
    for (const std::uint32_t thread : threads)
      write_label("thread_name", kQueries, thread, "name", Quoted{"thread " + std::to_string(thread)});
    for (std::size_t i = 0; i < t_.steps.size(); ++i) {
      if (!t_.steps[i].result.engine) continue;
      const EngineReport& r = *t_.steps[i].result.engine;
      begin_engine_slice(report_name(t_.steps[i].index, r), kQueries, r.thread);
      write_ns(r.begin_ns);
      out_.raw(",\"dur\":");
      write_ns(std::max<std::uint64_t>(r.duration_ns, 1));
      put(",\"args\":{\"time step\":", t_.steps[i].index);
      write_word("query", name_of(r.query));
      write_word("verdict", name_of(r.verdict));
      write_number("pairs", r.pairs);
      for (std::size_t k = 0; k < r.counts.size(); ++k)
        if (is_last_of_name(r.counts, k))
          put(",", Quoted{t_.header.names[r.counts[k].name]}, ":", r.counts[k].value);
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
      begin_engine_slice(t_.header.names[r.phases[k].name], 1, static_cast<std::uint64_t>(Thread::phases));
      write_time(begin);
      out_.raw(",\"dur\":");
      write_time(end - begin);
      out_.raw(",\"args\":{}}");
    }
    for (const EngineReport::Mark& mark : r.counts) {
      put(",\n{\"name\":", Quoted{"engine: " + t_.header.names[mark.name]}, kCounter);
      write_time(time_of(mark.at));
      put(",\"args\":{\"value\":", mark.value, "}}");
    }
  }

  void begin_engine_slice(std::string_view name, std::uint64_t process, std::uint64_t thread) {
    put(",\n{\"name\":", Quoted{name}, ",\"cat\":\"", kEngineCategory, "\",\"ph\":\"X\",\"pid\":", process,
        ",\"tid\":", thread, ",\"ts\":");
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
    out_.raw(",\n{\"name\":\"");
    write_name(e, i);
    put("\",\"cat\":\"", place_of(e.kind).category, "\",\"ph\":\"X\",\"pid\":1,\"tid\":", thread_of(e),
        ",\"ts\":");
    write_time(begin_of(i));
    out_.raw(",\"dur\":");
    write_time(duration_of(i));
    put(",\"args\":{\"event\":", i);
    Fields fields{*this};
    event_fields(fields, e);
    if (wall()) put(",\"ns\":", t_.wall_ns[i]);
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
    put(" ", step.index);
    if (!step.finished) return;
    put(": ", name_of(step.result.relation));
    const std::uint64_t pairs = step.result.pair_count;
    if (pairs > 0) put(", ", pairs, pairs == 1 ? " pair" : " pairs");
  }

  void write_pass_name(const PassSummary& p) {
    put("pass ", p.number(), ": ", name_of(p.stage), ", ", p.regions,
        p.regions == 1 ? " region, " : " regions, ", p.faces_before, " to ", p.faces_after, " faces");
  }

  /// Writes the fields of an event. Their order is fixed, so that equal traces give equal files.
  struct Fields {
    TraceWriter& w;

    static bool has(std::string_view, bool present) { return present; }
    void number(std::string_view name, std::uint64_t value) { w.write_number(name, value); }
    template <class Enum>
    void word(std::string_view name, Enum value) {
      w.write_word(name, name_of(value));
    }
    void flag(std::string_view name, bool value) {
      if (value) w.put(",\"", name, "\":true");
    }
    void real(std::string_view name, std::uint32_t bits) {
      w.put(",\"", name, "\":");
      w.out_.number(std::bit_cast<float>(bits));
    }
    void simplex(Side side, std::string_view name, std::uint32_t simplex) {
      const bool is_real = simplex < w.t_.header.bodies[static_cast<std::size_t>(side)].real_simplices;
      w.write_number(is_real ? name : pseudo_simplex(side), simplex);
    }
    void vertices(const Event& e) {
      std::string_view before = ",\"vertices\":[";
      for (const VertexId v : w.t_.vertices_of(e)) w.put(std::exchange(before, ","), v.value());
      if (before == ",") w.out_.raw("]");
    }
  };

  void write_word(std::string_view name, std::string_view word) { put(",\"", name, "\":", Quoted{word}); }
  void write_number(std::string_view name, std::uint64_t number) { put(",\"", name, "\":", number); }

  /// Writes one end of the arrow to an event from its cause.
  void write_flow(std::string_view phase, EventId effect, EventId at) {
    // bp "e": the arrow binds to the slice that encloses its time.
    put(",\n{\"name\":\"cause\",\"cat\":\"flow\",\"ph\":\"", phase, "\",\"id\":", effect,
        ",\"bp\":\"e\",\"pid\":1,\"tid\":", thread_of(t_.events[at]), ",\"ts\":");
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
    if (has_arrow(t_.events[i])) write_flow("f", i, i);
    for (; next_arrow_ < arrows_.size() && arrows_[next_arrow_].first == i; ++next_arrow_)
      write_flow("s", arrows_[next_arrow_].second, i);
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
    put(",\n{\"name\":", Quoted{name}, kCounter);
    write_time(begin_of(i));
    out_.raw(",\"args\":{");
  }

  /// Begins a counter within an event's slice, at `share` of its duration. An event on the event clock takes
  /// 1.
  void begin_counter_within(std::string_view name, EventId i, double share) {
    put(",\n{\"name\":", Quoted{name}, kCounter);
    if (wall())
      write_time(begin_of(i) + static_cast<std::uint64_t>(share * static_cast<double>(duration_of(i))));
    else
      put(static_cast<double>(i) + share);
    out_.raw(",\"args\":{");
  }

  /// Writes both ends of an interval, the upper one if it is finite.
  void write_ends(std::string_view lower_name, double lower, std::string_view upper_name, double upper) {
    put("\"", lower_name, "\":", lower);
    if (std::isfinite(upper)) put(",\"", upper_name, "\":", upper);
    out_.raw("}}");
  }

  /// Writes the convergence of bounds, spread by work over the half of an event's slice that begins at
  /// `begin`.
  void write_history(std::string_view name, EventId i, double begin, const std::vector<Bounds>& history) {
    for (const Bounds& b : history) {
      const double all = static_cast<double>(history.back().work) + 1;
      begin_counter_within(name, i, begin + 0.5 * static_cast<double>(b.work) / all);
      write_ends("lower", b.lower, "upper", b.upper);
    }
  }

  void write_count(std::string_view name, EventId i, std::string_view unit, std::uint64_t count) {
    begin_counter_within(name, i, 1);
    put("\"", unit, "\":", count, "}}");
  }

  /// Writes the measurements of a step before its result, which is its last event.
  void write_measured(EventId i) {
    const StepResult& r = t_.steps[t_.step_of(i)].result;
    if (r.distance) write_history("distance", i, 0, r.distance->history);
    if (r.clash) write_history("depth", i, 0.5, r.clash->history);
    if (r.near)
      for (const auto& n : NearPairsNumbers::kShown)
        write_count(n.on_pages, i, n.in_traces, (*r.near).*n.member);
    if (r.manifold) write_count("manifold points", i, "points", r.manifold->found);
    if (r.points) write_count("points inside", i, "points", r.points->inside);
  }

  /// Writes the search for the first contact, which precedes all steps, within the first event.
  void write_first_contact(const MeasuredApproach& m) {
    for (const ContactBounds& b : m.history) {
      const double share = static_cast<double>(b.work) / (static_cast<double>(m.history.back().work) + 1);
      begin_counter_within("first contact", 0, share);
      write_ends("t0", b.t0, "t1", b.t1);
      begin_counter_within("distance at t0", 0, share);
      write_ends("lower", b.lower, "upper", b.upper);
    }
  }

  void write_wrapper_counter(EventId i) {
    begin_counter("wrapper", i);
    put("\"faces of A\":", faces_[0]);
    if (t_.header.bodies.size() > 1) put(",\"faces of B\":", faces_[1]);
    put(",\"refinements\":", refinements_, "}}");
  }

  void write_hull_counter(EventId i) {
    begin_counter("hull", i);
    put("\"faces\":", faces_[0], ",\"regions\":", regions_, "}}");
  }

  void write_work_counter(EventId i) {
    begin_counter("work", i);
    put("\"face tests\":", tests_, ",\"contacts\":", contacts_, "}}");
  }

  void write_pending_counter(EventId i) {
    begin_counter("pending", i);
    put("\"node pairs\":", pending_pairs_, ",\"face tests\":", pending_tests_, "}}");
  }

  const Trace& t_;
  JsonOut out_;
  std::string_view separator_;                       ///< before the next label
  std::unordered_map<EventId, EventId> ends_;        ///< the end of each phase or pass, by its beginning
  std::vector<std::pair<EventId, EventId>> arrows_;  ///< from, to; ascending
  std::size_t next_arrow_ = 0;
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
