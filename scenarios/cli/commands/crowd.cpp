#include <memory>

#include "scenarios/cli/command.hpp"
#include "scenarios/cli/options.hpp"
#include "scenarios/cli/progress.hpp"
#include "scenarios/crowd/crowd_report.hpp"
#include "scenarios/io/files.hpp"

namespace lrb::cli {
namespace {

struct CrowdOptions {
  std::string crowd, folder;
  std::uint32_t jobs = 0;  ///< 0: all cores
  std::optional<std::uint32_t> steps;
  std::optional<trace::Clock> clock;
  bool no_frames = false, json = false;
};

int run_crowd_command(const CrowdOptions& o, const Globals& globals) {
  spec::Crowd crowd = spec::open_crowd(o.crowd);
  if (o.steps) crowd.steps = *o.steps;
  if (o.clock) crowd.clock = *o.clock;
  if (o.no_frames) crowd.frames.at = render::FrameSpec::At::none;
  const std::string folder = o.folder.empty() ? "out/" + crowd.name : o.folder;
  if (o.folder.empty()) io::refuse_run_of_another(folder, o.crowd);
  const std::uint32_t jobs = o.jobs > 0 ? o.jobs : all_cores();
  const run::ProgressReport progress = progress_report(globals.quiet);
  const crowd::CrowdRun run = crowd::run_crowd(crowd, jobs, progress);
  note(globals, run.notes);
  note(globals, {crowd::crowd_speed(run)});
  const std::string summary = crowd::write_crowd(crowd, run, folder, globals.command_line, progress);
  if (o.folder.empty()) io::mark_run(folder, o.crowd);
  print(o.json ? summary : folder + "/index.html\n");
  return kOk;
}

}  // namespace

Command add_crowd(CLI::App& root, const Globals& globals) {
  CLI::App* app = root.add_subcommand(
      "crowd", "Move many bodies: at each step a query for each pair whose boxes meet, on all cores");
  const auto o = std::make_shared<CrowdOptions>();
  app->add_option("CROWD", o->crowd, "A shipped crowd (see lrbscope list), or a JSON file")
      ->type_name("NAME|FILE")
      ->default_val("crowd");
  app->add_option("-o,--output", o->folder, "Folder to write to [out/NAME]")->type_name("DIR");
  app->add_option("--jobs", o->jobs, "Number of threads [all cores]; the result does not depend on it")
      ->check(CLI::Range(1u, 1024u))
      ->type_name("N");
  app->add_option("--steps", o->steps, "Number of time steps, instead of the crowd's own")
      ->check(CLI::Range(1u, 100000u))
      ->type_name("N");
  add_choice<trace::Clock>(
      *app, "--clock", o->clock,
      "Time in the trace. event: the same for any number of threads, a track for each body; "
      "wall: a track for each thread");
  app->add_flag("--no-frames", o->no_frames, "Draw nothing");
  app->add_flag("--json", o->json, "Print the summary instead of the page's path");
  return {app, [o, &globals] { return run_crowd_command(*o, globals); }};
}

}  // namespace lrb::cli
