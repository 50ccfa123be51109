#include "trace/trace_json_parts.hpp"

#include <array>
#include <type_traits>
#include <vector>

#include "trace/json_read.hpp"
#include "trace/measured_json.hpp"
#include <lrbscope/trace/record_fields.hpp>

namespace lrb::trace {

namespace {

/// Writes the members of a record.
class MemberWriter {
 public:
  explicit MemberWriter(JsonWriter& w) : w_(w) {}

  /// Writes nothing for an empty std::optional.
  template <class T>
  void member(const char* key, const T& value, Values values = {}) {
    if constexpr (kIsOptional<T>) {
      if (value) member(key, *value, values);
    } else if constexpr (std::is_enum_v<T>) {
      w_.member(key, name_of(value));
    } else {
      w_.member(key, value);
    }
  }
  template <class T>
  void member_unless(const T& usual, const char* key, const T& value) {
    if (value != usual) member(key, value);
  }
  template <class Row, class Visit>
  void rows(const char* key, const std::vector<Row>& rows, std::size_t, const char*, const Visit& visit) {
    w_.key(key).begin_array();
    for (const Row& row : rows) {
      w_.begin_array();
      visit(*this, row);
      w_.end_array();
    }
    w_.end_array();
  }
  template <class Row, class Visit>
  void rows_if_any(const char* key, const std::vector<Row>& all, std::size_t columns, const char* what,
                   const Visit& visit) {
    if (!all.empty()) rows(key, all, columns, what, visit);
  }
  /// Writes one value of a row, or several.
  template <class T>
  void cell(const T& value, Values = {}) {
    if constexpr (std::ranges::range<T>)
      for (const auto& x : value) cell(x);
    else
      w_.value(value);
  }

 private:
  JsonWriter& w_;
};

template <class T>
void write_value(JsonWriter& w, const T& value, Form form) {
  if constexpr (kIsOptional<T>)
    write_json(w, value.value());
  else if constexpr (std::is_enum_v<T>)
    w.value(name_of(value));
  else if constexpr (std::is_same_v<T, std::uint64_t>)
    form == Form::hash ? w.value(to_hex(value)) : w.value(value);
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
  w.begin_object().member("faces", separation.face_count).member("refined", separation.refined).end_object();
}

void write_history(JsonWriter& w, const std::vector<Bounds>& all) {
  MemberWriter io(w);
  history(io, all);
}

void write_history(JsonWriter& w, const std::vector<ContactBounds>& all) {
  MemberWriter io(w);
  history(io, all);
}

void write_answer(JsonWriter& w, const MeasuredApproach& m) {
  MemberWriter io(w);
  answer_members(io, m);
}

template <class Measured>
void write_json(JsonWriter& w, const Measured& m) {
  MemberWriter io(w);
  w.begin_object();
  members(io, m);
  w.end_object();
}
template void write_json(JsonWriter&, const MeasuredDistance&);
template void write_json(JsonWriter&, const MeasuredClash&);

void write_json(JsonWriter& w, const Pose& pose) {
  w.value(io::rows_of(pose));
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
  if (!h.names.empty()) w.member("names", h.names);
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
