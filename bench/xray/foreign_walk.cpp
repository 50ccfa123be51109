#include "bench/xray/foreign_walk.hpp"

#include <filesystem>

#include "bench/methods/triangles.hpp"
#include "bench/workers/workers.hpp"
#include "scenarios/compare/side_by_side.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/profile/captured_run.hpp"
#include "scenarios/run/run_page.hpp"
#include "scenarios/run/run_scenario.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/overlay.hpp>

namespace lrb::xray {
namespace {

void append(std::string& text, double x) {
  constexpr int kAllDigits = 17;
  text += io::number_text(x, kAllDigits);
  text += ' ';
}

void append(std::string& text, const LrbRep& rep) {
  const methods::Triangles t = methods::triangles_of(rep);
  text += std::to_string(t.vertices.size()) + " " + std::to_string(t.triangles.size()) + "\n";
  for (const Eigen::Vector3d& v : t.vertices)
    for (int i = 0; i < 3; ++i) append(text, v[i]);
  for (const auto& corners : t.triangles)
    for (const VertexId v : corners) text += std::to_string(v) + " ";
}

void append(std::string& text, const Pose& pose) {
  for (const double x : io::rows_of(pose)) append(text, x);
}

}  // namespace

capture::Capture walk_of(const std::string& engine, const LrbRep& a, const LrbRep& b,
                         std::span<const PosePair> poses) {
  constexpr std::chrono::seconds kLimit(600);
  const std::string program = workers::program_beside("lrbscope-xray-" + engine);
  if (program.empty())
    throw EnvironmentError("--method " + engine + ": cannot find the program lrbscope-xray-" + engine +
                           " next to lrbscope; install lib" + engine +
                           "-dev and build it: cmake --build --preset release --target lrbscope-workers");
  for (const LrbRep* rep : {&a, &b})
    if (rep->real_simplex_count() < 2)
      throw InputError(printable_name(rep->name()) +
                       ": expected a body of at least two triangles, found one");
  std::string text;
  append(text, a);
  append(text, b);
  text += std::to_string(poses.size()) + "\n";
  for (const PosePair& p : poses)
    for (const Pose* pose : {&p.a, &p.b}) {
      methods::check_rigid(*pose);
      append(text, *pose);
    }
  const workers::MemoryFile input("input"), captured("capture");
  input.write(text);
  const std::vector<std::string> lines =
      workers::lines_of({program, captured.path()}, kLimit, input.descriptor());
  if (lines.empty())
    throw EnvironmentError("--method " + engine + ": " + program + " failed, or took longer than " +
                           std::to_string(kLimit.count()) + " s");
  capture::Capture out = capture::read_capture(captured.path());
  if (out.cut_off || out.trees.size() != 2 || out.queries.size() != poses.size())
    throw EnvironmentError("--method " + engine + ": " + program +
                           " wrote an incomplete capture; check the free memory");
  return out;
}

run::Recording recording_of(const capture::Capture& walk, const run::Recording& ours,
                            const spec::Scenario& scenario) {
  profile::CapturedRunSettings settings;
  settings.name = scenario.name;
  settings.hash = scenario.hash;
  settings.sources = {ours.trace.header.bodies[0].source, ours.trace.header.bodies[1].source};
  settings.event_cap = scenario.event_cap;
  settings.reports = false;  // both runs have the same steps, and traces are the same every time
  profile::TreePair pair{{0, 1}, {}};
  for (std::size_t i = 0; i < walk.queries.size(); ++i) pair.queries.push_back(i);
  return profile::captured_run(walk, pair, ours.bodies, settings, ours.results, run::kSilent);
}

namespace {

using render::group_digits;

constexpr const char* kHeatFile = "heat.png";

report::Table wrong_table(const Xray& x, std::uint64_t& wrong) {
  constexpr std::size_t kMaxRows = 30;
  report::Table t{"Wrong pairs of " + x.title(),
                  {"step", "triangle of A", "triangle of B", "error", "explanation"}};
  wrong = 0;
  for (std::size_t i = 0; i < x.theirs.wrong.size(); ++i) {
    wrong += x.theirs.wrong[i].size();
    for (const run::WrongPair& w : x.theirs.wrong[i])
      if (t.rows.size() < kMaxRows)
        t.rows.push_back({std::to_string(x.ours.trace.steps[i].index), std::to_string(w.pair.a),
                          std::to_string(w.pair.b),
                          w.missed ? "intersecting, but not reported" : "reported, but disjoint",
                          x.why + " --pose " + std::to_string(i) + " --pair " + std::to_string(w.pair.a) +
                              "," + std::to_string(w.pair.b)});
  }
  t.note = "Compared with exact results. " + group_digits(wrong);
  t.note += wrong == 1 ? " pair is wrong." : " pairs are wrong.";
  if (x.method == "cgal")
    t.note +=
        " CGAL is called as in its manual, with A's triangles transformed to B's frame: its predicates are exact, but their "
        "corners were rounded by the transformation.";
  return t;
}

}  // namespace

std::vector<std::string> write_xray(const Xray& x, const std::string& folder,
                                    const run::ProgressReport& progress) {
  const compare::Runs runs{{&x.theirs, &x.ours}, {x.title(), "lrbscope"}, {&x.scenario, &x.scenario}};
  const std::size_t step = compare::busiest_step(runs);
  std::vector<std::string> notes;
  compare::reject_folder_of_run(folder);
  const report::Folder locked(folder);
  for (const auto& [recording, name] : {std::pair{&x.theirs, x.method}, {&x.ours, std::string("ours")}}) {
    spec::Scenario scenario = x.scenario;
    scenario.purpose = recording == &x.theirs
                           ? "Recorded in " + x.title() + "; its pairs are compared with exact answers."
                           : "Recorded in lrbscope.";
    const run::RunOutcome outcome = run::write_run(
        scenario, *recording, (std::filesystem::path(folder) / name).string(), x.command, progress);
    notes.insert(notes.end(), outcome.notes.begin(), outcome.notes.end());
  }
  report::Document doc(x.scenario.name, "The traversal of " + x.title() + " for two bodies at " +
                                            render::counted(x.theirs.trace.steps.size(), "pose", "poses") +
                                            ", beside that of lrbscope.");
  if (const std::string cut = compare::cut_words(runs); !cut.empty()) doc.purpose(cut);
  doc.command(x.command).version(x.ours.trace.header.lrbscope);
  std::uint64_t wrong = 0;
  const report::Table wrong_pairs = wrong_table(x, wrong);
  const auto number = [&](const char* label, const auto& count) {
    doc.number({label, group_digits(count(x.theirs)), "lrbscope: " + group_digits(count(x.ours))});
  };
  number("Box tests", [](const run::Recording& r) { return compare::sum_of(r, &Counters::box_tests); });
  number("Triangle pairs tested",
         [](const run::Recording& r) { return compare::sum_of(r, &Counters::face_tests); });
  number("Pairs found", compare::pairs_of);
  doc.number({"Wrong pairs", group_digits(wrong), "compared with exact answers"});
  doc.views({{x.title(), x.method + "/index.html"}, {"lrbscope", "ours/index.html"}});
  compare::add_work_charts(doc, runs);
  if (!wrong_pairs.rows.empty()) doc.table(wrong_pairs);
  report::Table totals = compare::totals_of(runs);
  totals.note =
      "A pair of nodes of " + x.title() +
      " is one test of two bounding volumes; of lrbscope's it is two nodes with up to eight boxes each, compared eight at a "
      "time. Faces that planes separate, eight at a time, are not among lrbscope's face tests.";
  doc.table(totals).picture(
      kHeatFile, compare::draw(runs, step, progress),
      "Box tests by face, step " + std::to_string(x.ours.trace.steps[step].index),
      "The tests of each node, shared evenly by the faces below it; both engines on one scale, and their difference. Pale: less "
      "than a fiftieth of the maximum.");
  doc.link({x.method + "/index.html", "the run of " + x.title() + ", with its trace"});
  doc.link({"ours/index.html", "the run of lrbscope, with its trace"}).write(locked);
  return notes;
}

}  // namespace lrb::xray
