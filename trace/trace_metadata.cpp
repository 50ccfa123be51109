#include "trace/trace_metadata.hpp"

#include <array>

#include "trace/json_parts.hpp"

namespace lrb::trace {

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
bool is_told(EventKind kind, const TraceHeader& header) {
  if (kind <= EventKind::result) return true;
  return kind < EventKind::pass ? header.level != EventLevel::faces : header.construction;
}

void write_totals(JsonWriter& w, const Trace& t) {
  std::array<std::uint64_t, kEventKinds> totals{};
  for (const Event& e : t.events) ++totals[static_cast<std::size_t>(e.kind)];
  w.begin_object();
  for (std::size_t k = 0; k < kEventKinds; ++k)
    if (is_told(static_cast<EventKind>(k), t.header)) w.member(name_of(static_cast<EventKind>(k)), totals[k]);
  w.end_object();
}

}  // namespace

void write_metadata(const Trace& trace, JsonOut& out) {
  const TraceHeader& h = trace.header;
  JsonWriter w(out, 2);
  w.begin_object();
  w.member("format", kTraceFormat).member("version", kTraceVersion).member("lrbscope", h.lrbscope);
  w.key("scenario");
  write_scenario(w, h);
  w.member("clock", name_of(h.clock));
  if (h.level != EventLevel::faces) w.member("level", name_of(h.level));
  if (!h.engine.empty()) w.member("engine", h.engine);
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
