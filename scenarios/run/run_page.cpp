#include "scenarios/run/run_page.hpp"

#include <algorithm>

#include "render/pictures/marks.hpp"
#include "scenarios/frames/frame_state.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/record/approach.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/run_charts.hpp"
#include "scenarios/run/run_tables.hpp"
#include "scenarios/run/scene_json.hpp"
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

/// Returns the step with the most to say: the last one.
const trace::Step* last_step(const trace::Trace& trace) {
  return trace.steps.empty() || !trace.steps.back().finished ? nullptr : &trace.steps.back();
}

/// Returns the number of pairs of the last step's answer in which not both faces are real.
std::size_t pseudo_pairs(const trace::Trace& trace) {
  const auto& bodies = trace.header.bodies;
  const auto events = trace.events_of(trace.steps.size() - 1);
  return static_cast<std::size_t>(std::count_if(events.begin(), events.end(), [&](const trace::Event& e) {
    return e.kind == EventKind::contact &&
           (e.a >= bodies[0].real_simplices || e.b >= bodies[1].real_simplices);
  }));
}

/// Returns the names of the bodies of which this holds: "A", "B" or "A and B".
template <class Test>
std::string sides_of(const RecordedRun& p, Test test) {
  std::string out;
  for (std::size_t i = 0; i < p.reps.size(); ++i)
    if (test(*p.reps[i])) out += (out.empty() ? "" : " and ") + std::string(i == 0 ? "A" : "B");
  return out;
}

/// Adds what was measured of a step besides the pairs.
void add_measured(const trace::StepResult& r, const std::string& at, std::vector<report::PageNumber>& out) {
  if (r.distance)
    out.push_back({"Distance", interval_words(r.distance->lower, r.distance->upper),
                   at + "; of the surfaces, proved" +
                       (r.distance->solids_meet && r.distance->upper > 0 ? ". The solids meet" : "")});
  if (!r.clash) return;
  const std::string reason(name_of(r.clash->reason));
  out.push_back({"Kind of contact", kind_words(r.clash->kind), reason.empty() ? at : at + "; " + reason});
  if (r.clash->depth)
    out.push_back({"Penetration depth", interval_words((*r.clash->depth)[0], (*r.clash->depth)[1]),
                   at + "; the way that B has to move, proved"});
  if (r.clash->volume)
    out.push_back({"Volume shared", interval_words((*r.clash->volume)[0], (*r.clash->volume)[1]), at});
}

std::vector<report::PageNumber> collision_numbers(const RecordedRun& p, const trace::Step& step) {
  const trace::StepResult& r = step.result;
  const auto at = "at step " + std::to_string(step.index);
  std::uint64_t regions = 0, faces = 0;
  std::string each;
  for (const LrbRep* rep : p.reps) {
    regions += rep->region_count();
    faces += rep->real_face_count();
    each += (each.empty() ? "" : " + ") + render::group_digits(rep->real_face_count());
  }
  std::vector<report::PageNumber> out = {
      {"Relation", io::in_words(name_of(r.relation)), at},
      {"Pairs of faces that meet", render::group_digits(r.pair_count), at}};
  const std::string open = sides_of(p, [](const LrbRep& rep) { return !rep.closed(); });
  if (r.relation == Relation::undefined && !open.empty())
    out[0].note +=
        "; " + open + (open.size() > 1 ? " are" : " is") + " open: nothing tells inside from outside";
  if (const std::string bare = sides_of(p, [](const LrbRep& rep) { return rep.region_count() == 0; });
      !bare.empty())
    out.push_back({"Without wrapper", bare,
                   (open.empty() ? std::string() : open + (open.size() > 1 ? " are" : " is") + " open; ") +
                       "no region is built on it, and all of its faces are always shown"});
  if (const CollideRequest& request = p.trace->header.request; request.is_coarse()) {
    out.back().note +=
        "; of wrappers: " + render::group_digits(pseudo_pairs(*p.trace)) + " with a pseudo face";
    out.push_back({"Error bound", error_bound_text(r.error_bound),
                   at + (r.finished ? "; how far those wrappers are off the bodies"
                                    : "; a limit was reached before the tolerance")});
  } else if (p.results != nullptr && !p.results->empty()) {
    out.push_back({"Contact regions", render::group_digits(p.results->back().regions.size()), at});
  }
  add_measured(r, at, out);
  if (const auto& search = p.trace->header.first_contact; search && search->step)
    out.push_back({"First contact", contact_step(*search),
                   contact_way(*search) + "; until then the surfaces are proved not to meet"});
  out.push_back({"Face tests", render::group_digits(r.counters.face_tests),
                 at + "; all pairs would be " +
                     render::group_digits(std::uint64_t{p.reps[0]->real_simplex_count()} *
                                          p.reps[1]->real_simplex_count())});
  out.push_back({"Regions opened", render::group_digits(r.counters.regions_opened),
                 "of " + render::group_digits(regions) + ", " + at});
  out.push_back({"Real faces", render::group_digits(faces), each});
  return out;
}

std::vector<report::PageNumber> wrapper_numbers(const LrbRep& rep) {
  const std::uint32_t real = rep.real_face_count();
  return {{"Real faces", render::group_digits(real), ""},
          {"Pseudo faces", render::group_digits(rep.face_count() - real),
           render::short_number(static_cast<double>(rep.face_count()) / real) + " faces in all per real one"},
          {"Outermost wrapper", render::group_digits(rep.outermost_faces().size()) + " faces", ""},
          {"Regions", render::group_digits(rep.region_count()),
           "in " + std::to_string(rep.layer_count()) + " layers"}};
}

/// Returns true if hits and contacts are the same curve, which is then shown once. In the complete query only
/// real faces are compared, so that every hit is a contact: event by event, the one that follows the hit.
bool same_as_contacts(const trace::Series& hits, const trace::Chart& chart) {
  const auto same = [&](const trace::Series& s) {
    return s.name == "contacts" &&
           std::equal(s.values.begin(), s.values.end(), hits.values.begin(), hits.values.end(),
                      [](double contacts, double all) { return contacts == all || contacts + 1 == all; });
  };
  return std::any_of(chart.series.begin(), chart.series.end(), same);
}

/// Returns true for the curve of a wrapper that its body does not have.
bool is_of_no_wrapper(const trace::Series& s, const RecordedRun& p) {
  return s.unit == "faces" &&
         ((s.name.ends_with(" A") && p.reps[0]->region_count() == 0) ||
          (s.name.ends_with(" B") && p.reps.size() > 1 && p.reps[1]->region_count() == 0));
}

/// Makes charts of the trace's curves by unit: faces of the wrappers in one, counts in the other.
std::vector<report::PageChart> charts_of(const RecordedRun& p, const trace::Chart& chart,
                                         report::PageCursor cursor, const char* faces_title,
                                         const char* counts_title, bool stepped) {
  report::PageChart faces, counts;
  faces.title = faces_title;
  counts.title = counts_title;
  faces.y_label = "faces";
  counts.y_label = "number in the step";
  for (const trace::Series& s : chart.series) {
    if (s.unit == "ms") continue;
    if (s.name == "hits" && same_as_contacts(s, chart)) continue;
    if (is_of_no_wrapper(s, p)) continue;
    report::PageChart& target = s.unit == "faces" ? faces : counts;
    // There is no curve for a body that is missing, or for a kind of event that never came.
    if (std::none_of(s.values.begin(), s.values.end(), [](double v) { return v > 0; })) continue;
    target.series.push_back({std::string(s.name), chart.x, s.values});
  }
  std::vector<report::PageChart> out;
  for (report::PageChart* c : {&faces, &counts}) {
    if (c->series.empty()) continue;
    c->x_label = std::string(chart.x_name);
    c->cursor = cursor;
    c->stepped = stepped;
    out.push_back(std::move(*c));
  }
  return out;
}

report::PageTable contact_table(const CollideResult& result, std::uint32_t step) {
  report::PageTable t;
  t.title = "Contact regions at step " + std::to_string(step);
  t.columns = {"region",           "pairs",    "curves",        "length", "area",
               "depth, estimated", "centroid", "normal, A to B"};
  constexpr std::size_t kMostRows = 30;
  for (std::size_t i = 0; i < std::min(result.regions.size(), kMostRows); ++i) {
    const ContactRegion& r = result.regions[i];
    const auto closed =
        std::count_if(r.loops.begin(), r.loops.end(), [](const ContactLoop& l) { return l.closed; });
    t.rows.push_back({std::to_string(i + 1), render::group_digits(r.pairs.size()),
                      std::to_string(closed) + " closed, " +
                          std::to_string(r.loops.size() - static_cast<std::size_t>(closed)) + " open",
                      render::short_number(r.length), render::short_number(r.area),
                      render::short_number(r.depth_estimate), vector_text(r.centroid),
                      vector_text(r.normal)});
  }
  t.note =
      "World frame; lengths in the meshes' unit. Depth is an estimate for the region, how far B must move along the normal "
      "to leave the region.";
  if (result.regions.size() > kMostRows)
    t.note += " " + std::to_string(result.regions.size() - kMostRows) + " more are left out here.";
  return t;
}

std::string faces_text(const Separation& s) {
  return render::group_digits(s.face_count[0]) + " + " + render::group_digits(s.face_count[1]) + " faces";
}

/// Says what was asked for, if it is less than the exact answer.
std::string coarse_words(const CollideRequest& request) {
  std::string limits;
  const auto add = [&](const std::string& limit) { limits += (limits.empty() ? "" : " and ") + limit; };
  if (request.tolerance > 0) add("to a tolerance of " + render::short_number(request.tolerance));
  if (request.max_tests > 0) add("within " + render::group_digits(request.max_tests) + " face tests");
  if (request.max_time > 0) add("within " + render::short_number(request.max_time) + " s");
  return " (Answered " + limits +
         ": faces that meet can be pseudo faces, off the bodies by no more than the error bound.)";
}

report::PageTable steps_table(const trace::Trace& trace) {
  report::PageTable t;
  t.title = "Every time step";
  t.rows_are = report::PageRows::steps;
  t.columns = {"step", "relation", "pairs", "face tests", "refinements", "fingerprint"};
  const CollideRequest& request = trace.header.request;
  if (request.is_coarse()) t.columns.insert(t.columns.end(), {"error bound", "finished"});
  if (request.separation) t.columns.emplace_back("proved apart by");
  const bool has_distance = was_measured(trace, &trace::StepResult::distance);
  const bool has_clash = was_measured(trace, &trace::StepResult::clash);
  if (has_distance) t.columns.emplace_back("distance");
  if (has_clash) t.columns.insert(t.columns.end(), {"kind of contact", "depth"});
  for (const trace::Step& s : trace.steps) {
    t.rows.push_back(
        {std::to_string(s.index), io::in_words(name_of(s.result.relation)),
         render::group_digits(s.result.pair_count), render::group_digits(s.result.counters.face_tests),
         render::group_digits(s.result.counters.refinements), trace::to_hex(s.result.fingerprint)});
    std::vector<std::string>& row = t.rows.back();
    if (request.is_coarse())
      row.insert(row.end(), {s.result.error_bound == 0 ? "0" : error_bound_text(s.result.error_bound),
                             s.result.finished ? "yes" : "no"});
    if (request.separation) row.push_back(s.result.separation ? faces_text(*s.result.separation) : "");
    if (const auto& d = s.result.distance; has_distance)
      row.push_back(d ? interval_words(d->lower, d->upper) : "");
    if (const auto& c = s.result.clash; has_clash)
      row.insert(row.end(), {c ? kind_words(c->kind, c->reason) : "",
                             c && c->depth ? interval_words((*c->depth)[0], (*c->depth)[1]) : ""});
  }
  t.note = "The fingerprint is FNV-1a 64 over the sorted pairs: equal answers, equal fingerprints.";
  if (request.is_coarse()) t.note += " An error bound of 0: the answer is exact.";
  return t;
}

void add_links(report::Page& page, const DrawnFrames& drawn, const ReportText& text, bool construction) {
  page.links.push_back({text.trace_file, text.trace_file,
                        "every event; drag it onto ui.perfetto.dev or chrome://tracing to walk through it"});
  page.links.push_back({"summary.json", "summary.json",
                        construction ? "every pass with its caps, and why they were refused, as JSON"
                                     : "totals, statistics and every time step as JSON"});
  for (const std::string& file : drawn.montage)
    page.links.push_back({file, file,
                          file.ends_with(".txt") ? "what to print under the montage"
                                                 : "panels (a), (b), (c), ... as one picture"});
  if (!drawn.frames.empty())
    page.links.push_back(
        {"frames/", "frames/", std::to_string(drawn.frames.size()) + " full pictures (PNG)"});
}

/// Says what was asked for, and what came out.
void add_answer(report::Page& page, const RecordedRun& p, const ReportText& text) {
  page.title = text.title;
  page.purpose = text.purpose;
  page.command = text.command;
  const bool two = p.reps.size() == 2;
  if (const trace::Step* step = last_step(*p.trace); two && step != nullptr) {
    page.verdict = io::in_words(name_of(step->result.relation));
    page.numbers = collision_numbers(p, *step);
  } else if (!two) {
    page.numbers = wrapper_numbers(*p.reps[0]);
  }
  if (two && p.trace->header.request.recursion != Recursion::complete)
    page.purpose += " (The paper's recursion was asked for: it can miss contacts.)";
  if (two && p.trace->header.request.is_coarse()) page.purpose += coarse_words(p.trace->header.request);
  if (p.trace->truncated())
    page.purpose += " (The trace was cut: it holds " + render::group_digits(p.trace->events.size()) + " of " +
                    render::group_digits(p.trace->events_seen) + " events, and so do frames and charts.)";
}

void add_mismatches(report::Page& page, const std::vector<std::string>& mismatches) {
  if (mismatches.empty()) return;
  report::PageTable t;
  t.title = "Not as expected";
  t.columns = {"expectation"};
  for (const std::string& m : mismatches) t.rows.push_back({m});
  page.tables.push_back(std::move(t));
  page.verdict = "not as expected";
}

void add_charts(report::Page& page, const RecordedRun& p) {
  const bool two = p.reps.size() == 2;
  if (p.trace->steps.size() > 1)
    page.charts = charts_of(p, trace::chart_over_steps(*p.trace), report::PageCursor::step,
                            "Largest wrappers, step by step", "Work and answer, step by step", false);
  std::vector<report::PageChart> by_event =
      charts_of(p, trace::chart_over_events(*p.trace), report::PageCursor::event,
                two ? "Wrappers, event by event" : "The wrapper, event by event",
                "Work and answer, event by event", true);
  // Of one body each event refines one region: there is nothing to count.
  if (!two) by_event.resize(std::min<std::size_t>(by_event.size(), 1));
  for (report::PageChart& c : by_event) page.charts.push_back(std::move(c));
  for (report::PageChart& c : measure_charts(*p.trace)) page.charts.push_back(std::move(c));
}

/// Tables of a run of two bodies: contacts of the last step, and all steps unless they are many.
void add_tables(report::Page& page, const RecordedRun& p) {
  if (p.reps.size() != 2) return;
  if (p.results != nullptr && !p.results->empty() && !p.results->back().regions.empty())
    page.tables.push_back(contact_table(p.results->back(), p.trace->steps.back().index));
  constexpr std::size_t kMostSteps = 200;
  for (report::PageTable& table : work_tables(p)) page.tables.push_back(std::move(table));
  for (report::PageTable& table : group_tables(p)) page.tables.push_back(std::move(table));
  if (p.trace->steps.size() <= kMostSteps) page.tables.push_back(steps_table(*p.trace));
  page.tables.push_back(quality_table(p));
}

}  // namespace

void add_frames(report::Page& page, const DrawnFrames& drawn, const std::string& folder, std::size_t budget) {
  std::vector<report::PngBytes> pngs;
  for (const DrawnFrame& f : drawn.frames) {
    const std::string bytes = io::read_text(folder + "/" + f.file);
    pngs.emplace_back(bytes.begin(), bytes.end());
  }
  report::InlinedImages images = report::inline_pngs(pngs, budget);
  page.frames_note = images.note;
  for (std::size_t i = 0; i < drawn.frames.size(); ++i) {
    const DrawnFrame& f = drawn.frames[i];
    page.frames.push_back({std::move(images.uris[i]), f.caption, f.file, static_cast<double>(f.event),
                           static_cast<double>(f.step)});
  }
}

void add_live_figure(report::Page& page, const std::string& folder, const std::string& title,
                     const std::string& caption, const std::string& file) {
  page.figures.push_back({title, caption, {}, file, io::read_text(folder + "/" + file)});
  page.links.push_back({file, file, title});
}

void add_figure(report::Page& page, const std::string& folder, const std::string& title,
                const std::string& caption, const std::string& file) {
  const std::string bytes = io::read_text(folder + "/" + file);
  const char* type = file.ends_with(".svg") ? "image/svg+xml" : "image/png";
  page.figures.push_back(
      {title, caption,
       report::data_uri(type, reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()), file});
  page.links.push_back({file, file, title});
}

report::Page run_page(const RecordedRun& p, const DrawnFrames& drawn, const std::string& folder,
                      const ReportText& text) {
  report::Page page;
  add_answer(page, p, text);
  add_mismatches(page, text.mismatches);
  page.scene = scene_json(p, {text.trace_file, text.why});
  // In three dimensions they are what is left where a browser has no WebGL, and can be smaller.
  constexpr std::size_t kBesideView = 2'500'000;
  add_frames(page, drawn, folder, p.reps[0]->dim() == 3 ? kBesideView : report::kInlineBudget);
  if (p.trace->header.construction) {
    add_construction(page, p);
  } else {
    add_charts(page, p);
    add_tables(page, p);
  }
  add_links(page, drawn, text, p.trace->header.construction);
  if (drawn.proved != nullptr)
    add_figure(page, folder, "Proof that the bodies are apart at step " + std::to_string(drawn.proved->index),
               "(a) the outermost wrappers, (b) refined as far as it takes until they have no point in "
               "common: " +
                   faces_text(*drawn.proved->result.separation) + ". Each holds its body.",
               kSeparationFile);
  page.footer = report::footer(p.trace->header.lrbscope);
  return page;
}

}  // namespace lrb::run
