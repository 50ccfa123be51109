#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <memory>
#include <sstream>

#include "bench/stability/case_meshes.hpp"
#include "bench/stability/case_picture.hpp"
#include "bench/stability/minimise.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/stability/saved_case.hpp"
#include "bench/stability/stability_experiment.hpp"
#include "bench/stability/stability_report.hpp"
#include "scenarios/io/files.hpp"
#include "tools/bench_options.hpp"
#include "tools/commands.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::tools {
namespace {

using namespace lrb::stability;
using methods::without;

struct StabilityOptions {
  std::string folder, save, saved;
  std::vector<std::string> search;
  engines::Goal goal = engines::Goal::tests_per_answer;
  std::size_t budget = 3000;
  std::vector<std::string> families, methods;
  std::optional<int> difficulty;
  std::optional<std::uint64_t> only;
  std::uint64_t cases = 100, seed = 1;
  unsigned jobs = 2;
  double timeout = 5;
  bool pairs = false, minimise = false, tex = false, json = false;
  Quantity quantity = Quantity::pairs;
};

void print_pairs(std::ostream& out, const char* what, const std::vector<SimplexPair>& pairs) {
  static constexpr std::size_t kToALine = 10;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i % kToALine == 0) out << (i > 0 ? "\n" : "") << "  " << what << ":";
    out << " " << pairs[i].a << "-" << pairs[i].b;
  }
  if (!pairs.empty()) out << "\n";
}

std::string describe(const Replay& r, Quantity quantity, bool pairs) {
  std::ostringstream out;
  const stability::Record& record = r.record;
  if (!record.family.empty())
    out << record.family << ", difficulty " << record.difficulty << ", case " << record.case_index << ", ";
  out << record.method << ": " << name_of(record.outcome);
  if (!record.message.empty()) out << " (" << record.message << ")";
  out << "\n";
  if (methods::is_list(quantity)) {
    out << "  pairs: " << record.expected << " expected, ";
    if (r.answered)
      out << r.answered->size() << " found, " << record.missed << " missed, " << record.extra << " extra\n";
    else
      out << "no list returned\n";
  }
  if (!record.relation.empty() && (quantity == Quantity::pairs || !methods::is_list(quantity)))
    out << "  " << (quantity == Quantity::pairs ? "relation" : name_of(quantity)) << ": "
        << record.expected_relation << " expected, " << record.relation << " found\n";
  if (pairs && r.answered) {
    print_pairs(out, "missed", without(r.expected, *r.answered));
    print_pairs(out, "extra", without(*r.answered, r.expected));
    print_pairs(out, "found", without(r.expected, without(r.expected, *r.answered)));
  } else if (pairs) {
    print_pairs(out, "expected", r.expected);
  }
  return out.str();
}

/// A single case, from a family or from a folder.
struct OneCase {
  cases::Case bodies;
  stability::Record origin;  ///< family, difficulty, case and seed; an empty family if they are not known
};

OneCase one_case(const StabilityOptions& o, const std::vector<FamilyRow>& families) {
  if (!o.saved.empty()) {
    SavedCase saved = load_case(o.saved);
    return {case_of(saved.meshes), saved.origin};
  }
  if (families.size() != 1 || !o.difficulty)
    throw InputError("--only: expected exactly one --family and one --difficulty with it");
  OneCase one;
  one.origin.family = families[0].name;
  one.origin.difficulty = *o.difficulty;
  one.origin.case_index = *o.only;
  one.origin.seed = o.seed;
  one.bodies = cases::make_case(*cases::find_family(one.origin.family), o.seed, *o.difficulty, *o.only);
  return one;
}

bool is_right(const stability::Record& r) {
  return r.outcome == stability::Outcome::right || r.outcome == stability::Outcome::rejected;
}

int replay_one(const StabilityOptions& o, const std::vector<workers::WorkerMethod>& methods,
               const std::vector<FamilyRow>& families) {
  const OneCase one = one_case(o, families);
  bool all_right = true;
  std::vector<Replay> replays;
  for (const workers::WorkerMethod& m : methods) {
    if (!m.info.present) {
      print(m.info.name + ": absent. " + m.info.remark + "\n");
      continue;
    }
    if (o.saved.empty()) {
      replays.push_back(replay(m, one.origin, o.timeout, o.quantity));
    } else {
      replays.push_back(CaseWorker(m, o.timeout).ask(meshes_of(one.bodies)));
      replays.back().record = with_case(replays.back().record, one.origin);
    }
    const Replay& r = replays.back();
    print(describe(r, o.quantity, o.pairs));
    all_right = all_right && is_right(r.record);
  }
  if (!o.save.empty() && !replays.empty())
    for (const std::string& file : save_case(one.bodies, replays, o.save)) print(o.save + "/" + file + "\n");
  return all_right ? kOk : kMismatch;
}

std::string size_text(const CaseSize& s, int dim) {
  return std::to_string(s.simplices) + (dim == 3 ? " triangles, " : " segments, ") +
         std::to_string(s.vertices) + " vertices, " + std::to_string(s.bits) + " bits";
}

int minimise_one(const StabilityOptions& o, const std::vector<workers::WorkerMethod>& methods,
                 const std::vector<FamilyRow>& families, const Globals& globals) {
  const OneCase one = one_case(o, families);
  const workers::WorkerMethod& method = methods.front();
  CaseMeshes start = meshes_of(one.bodies);
  CaseWorker worker(method, o.timeout);
  const cases::Family* family = cases::find_family(one.origin.family);
  if (family != nullptr && family->both_ways &&
      failure_of(case_of(start), worker.ask(start)) == FailureKind::none) {
    std::swap(start.a, start.b);  // one of the two answers is wrong
    std::swap(start.pose_a, start.pose_b);
  }
  Progress bar("minimise", 0, globals.quiet);
  MinimiseOptions options;
  // In a new process, so that no earlier case can be the cause.
  options.confirm = [&](const CaseMeshes& c) { return CaseWorker(method, o.timeout).ask(c); };
  options.progress = [&](std::uint64_t calls, const CaseSize& size) {
    bar.set(calls, size_text(size, start.a.dim));
  };
  Counterexample found{minimise(
                           start, [&](const CaseMeshes& c) { return worker.ask(c); }, options),
                       method, globals.command_line};
  bar.finish();
  found.found.answer.record = with_case(found.found.answer.record, one.origin);
  if (failure_of(case_of(found.found.meshes), options.confirm(found.found.meshes)) != found.found.kind)
    throw EnvironmentError("method '" + method.info.name +
                           "': gives different answers to the same case, and none to write down");
  print(describe(found.found.answer, o.quantity, o.pairs));
  print("  before: " + size_text(found.found.before, start.a.dim) +
        "\n  after: " + size_text(found.found.after, start.a.dim) + " (" + std::to_string(found.found.calls) +
        " calls" + (found.found.complete ? "" : ", stopped at their maximum") + ")\n");
  for (const std::string& file : save_counterexample(found, o.save)) print(o.save + "/" + file + "\n");
  return kMismatch;
}

Grid run_grid(const StabilityOptions& o, const std::vector<workers::WorkerMethod>& methods,
              const std::vector<FamilyRow>& families, const Globals& globals) {
  const auto begin = std::chrono::steady_clock::now();
  ExperimentOptions experiment;
  experiment.quantity = o.quantity;
  experiment.methods = methods;
  for (const FamilyRow& f : families) experiment.families.push_back(f.name);
  experiment.cases = o.cases;
  experiment.seed = o.seed;
  experiment.difficulty = o.difficulty;
  experiment.jobs = o.jobs;
  experiment.timeout = o.timeout;
  experiment.unfinished_file = o.folder + "/unfinished.jsonl";
  Progress bar("stability", 0, globals.quiet);
  const std::vector<stability::Record> records = run_experiment(experiment, bar.setter());
  bar.finish();
  io::write_text(o.folder + "/records.jsonl", to_lines(records));
  Grid grid = count_grid(workers::infos_of(methods), families, records);
  grid.quantity = o.quantity;
  grid.command = globals.command_line;
  grid.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return grid;
}

std::string command_of(const stability::Record& r, Quantity quantity) {
  const std::string of =
      quantity == Quantity::pairs ? "" : "--quantity " + std::string(name_of(quantity)) + " ";
  return "lrbscope stability " + of + "--family " + r.family + " --method " + r.method + " --difficulty " +
         std::to_string(r.difficulty) + " --only " + std::to_string(r.case_index) + " --seed " +
         std::to_string(r.seed) + (methods::is_list(quantity) ? " --pairs" : "");
}

/// Writes the page and its pictures, for which the worst cases are rerun.
void write_report(const StabilityOptions& o, const std::vector<workers::WorkerMethod>& methods,
                  const Grid& grid, const report::Folder& folder, const Globals& globals) {
  Progress bar("pictures", 0, globals.quiet);
  ReportOptions options;
  options.pictures = draw_worst_cases(
      grid, o.folder,
      [&](const stability::Record& r) {
        const auto method = std::find_if(methods.begin(), methods.end(), [&](const workers::WorkerMethod& m) {
          return m.info.name == r.method;
        });
        return replay(*method, r, o.timeout, o.quantity);
      },
      [&](std::size_t done, std::size_t total) { bar.setter()(done, total, "worst cases"); });
  bar.finish();
  options.command = [&](const stability::Record& r) { return command_of(r, o.quantity); };
  options.links = {{"records.jsonl", "every answer of every method, one JSON object a line"}};
  options.tex = o.tex;
  const report::Document page = write_stability_report(grid, folder, options);
  for (const std::string& line : page.notes()) std::cerr << "lrbscope: " << line << "\n";
  for (const std::string& f : page.written()) print(o.folder + "/" + f + "\n");
}

/// lrbscope's methods must not fail; others may.
bool ours_failed(const Grid& grid, const std::vector<workers::WorkerMethod>& methods) {
  for (std::size_t m = 0; m < methods.size(); ++m)
    for (std::size_t f = 0; f < grid.families.size(); ++f)
      if (methods[m].info.role == methods::Role::ours && grid.at(f, m).failures() > 0) return true;
  return false;
}

/// Returns the methods that answer with the requested quantity.
std::vector<workers::WorkerMethod> methods_for(Quantity quantity) {
  std::vector<workers::WorkerMethod> methods = workers::find_methods(quantity);
  std::erase_if(methods,
                [](const workers::WorkerMethod& m) { return !m.info.has(methods::Trait::hard_cases); });
  return methods;
}

/// Returns the default families: for numbers those of small bodies, because rational arithmetic is slow.
std::vector<FamilyRow> families_for(const StabilityOptions& o) {
  std::vector<FamilyRow> rows =
      chosen(stability::family_rows(), o.families, "family", [](const FamilyRow& f) { return f.name; });
  if (o.quantity != Quantity::pairs && o.families.empty())
    std::erase_if(rows, [](const FamilyRow& f) {
      static constexpr std::string_view kFamilies[] = {"touch", "shared", "coplanar",  "stack",  "kiss",
                                                       "slide", "tunnel", "drift",     "sliver", "thin",
                                                       "far",   "scale",  "zero-area", "mixture"};
      return std::find(std::begin(kFamilies), std::end(kFamilies), f.name) == std::end(kFamilies);
    });
  return rows;
}

void check_one_case(const StabilityOptions& o, const std::vector<workers::WorkerMethod>& methods) {
  const bool one = o.only || !o.saved.empty();
  for (const auto& [name, given] : {std::pair{"--save", !o.save.empty()}, {"--minimise", o.minimise}})
    if (given && !one) throw InputError(std::string(name) + ": expected --only CASE or --saved DIR with it");
  for (const auto& [name, given] : {std::pair{"--save", !o.save.empty()}, {"--saved", !o.saved.empty()}})
    if (given && o.quantity != Quantity::pairs)
      throw InputError(std::string(name) + ": expected --quantity pairs, found " +
                       std::string(name_of(o.quantity)));
  if (o.only && !o.saved.empty()) throw InputError("--saved: expected no --only with it");
  if (!o.minimise) return;
  if (o.save.empty()) throw InputError("--minimise: expected --save DIR with it");
  if (methods.size() != 1)
    throw InputError("--minimise: expected exactly one --method, found " + std::to_string(methods.size()));
}

/// The option --search.
int run_search(const StabilityOptions& o, const Globals& globals) {
  if (o.methods.size() > 1)
    throw InputError("--search: expected one --method, found " + std::to_string(o.methods.size()));
  const Contest contest = make_contest(o.search[0], o.search[1], o.methods, o.timeout);
  engines::Engine& engine = *contest.engines.front();
  engines::SearchOptions options;
  options.budget = o.budget;
  options.seed = o.seed;
  const record::ProgressReport progress = progress_report(globals.quiet);
  const auto& [a, b] = *contest.bodies;
  const engines::Found found =
      o.goal == engines::Goal::wrong
          ? engines::find_wrong(engine, a.rep, b.rep, contest.space, options, progress)
          : engines::find_costly(engine, contest.space, o.goal, options, progress);
  note(globals, found.failures);
  const auto name = [](const std::string& path) { return std::filesystem::path(path).filename().string(); };
  const std::string title = name(o.search[0]) + " and " + name(o.search[1]) + ", " + engine.name() + ": " +
                            std::string(name_of(o.goal)) + ", " + std::to_string(o.budget) +
                            " queries, seed " + std::to_string(o.seed);
  print_rows(title, found.rows, o.json);
  if (!o.folder.empty() && !found.poses.empty())
    write_scenario(contest, {o.search[0], o.search[1]},
                   "The worst poses, found by lrbscope stability --search: " + title + ".", found.poses,
                   o.folder);
  return kOk;
}

int run_stability(StabilityOptions o, const Globals& globals) {
  if (!o.search.empty()) return run_search(o, globals);
  if (o.folder.empty())
    o.folder =
        o.quantity == Quantity::pairs ? "out/stability" : "out/stability-" + std::string(name_of(o.quantity));
  const std::vector<FamilyRow> families = families_for(o);
  const std::vector<workers::WorkerMethod> methods = chosen_methods(methods_for(o.quantity), o.methods);
  check_one_case(o, methods);
  if (o.minimise) return minimise_one(o, methods, families, globals);
  if (o.only || !o.saved.empty()) return replay_one(o, methods, families);
  const report::Folder folder(o.folder);
  const Grid grid = run_grid(o, methods, families, globals);
  print(table(grid));
  print(o.folder + "/records.jsonl\n");
  write_report(o, methods, grid, folder, globals);
  if (!ours_failed(grid, methods)) return kOk;
  std::cerr << "lrbscope: mismatch: lrbscope's answers differ from exact brute force\n";
  return kMismatch;
}

}  // namespace

Command add_stability(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "stability",
      "Run families of hard cases through lrbscope and other engines, and report the failures of each");
  const auto o = std::make_shared<StabilityOptions>();
  app->add_option("-o,--output", o->folder, "DIR",
                  "Output folder [out/stability, or out/stability-QUANTITY]");
  add_quantity_option(*app, o->quantity);
  app->add_option("--family", o->families, "NAME", "Only these families");
  app->add_option("--method", o->methods, "NAME", "Only these methods")->delimiter(',');
  app->add_option("--difficulty", o->difficulty, "K",
                  "Only this difficulty, from 0 (benign) to 10 (degenerate)")
      ->in_range(0, kDifficulties - 1);
  app->add_option("--cases", o->cases, "N", "Number of cases per family and difficulty [100]")
      ->in_range(1, 1000000);
  app->add_option("--seed", o->seed, "S", "Random seed for the cases [1]")->not_negative();
  app->add_option("--jobs", o->jobs, "N", "Number of processes to run in parallel [2]")->in_range(1, 256);
  app->add_option("--timeout", o->timeout, "S", "Time limit per case and method, in seconds [5]")
      ->in_range(0.1, 3600.0);
  app->add_option("--only", o->only, "CASE", "Rerun this case and print the result")->not_negative();
  app->add_option(
      "--save", o->save, "DIR",
      "With --only or --saved: write the case as meshes and poses, the right answer with its proof in "
      "fractions, and the answers of the engines");
  app->add_option("--saved", o->saved, "DIR", "Query the case of a folder that --save wrote");
  app->add_flag("--minimise", o->minimise,
                "With --save and one --method: shrink a case that it fails on to the fewest triangles and "
                "bits, and write that with a picture and a report for the engine's tracker");
  add_tex_option(*app, o->tex, "the table of failures, grid.tex,");
  auto* search =
      app->add_option(
             "--search", o->search, "A B",
             "Only search for the poses of B beside A, two 3D bodies, at which one --method, ours by "
             "default or command:PROGRAM, does worst; with -o, also write a scenario of them for "
             "regression tests")
          ->expected(2);
  add_choice<engines::Goal>(
      *app, "--goal", o->goal,
      "With --search: quantity to maximise: tests for each pair found, tests, wasted visits "
      "(command:PROGRAM), time; or wrong: compare the pairs with the exact ones at poses that are hard in "
      "floating point [tests-per-answer]");
  app->add_option("--budget", o->budget, "N", "With --search: number of queries [3000]")
      ->in_range(8, 10000000);
  app->add_flag("--json", o->json, "With --search: print JSON, a line for each pose");
  for (const char* name : {"--goal", "--budget", "--json"}) app->get_option(name)->needs(search);
  app->add_flag("--pairs", o->pairs, "With --only or --saved: print the expected and the found pairs");
  return {app, [o, &globals] { return run_stability(*o, globals); }};
}

}  // namespace lrb::tools
