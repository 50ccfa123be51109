#include <iostream>
#include <memory>

#include "scenarios/crowd/crowd_report.hpp"
#include "scenarios/crowd/crowd_trace.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::cli {
namespace {

struct CrowdOptions {
  std::string crowd = "crowd", folder, pair;
  std::uint32_t jobs = 0;  ///< 0: all cores
  std::optional<std::uint32_t> steps;
  std::optional<trace::Clock> clock;
  bool no_frames = false, json = false;
};

/// Records two bodies of a recorded crowd as a run of their own.
int run_pair(const CrowdOptions& o, const Globals& globals) {
  const std::string path = run::trace_of(o.crowd);
  const std::string text = trace::load_trace_text(path);
  if (!crowd::is_crowd_trace(text))
    throw InputError(printable_name(o.crowd) + ": expected a recorded crowd (folder or trace) for --pair");
  const crowd::CrowdTrace trace = crowd::read_crowd_trace(text, path);
  const lrb::BodyPair pair = crowd::find_pair(trace, o.pair);
  spec::Scenario scenario = crowd::scenario_of_pair(trace, pair, path);
  scenario.frames.montage = 6;
  scenario.frames.views = run::whole_and_contact();
  if (o.no_frames) scenario.frames.at = render::FrameSpec::At::none;
  const std::string folder = o.folder.empty() ? "out/" + scenario.name : o.folder;
  const run::ProgressReport progress = progress_report(globals.quiet);
  std::vector<bodies::LoadedBody> bodies =
      run::find_bodies(path, {scenario.bodies[0].file, scenario.bodies[1].file}, {"A", "B"});
  run::Recording recording = run::record(scenario, std::move(bodies), progress);
  crowd::check_answers(trace, pair, recording);
  choose_views({}, scenario, recording);
  return report_outcome(run::write_run(scenario, recording, folder, globals.command_line, progress), folder,
                        o.json, globals);
}

int run_crowd_command(const CrowdOptions& o, const Globals& globals) {
  if (!o.pair.empty()) return run_pair(o, globals);
  spec::Crowd crowd = spec::open_crowd(o.crowd);
  if (o.steps) crowd.steps = *o.steps;
  if (o.clock) crowd.clock = *o.clock;
  if (o.no_frames) crowd.frames.at = render::FrameSpec::At::none;
  const std::string folder = o.folder.empty() ? "out/" + crowd.name : o.folder;
  if (o.folder.empty()) io::reject_run_of_another(folder, o.crowd);
  const std::uint32_t jobs = o.jobs > 0 ? o.jobs : all_cores();
  const run::ProgressReport progress = progress_report(globals.quiet);
  const crowd::CrowdRun run = crowd::run_crowd(crowd, jobs, progress);
  note(globals, run.notes);
  note(globals, {crowd::crowd_speed(run)});
  const std::string summary = crowd::write_crowd(crowd, run, folder, globals.command_line, progress);
  if (const crowd::CostliestPair pair = crowd::costliest_pair(run); !pair.names.empty())
    note(globals, {pair.text + "; their run: " + shell_line({"crowd", folder, "--pair", pair.names})});
  if (o.folder.empty()) io::mark_run(folder, o.crowd);
  print(o.json ? summary : folder + "/index.html\n");
  return kOk;
}

}  // namespace

Command add_crowd(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "crowd", "Move many bodies; per step, query each pair of bodies whose boxes overlap, on all cores");
  const auto o = std::make_shared<CrowdOptions>();
  app->add_option("CROWD", o->crowd, "NAME|FILE|DIR",
                  "Shipped crowd (see lrbscope list), JSON file, or with --pair a recorded crowd")
      ->capture_default_str();
  app->add_option("-o,--output", o->folder, "DIR", "Output folder [out/NAME]");
  app->add_option("--jobs", o->jobs, "N", "Number of threads [all cores]; the result does not depend on it")
      ->in_range(1u, 1024u);
  app->add_option("--steps", o->steps, "N", "Number of time steps [as in the crowd's file]")
      ->in_range(1u, 100000u);
  add_choice<trace::Clock>(
      *app, "--clock", o->clock,
      "Time in the trace. event: independent of the number of threads, one track per body; wall: wall-clock "
      "time, one track per thread");
  app->add_option(
         "--pair", o->pair, "BODY,BODY",
         "Record these two bodies of a recorded crowd (CROWD is its folder or trace) as a run of two "
         "bodies, for `why`, `export`, `figure` and `compare`")
      ->excludes(app->get_option("--jobs"))
      ->excludes(app->get_option("--steps"))
      ->excludes(app->get_option("--clock"));
  app->add_flag("--no-frames", o->no_frames, "Do not draw frames");
  app->add_flag("--json", o->json, "Print the summary as JSON instead of the page's path");
  return {app, [o, &globals] { return run_crowd_command(*o, globals); }};
}

namespace {

struct RunCommandOptions {
  std::string scenario, folder;
  PictureOptions picture;
  std::optional<Recursion> recursion;
  std::optional<EventLevel> events;
  std::optional<trace::Clock> clock;
  bool live = false, json = false;
};

int run_run(const RunCommandOptions& o, const Globals& globals) {
  spec::Scenario scenario = spec::open_scenario(o.scenario);
  apply(o.picture, scenario.frames);
  if (o.recursion) scenario.request.recursion = *o.recursion;
  if (o.events) scenario.events = *o.events;
  if (o.clock) scenario.clock = *o.clock;
  const std::string folder = o.folder.empty() ? "out/" + scenario.name : o.folder;
  if (o.folder.empty()) io::reject_run_of_another(folder, o.scenario);
  run::RunOutcome outcome =
      run::run_scenario(scenario, folder, globals.command_line, progress_report(globals.quiet), o.live);
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

Command add_run(App& root, const Globals& globals) {
  App* app = root.add_subcommand("run", "Run a scenario and write a page, frames, a trace and statistics");
  const auto o = std::make_shared<RunCommandOptions>();
  app->add_option("SCENARIO", o->scenario, "Shipped scenario (see lrbscope list) or JSON file")->required();
  app->add_option("-o,--output", o->folder, "DIR", "Output folder [out/NAME]");
  add_recursion_option(*app, o->recursion);
  add_events_option(*app, o->events);
  add_clock_option(*app, o->clock);
  add_picture_options(*app, o->picture);
  add_animation_option(*app, o->picture);
  add_live_option(*app, o->live);
  app->add_flag("--json", o->json, "Print the summary as JSON instead of the page's path");
  return {app, [o, &globals] { return run_run(*o, globals); }};
}

}  // namespace lrb::cli
