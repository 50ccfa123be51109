#include "scenarios/compare/compare_bodies.hpp"

#include <algorithm>

#include "render/montage.hpp"
#include "render/overlay.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/run/view_camera.hpp"
#include "trace/counters.hpp"
#include "trace/passes.hpp"

namespace lrb::compare {
namespace {

using render::group_digits;
using render::short_number;

const LrbRep& rep_of(const Runs& runs, std::size_t i) {
  return runs.of[i]->bodies[0].rep;
}

/// Returns the chart's curve of faces.
trace::Chart chart_of_faces(const trace::Trace& trace) {
  return trace.header.construction ? trace::chart_over_construction(trace) : trace::chart_over_events(trace);
}

run::Framing framing_of_bodies(const Runs& runs) {
  run::Framing out;
  out.dim = rep_of(runs, 0).dim();
  for (std::size_t i = 0; i < 2; ++i)
    for (const Eigen::Vector3d& v : rep_of(runs, i).vertices())
      out.points.push_back(runs.of[i]->trace.steps[0].pose_a.apply(v));
  return out;
}

}  // namespace

bool of_one_body(const Runs& runs) {
  return runs.of[0]->bodies.size() == 1 && runs.of[1]->bodies.size() == 1;
}

report::PageTable body_table(const Runs& runs) {
  report::PageTable t;
  t.title = "The LRB-reps";
  t.columns = {"run", "real faces", "faces for each", "regions", "layers", "outermost wrapper", "events"};
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

report::PageTable pass_table(const Runs& runs) {
  report::PageTable t;
  t.title = "Pass by pass";
  t.columns = {"pass"};
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
  t.note = "Faces: of the hull after the pass. Passes that made nothing are counted.";
  return t;
}

report::PageChart faces_chart(const Runs& runs) {
  report::PageChart c;
  const bool built = runs.of[0]->trace.header.construction;
  c.title = built ? "The hull, event by event" : "The wrapper, event by event";
  c.x_label = "event";
  c.y_label = "faces";
  c.stepped = true;
  for (std::size_t i = 0; i < 2; ++i) {
    trace::Chart chart = chart_of_faces(runs.of[i]->trace);
    for (trace::Series& s : chart.series)
      if (s.unit == "faces" && std::any_of(s.values.begin(), s.values.end(), [](double v) { return v > 0; }))
        c.series.push_back({runs.names[i], chart.x, std::move(s.values)});
  }
  return c;
}

render::Image draw_bodies(const Runs& runs, const run::ProgressReport& progress) {
  const run::Framing framing = framing_of_bodies(runs);
  std::vector<render::Panel> panels;
  for (std::size_t i = 0; i < 2; ++i) {
    const run::Recording& recording = *runs.of[i];
    const run::RecordedRun recorded = run::recorded_run_of(*runs.scenarios[i], recording);
    render::FrameSpec frame = runs.scenarios[i]->frames;
    frame.colour_by = render::FrameSpec::ColourBy::region;
    frame.at = render::FrameSpec::At::events;
    frame.events = {static_cast<trace::EventId>(recording.trace.events.size() - 1)};
    frame.width = 900;
    frame.height = 700;
    frame.montage = 0;
    if (frame.views.empty()) frame.views.emplace_back();
    frame.views.resize(1);
    frame.views[0].title = runs.names[i];
    panels.push_back({std::move(run::paint_frames(recorded, frame, progress, &framing).front().image), ""});
  }
  render::MontageOptions options;
  options.columns = 2;
  options.letters = false;
  return render::montage(panels, options);
}

}  // namespace lrb::compare
