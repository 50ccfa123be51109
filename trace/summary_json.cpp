#include "trace/summary_json.hpp"

#include <string_view>
#include <utility>

#include "trace/counters.hpp"
#include "trace/json_out.hpp"
#include "trace/json_parts.hpp"
#include "trace/work_shares.hpp"

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
  w.key("edges").begin_array();
  for (const double edge : h.edges) w.value(edge);
  w.end_array().key("counts").begin_array();
  for (const std::uint64_t count : h.counts) w.value(count);
  w.end_array().end_object();
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

}  // namespace

std::string summary_json(const Trace& trace) {
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
  w.key("steps").begin_array();
  for (std::size_t i = 0; i < trace.steps.size(); ++i) write_step(w, trace, i);
  w.end_array().key("totals");
  write_totals(w, count_events(trace.events));
  if (trace.header.level != EventLevel::faces) write_work(w, trace);
  write_statistics(w, trace);
  w.key("histograms").begin_array();
  for (const Histogram& h : {tests_by_depth(trace), refinements_by_size(trace), steps_by_tests(trace)})
    write_histogram(w, h);
  w.end_array().end_object();
  out.raw('\n');
  out.flush();
  return std::move(sink.text);
}

}  // namespace lrb::trace
