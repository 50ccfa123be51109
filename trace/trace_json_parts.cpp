#include "trace/trace_json_parts.hpp"

#include <array>
#include <optional>
#include <type_traits>
#include <vector>

#include <lrbscope/trace/record_fields.hpp>

namespace lrb::trace {

namespace {

template <class T>
void write_array(JsonWriter& w, const T& values) {
  w.begin_array();
  for (const auto& value : values) w.value(value);
  w.end_array();
}

template <class T>
void write_value(JsonWriter& w, const T& value, Form form) {
  if constexpr (std::is_enum_v<T>)
    w.value(name_of(value));
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    form == Form::hash ? w.value(to_hex(value)) : w.value(value);
  else if constexpr (std::is_same_v<T, std::vector<std::uint32_t>>)
    write_array(w, value);
  else if constexpr (std::is_same_v<T, std::optional<Separation>>)
    write_json(w, value.value());
  else if constexpr (std::is_same_v<T, std::optional<MeasuredDistance>> ||
                     std::is_same_v<T, std::optional<MeasuredClash>> ||
                     std::is_same_v<T, std::optional<MeasuredNearPairs>> ||
                     std::is_same_v<T, std::optional<MeasuredManifolds>> ||
                     std::is_same_v<T, std::optional<MeasuredPoints>> ||
                     std::is_same_v<T, std::optional<EngineReport>>)
    write_json(w, value.value());
  else if constexpr (std::is_same_v<T, Counters>)
    write_json(w, value);
  else
    w.value(value);  // infinite values as null
}

template <class Record>
void write_members(JsonWriter& w, const Record& record, bool coarse = false) {
  for_each_field<Record>([&](const auto& field) {
    if (!is_kept(field, record, coarse)) return;
    w.key(field.name);
    write_value(w, record.*field.member, field.form);
  });
}

template <class Record>
void write_object(JsonWriter& w, const Record& record) {
  w.begin_object();
  write_members(w, record);
  w.end_object();
}

}  // namespace

void write_json(JsonWriter& w, const BodyInfo& body) {
  write_object(w, body);
}

void write_json(JsonWriter& w, const Counters& counters) {
  write_object(w, counters);
}

void write_json(JsonWriter& w, const CollideRequest& request) {
  write_object(w, request);
}

void write_json(JsonWriter& w, const Separation& separation) {
  w.begin_object().key("faces");
  write_array(w, separation.face_count);
  w.key("refined").begin_array();
  for (const std::vector<RegionId>& regions : separation.refined) write_array(w, regions);
  w.end_array().end_object();
}

void write_history(JsonWriter& w, const std::vector<Bounds>& history) {
  w.key("course").begin_array();
  for (const Bounds& b : history) w.begin_array().value(b.work).value(b.lower).value(b.upper).end_array();
  w.end_array();
}

void write_history(JsonWriter& w, const std::vector<ContactBounds>& history) {
  w.key("course").begin_array();
  for (const ContactBounds& b : history) {
    w.begin_array().value(b.work).value(b.t0).value(b.t1).value(b.lower).value(b.upper);
    w.end_array();
  }
  w.end_array();
}

void write_json(JsonWriter& w, const MeasuredDistance& m) {
  w.begin_object().member("lower", m.lower).member("upper", m.upper).member("solids_meet", m.solids_meet);
  w.key("point_a");
  write_array(w, m.points[0]);
  w.key("point_b");
  write_array(w, m.points[1]);
  write_history(w, m.history);
  w.end_object();
}

void write_json(JsonWriter& w, const MeasuredClash& m) {
  w.begin_object().member("kind", name_of(m.kind));
  if (m.reason != ClashReason::none) w.member("reason", name_of(m.reason));
  w.member("shares_faces", m.shares_faces);
  w.key("distance");
  write_array(w, m.distance);
  if (m.depth) {
    w.key("depth");
    write_array(w, *m.depth);
    w.key("translation");
    write_array(w, m.translation);
  }
  if (m.volume) {
    w.key("volume");
    write_array(w, *m.volume);
  }
  write_history(w, m.history);
  w.end_object();
}

void write_json(JsonWriter& w, const MeasuredNearPairs& m) {
  w.begin_object().member("within", m.within).member("pairs", m.pairs).key("nearest").begin_array();
  for (const MeasuredNearPairs::Pair& p : m.nearest) {
    w.begin_array().value(p.a.value()).value(p.b.value()).value(p.lower).value(p.upper);
    for (const std::array<double, 3>& point : p.points)
      for (const double x : point) w.value(x);
    w.end_array();
  }
  w.end_array().end_object();
}

void write_json(JsonWriter& w, const MeasuredManifolds& m) {
  w.begin_object().member("margin", m.margin).member("manifolds", m.manifolds).member("points", m.found);
  w.key("contacts").begin_array();
  for (const MeasuredManifolds::Point& p : m.contacts) {
    w.begin_array().value(p.id).value(p.manifold).value(p.depth);
    for (const std::array<double, 3>& vector : {p.normal, p.points[0], p.points[1]})
      for (const double x : vector) w.value(x);
    w.end_array();
  }
  w.end_array().end_object();
}

void write_json(JsonWriter& w, const MeasuredPoints& m) {
  w.begin_object().member("count", m.count).member("inside", m.inside).member("on_surface", m.on_surface);
  w.member("has_sides", m.has_sides).key("smallest").begin_array();
  for (const MeasuredPoints::Point& p : m.smallest) {
    w.begin_array().value(p.number).value(p.face.value()).value(p.lower).value(p.upper);
    for (const std::array<double, 3>& point : p.points)
      for (const double x : point) w.value(x);
    w.end_array();
  }
  w.end_array().end_object();
}

void write_answer(JsonWriter& w, const MeasuredApproach& m) {
  w.member("outcome", name_of(m.outcome)).member("t0", m.t0).member("t1", m.t1);
  if (!m.step || !m.length) return;
  w.key("step");
  write_array(w, *m.step);
  w.key("length");
  write_array(w, *m.length);
}

void write_json(JsonWriter& w, const MeasuredApproach& m) {
  w.begin_object();
  write_answer(w, m);
  write_history(w, m.history);
  w.end_object();
}

void write_json(JsonWriter& w, const EngineReport& r) {
  w.begin_object().member("query", name_of(r.query)).member("verdict", name_of(r.verdict));
  w.member("pairs", r.pairs).member("complete", r.complete).member("thread", r.thread);
  w.member("begin_ns", r.begin_ns).member("duration_ns", r.duration_ns);
  const auto write = [&](const char* key, const std::vector<EngineReport::Mark>& marks, bool with_value) {
    if (marks.empty()) return;
    w.key(key).begin_array();
    for (const EngineReport::Mark& mark : marks) {
      w.begin_array().value(mark.name).value(mark.at);
      if (with_value) w.value(mark.value);
      w.end_array();
    }
    w.end_array();
  };
  write("counts", r.counts, true);
  write("phases", r.phases, false);
  w.end_object();
}

void write_json(JsonWriter& w, const Pose& pose) {
  w.begin_array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) w.value(pose.r(row, column));
    w.value(pose.t(row));
  }
  w.end_array();
}

void write_answer(JsonWriter& w, const StepResult& result, const CollideRequest& request) {
  write_members(w, result, request.is_coarse());
}

void write_scenario(JsonWriter& w, const TraceHeader& header) {
  w.begin_object().member("name", header.scenario).member("hash", to_hex(header.scenario_hash)).end_object();
}

void write_event_counts(JsonWriter& w, const Trace& trace) {
  w.begin_object();
  w.member("stored", std::uint64_t{trace.events.size()}).member("seen", trace.events_seen);
  w.member("cap", trace.header.event_cap).member("truncated", trace.truncated());
  w.end_object();
}

namespace {

void write_step(JsonWriter& w, const Step& s, const TraceHeader& header) {
  w.begin_object();
  w.member("index", s.index).member("first_event", s.first_event).member("events_seen", s.events_seen);
  w.key("pose_a");
  write_json(w, s.pose_a);
  if (header.bodies.size() > 1) {
    w.key("pose_b");
    write_json(w, s.pose_b);
  }
  if (s.finished) {
    w.key("result").begin_object();
    write_answer(w, s.result, header.request);
    w.end_object();
  }
  w.end_object();
}

/// Returns true if a trace can have events of a kind.
bool is_reported(EventKind kind, const TraceHeader& header) {
  if (kind <= EventKind::result) return true;
  return kind < EventKind::pass ? header.level != EventLevel::faces : header.construction;
}

void write_totals(JsonWriter& w, const Trace& t) {
  std::array<std::uint64_t, kEventKinds> totals{};
  for (const Event& e : t.events) ++totals[static_cast<std::size_t>(e.kind)];
  w.begin_object();
  for (std::size_t k = 0; k < kEventKinds; ++k)
    if (is_reported(static_cast<EventKind>(k), t.header))
      w.member(name_of(static_cast<EventKind>(k)), totals[k]);
  w.end_object();
}

}  // namespace

void write_metadata(const Trace& trace, JsonOut& out) {
  constexpr std::uint32_t kVersionWithoutReports = 3, kVersionOfReports = 4;
  const TraceHeader& h = trace.header;
  JsonWriter w(out, 2);
  w.begin_object();
  const std::uint32_t version = !trace.patch_vertices.empty() ? kTraceVersion
                                : trace.has_engine_reports()  ? kVersionOfReports
                                                              : kVersionWithoutReports;
  w.member("format", kTraceFormat).member("version", version).member("lrbscope", h.lrbscope);
  w.key("scenario");
  write_scenario(w, h);
  w.member("clock", name_of(h.clock));
  if (h.level != EventLevel::faces) w.member("level", name_of(h.level));
  if (!h.engine.empty()) w.member("engine", h.engine);
  if (!h.names.empty()) {
    w.key("names");
    write_array(w, h.names);
  }
  if (h.coherent) w.member("coherent", true);
  if (h.construction) w.member("construction", true);
  if (!h.pictures.empty()) w.key("pictures").json(h.pictures);
  if (h.first_contact) {
    w.key("first_contact");
    write_json(w, *h.first_contact);
  }
  w.key("events");
  write_event_counts(w, trace);
  w.key("totals");
  write_totals(w, trace);
  w.key("request");
  write_json(w, h.request);
  w.key("bodies").begin_array();
  for (const BodyInfo& b : h.bodies) write_json(w, b);
  w.end_array();
  w.key("steps").begin_array();
  for (const Step& s : trace.steps) write_step(w, s, h);
  w.end_array();
  w.end_object();
}

}  // namespace lrb::trace
