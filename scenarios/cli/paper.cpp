#include <cstdio>
#include <memory>

#include "engine/error.hpp"
#include "scenarios/cli/command.hpp"
#include "scenarios/cli/progress.hpp"
#include "scenarios/files.hpp"
#include "scenarios/generators/fractal.hpp"
#include "scenarios/paper/report.hpp"

namespace lrb::cli {
namespace {

struct PaperOptions {
  std::string folder = "out/paper", shard;
  std::vector<std::string> merge;
  SweepOptions sweep;
  bool json = false;
};

/// "i/n", i from 0.
Shard read_shard(const std::string& text) {
  Shard s;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%9u/%9u%c", &s.index, &s.count, &rest) != 2 || s.index >= s.count)
    throw InputError("--shard " + text + ": expected i/n with i from 0 to n - 1, as in 0/4");
  return s;
}

std::vector<PaperObject> make_objects() {
  std::vector<PaperObject> objects;
  for (const FractalSpec& spec : paper_objects()) {
    LrbRep rep = fractal_body(spec);
    const double by = objects.empty() ? 1 : diagonal(objects[0].rep) / diagonal(rep);
    objects.push_back({spec.name, by == 1 ? std::move(rep) : scaled(rep, by)});
  }
  return objects;
}

std::vector<ContactStep> read_shards(const std::vector<std::string>& files) {
  std::vector<ContactStep> steps;
  for (const std::string& file : files)
    for (ContactStep& s : read_json_lines(read_text(file), file)) steps.push_back(std::move(s));
  return merged(std::move(steps));
}

int run_paper(const PaperOptions& o, const Globals& globals) {
  SweepOptions sweep = o.sweep;
  if (!o.shard.empty()) sweep.shard = read_shard(o.shard);
  std::vector<ContactStep> steps = read_shards(o.merge);
  make_folder(o.folder);
  const FolderLock lock(o.folder);
  const std::vector<PaperObject> objects = make_objects();
  if (o.merge.empty()) {
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
  note(globals, write_paper_report({objects, steps, sweep.protocol, globals.command_line}, o.folder));
  print(o.json ? read_text(o.folder + "/tables.json") : o.folder + "/index.html\n");
  return kOk;
}

}  // namespace

Command add_paper(CLI::App& root, const Globals& globals) {
  CLI::App* app = root.add_subcommand("paper", "The paper's experiment: tables 1 and 2, figures 3.1 and 3.2");
  const auto o = std::make_shared<PaperOptions>();
  PaperProtocol& p = o->sweep.protocol;
  app->add_option("-o,--output", o->folder, "Folder to write to")->type_name("DIR")->capture_default_str();
  app->add_option("--collisions", p.collisions, "Of A with each object")
      ->check(CLI::Range(1, 100000))
      ->type_name("N")
      ->capture_default_str();
  app->add_option("--step", p.step, "Time step as a share of the diagonal")
      ->check(CLI::Range(1e-5, 0.5))
      ->type_name("SHARE")
      ->capture_default_str();
  app->add_option("--steps-after", p.steps_after, "Time steps counted after the first contact")
      ->check(CLI::Range(0, 1000))
      ->type_name("N")
      ->capture_default_str();
  app->add_option("--seed", p.seed, "Of directions and rotations")->type_name("N")->capture_default_str();
  app->add_option("--jobs", o->sweep.jobs, "Threads; the result does not depend on it")
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
