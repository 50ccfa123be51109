#include "scenarios/crowd/crowd_pairs.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <type_traits>

#include "trace/trace_json_parts.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/record_fields.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::crowd {

std::vector<PairHistory> pair_histories(const CrowdRun& run) {
  std::map<BodyPair, PairHistory> of;
  for (std::uint32_t step = 0; step < run.steps.size(); ++step)
    for (const CrowdQuery& q : run.steps[step].queries) {
      PairHistory& p = of[q.bodies];
      p.bodies = q.bodies;
      p.face_tests += q.result.counters.face_tests;
      if (!q.meets()) continue;
      if (p.steps++ == 0) p.first = step;
      if (q.result.pair_count >= p.most_pairs) p.most_pairs = q.result.pair_count, p.at = step;
    }
  std::vector<PairHistory> out;
  for (const auto& [bodies, history] : of) out.push_back(history);
  std::ranges::stable_sort(
      out, [](const PairHistory& x, const PairHistory& y) { return x.face_tests > y.face_tests; });
  return out;
}

std::string pair_table(const CrowdRun& run, std::size_t most) {
  const std::vector<PairHistory> pairs = pair_histories(run);
  std::vector<std::array<std::string, 6>> rows = {
      {"A", "B", "face tests", "steps in contact", "most pairs of faces", "at step"}};
  for (std::size_t i = 0; i < std::min(pairs.size(), most); ++i) {
    const PairHistory& p = pairs[i];
    const bool meets = p.steps > 0;
    rows.push_back({run.names[p.bodies.i], run.names[p.bodies.j], std::to_string(p.face_tests),
                    std::to_string(p.steps), meets ? std::to_string(p.most_pairs) : "",
                    meets ? std::to_string(p.at) : ""});
  }
  std::array<std::size_t, 6> widths{};
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  std::string out;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string space(widths[c] - row[c].size(), ' ');
      line += (c == 0 ? "" : "  ") + (c < 2 ? row[c] + space : space + row[c]);  // names left, numbers right
    }
    out += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  if (pairs.size() > most)
    out += "and " + render::counted(pairs.size() - most, "more pair", "more pairs") + "; --json lists all\n";
  return out;
}

namespace {

/// Returns a time with a unit in which it is at least 1, if it is at least a microsecond: "1.6 ms".
std::string time_text(double microseconds) {
  constexpr double kThousand = 1000;
  double value = microseconds;
  const char* unit = " us";
  for (const char* longer : {" ms", " s"}) {
    if (value < kThousand) break;
    value /= kThousand;
    unit = longer;
  }
  return render::short_number(value) + unit;
}

}  // namespace

std::string crowd_speed(const CrowdRun& run) {
  std::vector<double> broad_phases, queries;
  for (const CrowdStep& s : run.steps) {
    broad_phases.push_back(static_cast<double>(s.broad_phase_ns) / 1000);
    queries.push_back(static_cast<double>(s.queries_ns) / 1000);
  }
  const auto median_text = [](std::vector<double>& x) {
    const auto median = x.begin() + static_cast<std::ptrdiff_t>(x.size() / 2);
    std::nth_element(x.begin(), median, x.end());
    return time_text(*median);
  };
  return "a step takes (medians): broad phase " + median_text(broad_phases) + ", queries " +
         median_text(queries) + ", on " + std::to_string(run.threads) +
         (run.threads == 1 ? " thread" : " threads");
}

namespace {

using trace::JsonWriter;

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
  return static_cast<std::size_t>(std::ranges::count_if(
      step.queries, [relation](const CrowdQuery& q) { return q.result.relation == relation; }));
}

std::size_t bodies_in_contact(const CrowdStep& step, std::size_t bodies) {
  std::vector<bool> in(bodies);
  for (const CrowdQuery& q : step.queries)
    if (q.meets()) in[q.bodies.i] = in[q.bodies.j] = true;
  return static_cast<std::size_t>(std::ranges::count(in, true));
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
  const auto kept = std::ranges::count_if(step.queries, [](const CrowdQuery& q) { return q.is_kept; });
  if (kept > 0) w.member("kept_answers", static_cast<std::uint64_t>(kept));
  write_relations(w, step);
  w.member("bodies_in_contact", std::uint64_t{bodies_in_contact(step, bodies)});
  w.member("pairs_of_faces", pairs_of_faces(step)).member("fingerprint", trace::to_hex(fingerprint_of(step)));
  w.key("counters");
  trace::write_json(w, sum(step));
  w.key("queries").begin_array();
  for (const CrowdQuery& q : step.queries) {
    w.begin_object().member("a", q.bodies.i).member("b", q.bodies.j);
    w.member("relation", trace::name_of(q.result.relation)).member("pairs", q.result.pair_count);
    w.member("fingerprint", trace::to_hex(q.result.fingerprint));
    if (q.result.distance) {
      w.key("distance");
      trace::write_json(w, *q.result.distance);
    }
    if (q.result.clash) {
      w.key("clash");
      trace::write_json(w, *q.result.clash);
    }
    if (q.result.near) {
      w.key("near").begin_object();
      w.member("within", q.result.near->within).member("pairs", q.result.near->found).end_object();
    }
    w.end_object();
  }
  w.end_array().end_object();
}

/// Writes the pairs of bodies that were queried, those with most face tests first.
void write_pairs(JsonWriter& w, const CrowdRun& run) {
  w.key("pairs_by_cost").begin_array();
  for (const PairHistory& p : pair_histories(run)) {
    w.begin_object().member("a", p.bodies.i).member("b", p.bodies.j).member("face_tests", p.face_tests);
    w.member("steps_in_contact", p.steps);
    if (p.steps > 0)
      w.member("first_step", p.first).member("most_pairs", p.most_pairs).member("at_step", p.at);
    w.end_object();
  }
  w.end_array();
}

}  // namespace

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
    w.member("names", run.names);
    write_pairs(w, run);
    w.key("steps").begin_array();
    for (std::size_t i = 0; i < run.steps.size(); ++i) write_step(w, run.steps[i], i, n);
    w.end_array().end_object();
  });
}

namespace {

std::uint32_t find_body(const std::vector<std::string>& names, const std::string& name,
                        const std::string& crowd) {
  const auto at = std::ranges::find(names, name);
  if (at == names.end())
    throw InputError("--pair: " + crowd + " has no body " + printable_name(name) +
                     "; its bodies are named by kind and number, from " + names.front() + " to " +
                     names.back());
  return static_cast<std::uint32_t>(at - names.begin());
}

}  // namespace

BodyPair find_pair(const spec::Crowd& crowd, const std::string& names) {
  const std::size_t comma = names.find(',');
  if (comma == std::string::npos || names.find(',', comma + 1) != std::string::npos)
    throw InputError("--pair: expected the names of two bodies, such as \"gear 3,rock 5\", found " +
                     printable_name(names));
  const std::vector<std::string> all = body_names(crowd);
  const std::uint32_t i = find_body(all, names.substr(0, comma), crowd.name);
  const std::uint32_t j = find_body(all, names.substr(comma + 1), crowd.name);
  if (i == j) throw InputError("--pair: expected two bodies, found " + all[i] + " twice");
  return {std::min(i, j), std::max(i, j)};
}

spec::Scenario scenario_of_pair(const spec::Crowd& crowd, const CrowdMotion& motion, const BodyPair& pair) {
  spec::Scenario s;
  const std::vector<std::string> names = body_names(crowd);
  s.name = crowd.name + "-" + names[pair.i] + "-" + names[pair.j];
  std::replace(s.name.begin(), s.name.end(), ' ', '_');
  s.purpose = names[pair.i] + " (A) and " + names[pair.j] + " (B) of the crowd " + crowd.name + ".";
  Fnv64 hash;
  hash.add_value(crowd.hash);
  for (const std::uint32_t body : {pair.i, pair.j}) {
    hash.add_value(body);
    s.bodies.push_back(crowd.kinds[motion.kind(body)].body);
    s.bodies.back().pose = {};  // the poses of the motion contain it
    std::vector<Pose>& poses = body == pair.i ? s.motion.of_a : s.motion.poses;
    for (std::uint32_t step = 0; step < crowd.steps; ++step) poses.push_back(motion.pose(body, step));
  }
  s.hash = hash.value();
  s.motion.kind = spec::Motion::Kind::poses;
  s.request = crowd.request;
  s.more = crowd.more;
  s.request.contacts = s.request.mode == Mode::all_pairs;
  return s;
}

}  // namespace lrb::crowd
