#include "scenarios/compare/compare.hpp"

#include <algorithm>
#include <filesystem>

#include "render/pictures/panel.hpp"
#include "scenarios/compare/regions.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/run_page.hpp"
#include "scenarios/run/run_scenario.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/divergence.hpp>

namespace lrb::compare {
namespace {

using render::group_digits;
using render::short_number;

const LrbRep& rep_of(const Runs& runs, std::size_t i) {
  return runs.of[i]->bodies[0].rep;
}

/// Returns the chart with the curve of the number of faces.
trace::Chart chart_of_faces(const trace::Trace& trace) {
  return trace.header.construction ? trace::chart_over_construction(trace) : trace::chart_over_events(trace);
}

bool of_one_body(const Runs& runs) {
  return runs.of[0]->bodies.size() == 1 && runs.of[1]->bodies.size() == 1;
}

/// Returns a table of both LRB-reps: faces, regions, layers, outermost wrapper.
report::Table body_table(const Runs& runs) {
  report::Table t{
      "The LRB-reps",
      {"run", "real faces", "faces for each", "regions", "layers", "outermost wrapper", "events"}};
  for (std::size_t i = 0; i < 2; ++i) {
    const LrbRep& rep = rep_of(runs, i);
    t.rows.push_back({runs.names[i], group_digits(rep.real_face_count()),
                      short_number(static_cast<double>(rep.face_count()) / rep.real_face_count()),
                      group_digits(rep.region_count()), std::to_string(rep.layer_count()),
                      group_digits(rep.outermost_faces().size()),
                      group_digits(runs.of[i]->trace.events.size())});
  }
  return t;
}

/// Returns the results of each pass of two constructions; a table without rows for other runs.
report::Table pass_table(const Runs& runs) {
  report::Table t{"Passes", {"pass"}};
  for (const char* what : {"stage", "faces", "regions", "caps"})
    for (const std::string& name : runs.names) t.columns.push_back(std::string(what) + ", " + name);
  const std::array<std::vector<trace::PassSummary>, 2> passes = {trace::passes_of(runs.of[0]->trace),
                                                                 trace::passes_of(runs.of[1]->trace)};
  for (std::size_t k = 0; k < std::max(passes[0].size(), passes[1].size()); ++k) {
    t.rows.push_back({std::to_string(k + 1)});
    for (const auto text : {+[](const trace::PassSummary& p) { return std::string(name_of(p.stage)); },
                            +[](const trace::PassSummary& p) { return group_digits(p.faces_after); },
                            +[](const trace::PassSummary& p) { return group_digits(p.regions); },
                            +[](const trace::PassSummary& p) { return group_digits(p.accepted()); }})
      for (const auto& of : passes) t.rows.back().push_back(k < of.size() ? text(of[k]) : "");
  }
  t.note = "Faces: of the front after the pass. Passes that built nothing are counted.";
  return t;
}

/// Returns the number of faces of front or wrapper by event, for both runs.
report::Chart faces_chart(const Runs& runs) {
  const bool built = runs.of[0]->trace.header.construction;
  report::Chart c{built ? "The front by event" : "The wrapper by event", {"event"}, {"faces"}};
  for (std::size_t i = 0; i < 2; ++i) {
    trace::Chart chart = chart_of_faces(runs.of[i]->trace);
    for (trace::Series& s : chart.series)
      if (s.unit == "faces" && std::any_of(s.values.begin(), s.values.end(), [](double v) { return v > 0; }))
        c.series.push_back({runs.names[i], chart.x, std::move(s.values), {report::Line::steps}});
  }
  return c;
}

/// Draws both wrappers after the last event, coloured by region, through the same camera.
render::Image draw_bodies(const Runs& runs, const run::ProgressReport& progress) {
  run::Framing framing{{}, {}, rep_of(runs, 0).dim()};
  for (std::size_t i = 0; i < 2; ++i)
    for (const Eigen::Vector3d& x : render::body_points(rep_of(runs, i), runs.of[i]->trace.steps[0].pose_a))
      framing.points.push_back(x);
  std::vector<render::Panel> panels;
  for (std::size_t i = 0; i < 2; ++i) {
    const trace::Trace& trace = runs.of[i]->trace;
    render::FrameSpec frame = runs.scenarios[i]->frames;
    frame.colour_by = render::FrameSpec::ColourBy::region;
    panels.push_back(panel_after(run::recorded_run_of(*runs.scenarios[i], *runs.of[i]), std::move(frame),
                                 static_cast<trace::EventId>(trace.events.size() - 1), runs.names[i], framing,
                                 progress));
  }
  return in_a_row(panels);
}

constexpr const char* kPicture = "compare.png";
constexpr std::size_t kMaxSteps = 200;

/// Returns the first event of a step that differs.
std::optional<std::string> different_event(const Runs& runs) {
  const trace::Trace &x = runs.of[0]->trace, &y = runs.of[1]->trace;
  for (std::size_t step = 0; step < step_count(runs); ++step) {
    const auto p = x.events_of(step), q = y.events_of(step);
    const std::size_t both = std::min(p.size(), q.size());
    for (std::size_t i = 0; i < both; ++i)
      if (!(p[i] == q[i]))
        return "step " + std::to_string(x.steps[step].index) + ", event " + std::to_string(i) +
               " of the step: \"" + describe(p[i]) + "\" in " + runs.names[0] + ", \"" + describe(q[i]) +
               "\" in " + runs.names[1];
    if (p.size() != q.size())
      return "step " + std::to_string(x.steps[step].index) + ": " + group_digits(p.size()) + " events in " +
             runs.names[0] + ", " + group_digits(q.size()) + " in " + runs.names[1];
  }
  return {};
}

report::Table steps_table(const Runs& runs) {
  report::Table t{"Steps", {"step", "answer"}};
  for (const char* what : {"pairs", "face tests", "box tests"})
    for (const std::string& name : runs.names) t.columns.push_back(std::string(what) + ", " + name);
  for (std::size_t i = 0; i < std::min(step_count(runs), kMaxSteps); ++i) {
    const trace::Step &x = runs.of[0]->trace.steps[i], &y = runs.of[1]->trace.steps[i];
    const bool same = x.result.relation == y.result.relation && x.result.fingerprint == y.result.fingerprint;
    t.rows.push_back({std::to_string(x.index), same ? std::string(to_string(x.result.relation))
                                                    : std::string(to_string(x.result.relation)) + " / " +
                                                          to_string(y.result.relation) +
                                                          ", NOT the same pairs"});
    std::vector<std::string>& row = t.rows.back();
    for (const auto value : {+[](const trace::Step& s) { return s.result.pair_count; },
                             +[](const trace::Step& s) { return s.result.counters.face_tests; },
                             +[](const trace::Step& s) { return s.result.counters.box_tests; }})
      for (const trace::Step* s : {&x, &y}) row.push_back(group_digits(value(*s)));
  }
  if (step_count(runs) > kMaxSteps) t.note = "The first " + std::to_string(kMaxSteps) + " steps.";
  return t;
}

void check_runs(const Runs& runs) {
  const std::size_t one = runs.of[0]->bodies.size(), other = runs.of[1]->bodies.size();
  if (one != other)
    throw InputError(runs.names[one == 1 ? 0 : 1] + ": is a run of one body, and " +
                     runs.names[one == 1 ? 1 : 0] + " of two");
  if (step_count(runs) == 0) throw InputError("there is no step that both runs have");
}

std::optional<std::string> first_difference(const Runs& runs) {
  const std::optional<trace::Divergence> first =
      trace::first_divergence(runs.of[0]->trace, runs.of[1]->trace);
  const std::string cut = cut_words(runs);
  if (!first && cut.empty()) return {};
  if (!first) return "none among the events that were stored. " + cut;
  if (first->step) return first->message();
  const std::optional<std::string> event = different_event(runs);
  return first->message() + (event ? "; " + *event : std::string("; all events are the same"));
}

/// Returns the views of both runs' pages for a page in `folder`; empty if one of them has no page.
std::vector<report::View> views_of(const Runs& runs, const std::string& folder) {
  std::vector<report::View> out;
  for (std::size_t i = 0; i < 2; ++i) {
    std::error_code error;
    const std::filesystem::path page = std::filesystem::absolute(runs.pages[i], error).lexically_normal();
    if (runs.pages[i].empty() || !std::filesystem::is_regular_file(page, error)) return {};
    const std::filesystem::path from = std::filesystem::absolute(folder, error).lexically_normal();
    out.push_back({runs.names[i], io::url_path(page.lexically_relative(from).generic_string())});
  }
  return out;
}

}  // namespace

Difference write_comparison(const Runs& runs, const std::string& command, const std::string& folder,
                            const run::ProgressReport& progress) {
  check_runs(runs);
  reject_folder_of_run(folder);
  const bool alone = of_one_body(runs);
  const std::size_t step = alone ? 0 : busiest_step(runs);
  const render::Image picture = alone ? draw_bodies(runs, progress) : draw(runs, step, progress);
  Difference out{first_difference(runs), {}};
  const std::optional<std::string>& difference = out.first;
  report::Document doc(runs.names[0] + " and " + runs.names[1],
                       alone ? "Two recorded runs of one body each." : "Two recorded runs, step by step.");
  if (const std::string cut = cut_words(runs); !cut.empty()) doc.purpose(cut);
  doc.verdict(difference ? "differ" : "the same").command(command).version(runs.of[0]->trace.header.lrbscope);
  doc.text({"First difference", difference.value_or("None: all events and answers are the same.")});
  doc.views(views_of(runs, folder));
  if (alone) {
    doc.chart(faces_chart(runs)).table(body_table(runs));
    if (const report::Table passes = pass_table(runs); !passes.rows.empty()) doc.table(passes);
    if (const auto regions = compare_regions(runs)) {
      out.regions = regions_text(*regions, runs);
      doc.text({"Regions", regions_sentence(*regions, runs)});
      doc.each(region_tables(*regions, runs), &report::Document::table);
    } else if (rep_of(runs, 0).region_count() + rep_of(runs, 1).region_count() > 0) {
      out.regions = "regions are not compared: the bodies' own faces differ\n";
      doc.text({"Regions", "Not compared: the bodies' own faces differ."});
    }
    doc.picture(kPicture, picture, "After the last event", "Coloured by region, seen by one camera.");
  } else {
    add_work_charts(doc, runs);
    doc.table(totals_of(runs)).table(steps_table(runs));
    doc.picture(
        kPicture, picture, "Work by face, step " + std::to_string(runs.of[0]->trace.steps[step].index),
        "Both runs on one scale, seen by one camera; and their difference, face by face, where the bodies have the "
        "same faces. Pale: less than a fiftieth of the maximum.");
  }
  doc.write(folder);
  return out;
}

}  // namespace lrb::compare
