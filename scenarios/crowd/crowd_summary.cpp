#include <algorithm>
#include <type_traits>
#include <vector>

#include "engine/core/fnv.hpp"
#include "scenarios/crowd/crowd_json.hpp"
#include "trace/hex.hpp"
#include "trace/json_parts.hpp"
#include "trace/names.hpp"
#include "trace/record_fields.hpp"

namespace lrb::crowd {
namespace {

using trace::JsonWriter;

std::uint64_t pairs_of_faces(const CrowdStep& step) {
  std::uint64_t n = 0;
  for (const CrowdQuery& q : step.queries) n += q.result.pair_count;
  return n;
}

/// Returns a hash of all answers of a step: bodies, relation and fingerprint of each.
std::uint64_t fingerprint_of(const CrowdStep& step) {
  Fnv64 h;
  for (const CrowdQuery& q : step.queries) {
    h.add_value(q.bodies.i);
    h.add_value(q.bodies.j);
    h.add_value(static_cast<std::uint32_t>(q.result.relation));
    h.add_value(q.result.fingerprint);
  }
  return h.value();
}

void write_relations(JsonWriter& w, const CrowdStep& step) {
  w.key("relations").begin_object();
  for (const Relation r : {Relation::separate, Relation::crossing, Relation::touching, Relation::a_inside_b,
                           Relation::b_inside_a, Relation::undefined})
    w.member(trace::name_of(r), std::uint64_t{count(step, r)});
  w.end_object();
}

void write_step(JsonWriter& w, const CrowdStep& step, std::size_t index, std::size_t bodies) {
  w.begin_object().member("index", std::uint64_t{index});
  w.key("broad_phase").begin_object();
  w.member("box_tests", step.broad_phase.box_tests).member("swaps", step.broad_phase.swaps);
  w.member("sorted_afresh", step.broad_phase.sorted_afresh);
  w.member("pairs", std::uint64_t{step.queries.size()}).end_object();
  write_relations(w, step);
  w.member("bodies_in_contact", std::uint64_t{bodies_in_contact(step, bodies)});
  w.member("pairs_of_faces", pairs_of_faces(step)).member("fingerprint", trace::to_hex(fingerprint_of(step)));
  w.key("counters");
  trace::write_json(w, sum(step));
  w.key("queries").begin_array();
  for (const CrowdQuery& q : step.queries) {
    w.begin_object().member("a", q.bodies.i).member("b", q.bodies.j);
    w.member("relation", trace::name_of(q.result.relation)).member("pairs", q.result.pair_count);
    w.member("fingerprint", trace::to_hex(q.result.fingerprint)).end_object();
  }
  w.end_array().end_object();
}

}  // namespace

void write_kinds(JsonWriter& w, const spec::Crowd& crowd, const CrowdRun& run) {
  w.key("kinds").begin_array();
  for (std::size_t k = 0; k < run.kinds.size(); ++k) {
    const spec::BodySpec& spec = crowd.kinds[k].body;
    w.begin_object().member("name", crowd.kinds[k].name).member("count", crowd.kinds[k].count).key("body");
    trace::write_json(w, trace::describe_body(run.kinds[k].rep,
                                              spec.file.empty() ? "generator " + spec.generator : spec.file));
    w.end_object();
  }
  w.end_array();
}

std::size_t count(const CrowdStep& step, Relation relation) {
  return static_cast<std::size_t>(
      std::count_if(step.queries.begin(), step.queries.end(),
                    [relation](const CrowdQuery& q) { return q.result.relation == relation; }));
}

std::size_t bodies_in_contact(const CrowdStep& step, std::size_t bodies) {
  std::vector<bool> in(bodies);
  for (const CrowdQuery& q : step.queries)
    if (q.meets()) in[q.bodies.i] = in[q.bodies.j] = true;
  return static_cast<std::size_t>(std::count(in.begin(), in.end(), true));
}

Counters sum(const CrowdStep& step) {
  Counters all;
  for (const CrowdQuery& q : step.queries) {
    for_each_field<Counters>([&](const auto& field) {
      if constexpr (std::is_same_v<decltype(field.member), std::uint64_t Counters::*>)
        all.*field.member += q.result.counters.*field.member;
    });
  }
  return all;
}

std::string crowd_summary(const spec::Crowd& crowd, const CrowdRun& run) {
  return trace::json_text(2, [&](JsonWriter& w) {
    const std::uint64_t n = run.motion.body_count();
    w.begin_object().member("lrbscope", trace::lrbscope_version());
    w.key("crowd").begin_object();
    w.member("name", crowd.name).member("hash", trace::to_hex(crowd.hash)).end_object();
    w.key("request");
    trace::write_json(w, crowd.request);
    w.member("bodies", n).member("pairs_of_bodies", n * (n - 1) / 2);
    write_kinds(w, crowd, run);
    w.key("names").begin_array();
    for (const std::string& name : run.names) w.value(name);
    w.end_array().key("steps").begin_array();
    for (std::size_t i = 0; i < run.steps.size(); ++i) write_step(w, run.steps[i], i, n);
    w.end_array().end_object();
  });
}

std::string crowd_timing(const CrowdRun& run) {
  return trace::json_text(2, [&](JsonWriter& w) {
    w.begin_object().member("threads", run.threads).member("unit", "ns").key("steps").begin_array();
    for (const CrowdStep& s : run.steps) {
      w.begin_object().member("broad_phase", s.broad_phase_ns).member("queries", s.queries_ns).end_object();
    }
    w.end_array().end_object();
  });
}

}  // namespace lrb::crowd
