#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>

#include "bench/speed/chart_page.hpp"
#include "bench/speed/make_sets.hpp"
#include "bench/speed/peer_table.hpp"
#include "bench/speed/survey.hpp"
#include "scenarios/figure/figure_layout.hpp"
#include "tools/bench_options.hpp"
#include "tools/commands.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::tools {
namespace {

struct ChartOptions : MeasureOptions {
  ChartOptions() {
    folder_help = "out/chart, or out/chart-QUANTITY";
    set.poses = 8;
  }
  std::uint32_t faces = 2000;
  unsigned rounds = 3;
  bool scenes = true;
  std::string width;
  speed::ChartPrint print;
};

/// Returns the data sets of an earlier run for this quantity, by name.
std::vector<speed::DataSet> read_sets(const std::string& folder, methods::Quantity quantity) {
  std::vector<std::string> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.path().string().ends_with(".set.json")) files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  std::vector<speed::DataSet> sets;
  std::transform(files.begin(), files.end(), std::back_inserter(sets), speed::read_data_set);
  std::erase_if(sets, [&](const speed::DataSet& s) { return s.quantity != quantity; });
  if (sets.empty())
    throw InputError(printable_name(folder) + ": no data sets found; run `lrbscope chart measure` first");
  return sets;
}

void measure(const ChartOptions& o, const std::vector<workers::WorkerMethod>& methods,
             const Globals& globals) {
  speed::SurveyOptions options;
  options.folder = o.folder;
  options.timeout = o.timeout;
  options.judges = true;
  options.rounds = o.rounds;
  options.contestants = speed::contestants(methods);
  std::vector<speed::BodyPair> pairs;
  if (!o.models.empty()) pairs = speed::pairs_of_models(o.models);
  if (o.faces > 0)
    for (speed::BodyPair& p : speed::generated_pairs(o.faces)) pairs.push_back(std::move(p));
  std::vector<std::string> names;
  for (const speed::BodyPair& p : pairs) names.push_back(speed::set_name(p, o.set.quantity));
  speed::write_plan(options, names);
  for (const speed::BodyPair& p : pairs) options.sets.push_back(speed::make_data_set(p, o.set, o.folder));
  Progress bar("measure", 0, globals.quiet);
  speed::survey(options, bar.setter());
  print(o.folder + "/records.jsonl\n");
}

void draw(const ChartOptions& o, const std::vector<workers::WorkerMethod>& methods,
          const report::Folder& folder, const Globals& globals) {
  const std::vector<speed::DataSet> sets = read_sets(o.folder, o.set.quantity);
  const std::vector<methods::MethodInfo> infos = workers::infos_of(methods);
  const std::vector<speed::Record> records = speed::read_records(o.folder + "/records.jsonl");
  const std::vector<speed::Missing> missing = speed::missing_answers(o.folder, sets, records);
  const std::string unfinished = speed::missing_text(missing);
  if (!unfinished.empty()) note(globals, {unfinished});
  const std::vector<speed::Point> points = speed::measure_points(sets, infos, records);
  std::map<speed::SceneKey, std::string> scenes;
  if (o.scenes) scenes = speed::write_scenes(sets, points, o.folder, progress_report(globals.quiet));
  const auto charts = speed::accuracy_charts(sets, points, infos, [&](const speed::Point& p) {
    const auto it = scenes.find({p.set, p.pose_class});
    return it == scenes.end() ? std::string() : it->second;
  });
  report::Document page = speed::accuracy_page(o.set.quantity, sets, points, infos, charts, unfinished);
  page.number({"Machine", speed::machine(), speed::build_flags()}).command(globals.command_line);
  page.link({"records.jsonl", "every answer of every method"});
  page.file("points.jsonl", speed::to_lines(points), "computed from them");
  page.file("chart.csv", speed::drawn_csv(points), "the points of the charts");
  const report::Table settings = speed::table_of_settings(sets, points, infos);
  page.file("settings.csv", report::csv(settings), "which setting for which error");
  if (o.tex) page.file("settings.tex", report::booktabs(settings), "the same, for LaTeX with booktabs");
  for (const auto& [key, target] : scenes)
    page.link({target, "scene, trace and pictures", key.first + ", " + speed::info_of(key.second).title});
  page.print("chart", "for print", speed::accuracy_print(o.set.quantity, sets, missing, charts));
  if (o.print.width > 0)
    page.print("figure", figure::length_text(o.print.width * figure::kPointsPerMm) + " wide",
               speed::accuracy_print(o.set.quantity, sets, missing, charts, o.print), true);
  page.write(folder);
  for (const std::string& line : page.notes()) std::cerr << "lrbscope: " << line << "\n";
  for (const std::string& file : page.written()) print(o.folder + "/" + file + "\n");
}

int run_chart(ChartOptions o, bool measures, bool draws, const Globals& globals) {
  const methods::Quantity quantity = o.set.quantity;
  const bool pairs = quantity == methods::Quantity::pairs;
  if (quantity == methods::Quantity::self_intersections)
    throw InputError("--quantity: expected pairs, near_pairs, distance, first_contact or depth, found " +
                     std::string(name_of(quantity)));
  constexpr double kWidest = 500 * figure::kPointsPerMm;
  if (!o.print.panels.empty() && o.width.empty()) o.width = "85mm";
  if (!o.width.empty())
    o.print.width =
        figure::parse_length(o.width, "--width", 20 * figure::kPointsPerMm, kWidest) / figure::kPointsPerMm;
  if (o.folder.empty()) o.folder = pairs ? "out/chart" : "out/chart-" + std::string(name_of(quantity));
  const std::vector<workers::WorkerMethod> methods =
      chosen_methods(workers::find_methods(quantity), o.methods);
  const report::Folder folder(o.folder);
  if (measures) measure(o, methods, globals);
  if (draws) draw(o, methods, folder, globals);
  return kOk;
}

}  // namespace

Command add_chart(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "chart", "Chart speed versus accuracy of every method at every setting, exact and approximate");
  const auto o = std::make_shared<ChartOptions>();
  app->require_subcommand(0, 1);
  App* measures =
      app->add_subcommand("measure", "Measure only: append raw records to the folder")->fallthrough();
  App* draws =
      app->add_subcommand("draw", "Draw only: compute errors, charts and the page from existing records")
          ->fallthrough();
  add_measure_options(*app, *o);
  add_quantity_option(*app, o->set.quantity);
  app->get_option("--quantity")
      ->description("Quantity to compute: pairs, near_pairs, distance, first_contact or depth [pairs]");
  app->add_option("--faces", o->faces, "N", "Face count of the generated bodies; 0: none [2000]")
      ->in_range(0, 200000);
  app->add_option(
         "--rounds", o->rounds, "N",
         "Number of times that each method is timed, after all others; points on the frontier differ "
         "by more than the span of rounds [3]")
      ->in_range(1, 100);
  app->add_option("--width", o->width, "LENGTH",
                  "Also write figure.pdf and figure.svg, this wide on paper, in mm, cm, in or pt; text is 7 "
                  "points high [85mm with --panel]");
  app->add_option("--panel", o->print.panels, "NAME,NAME,...",
                  "Panels of the figure: pairs of bodies, classes of poses, or BODIES/CLASS [all]")
      ->delimiter(',');
  add_tex_option(*app, o->tex, "settings.tex, the table of settings,");
  app->add_flag("!--no-scenes", o->scenes, "Do not run the scenarios that the chart's points link to");
  return {app, [o, &globals, measures, draws] {
            return run_chart(*o, !draws->parsed(), !measures->parsed(), globals);
          }};
}

}  // namespace lrb::tools
