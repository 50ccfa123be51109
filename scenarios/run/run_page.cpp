#include "scenarios/run/run_page.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "render/page_palette.hpp"
#include "render/pictures/marks.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/run/run_charts.hpp"
#include "scenarios/run/scene_json.hpp"
#include "scenarios/spec/motion.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {
namespace {

std::string vector_text(const Eigen::Vector3d& v) {
  return "(" + render::short_number(v.x()) + ", " + render::short_number(v.y()) + ", " +
         render::short_number(v.z()) + ")";
}

/// Returns the last step; null if it is not finished.
const trace::Step* last_step(const trace::Trace& trace) {
  return trace.steps.empty() || !trace.steps.back().finished ? nullptr : &trace.steps.back();
}

/// Returns the number of pairs of a step's answer in which not both faces are real.
std::size_t pseudo_pairs(const trace::Trace& trace, std::size_t step) {
  const auto& bodies = trace.header.bodies;
  const auto events = trace.events_of(step);
  return static_cast<std::size_t>(std::count_if(events.begin(), events.end(), [&](const trace::Event& e) {
    return e.kind == EventKind::contact &&
           (e.a >= bodies[0].real_simplices || e.b >= bodies[1].real_simplices);
  }));
}

/// Adds the measurements of a step other than pairs.
void add_measured(const trace::StepResult& r, std::vector<report::Number>& out) {
  if (r.distance)
    out.push_back({"Distance", pictures::interval_text(r.distance->lower, r.distance->upper),
                   std::string("of the surfaces, proven") +
                       (r.distance->solids_meet && r.distance->upper > 0 ? ". The solids overlap" : "")});
  if (r.near)
    for (const auto& n : NearPairsNumbers::kShown) {
      out.push_back({n.on_pages, render::group_digits((*r.near).*n.member),
                     "within a distance of " + render::short_number(r.near->within)});
      out.back().label[0] += 'A' - 'a';
    }
  if (r.manifold)
    out.push_back({"Contact manifolds", render::group_digits(r.manifold->manifolds),
                   render::counted(r.manifold->found, "point", "points")});
  if (r.points)
    out.push_back({r.points->has_sides ? "Points inside" : "Points",
                   render::group_digits(r.points->has_sides ? r.points->inside : r.points->count),
                   frames::text_of(*r.points)});
  if (!r.clash) return;
  out.push_back({"Contact kind", pictures::kind_text(r.clash->kind), std::string(name_of(r.clash->reason))});
  if (r.clash->depth)
    out.push_back({"Penetration depth", pictures::interval_text((*r.clash->depth)[0], (*r.clash->depth)[1]),
                   std::string("length of B's separation vector, proven") +
                       (r.clash->finished ? "" : ". The limit of steps was reached")});
  if (r.clash->volume)
    out.push_back(
        {"Shared volume", pictures::interval_text((*r.clash->volume)[0], (*r.clash->volume)[1]), ""});
}

}  // namespace

std::vector<report::Number> step_numbers(const frames::RecordedRun& p, std::size_t step) {
  const trace::Step& s = p.trace->steps[step];
  if (!s.finished || p.reps.size() != 2 || p.trace->has_engine_reports()) return {};
  const trace::StepResult& r = s.result;
  std::vector<report::Number> out = {{"Relation", io::in_words(name_of(r.relation)), ""},
                                     {"Pairs", render::group_digits(r.pair_count), ""}};
  if (r.relation == Relation::undefined) out[0].note = "of open bodies: inside and outside are not defined";
  if (p.trace->header.request.is_coarse()) {
    out.back().note =
        "of wrappers: " + render::group_digits(pseudo_pairs(*p.trace, step)) + " with a pseudo face";
    out.push_back({"Error bound", frames::error_bound_text(r.error_bound),
                   r.finished ? "deviation of those wrappers from the bodies"
                              : "a limit was reached before the tolerance"});
  } else if (p.results != nullptr && step < p.results->size()) {
    out.push_back({"Contact regions", render::group_digits((*p.results)[step].regions.size()), ""});
  }
  add_measured(r, out);
  out.push_back({"Face tests", render::group_digits(r.counters.face_tests),
                 "brute force: " + render::group_digits(std::uint64_t{p.reps[0]->real_simplex_count()} *
                                                        p.reps[1]->real_simplex_count())});
  if (!p.trace->header.engine.empty()) return out;
  std::uint64_t regions = 0;
  for (const LrbRep* rep : p.reps) regions += rep->region_count();
  out.push_back(
      {"Refined", render::group_digits(r.counters.regions_opened), "of " + render::group_digits(regions)});
  return out;
}

namespace {

std::string body_text(const frames::RecordedRun& p, std::size_t side) {
  const LrbRep& rep = *p.reps[side];
  const std::string name = std::filesystem::path(p.trace->header.bodies[side].name).stem().string();
  return std::string(p.reps.size() == 1 ? ""
                     : side == 0        ? "A: "
                                        : "B: ") +
         (name.empty() ? "the body" : name) + " (" + render::counted(rep.real_face_count(), "face", "faces") +
         ")";
}

std::uint64_t tests_of(const trace::Step& step) {
  const Counters& c = step.result.counters;
  return c.box_tests + c.prefilter_tests + c.face_tests;
}

/// Returns the bodies, their first contact and the costliest query, in a sentence.
std::string sentence_of(const frames::RecordedRun& p) {
  using render::counted;
  if (p.reps.size() == 2) {
    const std::string both = body_text(p, 0) + ", " + body_text(p, 1);
    if (p.trace->has_engine_reports())
      return p.trace->header.engine + ": " + engine_sentence(p) + " " + both + ".";
    std::string out = both, proof;
    const auto& steps = p.trace->steps;
    if (const auto& search = p.trace->header.first_contact; search && search->step)
      out += ". First touch at " + spec::contact_step(*search),
          proof = ". Proven collision-free until the first touch, " + spec::contact_way(*search);
    else if (const trace::EventId at = record::first_contact(*p.trace); at != kNull)
      out += steps.size() > 1
                 ? ". They intersect from step " + std::to_string(steps[p.trace->step_of(at)].index)
                 : ". They intersect";
    else
      out += steps.size() > 1 ? ". They do not touch in any step" : ". They do not touch";
    if (steps.size() > 1)
      out += ". Step " +
             std::to_string(std::max_element(steps.begin(), steps.end(),
                                             [](const trace::Step& x, const trace::Step& y) {
                                               return tests_of(x) < tests_of(y);
                                             })
                                ->index) +
             " costs most";
    out += proof;
    for (const LrbRep* rep : p.reps)
      if (rep->region_count() == 0 && p.trace->header.engine.empty())
        out += std::string(". ") + (rep == p.reps[0] ? "A" : "B") + (rep->closed() ? "" : " is open and") +
               " has no wrapper";
    return out + ".";
  }
  const LrbRep& rep = *p.reps[0];
  std::string name = body_text(p, 0);
  if (rep.region_count() == 0) return name + " has no wrapper.";
  return name + " has " + counted(rep.region_count(), "region", "regions") + " in " +
         counted(rep.layer_count(), "layer", "layers") + ": " +
         (p.trace->header.construction ? "passes of caps replace its surface until the outermost wrapper has "
                                       : "refined one by one, they lead from the outermost wrapper of ") +
         counted(rep.outermost_faces().size(), "face", "faces") +
         (p.trace->header.construction ? "." : " to the body.");
}

std::vector<report::Number> wrapper_numbers(const LrbRep& rep) {
  const std::uint32_t real = rep.real_face_count();
  return {{"Real faces", render::group_digits(real), ""},
          {"Pseudo faces", render::group_digits(rep.face_count() - real),
           render::short_number(static_cast<double>(rep.face_count()) / real) + " faces in all per real one"},
          {"Outermost wrapper", render::group_digits(rep.outermost_faces().size()) + " faces", ""},
          {"Regions", render::group_digits(rep.region_count()),
           "in " + std::to_string(rep.layer_count()) + " layers"}};
}

/// Returns true if hits and contacts are the same curve, which is then shown once. The complete query
/// compares only real faces, so every hit is a contact: event by event, the one after the hit.
bool same_as_contacts(const trace::Series& hits, const trace::Chart& chart) {
  const auto same = [&](const trace::Series& s) {
    return s.name == "contacts" &&
           std::equal(s.values.begin(), s.values.end(), hits.values.begin(), hits.values.end(),
                      [](double contacts, double all) { return contacts == all || contacts + 1 == all; });
  };
  return std::any_of(chart.series.begin(), chart.series.end(), same);
}

/// Returns the colour of a curve: that of its body or event in the view; empty: the palette's next.
std::string colour_of(std::string_view curve) {
  namespace palette = render::palette;
  if (curve.ends_with(" A")) return render::css(palette::body(Side::a));
  if (curve.ends_with(" B")) return render::css(palette::body(Side::b));
  if (curve == "face tests") return render::css(palette::kUnderTest);
  if (curve == "refinements") return render::css(palette::kRefining);
  if (curve == "contacts") return render::css(palette::kContact);
  return {};
}

/// Returns true for the curve of a wrapper if its body has no wrapper, or another engine was recorded.
bool is_of_no_wrapper(const trace::Series& s, const frames::RecordedRun& p) {
  if (s.unit == "faces" && !p.trace->header.engine.empty()) return true;
  return s.unit == "faces" &&
         ((s.name.ends_with(" A") && p.reps[0]->region_count() == 0) ||
          (s.name.ends_with(" B") && p.reps.size() > 1 && p.reps[1]->region_count() == 0));
}

/// Adds charts of the trace's curves by unit: faces of the wrappers in one, counts in the other, which is
/// left out for one body (each event refines one region).
void add_charts_of(report::Document& doc, const frames::RecordedRun& p, const trace::Chart& chart,
                   report::Cursor cursor, const std::string& faces_title, const std::string& counts_title) {
  const report::Axis x{std::string(chart.x_name)};
  report::Chart faces{faces_title, x, {"faces"}, {}, {}, cursor};
  report::Chart counts{counts_title, x, {"count"}, {}, {}, cursor};
  const report::Line line = cursor == report::Cursor::event ? report::Line::steps : report::Line::straight;
  for (const trace::Series& s : chart.series) {
    if (s.unit == "ms" || is_of_no_wrapper(s, p)) continue;
    if (s.name == "hits" && same_as_contacts(s, chart)) continue;
    // A curve is missing if its body is missing, or if its kind of event did not occur.
    if (std::none_of(s.values.begin(), s.values.end(), [](double v) { return v > 0; })) continue;
    (s.unit == "faces" ? faces : counts)
        .series.push_back({std::string(s.name), chart.x, s.values, {line, colour_of(s.name)}});
  }
  if (!faces.series.empty()) doc.chart(faces);
  if (!counts.series.empty() && p.reps.size() == 2) doc.chart(counts);
}

report::Table contact_table(const CollideResult& result, std::uint32_t step) {
  report::Table t{
      "Contact regions at step " + std::to_string(step),
      {"region", "pairs", "curves", "length", "area", "depth, estimated", "centroid", "normal, A to B"}};
  constexpr std::size_t kMaxRows = 30;
  for (std::size_t i = 0; i < std::min(result.regions.size(), kMaxRows); ++i) {
    const ContactRegion& r = result.regions[i];
    const auto closed =
        std::count_if(r.loops.begin(), r.loops.end(), [](const ContactLoop& l) { return l.closed; });
    t.rows.push_back({std::to_string(i + 1), render::group_digits(r.pairs.size()),
                      std::to_string(closed) + " closed, " +
                          std::to_string(r.loops.size() - static_cast<std::size_t>(closed)) + " open",
                      render::short_number(r.length), render::short_number(r.area),
                      render::short_number(r.depth_estimate), vector_text(r.centroid),
                      vector_text(r.normal)});
    if (r.pairs.empty()) continue;
    const SimplexPair& pair = result.pairs[r.pairs.front()];
    t.targets.resize(t.rows.size());
    t.targets.back() = "pair " + std::to_string(step) + " " + std::to_string(pair.a.value()) + " " +
                       std::to_string(pair.b.value());
  }
  t.note =
      "World frame; lengths in the meshes' unit. Depth: estimated translation of B along the normal that separates the "
      "region. A click on a row selects the region's first pair in the view.";
  if (result.regions.size() > kMaxRows)
    t.note += " " + std::to_string(result.regions.size() - kMaxRows) + " more are left out here.";
  return t;
}

std::string faces_text(const Separation& s) {
  return render::group_digits(s.face_count[0]) + " + " + render::group_digits(s.face_count[1]) + " faces";
}

/// Describes the request of an approximate answer.
std::string coarse_text(const CollideRequest& request) {
  std::string limits;
  const auto add = [&](const std::string& limit) { limits += (limits.empty() ? "" : " and ") + limit; };
  if (request.tolerance > 0) add("to a tolerance of " + render::short_number(request.tolerance));
  if (request.max_tests > 0) add("within " + render::group_digits(request.max_tests) + " face tests");
  if (request.max_time > 0) add("within " + render::short_number(request.max_time) + " s");
  return "(Answered " + limits +
         ": intersecting faces can be pseudo faces, whose deviation from the bodies is at most the error bound.)";
}

report::Table steps_table(const trace::Trace& trace) {
  using render::group_digits;
  using trace::StepResult;
  report::Table t{"Every time step", {"step"}};
  for (const trace::Step& s : trace.steps) {
    t.rows.push_back({std::to_string(s.index)});
    t.targets.push_back("step " + t.rows.back()[0]);
  }
  const auto column = [&](const char* name, const auto& cell) {
    t.columns.emplace_back(name);
    for (std::size_t i = 0; i < t.rows.size(); ++i) t.rows[i].push_back(cell(trace.steps[i].result));
  };
  const auto count = [&](const char* name, std::uint64_t Counters::*counter) {
    column(name, [&](const StepResult& r) { return group_digits(r.counters.*counter); });
  };
  /// Adds a column of a measurement that some step has.
  const auto measured = [&](const char* name, auto what, const auto& text) {
    if (!was_measured(trace, what)) return;
    column(name, [&](const StepResult& r) { return r.*what ? text(*(r.*what)) : std::string(); });
  };
  const CollideRequest& request = trace.header.request;
  const bool timed = !trace.wall_ns.empty();
  const bool has_trees = request.recursion == Recursion::complete;
  const bool is_ours =
      trace.header.engine.empty();  // other engines have neither wrappers nor tests of planes
  column("relation", [](const StepResult& r) { return io::in_words(name_of(r.relation)); });
  column("pairs", [](const StepResult& r) { return group_digits(r.pair_count); });
  if (timed) t.columns.emplace_back("microseconds");
  for (std::size_t i = 0; timed && i < t.rows.size(); ++i)
    t.rows[i].push_back(render::short_number(1e6 * std::fmax(0, trace::seconds_of_step(trace, i))));
  if (has_trees) count("box tests", &Counters::box_tests);
  if (has_trees && is_ours) count("plane tests", &Counters::prefilter_tests);
  count("face tests", &Counters::face_tests);
  if (is_ours) count("refinements", &Counters::refinements);
  column("fingerprint", [](const StepResult& r) { return trace::to_hex(r.fingerprint); });
  if (request.is_coarse()) {
    column("error bound", [](const StepResult& r) {
      return r.error_bound == 0 ? "0" : frames::error_bound_text(r.error_bound);
    });
    column("finished", [](const StepResult& r) { return r.finished ? "yes" : "no"; });
  }
  if (request.separation)
    column("proof of separation",
           [](const StepResult& r) { return r.separation ? faces_text(*r.separation) : ""; });
  measured("distance", &StepResult::distance,
           [](const auto& d) { return pictures::interval_text(d.lower, d.upper); });
  measured("contact kind", &StepResult::clash,
           [](const auto& c) { return pictures::kind_text(c.kind, c.reason); });
  measured("depth", &StepResult::clash, [](const auto& c) {
    return c.depth ? pictures::interval_text((*c.depth)[0], (*c.depth)[1]) : "";
  });
  for (const auto& n : NearPairsNumbers::kShown)
    measured(n.on_pages, &StepResult::near, [&](const auto& m) { return group_digits(m.*n.member); });
  measured("contact manifolds", &StepResult::manifold,
           [](const auto& m) { return group_digits(m.manifolds); });
  measured("points", &StepResult::manifold, [](const auto& m) { return group_digits(m.found); });
  measured("points inside", &StepResult::points,
           [](const auto& p) { return p.has_sides ? group_digits(p.inside) : ""; });
  measured("smallest distance", &StepResult::points, [](const auto& p) {
    return p.smallest.empty() ? "" : pictures::interval_text(p.smallest[0].lower, p.smallest[0].upper);
  });
  t.note = "The fingerprint is FNV-1a 64 over the sorted pairs: equal answers, equal fingerprints.";
  if (timed) t.note += " Microseconds: from the first to the last event of the step, recording included.";
  if (request.is_coarse()) t.note += " An error bound of 0: the answer is exact.";
  return t;
}

/// Adds the request and the result.
void add_answer(report::Document& doc, const frames::RecordedRun& p, const ReportText& text) {
  const bool two = p.reps.size() == 2;
  doc.command(text.command);
  if (p.trace->has_engine_reports()) {
    add_engine_answer(doc, p);
  } else if (const trace::Step* step = last_step(*p.trace); two && step != nullptr) {
    doc.verdict(io::in_words(name_of(step->result.relation)));
    doc.each(step_numbers(p, p.trace->steps.size() - 1), &report::Document::number);
  } else if (!two) {
    doc.each(wrapper_numbers(*p.reps[0]), &report::Document::number);
  }
  if (two && p.trace->header.request.recursion != Recursion::complete)
    doc.purpose("(The paper's recursion was requested: it can miss contacts.)");
  if (two && p.trace->header.request.is_coarse()) doc.purpose(coarse_text(p.trace->header.request));
  if (p.trace->truncated())
    doc.purpose("(The trace was cut: it holds " + render::group_digits(p.trace->events.size()) + " of " +
                render::group_digits(p.trace->events_seen) + " events, and so do frames and charts.)");
  if (!text.mismatches.empty()) doc.verdict("not as expected");
}

void add_charts(report::Document& doc, const frames::RecordedRun& p) {
  if (p.trace->has_engine_reports())
    doc.each(engine_charts(p), &report::Document::chart);
  else if (p.trace->steps.size() > 1)
    add_charts_of(doc, p, trace::chart_over_steps(*p.trace), report::Cursor::step, "Largest wrappers by step",
                  "Work and answer by step");
  add_charts_of(doc, p, trace::chart_over_events(*p.trace), report::Cursor::event, "Wrapper size by event",
                "Work and answer by event");
  doc.each(measure_charts(*p.trace), &report::Document::chart);
}

/// Tables of a run of two bodies: contacts of the last step, and all steps unless there are too many.
void add_tables(report::Document& doc, const frames::RecordedRun& p) {
  if (p.reps.size() != 2) return;
  if (p.trace->has_engine_reports()) {
    doc.tab("Queries").table(engine_table(p));
    doc.tab("Work").each(engine_counter_tables(p), &report::Document::table);
    doc.each(work_tables(p), &report::Document::table);
    return;
  }
  constexpr std::size_t kMaxSteps = 200;
  if (p.trace->steps.size() <= kMaxSteps) doc.tab("Steps").table(steps_table(*p.trace));
  if (p.results != nullptr && !p.results->empty() && !p.results->back().regions.empty())
    doc.tab("Contacts").table(contact_table(p.results->back(), p.trace->steps.back().index));
  doc.tab("Work").each(work_tables(p), &report::Document::table);
  if (!p.trace->header.engine.empty()) return;  // the bodies' own trees and regions were not used
  doc.tab("Regions").each(group_tables(p), &report::Document::table);
  doc.tab("Bodies").table(quality_table(p));
}

}  // namespace

report::Link trace_link(const std::string& file) {
  return {file, "all events; opens in ui.perfetto.dev and chrome://tracing"};
}

report::Document run_page(const frames::RecordedRun& p, const frames::DrawnFrames& drawn,
                          const std::string& folder, const ReportText& text) {
  report::Document doc(text.title, text.purpose);
  doc.explain(p.trace->header.engine.empty() ? meaning_of_column : meaning_for_engines)
      .summary(sentence_of(p));
  add_answer(doc, p, text);
  doc.scene(scene_json(p, {text.trace_file, text.why}));
  doc.each(text.links, &report::Document::link);
  for (const std::string& file : drawn.montage)
    doc.link({file, file.ends_with(".txt") ? "caption of the montage"
                                           : "panels (a), (b), (c), ... as one picture"});
  if (!text.mismatches.empty()) {
    report::Table t{"Not as expected", {"expectation"}};
    for (const std::string& m : text.mismatches) t.rows.push_back({m});
    doc.tab("Not as expected").table(t);
  }
  doc.tab("Charts");
  if (p.trace->header.construction) {
    add_construction(doc, p);
  } else {
    add_charts(doc, p);
    add_tables(doc, p);
  }
  // Frames may be smaller beside the 3D view, which not every browser shows.
  constexpr std::size_t kBesideView = 2'500'000;
  std::vector<report::Frame> frames;
  for (const frames::DrawnFrame& f : drawn.frames)
    frames.push_back({f.file, f.caption, static_cast<double>(f.event), static_cast<double>(f.step)});
  doc.tab("Frames").frames(frames, folder, p.reps[0]->dim() == 3 ? kBesideView : report::kInlineBudget);
  if (drawn.proved != nullptr)
    doc.tab("Proof").picture(frames::kSeparationFile, io::read_text(folder + "/" + frames::kSeparationFile),
                             "Proof of separation at step " + std::to_string(drawn.proved->index),
                             "(a) The outermost wrappers. (b) Refined until they have no point in common: " +
                                 faces_text(*drawn.proved->result.separation) + ". Each contains its body.");
  doc.tab("");
  return doc.version(p.trace->header.lrbscope);
}

}  // namespace lrb::run
