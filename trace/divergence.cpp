// First difference of two traces, in causal order: bodies, request, then each step's poses, events and
// results. A comparison that has found a difference ignores all later ones, so the checks are written in
// sequence.

#include <algorithm>
#include <type_traits>

#include "trace/event_fields.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/trace/divergence.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/record_fields.hpp>
namespace lrb::trace {

std::string to_text(const EngineReport& r) {
  std::string out = std::string(name_of(r.query)) + ", " + std::string(name_of(r.verdict)) + ", " +
                    std::to_string(r.pairs) + (r.pairs == 1 ? " pair" : " pairs");
  if (!r.complete) out += ", not all events";
  const auto add = [&](const std::vector<EngineReport::Mark>& marks, const char* what) {
    if (!marks.empty()) out += ", " + std::to_string(marks.size()) + " " + what;
  };
  add(r.counts, "counts");
  add(r.phases, "phases");
  return out;
}

namespace {

std::string to_text(std::uint64_t value) {
  return std::to_string(value);
}
std::string to_text(double value) {
  return io::exact_text(value);
}
std::string to_text(const std::string& text) {
  return text.empty() ? "lrbscope" : text;
}
std::string to_text(const std::optional<Separation>& s) {
  return s ? "wrappers of " + std::to_string(s->face_count[0]) + " and " + std::to_string(s->face_count[1]) +
                 " faces"
           : "none";
}
template <class Measured>
std::string to_text(const std::optional<Measured>& m) {
  return m ? to_text(*m) : "none";
}
std::string to_text(const std::vector<std::uint32_t>& values) {
  std::string out = "[";
  for (const std::uint32_t value : values)
    out.append(out.size() > 1 ? ", " : "").append(std::to_string(value));
  return out + "]";
}
std::string to_text(bool value) {
  return value ? "true" : "false";
}
template <class Enum>
requires std::is_enum_v<Enum> std::string to_text(Enum value) {
  return std::string(name_of(value));
}

std::string to_text(const Pose& pose) {
  std::string out;
  for (const double x : io::rows_of(pose)) out += (out.empty() ? "(" : " ") + to_text(x);
  return out + ")";
}

/// Compares values one by one and keeps the first difference.
class Comparison {
 public:
  bool differs() const { return found_.has_value(); }
  std::optional<Divergence> result() && { return std::move(found_); }
  void at(std::optional<EventId> event, std::optional<std::size_t> step, std::uint32_t number = 0) {
    event_ = event, step_ = step, number_ = number;
  }

  void found(std::string what, std::string expected, std::string actual) {
    if (!found_)
      found_ = Divergence{event_, step_, number_, std::move(what), std::move(expected), std::move(actual)};
  }
  template <class T>
  void same(const std::string& what, const T& expected, const T& actual) {
    if (!found_ && expected != actual) found(what, to_text(expected), to_text(actual));
  }

 private:
  std::optional<Divergence> found_;
  std::optional<EventId> event_;
  std::optional<std::size_t> step_;
  std::uint32_t number_ = 0;
};

void compare_bodies(Comparison& c, const TraceHeader& x, const TraceHeader& y) {
  c.same("number of bodies", std::uint64_t{x.bodies.size()}, std::uint64_t{y.bodies.size()});
  for (std::size_t i = 0; i < x.bodies.size() && !c.differs(); ++i) {
    const BodyInfo &p = x.bodies[i], &q = y.bodies[i];
    // The hash covers the whole LRB-rep; face and region counts only make the message clearer.
    if (p.hash == q.hash) continue;
    const auto text = [](const BodyInfo& b) {
      return to_hex(b.hash) + " (" + std::to_string(b.real_faces) + " real faces, " +
             std::to_string(b.regions) + " regions)";
    };
    c.found("hash of body " + std::string(name_of(static_cast<Side>(i))), text(p), text(q));
  }
}

/// Returns a report without what differs from run to run.
std::optional<EngineReport> without_times(std::optional<EngineReport> report) {
  if (report) report->thread = 0, report->begin_ns = report->duration_ns = 0;
  return report;
}

/// Adds the fields in which two records differ.
template <class Record>
void add_differences(const Record& x, const Record& y, bool is_counter, std::vector<FieldDifference>& out) {
  for_each_field<Record>([&](const auto& field) {
    const auto &expected = x.*field.member, &actual = y.*field.member;
    const auto add = [&](const auto& p, const auto& q) {
      if (p != q) out.push_back({std::string(field.name), to_text(p), to_text(q), is_counter});
    };
    if constexpr (std::is_same_v<decltype(expected), const std::optional<EngineReport>&>) {
      add(without_times(expected), without_times(actual));
    } else if constexpr (std::is_same_v<decltype(expected), const Counters&>) {
      add_differences(expected, actual, true, out);
    } else {
      add(expected, actual);
      if constexpr (std::is_same_v<decltype(expected), const std::uint64_t&>)
        if (field.form == Form::hash && expected != actual)
          out.back().expected = to_hex(expected), out.back().actual = to_hex(actual);
    }
  });
}

/// Compares the fields of two records; `before` is the prefix of their names.
template <class Record>
void compare_fields(Comparison& c, const Record& x, const Record& y, const std::string& before) {
  std::vector<FieldDifference> all;
  add_differences(x, y, false, all);
  if (!all.empty())
    c.found((all[0].is_counter ? "counter " : before) + all[0].name, all[0].expected, all[0].actual);
}

/// The fields of an event as texts.
struct FieldTexts {
  std::vector<std::pair<std::string, std::string>> all;

  explicit FieldTexts(const Event& e) { event_fields(*this, e); }
  static bool has(std::string_view, bool present) { return present; }
  void number(std::string_view name, std::uint64_t value) { all.emplace_back(name, to_text(value)); }
  template <class Enum>
  void word(std::string_view name, Enum value) {
    all.emplace_back(name, to_text(value));
  }
  void flag(std::string_view name, bool value) { all.emplace_back(name, to_text(value)); }
  void real(std::string_view name, std::uint32_t bits) {
    all.emplace_back(name, to_text(double{std::bit_cast<float>(bits)}));
  }
  void simplex(Side, std::string_view name, std::uint32_t value) { number(name, value); }
  static void vertices(const Event& /*compared with the steps*/) {}

  std::string text_of(const std::string& name) const {
    for (const auto& [known, text] : all)
      if (known == name) return text;
    return "none";
  }
};

void compare_events(Comparison& c, const Event& x, const Event& y) {
  // The fields depend on the kind: compare kinds first.
  c.same("kind", x.kind, y.kind);
  if (c.differs()) return;
  const FieldTexts p(x), q(y);
  for (const FieldTexts* fields : {&p, &q})
    for (const auto& field : fields->all)
      if (p.text_of(field.first) != q.text_of(field.first))
        return c.found(field.first, p.text_of(field.first), q.text_of(field.first));
}

std::string to_text(std::span<const VertexId> vertices) {
  std::string out;
  for (const VertexId v : vertices) out += (out.empty() ? "" : " ") + std::to_string(v);
  return out.empty() ? "not recorded" : out;
}

void compare_results(Comparison& c, const Step& x, const Step& y) {
  c.same("step finished", x.finished, y.finished);
  compare_fields(c, x.result, y.result, "");
  c.same("events seen", x.events_seen, y.events_seen);
}

void compare_step_events(Comparison& c, const Trace& x, const Trace& y, std::size_t step) {
  const std::span<const Event> p = x.events_of(step), q = y.events_of(step);
  const EventId first = x.steps[step].first_event;
  // The common prefix: equal events are skipped by one comparison each.
  for (std::size_t i = 0; i < std::min(p.size(), q.size()); ++i) {
    const auto of_x = x.vertices_of(p[i]), of_y = y.vertices_of(q[i]);
    const bool same_vertices = std::equal(of_x.begin(), of_x.end(), of_y.begin(), of_y.end());
    if (p[i] == q[i] && same_vertices) continue;
    c.at(first + static_cast<EventId>(i), step, x.steps[step].index);
    compare_events(c, p[i], q[i]);
    if (!same_vertices) c.found("vertices", to_text(of_x), to_text(of_y));
    return;
  }
  if (p.size() == q.size()) return;
  // One run has more events: the first extra one is the difference.
  const std::size_t i = std::min(p.size(), q.size());
  c.at(first + static_cast<EventId>(i), step, x.steps[step].index);
  const std::string end = "the end of the step";
  c.found("event", i < p.size() ? describe(p[i]) : end, i < q.size() ? describe(q[i]) : end);
}

void compare_steps(Comparison& c, const Trace& x, const Trace& y) {
  for (std::size_t i = 0; i < std::min(x.steps.size(), y.steps.size()) && !c.differs(); ++i) {
    const Step &p = x.steps[i], &q = y.steps[i];
    c.at(std::nullopt, i, p.index);
    c.same("index of the step", std::uint64_t{p.index}, std::uint64_t{q.index});
    // Poses are inputs: if they differ, different events are a consequence.
    if (!equal(p.pose_a, q.pose_a)) c.found("pose of A", to_text(p.pose_a), to_text(q.pose_a));
    if (!equal(p.pose_b, q.pose_b)) c.found("pose of B", to_text(p.pose_b), to_text(q.pose_b));
    if (!c.differs()) compare_step_events(c, x, y, i);
    // Events come before results, because they usually explain them.
    c.at(std::nullopt, i, p.index);
    compare_results(c, p, q);
  }
  c.at(std::nullopt, std::nullopt);
  c.same("number of steps", std::uint64_t{x.steps.size()}, std::uint64_t{y.steps.size()});
}

}  // namespace

std::string describe(const Event& e) {
  std::string out = std::string(name_of(e.kind)) + ":";
  for (const auto& [name, text] : FieldTexts(e).all)
    out += (out.back() == ':' ? " " : ", ") + name + " " + text;
  return out;
}

std::string Divergence::message() const {
  std::string out = event  ? "event " + std::to_string(*event) + " (step " + std::to_string(number) + ")"
                    : step ? "step " + std::to_string(number)
                           : std::string("run");
  return out + ": " + what + ": expected " + expected + ", found " + actual;
}

std::vector<FieldDifference> differing_fields(const StepResult& expected, const StepResult& actual) {
  std::vector<FieldDifference> out;
  add_differences(expected, actual, false, out);
  return out;
}

std::optional<Divergence> first_divergence(const Trace& expected, const Trace& actual) {
  Comparison c;
  c.same("construction", expected.header.construction, actual.header.construction);
  compare_bodies(c, expected.header, actual.header);
  compare_fields(c, expected.header.request, actual.header.request, "request: ");
  c.same("level of events", expected.header.level, actual.header.level);
  c.same("engine", expected.header.engine, actual.header.engine);
  c.same("first contact", expected.header.first_contact, actual.header.first_contact);
  if (!c.differs()) compare_steps(c, expected, actual);
  return std::move(c).result();
}

}  // namespace lrb::trace
