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
  if (r.tolerance > 0) w.member("tolerance", r.tolerance);
  if (r.max_tests > 0) w.member("max_tests", r.max_tests);
  if (r.max_time > 0) w.member("max_time", r.max_time);
  if (r.separation) w.member("separation", true);
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

void write_answer(JsonWriter& w, const StepResult& r, const CollideRequest& request) {
  w.member("relation", name_of(r.relation)).member("interiors_overlap", name_of(r.interiors_overlap));
  w.member("pairs", r.pair_count).member("fingerprint", to_hex(r.fingerprint));
  if (request.is_coarse()) w.member("error_bound", r.error_bound).member("finished", r.finished);
  if (r.separation) {
    w.key("separation").begin_object().key("faces").begin_array();
    for (const std::uint32_t faces : r.separation->face_count) w.value(faces);
    w.end_array().key("refined").begin_array();
    for (const std::vector<RegionId>& regions : r.separation->refined) {
      w.begin_array();
      for (const RegionId region : regions) w.value(region);
      w.end_array();
    }
    w.end_array().end_object();
  }
  w.key("counters");
  write_json(w, r.counters);
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
