#include "trace/json_parts.hpp"

namespace lrb::trace {

void write_json(JsonWriter& w, const BodyInfo& b) {
  w.begin_object();
  w.member("name", b.name).member("source", b.source).member("hash", to_hex(b.hash));
  w.member("dim", b.dim).member("closed", b.closed);
  w.member("real_faces", b.real_faces).member("total_faces", b.total_faces);
  w.member("outer_faces", b.outer_faces).member("regions", b.regions).member("layers", b.layers);
  w.member("real_simplices", b.real_simplices).member("simplices", b.simplices);
  w.end_object();
}

void write_json(JsonWriter& w, const Counters& c) {
  w.begin_object();
  w.member("face_tests", c.face_tests).member("real_tests", c.real_tests);
  w.member("exact_fallbacks", c.exact_fallbacks).member("node_pairs", c.node_pairs);
  w.member("box_tests", c.box_tests).member("prefilter_tests", c.prefilter_tests);
  w.member("refinements", c.refinements).member("regions_opened", c.regions_opened);
  w.key("face_tests_by_level").begin_array();
  for (const std::uint32_t n : c.face_tests_by_level) w.value(n);
  w.end_array().end_object();
}

void write_json(JsonWriter& w, const CollideRequest& r) {
  w.begin_object();
  w.member("mode", name_of(r.mode)).member("recursion", name_of(r.recursion));
  w.member("predicates", name_of(r.predicates)).member("wrapper", name_of(r.wrapper));
  w.member("contacts", r.contacts).member("interiors_overlap", r.interiors_overlap);
  w.end_object();
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

}  // namespace lrb::trace
