#include "bench/tails/worst.hpp"

#include <filesystem>
#include <memory>

#include "bench/speed/peer_table.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/report/document.hpp"
#include "tools/commands.hpp"
#include "tools/engines.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/error.hpp>

namespace lrb::cli {
namespace {

struct WorstOptions : EngineOptions {
  tails::Goal goal = tails::Goal::tests_per_answer;
  tails::SearchOptions search;
  std::string folder;
  bool at_random = false, json = false;
};

std::string title_of(const WorstOptions& o, const std::string& engine) {
  return std::filesystem::path(o.a).filename().string() + " and " +
         std::filesystem::path(o.b).filename().string() + ", " + engine + ": " +
         std::string(name_of(o.goal)) + ", " + std::to_string(o.search.budget) + " queries, seed " +
         std::to_string(o.search.seed);
}

/// Returns the file of a body as seen from a scenario in the folder.
std::string file_from(const std::string& folder, const std::string& body) {
  namespace fs = std::filesystem;
  return fs::relative(fs::absolute(body), fs::absolute(folder)).string();
}

/// Returns the scenario of the poses. Scenarios join corners; without that there is none.
std::string scenario_of(const WorstOptions& o, const std::string& purpose, const std::vector<Pose>& poses,
                        const Contest& contest) {
  if (o.corners == bodies::Corners::apart || poses.empty()) return "";
  const auto& [a, b] = *contest.bodies;
  return tails::scenario_text(purpose, poses, a.rep, b.rep, file_from(o.folder, o.a),
                              file_from(o.folder, o.b));
}

/// Writes the file of each pose, and returns the commands that record them.
std::vector<std::string> write_poses(const WorstOptions& o, const std::string& engine,
                                     const std::vector<Pose>& poses) {
  std::vector<std::string> commands;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const std::string name = std::to_string(i + 1), file = o.folder + "/poses/" + name + ".txt";
    const std::string folder = o.folder + "/" + name;
    io::save_poses(file, {&poses[i], 1});
    commands.push_back(record_line(o, engine, file, folder));
  }
  return commands;
}

template <class Lines>
void print_found(const WorstOptions& o, const std::string& engine, const std::string& table,
                 const Lines& lines) {
  if (!o.json) return print(title_of(o, engine) + "\n" + table);
  for (const auto& line : lines) print(one_line(line));
}

void find_costly(const WorstOptions& o, const Contest& contest, tails::Engine& engine,
                 const Globals& globals) {
  const bool compare = o.at_random || !o.folder.empty();
  const tails::Worst worst =
      tails::find_worst(engine, contest.space, o.goal, o.search, compare, progress_report(globals.quiet));
  note(globals, worst.failures);
  print_found(o, worst.engine, tails::table_of(worst), tails::json_of(worst, contest.space));
  if (o.folder.empty()) return;
  std::vector<Pose> poses;
  for (const tails::QueriedTrial& t : worst.poses) poses.push_back(contest.space.pose(t.trial.at));
  const tails::WorstPage page = {
      title_of(o, worst.engine),
      "The poses at which the engine does worst, found by search: 60 % of the queries are random, the others "
      "improve the best eight of these.",
      globals.command_line,
      o.goal == tails::Goal::time ? bench::machine() : "",
      scenario_of(o, tails::purpose_of(worst), poses, contest),
      write_poses(o, worst.engine, poses)};
  note(globals, tails::write_worst_page(worst, page, o.folder));
}

void find_wrong(const WorstOptions& o, const Contest& contest, tails::Engine& engine,
                const Globals& globals) {
  const auto& [a, b] = *contest.bodies;
  const tails::WrongSearch found = tails::find_wrong(engine, a.rep, b.rep, contest.space, o.search.budget,
                                                     o.search.seed, progress_report(globals.quiet));
  print_found(o, found.engine, tails::table_of(found), tails::json_of(found));
  if (o.folder.empty()) return;
  std::vector<Pose> poses;
  for (const tails::Judged& j : found.worst()) poses.push_back(j.at.pose);
  const std::string purpose = "Poses at which " + found.engine +
                              " reports wrong pairs, found by lrbscope worst --goal wrong, seed " +
                              std::to_string(o.search.seed) + ".";
  note(globals, tails::write_wrong_page(found, title_of(o, found.engine), globals.command_line,
                                        scenario_of(o, purpose, poses, contest),
                                        write_poses(o, found.engine, poses), o.folder));
}

int run_worst(const WorstOptions& o, const Globals& globals) {
  Contest contest = make_contest(o);
  if (contest.engines.size() != 1)
    throw InputError("expected one engine, found " + std::to_string(contest.engines.size()) +
                     "; run worst for each");
  if (o.goal == tails::Goal::wasted && o.command.empty()) {
    // Only a recorded traversal shows wasted visits.
    const std::string name = contest.engines.front()->name();
    if (name != "fcl" && name != "cgal")
      throw InputError("--goal wasted: expected fcl, cgal or a --command, found " + name);
    contest.engines.front() =
        tails::recorded_engine(name, (*contest.bodies)[0].rep, (*contest.bodies)[1].rep);
  }
  tails::Engine& engine = *contest.engines.front();
  if (o.goal == tails::Goal::wrong)
    find_wrong(o, contest, engine, globals);
  else
    find_costly(o, contest, engine, globals);
  if (!o.folder.empty() && !o.json) print(o.folder + "/index.html\n");
  return kOk;
}

}  // namespace

Command add_worst(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "worst", "Search for the poses at which an engine does most work, or answers wrongly");
  const auto o = std::make_shared<WorstOptions>();
  app->add_option("A", o->a, "Mesh or .lrb file, 3D; does not move")->required();
  app->add_option("B", o->b, "Mesh or .lrb file, 3D; moves")->required();
  add_engine_options(*app, *o);
  add_choice<tails::Goal>(
      *app, "--goal", o->goal,
      "Quantity to maximise: tests for each pair found, tests, time, or wrong: compare the pairs "
      "with the exact ones at poses that are hard in floating point [tests-per-answer]");
  app->add_option("--budget", o->search.budget, "N", "Number of queries [3000]")->in_range(8, 10000000);
  app->add_option("--seed", o->search.seed, "S", "Random seed for the poses [1]")->not_negative();
  app->add_flag("--random", o->at_random, "Also spend the same budget at random, for comparison");
  app->add_option(
      "-o,--output", o->folder, "DIR",
      "Write a page with a map of the cost, the poses, and a scenario of them for regression tests");
  app->add_flag("--json", o->json, "Print JSON, a line for each pose");
  return {app, [o, &globals] { return run_worst(*o, globals); }};
}

}  // namespace lrb::cli
