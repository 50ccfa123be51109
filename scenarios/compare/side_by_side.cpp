#include "scenarios/compare/side_by_side.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "render/pictures/panel.hpp"
#include "scenarios/frames/face_colours.hpp"
#include "scenarios/record/moments.hpp"
#include "scenarios/run/run_scenario.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::compare {
namespace {

using render::group_digits;
using ColourBy = pictures::FrameSpec::ColourBy;
using FaceValues = std::array<std::vector<double>, 2>;  ///< of A and of B

/// Returns the face values that determine the colours in a step.
FaceValues values_of(const record::Recording& r, ColourBy by, std::size_t step) {
  FaceValues out;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = frames::face_values(by, r.bodies[i].rep, static_cast<Side>(i), r.trace.events_of(step),
                                 r.trees.empty() ? nullptr : &r.trees[i]);
  return out;
}

double largest(const FaceValues& values) {
  return frames::scale_without_the_smallest(values)[1];
}

/// Returns |x - y| for each real face; empty if the numbers of faces differ.
FaceValues difference(const Runs& runs, const std::array<FaceValues, 2>& values) {
  FaceValues out;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::uint32_t n = runs.of[0]->bodies[i].rep.real_face_count();
    if (n != runs.of[1]->bodies[i].rep.real_face_count()) return {};
    out[i].resize(values[0][i].size());
    for (std::uint32_t f = 0; f < n; ++f) out[i][f] = std::abs(values[0][i][f] - values[1][i][f]);
  }
  return out;
}

}  // namespace

std::size_t step_count(const Runs& runs) {
  return std::min(runs.of[0]->trace.steps.size(), runs.of[1]->trace.steps.size());
}

std::size_t busiest_step(const Runs& runs) {
  const auto work = [&](std::size_t i) {
    return runs.of[0]->trace.steps[i].result.counters.box_tests +
           runs.of[1]->trace.steps[i].result.counters.box_tests;
  };
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < step_count(runs); ++i)
    if (is_whole(*runs.of[0], i) && is_whole(*runs.of[1], i) && (!best || work(i) > work(*best))) best = i;
  if (!best)
    throw InputError(
        "no step is recorded completely in both runs; record them with a larger trace.max_events");
  return *best;
}

bool is_whole(const record::Recording& run, std::size_t step) {
  return run.trace.steps[step].events_seen == run.trace.events_of(step).size();
}

std::string cut_words(const Runs& runs) {
  std::string out;
  for (std::size_t i = 0; i < 2; ++i)
    if (const trace::Trace& t = runs.of[i]->trace; t.truncated())
      out += (out.empty() ? "" : " ") + runs.names[i] + " is truncated: its trace contains " +
             group_digits(t.events.size()) + " of " + group_digits(t.events_seen) + " events.";
  return out;
}

void reject_folder_of_run(const std::string& folder, const std::string& option) {
  std::error_code error;
  for (const char* file : {"/trace.json", "/trace.json.gz"})
    if (std::filesystem::exists(folder + file, error))
      throw InputError(printable_name(folder) +
                       ": contains a run, whose page would be overwritten; choose another folder with " +
                       option);
}

ColourBy common_colours(const Runs& runs) {
  return runs.of[0]->trees.empty() || runs.of[1]->trees.empty() ? ColourBy::face_tests : ColourBy::box_tests;
}

render::Panel panel_after(const frames::RecordedRun& recorded, pictures::FrameSpec frame,
                          trace::EventId event, const std::string& title, const pictures::Framing& framing,
                          const record::ProgressReport& progress) {
  frame.at = pictures::FrameSpec::At::events;
  frame.events = {event};
  frame.width = 900;
  frame.height = 700;
  frame.views = {frame.first_view()};
  frame.views[0].title = title;
  return {std::move(frames::paint_frames(recorded, frame, progress, &framing).front().image), ""};
}

render::Image in_a_row(const std::vector<render::Panel>& panels) {
  render::MontageOptions options;
  options.columns = static_cast<int>(panels.size());
  options.letters = false;
  return render::montage(panels, options);
}

render::Image draw(const Runs& runs, std::size_t step, const record::ProgressReport& progress) {
  const ColourBy by = common_colours(runs);
  const std::array<FaceValues, 2> values = {values_of(*runs.of[0], by, step),
                                            values_of(*runs.of[1], by, step)};
  const FaceValues& larger = largest(values[0]) > largest(values[1]) ? values[0] : values[1];
  const auto& bodies = runs.of[0]->bodies;
  const trace::Step& first = runs.of[0]->trace.steps[step];
  const pictures::PosedBodies posed{bodies[0].rep, first.pose_a, bodies[1].rep, first.pose_b};
  const pictures::Framing framing{posed.points(), {}, posed.dim()};
  std::vector<render::Panel> panels;
  const auto add = [&](std::size_t i, const std::string& title, const FaceValues& shown,
                       const std::string& value_name) {
    frames::RecordedRun recorded = run::recorded_run_of(*runs.scenarios[i], *runs.of[i]);
    recorded.value_range = frames::scale_without_the_smallest(shown);
    if (!value_name.empty()) recorded.face_values = &shown;
    recorded.value_name = value_name;
    pictures::FrameSpec frame = runs.scenarios[i]->frames;
    frame.colour_by = by;
    frame.views = {frame.first_view()};
    frame.views[0].wrapper = false;
    panels.push_back(panel_after(recorded, std::move(frame), record::last_event(runs.of[i]->trace, step),
                                 title, framing, progress));
  };
  for (std::size_t i = 0; i < 2; ++i) add(i, runs.names[i], larger, "");
  const FaceValues deviation = difference(runs, values);
  if (largest(deviation) > 0)
    add(0, "Difference", deviation,
        by == ColourBy::box_tests ? "difference of box tests" : "difference of face tests");
  return in_a_row(panels);
}

void add_work_charts(report::Document& doc, const Runs& runs) {
  for (const auto& [what, counter] :
       {std::pair{"Box tests", &Counters::box_tests}, {"Face tests", &Counters::face_tests}}) {
    report::Chart c{std::string(what) + " by step", {"time step"}, {what, true}, {}, "0 is drawn as 1."};
    for (std::size_t i = 0; i < 2; ++i) {
      report::Series s{runs.names[i], {}, {}};
      for (const trace::Step& step : runs.of[i]->trace.steps) {
        s.x.push_back(step.index);
        s.y.push_back(static_cast<double>(std::max<std::uint64_t>(step.result.counters.*counter, 1)));
      }
      c.series.push_back(std::move(s));
    }
    doc.chart(c);
  }
}

std::uint64_t sum_of(const record::Recording& run, std::uint64_t Counters::*counter) {
  std::uint64_t out = 0;
  for (const trace::Step& s : run.trace.steps) out += s.result.counters.*counter;
  return out;
}

std::uint64_t pairs_of(const record::Recording& run) {
  std::uint64_t out = 0;
  for (const trace::Step& s : run.trace.steps) out += s.result.pair_count;
  return out;
}

report::Table totals_of(const Runs& runs) {
  report::Table t{"All steps together",
                  {"run", "pairs of nodes", "box tests", "face tests", "refined regions", "pairs found"}};
  for (std::size_t i = 0; i < 2; ++i) {
    const record::Recording& r = *runs.of[i];
    t.rows.push_back(
        {runs.names[i], group_digits(sum_of(r, &Counters::node_pairs)),
         group_digits(sum_of(r, &Counters::box_tests)), group_digits(sum_of(r, &Counters::face_tests)),
         r.trace.header.engine.empty() ? group_digits(sum_of(r, &Counters::regions_opened)) : "none",
         group_digits(pairs_of(r))});
  }
  return t;
}

}  // namespace lrb::compare
