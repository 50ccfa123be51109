#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>

#include "engine/error.hpp"
#include "engine/mesh/file_bytes.hpp"
#include "scenarios/charts/gnuplot.hpp"
#include "scenarios/cli/choice.hpp"
#include "scenarios/cli/command.hpp"
#include "scenarios/cli/measure_options.hpp"
#include "scenarios/cli/progress.hpp"
#include "scenarios/files.hpp"
#include "scenarios/measure/chart_page.hpp"
#include "scenarios/measure/chart_print.hpp"
#include "scenarios/measure/machine.hpp"
#include "scenarios/measure/scenes.hpp"
#include "scenarios/measure/survey.hpp"

namespace lrb::cli {
namespace {

using namespace lrb::measure;
using stability::WorkerMethod;

struct ChartOptions : MeasureOptions {
  ChartOptions() {
    folder = "out/chart";
    set.poses = 8;
  }
  std::uint32_t faces = 2000;
  bool scenes = true;
};

/// Data sets of an earlier `measure`, by name.
std::vector<DataSet> read_sets(const std::string& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().string().ends_with(".set.json")) files.push_back(entry.path().string());
  if (files.empty())
    throw InputError(printable_name(folder) + ": no data sets there; run `lrbscope chart measure` first");
  std::sort(files.begin(), files.end());
  std::vector<DataSet> sets;
  for (const std::string& f : files) sets.push_back(read_data_set(f));
  return sets;
}

void measure(const ChartOptions& o, const std::vector<WorkerMethod>& methods, const Globals& globals) {
  SurveyOptions options;
  options.folder = o.folder;
  options.timeout = o.timeout;
  options.keep = true;
  options.contestants = contestants(methods);
  std::vector<BodyPair> pairs;
  if (!o.models.empty()) pairs = pairs_of_models(o.models);
  if (o.faces > 0)
    for (BodyPair& p : generated_pairs(o.faces)) pairs.push_back(std::move(p));
  for (const BodyPair& p : pairs) options.sets.push_back(make_data_set(p, o.set, o.folder));
  Progress bar("measure", 0, globals.quiet);
  survey(options, [&](std::uint64_t done, std::uint64_t total, const std::string& what) {
    bar.set_total(total);
    bar.set(done, what);
  });
  print(o.folder + "/records.jsonl\n");
}

void draw(const ChartOptions& o, const std::vector<WorkerMethod>& methods, const Globals& globals) {
  const std::vector<DataSet> sets = read_sets(o.folder);
  std::vector<methods::MethodInfo> infos;
  for (const WorkerMethod& m : methods) infos.push_back(m.info);
  std::vector<Point> points;
  {
    Progress bar("errors", 0, globals.quiet);
    points = measure_points(sets, infos, read_records(o.folder + "/records.jsonl"),
                            [&](std::size_t done, std::size_t total) {
                              bar.set_total(total);
                              bar.set(done);
                            });
  }
  write_text(o.folder + "/points.jsonl", to_lines(points));
  std::map<SceneKey, std::string> scenes;
  if (o.scenes) scenes = write_scenes(sets, points, o.folder, progress_report(globals.quiet));
  Page page = accuracy_page(sets, points, infos, [&](const Point& p) {
    const auto it = scenes.find({p.set, p.pose_class});
    return it == scenes.end() ? std::string() : it->second;
  });
  page.numbers = {{"Machine", machine(), build_flags()}};
  page.command = globals.command_line;
  page.links = {{"records.jsonl", "records.jsonl", "every answer of every method"},
                {"points.jsonl", "points.jsonl", "what was computed from them"}};
  for (const auto& [key, target] : scenes)
    page.links.push_back({key.first + ", " + title(key.second), target, "scene, trace and pictures"});
  try {
    const Gnuplot chart = accuracy_chart(sets, points);
    for (const char* ending : {".svg", ".png"}) {
      lrb::draw(chart, o.folder + "/chart" + ending);
      page.links.push_back({std::string("chart") + ending, std::string("chart") + ending, "for print"});
      print(o.folder + "/chart" + ending + "\n");
    }
  } catch (const EnvironmentError& e) {
    std::cerr << "lrbscope: " << e.what() << "\n";
  }
  write_text(o.folder + "/index.html", page_html(page));
  print(o.folder + "/index.html\n");
}

int run_chart(const ChartOptions& o, bool measures, bool draws, const Globals& globals) {
  const std::vector<WorkerMethod> methods = chosen(stability::find_all_methods(), o.methods, "method",
                                                   [](const WorkerMethod& m) { return m.info.name; });
  make_folder(o.folder);
  const FolderLock lock(o.folder);
  if (measures) measure(o, methods, globals);
  if (draws) draw(o, methods, globals);
  return kOk;
}

}  // namespace

Command add_chart(CLI::App& root, const Globals& globals) {
  CLI::App* app = root.add_subcommand(
      "chart", "Speed against accuracy: every method at every setting, exact ones and approximations");
  const auto o = std::make_shared<ChartOptions>();
  app->require_subcommand(0, 1);
  CLI::App* measures =
      app->add_subcommand("measure", "Ask only: raw records, added to what is there")->fallthrough();
  CLI::App* draws = app->add_subcommand("draw", "From the records: errors, charts, page")->fallthrough();
  add_measure_options(*app, *o);
  app->add_option("--faces", o->faces, "Size of the generated bodies; 0: none [2000]")
      ->check(CLI::Range(0, 200000))
      ->type_name("N");
  app->add_flag("!--no-scenes", o->scenes, "Do not play the scenes that points lead to");
  return {app, [o, &globals, measures, draws] {
            return run_chart(*o, !draws->parsed(), !measures->parsed(), globals);
          }};
}

}  // namespace lrb::cli
