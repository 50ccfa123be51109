#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include <nlohmann/json.hpp>

#include "scenarios/io/files.hpp"
#include "scenarios/io/unfinished.hpp"
#include "scenarios/paper/experiment.hpp"
#include "scenarios/paper/paper_report.hpp"
#include "scenarios/paper/protocol.hpp"
#include "scenarios/paper/series.hpp"
#include "scenarios/paper/sweep.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::cli {

namespace {

// The series: reads its options and runs it.

struct PaperSeriesOptions {
  std::vector<std::string> meshes;
  resolutions::ResolutionOptions resolutions;  ///< most = 0: no series
  bool lean = false;
};

void add_series_options(CLI::App& app, PaperSeriesOptions& o) {
  app.add_option("--meshes", o.meshes,
                 "Meshes, or folders of meshes, to collide at several resolutions [two generated bodies]")
      ->type_name("PATH...");
  app.add_option(
         "--resolutions", o.resolutions.most,
         "Number of resolutions per body, each with half as many faces as the one before; 0 omits this part")
      ->check(CLI::Range(0, 30))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--subdivide", o.resolutions.subdivisions,
                 "Number of subdivisions of each body; each one replaces a face by four")
      ->check(CLI::Range(0, 4))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("--lean", o.lean, "Build these bodies with fewer pseudo faces; wrappers fit less tightly");
}

/// Makes the bodies from the given meshes, or generated ones; A is the paper's object.
std::vector<paper::SeriesObject> make_series(const PaperSeriesOptions& o, const LrbRep& a,
                                             const Globals& globals) {
  if (o.resolutions.most == 0) return {};
  std::vector<std::string> notes;
  const std::vector<Mesh> bodies =
      o.meshes.empty() ? paper::own_series_bodies() : paper::read_series_bodies(o.meshes, notes);
  note(globals, notes);
  Progress progress("resolutions", 0, globals.quiet);
  std::uint64_t done = 0;
  BuildOptions building;
  building.lean = o.lean;
  return paper::make_series(bodies, o.resolutions, building, paper::diagonal(a),
                            [&] { progress.set(++done); });
}

/// Runs the collisions.
std::vector<paper::ContactStep> run_series(const LrbRep& a, std::span<const paper::SeriesObject> objects,
                                           const paper::SweepOptions& sweep, const paper::PartRunner& part,
                                           const Globals& globals) {
  Progress progress("resolutions collide", 0, globals.quiet);
  return paper::run_series(
      a, objects, sweep,
      [&](std::uint64_t done, std::uint64_t of) {
        progress.set_total(of);
        progress.set(done);
      },
      part);
}

/// Writes a shard's series, to be merged later: series.jsonl and series_times.jsonl.
void write_series_shard(const std::vector<paper::ContactStep>& steps, const std::string& folder) {
  io::write_text(folder + "/series.jsonl", paper::to_json_lines(steps));
  io::write_text(folder + "/series_times.jsonl", paper::times_to_json_lines(steps));
}

/// Reads the series next to the shards' records.jsonl.
std::vector<paper::ContactStep> read_series_shards(const std::vector<std::string>& records) {
  const auto beside = [](const std::string& file, const char* name) {
    return (std::filesystem::path(file).parent_path() / name).string();
  };
  std::vector<paper::ContactStep> steps;
  for (const std::string& file : records) {
    const std::string path = beside(file, "series.jsonl");
    for (paper::ContactStep& s : paper::read_json_lines(io::read_text(path), path))
      steps.push_back(std::move(s));
  }
  steps = paper::merged(std::move(steps));
  for (const std::string& file : records) {
    const std::string path = beside(file, "series_times.jsonl");
    paper::read_times(io::read_text(path), path, steps);
  }
  return steps;
}

// The command.

struct PaperOptions {
  std::string folder = "out/paper", experiment = "paper", shard;
  std::vector<std::string> merge;
  std::optional<std::uint32_t> collisions, steps_after;  ///< these override the experiment
  std::optional<double> step;
  std::optional<std::uint64_t> seed;
  std::uint32_t jobs = 0;  ///< 0: all cores
  PaperSeriesOptions series;
  bool json = false, print = false;
};

paper::PaperExperiment experiment_of(const PaperOptions& o) {
  paper::PaperExperiment e = paper::open_experiment(o.experiment);
  if (o.collisions) e.protocol.collisions = *o.collisions;
  if (o.steps_after) e.protocol.steps_after = *o.steps_after;
  if (o.step) e.protocol.step = *o.step;
  if (o.seed) e.protocol.seed = *o.seed;
  return e;
}

/// Reads "i/n", i from 0.
paper::Shard read_shard(const std::string& text) {
  paper::Shard s;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%9u/%9u%c", &s.index, &s.count, &rest) != 2 || s.index >= s.count)
    throw InputError("--shard " + text + ": expected i/n with i from 0 to n - 1, as in 0/4");
  return s;
}

std::vector<paper::ContactStep> read_shards(const std::vector<std::string>& files) {
  std::vector<paper::ContactStep> steps;
  for (const std::string& file : files)
    for (paper::ContactStep& s : paper::read_json_lines(io::read_text(file), file))
      steps.push_back(std::move(s));
  return paper::merged(std::move(steps));
}

/// Runs a part of the command, and records its duration.
class PartTimes {
 public:
  template <class Part>
  auto run(const std::string& name, const Part& part) {
    const auto begin = std::chrono::steady_clock::now();
    auto result = part();
    taken.emplace_back(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    return result;
  }
  std::vector<std::pair<std::string, double>> taken;
};

std::vector<paper::ContactStep> sweep_objects(std::span<const paper::PaperObject> objects,
                                              const paper::SweepOptions& sweep, const Globals& globals) {
  Progress progress("paper", 0, globals.quiet);
  return paper::run_sweep(objects, sweep, [&](std::uint64_t done, std::uint64_t of) {
    progress.set_total(of);
    progress.set(done);
  });
}

/// The parts that an interrupted run had finished.
class FinishedParts {
 public:
  /// An empty folder: nothing is kept.
  FinishedParts(const std::string& folder, const std::string& head)
      : path_(folder.empty() ? "" : folder + "/unfinished.jsonl"), file_(path_, head) {
    for (const std::string& line : file_.lines()) {
      const auto value = nlohmann::json::parse(line, nullptr, false);
      if (!value.is_object()) continue;
      std::vector<paper::ContactStep> steps = paper::read_json_lines(value.value("records", ""), path_);
      paper::read_times(value.value("times", ""), path_, steps);
      known_[value.value("part", "")] = std::move(steps);
    }
  }

  /// Returns the steps of a part: those of the earlier run, or of run().
  std::vector<paper::ContactStep> steps(const std::string& name,
                                        const std::function<std::vector<paper::ContactStep>()>& run) {
    if (const auto it = known_.find(name); it != known_.end()) return it->second;
    std::vector<paper::ContactStep> steps = run();
    file_.add(nlohmann::ordered_json{{"part", name},
                                     {"records", paper::to_json_lines(steps)},
                                     {"times", paper::times_to_json_lines(steps)}}
                  .dump());
    return steps;
  }

  void remove() const { file_.remove(); }

 private:
  std::string path_;
  io::UnfinishedFile file_;
  std::map<std::string, std::vector<paper::ContactStep>> known_;
};

/// Describes the run whose parts can be continued: the version, the protocol, the shard and the bodies.
std::string head_of(const paper::SweepOptions& sweep, std::span<const paper::PaperObject> objects) {
  nlohmann::ordered_json head = {{"lrbscope", trace::lrbscope_version()},
                                 {"collisions", sweep.protocol.collisions},
                                 {"steps_after", sweep.protocol.steps_after},
                                 {"step", sweep.protocol.step},
                                 {"seed", sweep.protocol.seed},
                                 {"shard", {sweep.shard.index, sweep.shard.count}}};
  for (const paper::PaperObject& o : objects)
    head["objects"].push_back(o.name + " " + trace::to_hex(o.rep.hash()));
  return head.dump();
}

/// Takes the protocol and the resolutions from the shards to be merged; drops the series if the experiment
/// defines none. Throws InputError if there is nothing to divide into shards.
void settle(PaperOptions& o, paper::PaperExperiment& experiment) {
  if (!experiment.collides() && (!o.shard.empty() || !o.merge.empty()))
    throw InputError("experiment " + experiment.name +
                     ": has no collisions, so it does not take --shard or --merge");
  if (!o.merge.empty()) {
    const paper::ShardFile whole = paper::read_shard_files(o.merge);
    experiment.protocol = whole.protocol;
    o.series.resolutions = whole.resolutions;
    o.series.lean = whole.lean;
  } else if (!experiment.collides() || (experiment.name != "paper" && o.series.meshes.empty())) {
    o.series.resolutions.most = 0;  // other experiments have a series only if meshes are given
  }
}

/// `series_steps`: null if there is no series.
void write_shard(const PaperOptions& o, const paper::SweepOptions& sweep,
                 const std::vector<paper::ContactStep>& steps,
                 const std::vector<paper::ContactStep>* series_steps) {
  paper::write_shard_file({sweep.shard, sweep.protocol, o.series.resolutions, o.series.lean}, o.folder);
  io::write_text(o.folder + "/records.jsonl", paper::to_json_lines(steps));
  if (series_steps != nullptr) write_series_shard(*series_steps, o.folder);
  print(o.folder + "/records.jsonl\n");
}

int run_paper(PaperOptions o, const Globals& globals) {
  if (o.print) {
    print(paper::shipped_experiment(o.experiment));
    return kOk;
  }
  paper::PaperExperiment experiment = experiment_of(o);
  settle(o, experiment);
  const bool merging = !o.merge.empty();
  paper::SweepOptions sweep{experiment.protocol, {}, o.jobs > 0 ? o.jobs : all_cores()};
  if (!o.shard.empty()) sweep.shard = read_shard(o.shard);
  const bool with_series = o.series.resolutions.most > 0;
  std::vector<paper::ContactStep> steps = read_shards(o.merge), series_steps;
  if (merging && with_series) series_steps = read_series_shards(o.merge);
  PartTimes clock;
  std::vector<std::string> notes;
  const std::vector<paper::PaperObject> objects =
      clock.run("the paper's objects", [&] { return paper::make_objects(experiment, notes); });
  note(globals, notes);
  if (merging) paper::check_records({objects, steps, experiment, globals.command_line});
  const report::Folder folder(o.folder);
  const LrbRep& a = objects[0].rep;
  const bool computes = !merging && experiment.collides();
  FinishedParts parts(computes ? o.folder : "", head_of(sweep, objects));
  if (computes)
    steps = clock.run("their collisions", [&] {
      return parts.steps("objects", [&] { return sweep_objects(objects, sweep, globals); });
    });
  if (computes && with_series &&
      o.shard.empty()) {  // so that an interruption of the rest leaves these results
    paper::write_paper_report({objects, steps, experiment, globals.command_line, nullptr, clock.taken},
                              folder);
    note(globals,
         {"wrote " + o.folder + "/index.html; bodies at several resolutions follow (--resolutions 0: none)"});
  }
  const std::vector<paper::SeriesObject> series =
      clock.run("bodies at several resolutions", [&] { return make_series(o.series, a, globals); });
  if (!merging && with_series)
    series_steps = clock.run("their collisions", [&] {
      const auto part = [&](const std::string& name, const auto& run) { return parts.steps(name, run); };
      return run_series(a, series, sweep, part, globals);
    });
  if (!o.shard.empty()) {
    write_shard(o, sweep, steps, with_series ? &series_steps : nullptr);
    parts.remove();
    return kOk;
  }
  const paper::SeriesReport series_report{a, series, series_steps, sweep.jobs};
  note(globals, paper::write_paper_report({objects, steps, experiment, globals.command_line,
                                           with_series ? &series_report : nullptr, clock.taken},
                                          folder));
  parts.remove();
  print(o.json ? io::read_text(o.folder + "/tables.json") : o.folder + "/index.html\n");
  return kOk;
}

}  // namespace

Command add_paper(CLI::App& root, const Globals& globals) {
  CLI::App* app = root.add_subcommand(
      "paper",
      "Reproduce the paper's experiment: tables, figures, close-ups of single collisions, and the same on "
      "meshes");
  const auto o = std::make_shared<PaperOptions>();
  app->add_option("-o,--output", o->folder, "Output folder")->type_name("DIR")->capture_default_str();
  app->add_option("--experiment", o->experiment,
                  "Experiment: paper, table1, table2, figures, close_up or a JSON file")
      ->type_name("NAME|FILE")
      ->capture_default_str();
  app->add_flag("--print", o->print, "Only print the shipped experiment, as a starting point for your own");
  app->add_option("--collisions", o->collisions, "Number of collisions of A with each object [100]")
      ->check(CLI::Range(1u, paper::kMaxCollisions))
      ->type_name("N");
  app->add_option("--step", o->step, "Time step, as a fraction of the diagonal [0.005]")
      ->check(CLI::Range(paper::kMinStep, paper::kMaxStep))
      ->type_name("SHARE");
  app->add_option("--steps-after", o->steps_after, "Number of time steps counted after first contact [5]")
      ->check(CLI::Range(0u, paper::kMaxStepsAfter))
      ->type_name("N");
  app->add_option("--seed", o->seed, "Random seed for directions and rotations [1]")->type_name("N");
  app->add_option("--jobs", o->jobs, "Number of threads [all cores]; the result does not depend on it")
      ->check(CLI::Range(1u, 1024u))
      ->type_name("N");
  CLI::Option* shard =
      app->add_option("--shard", o->shard,
                      "Run only part i of n (from 0) of the collisions, and write only its records")
          ->type_name("i/n");
  CLI::Option* merge = app->add_option("--merge", o->merge,
                                       "Report the records of all shards without computing any; repeat the "
                                       "shards' --meshes, if any")
                           ->type_name("records.jsonl...")
                           ->excludes(shard);
  add_series_options(*app, o->series);
  for (const char* of_shards :
       {"--collisions", "--step", "--steps-after", "--seed", "--resolutions", "--subdivide", "--lean"})
    merge->excludes(app->get_option(of_shards));
  app->add_flag("--json", o->json, "Print the tables as JSON instead of the page's path");
  return {app, [o, &globals] { return run_paper(*o, globals); }};
}

}  // namespace lrb::cli
