#include "scenarios/crowd/crowd_report.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <type_traits>
#include <vector>

#include "render/pictures/marks.hpp"
#include "scenarios/crowd/crowd_frames.hpp"
#include "scenarios/crowd/crowd_trace.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/document.hpp"
#include "scenarios/run/run_page.hpp"
#include "trace/trace_json_parts.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/record_fields.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::crowd {
namespace {

class FileSink final : public trace::ByteSink {
 public:
  explicit FileSink(const std::string& path) : file_(path) {}
  void write(std::string_view bytes) override { file_.write(bytes); }
  void commit() { file_.commit(); }

 private:
  AtomicFile file_;
};

/// The queries of two bodies over all steps.
struct PairHistory {
  BodyPair bodies{0, 0};
  std::uint32_t first = 0, steps = 0;      ///< the first step at which they intersect, and the number of them
  std::uint64_t most_pairs = 0;            ///< of faces at a step
  std::uint32_t at = 0;                    ///< that step
  std::uint64_t face_tests = 0;            ///< sum over all steps
  Relation relation = Relation::separate;  ///< at the last step at which they intersect, or at the last step
  const trace::StepResult* last = nullptr;  ///< of the last step at which they intersect
  // If they were measured: the answers with the smallest distance, the largest depth and most near pairs.
  const trace::StepResult *nearest = nullptr, *deepest = nullptr, *nearby = nullptr;
};

double depth_of(const trace::StepResult& r) {
  return r.clash && r.clash->depth ? (*r.clash->depth)[0] : 0;
}

/// Remembers the extreme answers of two bodies.
void compare_measures(PairHistory& p, const trace::StepResult& r) {
  if (r.distance && (p.nearest == nullptr || r.distance->upper < p.nearest->distance->upper)) p.nearest = &r;
  if (r.clash && (p.deepest == nullptr || depth_of(r) > depth_of(*p.deepest))) p.deepest = &r;
  if (r.near && (p.nearby == nullptr || r.near->pairs > p.nearby->near->pairs)) p.nearby = &r;
}

/// Returns the pairs of bodies that were queried, those with most face tests first.
std::vector<PairHistory> pair_histories(const CrowdRun& run) {
  std::map<BodyPair, PairHistory> of;
  for (std::uint32_t step = 0; step < run.steps.size(); ++step)
    for (const CrowdQuery& q : run.steps[step].queries) {
      PairHistory& p = of[q.bodies];
      p.bodies = q.bodies;
      p.face_tests += q.result.counters.face_tests;
      compare_measures(p, q.result);
      if (p.steps == 0 || q.meets()) p.relation = q.result.relation;
      if (!q.meets()) continue;
      if (p.steps++ == 0) p.first = step;
      if (q.result.pair_count >= p.most_pairs) p.most_pairs = q.result.pair_count, p.at = step;
      p.last = &q.result;
    }
  std::vector<PairHistory> out;
  for (const auto& [bodies, history] : of) out.push_back(history);
  std::stable_sort(out.begin(), out.end(),
                   [](const PairHistory& x, const PairHistory& y) { return x.face_tests > y.face_tests; });
  return out;
}

/// Returns the mean of a count over the steps.
template <class Count>
std::string a_step(const CrowdRun& run, const Count& count) {
  std::uint64_t total = 0;
  for (const CrowdStep& s : run.steps) total += count(s);
  return render::short_number(static_cast<double>(total) / static_cast<double>(run.steps.size()));
}

std::size_t queried(const CrowdStep& s) {
  return s.queries.size();
}

std::size_t met(const CrowdStep& s) {
  return static_cast<std::size_t>(
      std::count_if(s.queries.begin(), s.queries.end(), [](const CrowdQuery& q) { return q.meets(); }));
}

void add_numbers(report::Document& doc, const spec::Crowd& crowd, const CrowdRun& run) {
  const std::uint64_t n = run.motion.body_count(), all = n * (n - 1) / 2;
  std::uint64_t faces = 0;
  for (std::uint32_t i = 0; i < n; ++i) faces += run.rep(i).real_face_count();
  doc.number({"Bodies", render::group_digits(n),
              "of " + render::counted(crowd.kinds.size(), "kind", "kinds") + ", " +
                  render::group_digits(faces) + " real faces"})
      .number({"Time steps", render::group_digits(run.steps.size())})
      .number({"Overlapping boxes", a_step(run, queried),
               "of " + render::group_digits(all) + " pairs of bodies, a step"})
      .number({"Intersecting bodies", a_step(run, met), "pairs a step"})
      .number(
          {"Face tests", a_step(run, [](const CrowdStep& s) { return sum(s).face_tests; }), "exact, a step"});
}

/// A curve over the steps. Steps without a value are left out.
struct Curve {
  const char* label;
  std::function<std::optional<double>(const CrowdStep&)> value;
};

void add_chart(report::Document& doc, const CrowdRun& run, const char* title, const char* y_label,
               const std::vector<Curve>& curves) {
  if (run.steps.size() < 2) return;
  report::Chart chart{title, {"time step"}, {y_label}, {}, {}, report::Cursor::step};
  for (const Curve& curve : curves) {
    report::Series s{curve.label, {}, {}};
    for (std::size_t i = 0; i < run.steps.size(); ++i) {
      const std::optional<double> y = curve.value(run.steps[i]);
      if (!y) continue;
      s.x.push_back(static_cast<double>(i));
      s.y.push_back(*y);
    }
    if (std::any_of(s.y.begin(), s.y.end(), [](double y) { return y > 0; })) chart.series.push_back(s);
  }
  if (!chart.series.empty()) doc.chart(chart);
}

/// Returns the smallest distance of the pairs that do not intersect (upper bounds).
std::optional<double> smallest_distance(const CrowdStep& step) {
  std::optional<double> least;
  for (const CrowdQuery& q : step.queries)
    if (const auto& d = q.result.distance; d && !d->solids_meet && !(least && *least <= d->upper))
      least = d->upper;
  return least;
}

/// Returns the largest depth (lower bounds).
std::optional<double> largest_depth(const CrowdStep& step) {
  double most = 0;
  for (const CrowdQuery& q : step.queries) most = std::max(most, depth_of(q.result));
  return most > 0 ? std::optional(most) : std::nullopt;
}

void add_charts(report::Document& doc, const CrowdRun& run) {
  using S = const CrowdStep&;
  const std::size_t n = run.motion.body_count();
  add_chart(doc, run, "Pairs of bodies by step", "pairs in the step",
            {{"overlapping boxes", [](S s) { return s.queries.size(); }},
             {"crossing", [](S s) { return count(s, Relation::crossing); }},
             {"touching", [](S s) { return count(s, Relation::touching); }},
             {"one inside the other",
              [](S s) { return count(s, Relation::a_inside_b) + count(s, Relation::b_inside_a); }},
             {"bodies in contact", [n](S s) { return bodies_in_contact(s, n); }}});
  add_chart(doc, run, "Smallest distance of separate bodies by step", "length",
            {{"smallest distance", smallest_distance}});
  add_chart(doc, run, "Largest penetration depth by step", "length", {{"largest depth", largest_depth}});
  add_chart(doc, run, "Work by step", "count",
            {{"face tests", [](S s) { return sum(s).face_tests; }},
             {"refinements", [](S s) { return sum(s).refinements; }}});
  add_chart(doc, run, "Broad phase by step", "count",
            {{"box tests", [](S s) { return s.broad_phase.box_tests; }},
             {"swaps in the order", [](S s) { return s.broad_phase.swaps; }}});
}

report::Table pair_table(const spec::Crowd& crowd, const CrowdRun& run) {
  constexpr std::size_t kMaxRows = 200;
  const spec::StepQuestions& more = crowd.more;
  const bool with_separate = more.distance || more.near;
  report::Table t{
      with_separate ? "Pairs of bodies that are near or intersect" : "Pairs of bodies that intersect",
      {"A", "B", "first step", "steps", "last relation"}};
  if (more.distance) t.columns.emplace_back("smallest distance");
  if (more.clash) t.columns.insert(t.columns.end(), {"largest depth", "contact kind there"});
  if (more.near) t.columns.emplace_back("most near pairs");
  t.columns.insert(t.columns.end(), {"most pairs of faces", "at step", "face tests in all steps",
                                     "fingerprint at the last of the steps"});
  std::vector<PairHistory> pairs = pair_histories(run);
  if (!with_separate) std::erase_if(pairs, [](const PairHistory& p) { return p.steps == 0; });
  for (std::size_t i = 0; i < std::min(pairs.size(), kMaxRows); ++i) {
    const PairHistory& p = pairs[i];
    const bool meets = p.steps > 0;
    t.targets.push_back("bodies " + std::to_string(meets ? p.at : 0) + " " + std::to_string(p.bodies.i) +
                        " " + std::to_string(p.bodies.j));
    std::vector<std::string>& row = t.rows.emplace_back();
    row = {run.names[p.bodies.i], run.names[p.bodies.j], meets ? std::to_string(p.first) : "",
           render::group_digits(p.steps), io::in_words(name_of(p.relation))};
    if (more.distance)
      row.push_back(run::interval_text(p.nearest->distance->lower, p.nearest->distance->upper));
    if (more.clash) {
      const trace::MeasuredClash& clash = *p.deepest->clash;
      row.push_back(clash.depth ? run::interval_text((*clash.depth)[0], (*clash.depth)[1]) : "");
      row.push_back(run::kind_text(clash.kind, clash.reason));
    }
    if (more.near) row.push_back(render::group_digits(p.nearby->near->pairs));
    row.insert(row.end(),
               {render::group_digits(p.most_pairs), meets ? std::to_string(p.at) : "",
                render::group_digits(p.face_tests), meets ? trace::to_hex(p.last->fingerprint) : ""});
  }
  t.note =
      "The pairs with most face tests first. lrbscope crowd DIR --pair \"A,B\" records two bodies as a run of "
      "their own. ";
  t.note += more.near ? "Pairs with boxes farther apart than near pairs of faces may be are not queried."
                      : "Pairs with disjoint boxes are not queried: they have no point in common.";
  if (pairs.size() > kMaxRows)
    t.note += " " + std::to_string(pairs.size() - kMaxRows) + " more pairs are left out here.";
  return t;
}

report::Link trace_link(const spec::Crowd& crowd, const std::string& file) {
  return {file, std::string("queries on the tracks of their ") +
                    (crowd.clock == trace::Clock::event ? "bodies" : "threads") +
                    "; opens in ui.perfetto.dev"};
}

/// Returns the run in a few sentences: the bodies, the queries of a step, and the costliest pair.
std::string sentence_of(const CrowdRun& run) {
  std::string out = render::counted(run.motion.body_count(), "body", "bodies") + " in " +
                    render::counted(run.steps.size(), "step", "steps") + ": on average the boxes of " +
                    a_step(run, queried) + " pairs overlap in a step, and " + a_step(run, met) +
                    " pairs intersect.";
  if (const CostliestPair pair = costliest_pair(run); !pair.names.empty())
    out += " The pair with the " + pair.text + ".";
  return out;
}

/// `recorded`: the folder or trace of the run, for the command that records two of its bodies.
void write_pictures_and_page(const spec::Crowd& crowd, const CrowdRun& run, const report::Folder& folder,
                             const std::string& command, const std::vector<report::Link>& links,
                             const std::string& recorded, const run::ProgressReport& progress) {
  const std::vector<std::pair<std::string, std::string>> text = {
      {"Software", std::string("lrbscope ") + trace::lrbscope_version()},
      {"lrbscope:crowd", crowd.name},
      {"lrbscope:crowd_hash", trace::to_hex(crowd.hash)},
  };
  const run::DrawnFrames drawn = draw_crowd(crowd, run, folder, text, progress);
  progress("page", 0, 1);
  report::Document doc(crowd.name, crowd.purpose);
  doc.summary(sentence_of(run)).command(command);
  doc.each(links, &report::Document::link);
  add_numbers(doc, crowd, run);
  doc.crowd_view(crowd_scene_json(crowd, run, "lrbscope crowd " + io::shell_word(recorded) + " --pair"));
  doc.tab("Pairs").table(pair_table(crowd, run));
  doc.tab("Charts");
  add_charts(doc, run);
  doc.tab("Frames");
  // Frames may be smaller beside the 3D view, which not every browser shows.
  constexpr std::size_t kBesideView = 2'500'000;
  run::add_frames(doc, drawn, folder, kBesideView);
  doc.tab("").write(folder);
}

}  // namespace

std::string write_crowd(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                        const std::string& command, const run::ProgressReport& progress) {
  run::check_frame_size(crowd.frames);
  const report::Folder locked(folder);
  FileSink sink(folder + "/trace.json");
  write_crowd_trace(crowd, run, sink);
  sink.commit();
  const std::string summary = crowd_summary(crowd, run);
  io::write_text(folder + "/summary.json", summary);
  io::write_text(folder + "/timing.json", crowd_timing(run));
  for (std::size_t k = 0; k < run.kinds.size(); ++k)
    save_lrb(run.kinds[k].rep, folder + "/" + crowd.kinds[k].name + ".lrb");
  write_pictures_and_page(crowd, run, locked, command,
                          {trace_link(crowd, "trace.json"),
                           {"summary.json", "steps and answers, as JSON"},
                           {"timing.json", "times of the steps"}},
                          folder, progress);
  return summary;
}

void redraw_crowd(const spec::Crowd& crowd, const CrowdRun& run, const std::string& folder,
                  const std::string& command, const std::string& trace_file,
                  const run::ProgressReport& progress) {
  const std::string file = std::filesystem::relative(trace_file, folder).generic_string();
  write_pictures_and_page(crowd, run, folder, command, {trace_link(crowd, file)}, trace_file, progress);
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

CostliestPair costliest_pair(const CrowdRun& run) {
  const std::vector<PairHistory> pairs = pair_histories(run);
  if (pairs.empty()) return {};
  const PairHistory& p = pairs.front();
  const std::string &a = run.names[p.bodies.i], &b = run.names[p.bodies.j];
  CostliestPair out{a + "," + b, "most face tests: " + render::group_digits(p.face_tests) + " for " + a +
                                     " and " + b + " in all steps"};
  if (p.steps > 0)
    out.text +=
        "; most pairs of faces: " + render::group_digits(p.most_pairs) + " at step " + std::to_string(p.at);
  return out;
}

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
  const auto kept =
      std::count_if(step.queries.begin(), step.queries.end(), [](const CrowdQuery& q) { return q.is_kept; });
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
      w.member("within", q.result.near->within).member("pairs", q.result.near->pairs).end_object();
    }
    w.end_object();
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
