#include "scenarios/xray/xray_report.hpp"

#include <algorithm>
#include <array>

#include "render/montage.hpp"
#include "render/overlay.hpp"
#include "render/png.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/moments.hpp"
#include "scenarios/run/run_report.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/xray/foreign_run.hpp"
#include "trace/node_work.hpp"

namespace lrb::xray {
namespace {

using render::group_digits;

constexpr const char* kHeatFile = "heat.png";

/// Returns the step at which the engines together test most boxes.
std::size_t busiest_step(const Xray& x) {
  std::size_t best = 0;
  const auto work = [&](std::size_t i) {
    return x.theirs.trace.steps[i].result.counters.box_tests +
           x.ours.trace.steps[i].result.counters.box_tests;
  };
  for (std::size_t i = 1; i < x.ours.trace.steps.size(); ++i)
    if (work(i) > work(best)) best = i;
  return best;
}

/// Returns the largest number of box tests of a face in a step.
double most_box_tests(const run::Recording& r, std::size_t step) {
  double most = 0;
  for (const Side side : {Side::a, Side::b}) {
    const auto i = static_cast<std::size_t>(side);
    for (const double v : trace::box_tests_by_face(
             r.bodies[i].rep, r.trees[i], trace::count_nodes(r.trees[i], side, r.trace.events_of(step))))
      most = std::max(most, v);
  }
  return most;
}

/// Returns what a camera has to show: the bodies of one step.
run::Framing framing_of(const run::RecordedRun& run, std::size_t step) {
  const trace::Step& s = run.trace->steps[step];
  run::Framing out;
  for (const auto& [rep, pose] : {std::pair{run.reps[0], &s.pose_a}, {run.reps[1], &s.pose_b}})
    for (const Eigen::Vector3d& v : rep->vertices()) out.points.push_back(pose->apply(v));
  return out;
}

/// Draws the box tests of both engines on one scale.
render::Image heat_maps(const Xray& x, std::size_t step, const run::ProgressReport& progress) {
  constexpr double kFew = 0.02;
  const double most = std::max(most_box_tests(x.theirs, step), most_box_tests(x.ours, step));
  std::vector<render::Panel> panels;
  for (const auto& [recording, name] :
       {std::pair{&x.theirs, x.walk.title}, {&x.ours, std::string("lrbscope")}}) {
    spec::FrameSpec frame = x.scenario.frames;
    frame.colour_by = spec::FrameSpec::ColourBy::box_tests;
    frame.at = spec::FrameSpec::At::events;
    frame.events = {run::last_event(recording->trace, step)};
    frame.width = 900;
    frame.height = 700;
    frame.views.resize(1);
    frame.views[0].wrapper = false;
    frame.views[0].title = name;
    run::RecordedRun recorded = run::recorded_run_of(x.scenario, *recording);
    recorded.value_range = {{kFew * most, most}};
    const run::Framing framing = framing_of(recorded, step);
    panels.push_back({std::move(run::paint_frames(recorded, frame, progress, &framing).front().image), ""});
  }
  render::MontageOptions options;
  options.columns = 2;
  options.letters = false;
  return render::montage(panels, options);
}

std::uint64_t sum(const run::Recording& r, std::uint64_t Counters::*counter) {
  std::uint64_t out = 0;
  for (const trace::Step& s : r.trace.steps) out += s.result.counters.*counter;
  return out;
}
std::uint64_t pairs(const run::Recording& r) {
  std::uint64_t out = 0;
  for (const trace::Step& s : r.trace.steps) out += s.result.pair_count;
  return out;
}

report::PageTable totals_table(const Xray& x) {
  report::PageTable t;
  t.title = "All steps together";
  t.columns = {"engine", "pairs of nodes", "box tests", "pairs of triangles tested", "pairs found"};
  for (const auto& [r, name] : {std::pair{&x.theirs, x.walk.title}, {&x.ours, std::string("lrbscope")}})
    t.rows.push_back({name, group_digits(sum(*r, &Counters::node_pairs)),
                      group_digits(sum(*r, &Counters::box_tests)),
                      group_digits(sum(*r, &Counters::face_tests)), group_digits(pairs(*r))});
  t.note =
      "A pair of nodes of " + x.walk.title +
      " is one test of two bounding volumes; of lrbscope's it is two nodes with up to eight boxes each, compared "
      "eight at a time. What planes of eight triangles at a time part is not among lrbscope's triangles tested.";
  return t;
}

report::PageTable wrong_table(const Xray& x, std::uint64_t& wrong) {
  constexpr std::size_t kMostRows = 30;
  report::PageTable t;
  t.title = "Pairs that " + x.walk.title + " got wrong";
  t.columns = {"step", "triangle of A", "triangle of B", "what is wrong", "why"};
  wrong = 0;
  for (std::size_t i = 0; i < x.walk.steps.size(); ++i) {
    const WrongPairs w = wrong_pairs(x.walk.steps[i], x.ours.results[i].pairs);
    wrong += w.too_many.size() + w.missing.size();
    for (const auto& [list, words] : {std::pair{&w.too_many, "reported, but they do not meet"},
                                      {&w.missing, "they meet, but are not reported"}})
      for (const SimplexPair& p : *list)
        if (t.rows.size() < kMostRows)
          t.rows.push_back({std::to_string(x.ours.trace.steps[i].index), std::to_string(p.a),
                            std::to_string(p.b), words,
                            x.why + " --pose " + std::to_string(i) + " --pair " + std::to_string(p.a) + "," +
                                std::to_string(p.b)});
  }
  t.note = "Against exact answers. " + group_digits(wrong) +
           (wrong == 1 ? " pair is wrong." : " pairs are wrong.");
  return t;
}

report::PageChart chart(const Xray& x, const char* title, const char* what,
                        std::uint64_t Counters::*counter) {
  report::PageChart c;
  c.title = title;
  c.x_label = "time step";
  c.y_label = what;
  c.log_y = true;
  c.note = "0 is drawn as 1.";
  for (const auto& [r, name] : {std::pair{&x.theirs, x.walk.title}, {&x.ours, std::string("lrbscope")}}) {
    report::PageSeries s{name, {}, {}};
    for (const trace::Step& step : r->trace.steps) {
      s.x.push_back(step.index);
      s.y.push_back(static_cast<double>(std::max<std::uint64_t>(step.result.counters.*counter, 1)));
    }
    c.series.push_back(std::move(s));
  }
  return c;
}

}  // namespace

std::vector<std::string> write_xray(const Xray& x, const std::string& folder,
                                    const run::ProgressReport& progress) {
  std::vector<std::string> notes;
  io::make_folder(folder);
  const io::FolderLock lock(folder);
  io::refuse_links(folder);
  for (const auto& [recording, name] : {std::pair{&x.theirs, x.method}, {&x.ours, std::string("ours")}}) {
    spec::Scenario scenario = x.scenario;
    scenario.purpose =
        recording == &x.theirs
            ? "Recorded in " + x.walk.title +
                  ". It has no wrappers, so that none is refined; contact curves are exact ones."
            : "Recorded in lrbscope.";
    const run::RunOutcome outcome =
        run::write_run(scenario, *recording, folder + "/" + name, x.command, progress);
    notes.insert(notes.end(), outcome.notes.begin(), outcome.notes.end());
  }
  const std::size_t step = busiest_step(x);
  report::Page page;
  page.title = x.scenario.name;
  page.purpose = "What " + x.walk.title + " does for two bodies at " + std::to_string(x.walk.steps.size()) +
                 (x.walk.steps.size() == 1 ? " pose" : " poses") +
                 ", recorded in its own traversal, beside what lrbscope does.";
  page.command = x.command;
  std::uint64_t wrong = 0;
  report::PageTable wrong_pairs = wrong_table(x, wrong);
  page.numbers = {{"Box tests", group_digits(sum(x.theirs, &Counters::box_tests)),
                   "lrbscope: " + group_digits(sum(x.ours, &Counters::box_tests))},
                  {"Pairs of triangles tested", group_digits(sum(x.theirs, &Counters::face_tests)),
                   "lrbscope: " + group_digits(sum(x.ours, &Counters::face_tests))},
                  {"Pairs found", group_digits(pairs(x.theirs)), "lrbscope: " + group_digits(pairs(x.ours))},
                  {"Wrong pairs", group_digits(wrong), "against exact answers"}};
  page.charts = {chart(x, "Tests of boxes, step by step", "box tests", &Counters::box_tests),
                 chart(x, "Pairs of triangles tested, step by step", "pairs tested", &Counters::face_tests)};
  if (!wrong_pairs.rows.empty()) page.tables.push_back(std::move(wrong_pairs));
  page.tables.push_back(totals_table(x));
  render::write_png(heat_maps(x, step, progress), folder + "/" + kHeatFile);
  run::add_figure(
      page, folder, "Where the box tests went, at step " + std::to_string(x.ours.trace.steps[step].index),
      "Each node's tests are shared evenly by the faces beneath it; both engines on one scale. Pale faces have "
      "fewer than a fiftieth of the most.",
      kHeatFile);
  page.links.push_back({x.method + "/index.html", x.method + "/index.html",
                        "the run of " + x.walk.title + ", with its trace"});
  page.links.push_back({"ours/index.html", "ours/index.html", "the run of lrbscope, with its trace"});
  page.footer =
      "lrbscope " + x.ours.trace.header.lrbscope + ". This page holds all it needs and fetches nothing.";
  io::write_text(folder + "/index.html", report::page_html(page));
  return notes;
}

}  // namespace lrb::xray
