#include "trace/divergence.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <type_traits>

#include "trace/hex.hpp"
#include "trace/names.hpp"

namespace lrb::trace {

namespace {

std::string or_none(std::uint32_t value) {
  return value == kNull ? "none" : std::to_string(value);
}

std::string words(std::uint64_t value) {
  return std::to_string(value);
}
std::string words(double value) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}
std::string words(const std::optional<Separation>& s) {
  return s ? "wrappers of " + std::to_string(s->face_count[0]) + " and " + std::to_string(s->face_count[1]) +
                 " faces"
           : "none";
}
std::string words(bool value) {
  return value ? "true" : "false";
}
template <class Enum>
requires std::is_enum_v<Enum> std::string words(Enum value) {
  return std::string(name_of(value));
}

std::string words(const Pose& pose) {
  std::string out = "(";
  std::array<char, 32> digits{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) {
      const double x = column < 3 ? pose.r(row, column) : pose.t(row);
      out.append(row + column == 0 ? "" : " ");
      out.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr);
    }
  return out + ")";
}

/// Compares value after value and keeps the first difference.
class Comparison {
 public:
  bool differs() const { return found_.has_value(); }
  std::optional<Divergence> result() && { return std::move(found_); }
  void at(std::optional<EventId> event, std::optional<std::size_t> step) { event_ = event, step_ = step; }

  void found(std::string what, std::string expected, std::string actual) {
    if (!found_) found_ = Divergence{event_, step_, std::move(what), std::move(expected), std::move(actual)};
  }
  template <class T>
  void same(const char* what, const T& expected, const T& actual) {
    if (!found_ && expected != actual) found(what, words(expected), words(actual));
  }
  void same_or_none(const std::string& what, std::uint32_t expected, std::uint32_t actual) {
    if (!found_ && expected != actual) found(what, or_none(expected), or_none(actual));
  }

 private:
  std::optional<Divergence> found_;
  std::optional<EventId> event_;
  std::optional<std::size_t> step_;
};

void compare_bodies(Comparison& c, const TraceHeader& x, const TraceHeader& y) {
  c.same("number of bodies", std::uint64_t{x.bodies.size()}, std::uint64_t{y.bodies.size()});
  for (std::size_t i = 0; i < x.bodies.size() && !c.differs(); ++i) {
    const BodyInfo &p = x.bodies[i], &q = y.bodies[i];
    if (p.hash == q.hash) continue;
    const auto tell = [](const BodyInfo& b) {
      return to_hex(b.hash) + " (" + std::to_string(b.real_faces) + " real faces, " +
             std::to_string(b.regions) + " regions)";
    };
    c.found("hash of body " + std::string(name_of(static_cast<Side>(i))), tell(p), tell(q));
  }
}

void compare_requests(Comparison& c, const CollideRequest& x, const CollideRequest& y) {
  c.same("request: mode", x.mode, y.mode);
  c.same("request: recursion", x.recursion, y.recursion);
  c.same("request: predicates", x.predicates, y.predicates);
  c.same("request: wrapper", x.wrapper, y.wrapper);
  c.same("request: tolerance", x.tolerance, y.tolerance);
  c.same("request: max_tests", x.max_tests, y.max_tests);
  c.same("request: max_time", x.max_time, y.max_time);
  c.same("request: separation", x.separation, y.separation);
}

void compare_events(Comparison& c, const Event& x, const Event& y) {
  c.same("kind", x.kind, y.kind);
  if (c.differs()) return;
  const auto [a, b] = fields_of(x.kind);
  c.same("side", x.side, y.side);
  if (x.kind == EventKind::result)
    c.same("relation", static_cast<Relation>(x.a), static_cast<Relation>(y.a));
  else
    c.same_or_none(std::string(a), x.a, y.a);
  c.same_or_none(std::string(b), x.b, y.b);
  c.same("meet", x.meet, y.meet);
  c.same_or_none("depth of A", x.depth_a, y.depth_a);
  c.same_or_none("depth of B", x.depth_b, y.depth_b);
  c.same_or_none("cause", x.cause, y.cause);
  c.same_or_none("wrapper faces", x.boundary, y.boundary);
}

void compare_results(Comparison& c, const Step& x, const Step& y) {
  c.same("step finished", x.finished, y.finished);
  const StepResult &p = x.result, &q = y.result;
  c.same("relation", p.relation, q.relation);
  c.same("interiors overlap", p.interiors_overlap, q.interiors_overlap);
  c.same("pairs", p.pair_count, q.pair_count);
  if (p.fingerprint != q.fingerprint)
    c.found("fingerprint of the pairs", to_hex(p.fingerprint), to_hex(q.fingerprint));
  c.same("error bound", p.error_bound, q.error_bound);
  c.same("finished", p.finished, q.finished);
  if (!equal(p.separation, q.separation))
    c.found("certificate of separation", words(p.separation), words(q.separation));
  c.same("events seen", x.events_seen, y.events_seen);
  const Counters &m = p.counters, &n = q.counters;
  c.same("counter face_tests", m.face_tests, n.face_tests);
  c.same("counter real_tests", m.real_tests, n.real_tests);
  c.same("counter exact_fallbacks", m.exact_fallbacks, n.exact_fallbacks);
  c.same("counter node_pairs", m.node_pairs, n.node_pairs);
  c.same("counter box_tests", m.box_tests, n.box_tests);
  c.same("counter prefilter_tests", m.prefilter_tests, n.prefilter_tests);
  c.same("counter refinements", m.refinements, n.refinements);
  c.same("counter regions_opened", m.regions_opened, n.regions_opened);
  if (m.face_tests_by_level != n.face_tests_by_level)
    c.found("counter face_tests_by_level", "a list", "another");
}

void compare_step_events(Comparison& c, const Trace& x, const Trace& y, std::size_t step) {
  const std::span<const Event> p = x.events_of(step), q = y.events_of(step);
  const EventId first = x.steps[step].first_event;
  for (std::size_t i = 0; i < std::min(p.size(), q.size()); ++i) {
    if (p[i] == q[i]) continue;
    c.at(first + static_cast<EventId>(i), step);
    compare_events(c, p[i], q[i]);
    return;
  }
  if (p.size() == q.size()) return;
  const std::size_t i = std::min(p.size(), q.size());
  c.at(first + static_cast<EventId>(i), step);
  const std::string end = "the end of the step";
  c.found("event", i < p.size() ? describe(p[i]) : end, i < q.size() ? describe(q[i]) : end);
}

void compare_steps(Comparison& c, const Trace& x, const Trace& y) {
  for (std::size_t i = 0; i < std::min(x.steps.size(), y.steps.size()) && !c.differs(); ++i) {
    const Step &p = x.steps[i], &q = y.steps[i];
    c.at(std::nullopt, i);
    c.same("index of the step", std::uint64_t{p.index}, std::uint64_t{q.index});
    if (!equal(p.pose_a, q.pose_a)) c.found("pose of A", words(p.pose_a), words(q.pose_a));
    if (!equal(p.pose_b, q.pose_b)) c.found("pose of B", words(p.pose_b), words(q.pose_b));
    if (!c.differs()) compare_step_events(c, x, y, i);
    c.at(std::nullopt, i);
    compare_results(c, p, q);
  }
  c.at(std::nullopt, std::nullopt);
  c.same("number of steps", std::uint64_t{x.steps.size()}, std::uint64_t{y.steps.size()});
}

}  // namespace

std::string describe(const Event& e) {
  std::string out(name_of(e.kind));
  out += ':';
  const auto [a, b] = fields_of(e.kind);
  const auto add = [&](std::string_view name, const std::string& value) {
    out.append(out.back() == ':' ? " " : ", ").append(name).append(" ").append(value);
  };
  if (!a.empty())
    add(a, e.kind == EventKind::result ? words(static_cast<Relation>(e.a)) : std::to_string(e.a));
  if (e.kind == EventKind::refine || e.kind == EventKind::coarsen) out += " of " + words(e.side);
  if (!b.empty()) add(b, std::to_string(e.b));
  if (e.kind == EventKind::face_test || e.kind == EventKind::contact) add("meet", words(e.meet));
  if (e.boundary != kNull) add("wrapper faces", std::to_string(e.boundary));
  if (e.cause != kNull) add("cause", std::to_string(e.cause));
  return out;
}

std::string Divergence::message() const {
  std::string out =
      event  ? "event " + std::to_string(*event) + " (step " + std::to_string(step.value_or(0)) + ")"
      : step ? "step " + std::to_string(*step)
             : std::string("run");
  return out + ": " + what + ": expected " + expected + ", found " + actual;
}

std::optional<Divergence> first_divergence(const Trace& expected, const Trace& actual) {
  Comparison c;
  compare_bodies(c, expected.header, actual.header);
  compare_requests(c, expected.header.request, actual.header.request);
  if (!c.differs()) compare_steps(c, expected, actual);
  return std::move(c).result();
}

}  // namespace lrb::trace
