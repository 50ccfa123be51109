#include <iostream>
#include <memory>

#include "scenarios/cli/command.hpp"
#include "scenarios/cli/options.hpp"
#include "scenarios/cli/progress.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/shipped.hpp"

namespace lrb::cli {
namespace {

struct RunCommandOptions {
  std::string scenario, folder;
  PictureOptions picture;
  std::optional<Recursion> recursion;
  std::optional<EventLevel> events;
  bool json = false;
};

int run_run(const RunCommandOptions& o, const Globals& globals) {
  spec::Scenario scenario = spec::open_scenario(o.scenario);
  apply(o.picture, scenario.frames);
  if (o.recursion) scenario.request.recursion = *o.recursion;
  if (o.events) scenario.events = *o.events;
  const std::string folder = o.folder.empty() ? "out/" + scenario.name : o.folder;
  if (o.folder.empty()) io::refuse_run_of_another(folder, o.scenario);
  run::RunOutcome outcome =
      run::run_scenario(scenario, folder, globals.command_line, progress_report(globals.quiet));
  if (o.folder.empty()) io::mark_run(folder, o.scenario);
  animate_frames(o.picture, folder);
  return report_outcome(outcome, folder, o.json, globals);
}

}  // namespace

int report_outcome(const run::RunOutcome& outcome, const std::string& folder, bool json,
                   const Globals& globals) {
  note(globals, outcome.notes);
  for (const std::string& line : outcome.mismatches) std::cerr << "lrbscope: mismatch: " << line << "\n";
  print(json ? outcome.summary : folder + "/index.html\n");
  return outcome.mismatches.empty() ? kOk : kMismatch;
}

Command add_run(CLI::App& root, const Globals& globals) {
  CLI::App* app = root.add_subcommand("run", "Run a scenario: frames, trace, numbers and a page");
  const auto o = std::make_shared<RunCommandOptions>();
  app->add_option("SCENARIO", o->scenario, "A shipped scenario (see lrbscope list), or a JSON file")
      ->required();
  app->add_option("-o,--output", o->folder, "Folder to write to [out/NAME]")->type_name("DIR");
  add_recursion_option(*app, o->recursion);
  add_events_option(*app, o->events);
  add_picture_options(*app, o->picture);
  add_animation_option(*app, o->picture);
  app->add_flag("--json", o->json, "Print the summary instead of the page's path");
  return {app, [o, &globals] { return run_run(*o, globals); }};
}

}  // namespace lrb::cli
