#include <iostream>
#include <memory>

#include "scenarios/crowd/crowd_pairs.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::tools {
namespace {

struct CrowdOptions {
  std::string crowd = "crowd", folder, pair;
  std::uint32_t jobs = 0;  ///< 0: all cores
  std::optional<std::uint32_t> steps;
  bool no_frames = false, json = false;
};

/// Records two bodies of a crowd as a run of their own.
int run_pair(const CrowdOptions& o, const spec::Crowd& crowd, const Globals& globals) {
  const lrb::BodyPair pair = crowd::find_pair(crowd, o.pair);
  const record::ProgressReport progress = progress_report(globals.quiet);
  std::vector<bodies::LoadedBody> kinds = crowd::make_kinds(crowd, progress);
  const crowd::CrowdMotion motion(crowd, kinds);
  spec::Scenario scenario = crowd::scenario_of_pair(crowd, motion, pair);
  scenario.frames.montage = 6;
  scenario.frames.views = frames::whole_and_contact();
  if (o.no_frames) scenario.frames.at = pictures::FrameSpec::At::none;
  const std::string folder = o.folder.empty() ? "out/" + scenario.name : o.folder;
  record::Recording recording =
      record::record(scenario, {kinds[motion.kind(pair.i)], kinds[motion.kind(pair.j)]}, progress);
  choose_views({}, scenario, recording);
  return report_outcome(run::write_run(scenario, recording, folder, globals.command_line, progress), folder,
                        o.json, globals);
}

int run_crowd_command(const CrowdOptions& o, const Globals& globals) {
  spec::Crowd crowd = spec::open_crowd(o.crowd);
  note(globals, crowd.notes);
  if (o.steps && !crowd.poses.empty() && *o.steps > crowd.poses.size())
    throw InputError("--steps: the crowd has poses for " + std::to_string(crowd.poses.size()) + " steps");
  if (o.steps) crowd.steps = *o.steps;
  if (!o.pair.empty()) return run_pair(o, crowd, globals);
  const std::uint32_t jobs = o.jobs > 0 ? o.jobs : all_cores();
  const crowd::CrowdRun run = crowd::run_crowd(crowd, jobs, progress_report(globals.quiet));
  note(globals, run.notes);
  note(globals, {crowd::crowd_speed(run)});
  constexpr std::size_t kMaxLines = 20;
  print(o.json ? crowd::crowd_summary(crowd, run) : crowd::pair_table(run, kMaxLines));
  if (const std::vector<crowd::PairHistory> pairs = crowd::pair_histories(run); !pairs.empty()) {
    const lrb::BodyPair& costliest = pairs.front().bodies;
    note(globals,
         {"the run of the first pair: " +
          shell_line({"crowd", o.crowd, "--pair", run.names[costliest.i] + "," + run.names[costliest.j]})});
  }
  return kOk;
}

}  // namespace

Command add_crowd(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "crowd", "Move many bodies, query each pair of bodies whose boxes overlap, and list the pairs by cost");
  const auto o = std::make_shared<CrowdOptions>();
  app->add_option("CROWD", o->crowd, "NAME|FILE", "Shipped crowd (see lrbscope list) or JSON file")
      ->capture_default_str();
  Option* pair =
      app->add_option("--pair", o->pair, "BODY,BODY",
                      "Instead, record these two bodies as a run with a page, frames and a trace, for `why`, "
                      "`export`, `figure` and `compare`");
  app->add_option("-o,--output", o->folder, "DIR",
                  "Output folder of the two bodies' run [out/NAME-BODY-BODY]")
      ->needs(pair);
  app->add_option("--jobs", o->jobs, "N", "Number of threads [all cores]; the result does not depend on it")
      ->in_range(1u, 1024u)
      ->excludes(pair);
  app->add_option("--steps", o->steps, "N", "Number of time steps [as in the crowd's file]")
      ->in_range(1u, 100000u);
  app->add_flag("--no-frames", o->no_frames, "With --pair: do not draw frames")->needs(pair);
  app->add_flag("--json", o->json,
                "Print the steps and all pairs, or with --pair the run's summary, as JSON");
  return {app, [o, &globals] { return run_crowd_command(*o, globals); }};
}

namespace {

struct RunCommandOptions {
  std::string scenario, folder;
  PictureOptions picture;
  std::optional<Recursion> recursion;
  std::optional<EventLevel> events;
  std::optional<trace::Clock> clock;
  bool json = false;
};

int run_run(const RunCommandOptions& o, const Globals& globals) {
  spec::Scenario scenario = spec::open_scenario(o.scenario);
  for (const spec::BodySpec& body : scenario.bodies) protect_input(body.file);
  PictureOptions picture = o.picture;
  if (picture.camera.up == "auto")
    resolve_up(picture.camera.up, record::make_body(scenario.bodies[0]).rep, globals);
  apply(picture, scenario.frames);
  if (o.recursion) scenario.request.recursion = *o.recursion;
  if (o.events) scenario.events = *o.events;
  if (o.clock) scenario.clock = *o.clock;
  const std::string folder = o.folder.empty() ? "out/" + scenario.name : o.folder;
  if (o.folder.empty()) io::reject_run_of_another(folder, o.scenario);
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
  app->add_flag("--json", o->json, "Print the summary as JSON instead of the page's path");
  return {app, [o, &globals] { return run_run(*o, globals); }};
}

}  // namespace lrb::tools
