#include <utility>
#include <vector>

#include "trace/trace_json_parts.hpp"
#include <lrbscope/obb_tree.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace_json.hpp>
#include <lrbscope/trace/work.hpp>
#include <lrbscope/validate.hpp>

namespace lrb::trace {

namespace {

void write_totals(JsonWriter& w, const Totals& t) {
  w.begin_object();
  w.member("events", t.events).member("face_tests", t.face_tests).member("hits", t.hits);
  w.member("crossings", t.crossings).member("contacts", t.contacts);
  w.member("refinements_a", t.refinements[0]).member("refinements_b", t.refinements[1]);
  w.member("coarsenings_a", t.coarsenings[0]).member("coarsenings_b", t.coarsenings[1]);
  w.member("faces_added", t.faces_added).end_object();
}

void write_step(JsonWriter& w, const Trace& trace, std::size_t i) {
  const Step& step = trace.steps[i];
  w.begin_object().member("index", step.index);
  if (step.finished) write_answer(w, step.result, trace.header.request);
  w.key("events");
  write_totals(w, count_events(trace.events_of(i)));
  w.end_object();
}

void write_statistics(JsonWriter& w, const Trace& trace) {
  w.key("statistics").begin_array();
  for (const Statistic& s : statistics(trace))
    w.begin_object()
        .member("name", s.name)
        .member("value", s.value)
        .member("unit", s.unit)
        .member("description", s.description)
        .end_object();
  w.end_array();
}

void write_histogram(JsonWriter& w, const Histogram& h) {
  w.begin_object().member("name", h.name).member("unit", h.unit).member("description", h.description);
  w.member("edges", h.edges).member("counts", h.counts).end_object();
}

void write_work(JsonWriter& w, const Trace& trace) {
  w.key("work").begin_array();
  for (const WorkShare& s : work_shares(trace)) {
    w.begin_object()
        .member("part", s.name)
        .member("events", s.events)
        .member("count", s.count)
        .member("of", s.what);
    if (s.box_tests > 0) w.member("box_tests", s.box_tests);
    if (trace.header.clock == Clock::wall) w.member("seconds", s.seconds);
    w.end_object();
  }
  w.end_array();
}

void write_caps(JsonWriter& w, const std::array<std::uint32_t, kEnumNames<CapVerdict>.size()>& caps) {
  w.begin_object();
  for (std::size_t v = 1; v < caps.size(); ++v)
    if (caps[v] > 0) w.member(name_of(static_cast<CapVerdict>(v)), caps[v]);
  w.end_object();
}

void write_pass(JsonWriter& w, const PassSummary& p) {
  w.begin_object().member("stage", name_of(p.stage));
  if (p.regions > 0) w.member("layer", p.layer);
  if (p.max_deviation > 0) w.member("distance_allowed", p.max_deviation);
  w.member("faces_before", p.faces_before).member("faces_after", p.faces_after);
  w.member("regions", p.regions).member("pieces_merged", p.merged);
  w.member("patches", p.patches).member("accepted", p.accepted()).member("retried", p.retried);
  w.key("refused");
  write_caps(w, p.caps);
  w.member("lids", p.lids).member("faces_covered", p.covered);
  if (p.deviation > 0) w.member("distance", p.deviation);
  w.member("faces_barred", p.excluded).member("vertices_without_patch", p.no_patch);
  w.member("vertices_that_wait", p.waiting).member("given_up", p.given_up).end_object();
}

void write_construction(JsonWriter& w, const Trace& trace) {
  const std::vector<PassSummary> passes = passes_of(trace);
  const auto caps = caps_of(passes);
  std::uint64_t patches = 0, regions = 0;
  for (const PassSummary& p : passes) patches += p.patches, regions += p.regions;
  w.key("construction").begin_object();
  w.member("patches", patches).member("accepted", caps[0]).member("regions", regions);
  w.key("refused");
  write_caps(w, caps);
  w.key("passes").begin_array();
  for (const PassSummary& p : passes) write_pass(w, p);
  w.end_array().end_object();
}

/// Writes the statistics of queries.
void write_queries(JsonWriter& w, const Trace& trace) {
  w.key("steps").begin_array();
  for (std::size_t i = 0; i < trace.steps.size(); ++i) write_step(w, trace, i);
  w.end_array().key("totals");
  write_totals(w, count_events(trace.events));
  if (trace.header.level != EventLevel::faces) write_work(w, trace);
  write_statistics(w, trace);
  w.key("histograms").begin_array();
  for (const Histogram& h : {tests_by_depth(trace), refinements_by_size(trace), steps_by_tests(trace)})
    write_histogram(w, h);
  w.end_array();
}

void write_quality(JsonWriter& w, const LrbRep& rep) {
  const TreeQuality q = tree_quality(rep.tree());
  w.begin_object().member("body", rep.name()).key("tree").begin_object();
  w.member("nodes", q.nodes).member("height", q.height);
  w.member("inner_nodes_a_line_visits", q.sah_inner).member("leaves_a_line_visits", q.sah_leaves);
  w.member("child_fill", q.child_fill).member("leaf_fill", q.leaf_fill);
  w.member("sibling_overlap", q.sibling_overlap).member("bytes_per_simplex", q.bytes_per_simplex);
  w.end_object().key("lrb").begin_object();
  w.member("faces_per_real_face", static_cast<double>(rep.face_count()) / rep.real_face_count());
  w.member("regions", rep.region_count()).member("layers", rep.layer_count());
  w.member("outer_faces", rep.outermost_faces().size()).member("lid_height", lid_height(rep));
  w.end_object().end_object();
}

void write_depths(JsonWriter& w, const std::vector<DepthWork>& depths) {
  w.begin_array();
  for (const DepthWork& d : depths) {
    w.begin_object().member("nodes", d.nodes).member("expected", d.expected);
    w.member("visited", d.nodes_visited).member("visits", d.visits).member("ended", d.ended);
    w.member("box_tests", d.box_tests).end_object();
  }
  w.end_array();
}

/// Writes the statistics of the bodies, which are not in the trace.
void write_bodies(JsonWriter& w, const Trace& trace, std::span<const SummaryBody> bodies) {
  if (bodies.empty()) return;
  w.key("quality").begin_array();
  for (const SummaryBody& body : bodies) write_quality(w, *body.rep);
  w.end_array();
  if (bodies.size() != 2 || bodies[0].walked == nullptr || bodies[1].walked == nullptr) return;
  w.key("walk_by_depth").begin_object();
  for (const Side side : {Side::a, Side::b}) {
    const TreeShape& tree = *bodies[static_cast<std::size_t>(side)].walked;
    w.key(name_of(side));
    write_depths(w, work_by_depth(tree, count_nodes(tree, side, trace.events)));
  }
  w.end_object();
}

}  // namespace

std::string summary_json(const Trace& trace, std::span<const SummaryBody> bodies) {
  StringSink sink;
  JsonOut out(sink);
  JsonWriter w(out, 2);
  w.begin_object().member("lrbscope", trace.header.lrbscope);
  w.key("scenario");
  write_scenario(w, trace.header);
  w.key("request");
  write_json(w, trace.header.request);
  w.key("bodies").begin_array();
  for (const BodyInfo& body : trace.header.bodies) write_json(w, body);
  w.end_array().key("events");
  write_event_counts(w, trace);
  if (trace.header.first_contact) {
    w.key("first_contact").begin_object();
    write_answer(w, *trace.header.first_contact);
    w.end_object();
  }
  if (trace.header.construction)
    write_construction(w, trace);
  else
    write_queries(w, trace);
  write_bodies(w, trace, bodies);
  w.end_object();
  out.raw('\n');
  out.flush();
  return std::move(sink.text);
}

}  // namespace lrb::trace
