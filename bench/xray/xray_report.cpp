#include "bench/xray/xray_report.hpp"

#include <algorithm>
#include <filesystem>

#include "bench/xray/foreign_walk.hpp"
#include "scenarios/compare/side_by_side.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/run_page.hpp"
#include "scenarios/run/run_scenario.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::xray {
namespace {

using render::group_digits;

constexpr const char* kHeatFile = "heat.png";

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
  t.note = "Against exact answers. " + group_digits(wrong);
  t.note += wrong == 1 ? " pair is wrong." : " pairs are wrong.";
  if (x.method == "cgal")
    t.note +=
        " CGAL is asked as its manual shows, with A's triangles moved into B's frame: its predicates are exact, but "
        "the corners that they see were rounded on the way.";
  return t;
}

}  // namespace

std::vector<std::string> write_xray(const Xray& x, const std::string& folder,
                                    const run::ProgressReport& progress) {
  const compare::Runs runs{{&x.theirs, &x.ours}, {x.walk.title, "lrbscope"}, {&x.scenario, &x.scenario}};
  const std::size_t step = compare::busiest_step(runs);
  std::vector<std::string> notes;
  compare::refuse_folder_of_run(folder);
  make_folder(folder);
  const io::FolderLock lock(folder);
  io::refuse_links(folder);
  for (const auto& [recording, name] : {std::pair{&x.theirs, x.method}, {&x.ours, std::string("ours")}}) {
    spec::Scenario scenario = x.scenario;
    scenario.purpose =
        recording == &x.theirs
            ? "Recorded in " + x.walk.title +
                  ". It has no wrappers, so that none is refined; contact curves are exact ones."
            : "Recorded in lrbscope.";
    const run::RunOutcome outcome = run::write_run(
        scenario, *recording, (std::filesystem::path(folder) / name).string(), x.command, progress);
    notes.insert(notes.end(), outcome.notes.begin(), outcome.notes.end());
  }
  report::Page page;
  page.title = x.scenario.name;
  page.purpose = "What " + x.walk.title + " does for two bodies at " + std::to_string(x.walk.steps.size()) +
                 (x.walk.steps.size() == 1 ? " pose" : " poses") +
                 ", recorded in its own traversal, beside what lrbscope does.";
  if (const std::string cut = compare::cut_words(runs); !cut.empty()) page.purpose += " " + cut;
  page.command = x.command;
  std::uint64_t wrong = 0;
  report::PageTable wrong_pairs = wrong_table(x, wrong);
  page.numbers = {
      {"Box tests", group_digits(compare::sum_of(x.theirs, &Counters::box_tests)),
       "lrbscope: " + group_digits(compare::sum_of(x.ours, &Counters::box_tests))},
      {"Pairs of triangles tested", group_digits(compare::sum_of(x.theirs, &Counters::face_tests)),
       "lrbscope: " + group_digits(compare::sum_of(x.ours, &Counters::face_tests))},
      {"Pairs found", group_digits(compare::pairs_of(x.theirs)),
       "lrbscope: " + group_digits(compare::pairs_of(x.ours))},
      {"Wrong pairs", group_digits(wrong), "against exact answers"}};
  page.charts = {
      compare::chart_of(runs, "Tests of boxes, step by step", "box tests", &Counters::box_tests),
      compare::chart_of(runs, "Tests of faces, step by step", "face tests", &Counters::face_tests)};
  if (!wrong_pairs.rows.empty()) page.tables.push_back(std::move(wrong_pairs));
  page.tables.push_back(compare::totals_of(runs));
  page.tables.back().note =
      "A pair of nodes of " + x.walk.title +
      " is one test of two bounding volumes; of lrbscope's it is two nodes with up to eight boxes each, compared eight at a "
      "time. What planes of eight faces at a time part is not among lrbscope's face tests.";
  render::write_png(compare::draw(runs, step, progress), folder + "/" + kHeatFile);
  run::add_figure(
      page, folder, "Where the box tests went, at step " + std::to_string(x.ours.trace.steps[step].index),
      "Each node's tests are shared evenly by the faces beneath it; both engines on one scale, and how much they "
      "differ. Pale faces have fewer than a fiftieth of the most.",
      kHeatFile);
  page.links.push_back({x.method + "/index.html", x.method + "/index.html",
                        "the run of " + x.walk.title + ", with its trace"});
  page.links.push_back({"ours/index.html", "ours/index.html", "the run of lrbscope, with its trace"});
  page.views = {{x.walk.title, x.method + "/index.html"}, {"lrbscope", "ours/index.html"}};
  page.footer = report::footer(x.ours.trace.header.lrbscope);
  io::write_text(folder + "/index.html", report::page_html(page));
  return notes;
}

}  // namespace lrb::xray
