#include <cstdio>
#include <memory>

#include "engine/error.hpp"
#include "scenarios/cli/command.hpp"
#include "scenarios/cli/progress.hpp"
#include "scenarios/files.hpp"
#include "scenarios/paper/experiment.hpp"
#include "scenarios/paper/report.hpp"
#include "scenarios/paper/report_pictures.hpp"

namespace lrb::cli {
namespace {

struct PaperOptions {
  std::string folder = "out/paper", experiment = "paper", shard;
  std::vector<std::string> merge;
  std::optional<std::uint32_t> collisions, steps_after;  ///< over what the experiment says
  std::optional<double> step;
  std::optional<std::uint64_t> seed;
  std::uint32_t jobs = 1;
  bool json = false, print = false;
};

PaperExperiment experiment_of(const PaperOptions& o) {
  PaperExperiment e = open_experiment(o.experiment);
  if (o.collisions) e.protocol.collisions = *o.collisions;
  if (o.steps_after) e.protocol.steps_after = *o.steps_after;
  if (o.step) e.protocol.step = *o.step;
  if (o.seed) e.protocol.seed = *o.seed;
  return e;
}

/// "i/n", i from 0.
Shard read_shard(const std::string& text) {
  Shard s;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%9u/%9u%c", &s.index, &s.count, &rest) != 2 || s.index >= s.count)
    throw InputError("--shard " + text + ": expected i/n with i from 0 to n - 1, as in 0/4");
  return s;
}

std::vector<ContactStep> read_shards(const std::vector<std::string>& files) {
  std::vector<ContactStep> steps;
  for (const std::string& file : files)
    for (ContactStep& s : read_json_lines(read_text(file), file)) steps.push_back(std::move(s));
  return merged(std::move(steps));
}

int run_paper(const PaperOptions& o, const Globals& globals) {
  if (o.print) {
    print(shipped_experiment(o.experiment));
    return kOk;
  }
  const PaperExperiment experiment = experiment_of(o);
  SweepOptions sweep{experiment.protocol, {}, o.jobs};
  if (!o.shard.empty()) sweep.shard = read_shard(o.shard);
  if (!experiment.collides() && (!o.shard.empty() || !o.merge.empty()))
    throw InputError("experiment " + experiment.name +
                     ": nothing collides in it; leave out --shard and --merge");
  std::vector<ContactStep> steps = read_shards(o.merge);
  std::vector<std::string> notes;
  const std::vector<PaperObject> objects = make_objects(experiment, notes);
  note(globals, notes);
  if (!o.merge.empty()) check_records({objects, steps, experiment, globals.command_line});
  make_folder(o.folder);
  const FolderLock lock(o.folder);
  if (o.merge.empty() && experiment.collides()) {
    Progress progress("paper", 0, globals.quiet);
    steps = run_sweep(objects, sweep, [&](std::uint64_t done, std::uint64_t of) {
      progress.set_total(of);
      progress.set(done);
    });
  }
  if (sweep.shard.count > 1 && o.merge.empty()) {
    write_text(o.folder + "/records.jsonl", to_json_lines(steps));
    print(o.folder + "/records.jsonl\n");
    return kOk;
  }
  note(globals, write_paper_report({objects, steps, experiment, globals.command_line}, o.folder));
  print(o.json ? read_text(o.folder + "/tables.json") : o.folder + "/index.html\n");
  return kOk;
}

}  // namespace

Command add_paper(CLI::App& root, const Globals& globals) {
  CLI::App* app = root.add_subcommand(
      "paper", "The paper's experiment: its tables and figures, and close-ups of single collisions");
  const auto o = std::make_shared<PaperOptions>();
  app->add_option("-o,--output", o->folder, "Folder to write to")->type_name("DIR")->capture_default_str();
  app->add_option(
         "--experiment", o->experiment,
         "Objects, protocol and what is reported: paper, table1, table2, figures, close_up, or a JSON file")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  app->add_flag("--print", o->print, "Print the experiment of that name instead: to be changed and run");
  app->add_option("--collisions", o->collisions, "Of A with each object [100]")
      ->check(CLI::Range(1u, kMostCollisions))
      ->type_name("N");
  app->add_option("--step", o->step, "Time step as a share of the diagonal [0.005]")
      ->check(CLI::Range(kLeastStep, kMostStep))
      ->type_name("SHARE");
  app->add_option("--steps-after", o->steps_after, "Time steps counted after the first contact [5]")
      ->check(CLI::Range(0u, kMostStepsAfter))
      ->type_name("N");
  app->add_option("--seed", o->seed, "Of directions and rotations [1]")->type_name("N");
  app->add_option("--jobs", o->jobs, "Threads; the result does not depend on it")
      ->check(CLI::Range(1u, 1024u))
      ->type_name("N")
      ->capture_default_str();
  CLI::Option* shard = app->add_option("--shard", o->shard,
                                       "Part i (from 0) of n of the collisions: writes records.jsonl alone")
                           ->type_name("i/n");
  app->add_option("--merge", o->merge, "Report these records instead of computing any")
      ->type_name("records.jsonl...")
      ->excludes(shard);
  app->add_flag("--json", o->json, "Print the tables instead of the page's path");
  return {app, [o, &globals] { return run_paper(*o, globals); }};
}

}  // namespace lrb::cli
