#include "bench/tails/tails.hpp"

#include <filesystem>
#include <memory>

#include "bench/speed/peer_table.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/report/document.hpp"
#include "tools/commands.hpp"
#include "tools/engines.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::cli {
namespace {

struct TailsOptions : EngineOptions {
  std::size_t poses = 10000;
  std::uint64_t seed = 1;
  std::string folder;
  std::vector<std::string> record;
  bool json = false;
};

constexpr const char* kSampling =
    "rotations are uniform, and the direction from the centre of A's box to the centre of B's is uniform, and so is "
    "their distance, up to the mean of both boxes' diagonals";

/// A pose that can be recorded, its file, and the folder of its record.
struct Recordable {
  std::string pose_file, folder;
};

Recordable recordable(const TailsOptions& o, const tails::Tail& tail, std::size_t pose) {
  const std::string name = file_word(tail.engine) + "-" + std::to_string(pose);
  return {o.folder + "/poses/" + name + ".txt", o.folder + "/" + name};
}

std::vector<std::string> xray_words(const TailsOptions& o, const tails::Tail& tail, std::size_t pose) {
  if (!tail.queries.empty()) {
    const std::string query = std::to_string(tail.queries[pose]);
    return {"import", o.a, "--queries", query, "-o", o.folder + "/query-" + query};
  }
  const Recordable r = recordable(o, tail, pose);
  return record_words(o, tail.engine, r.pose_file, r.folder);
}

/// Runs the command of a pose.
void record(const TailsOptions& o, const tails::Tail& tail, std::size_t pose, const Globals& globals) {
  if (tail.queries.empty()) {
    const Recordable r = recordable(o, tail, pose);
    io::save_poses(r.pose_file, {&tail.poses[pose], 1});
    if (!o.command.empty() && tail.engine == o.command)
      write_file(r.folder + ".lrbcap",
                 tails::record_capture(o.command, o.files(), o.limit(), tail.poses[pose]));
  }
  run_command(xray_words(o, tail, pose), globals);
}

void write_tails(const TailsOptions& o, const std::vector<tails::Tail>& tails, const std::string& title,
                 const std::string& purpose, const std::string& machine, const Globals& globals) {
  for (const tails::Tail& tail : tails) {
    if (!tail.queries.empty()) continue;
    constexpr std::size_t kMaxRows = 10;
    for (const std::size_t pose : tails::costliest(tail, kMaxRows))
      io::save_poses(recordable(o, tail, pose).pose_file, {&tail.poses[pose], 1});
  }
  const tails::TailsPage page = {
      title, purpose, globals.command_line, machine,
      [&](const tails::Tail& tail, std::size_t pose) { return shell_line(xray_words(o, tail, pose)); }};
  note(globals, tails::write_tails_page(tails, page, o.folder));
}

int finish(const TailsOptions& o, const std::vector<tails::Tail>& tails, const std::string& title,
           const std::string& purpose, const std::string& machine, const Globals& globals) {
  // Words of --record are checked before anything is written.
  for (const std::string& at : o.record)
    for (const tails::Tail& tail : tails) tails::pose_at(tail, at);
  note(globals, tails::notes_of(tails));
  if (o.json) {
    for (const auto& line : tails::json_of(tails)) print(one_line(line));
  } else {
    print(title + "\n" + tails::table_of(tails));
  }
  if (o.folder.empty()) return kOk;
  write_tails(o, tails, title, purpose, machine, globals);
  if (!o.json) print(o.folder + "/index.html\n");
  for (const tails::Tail& tail : tails)
    for (const std::string& at : o.record) record(o, tail, tails::pose_at(tail, at), globals);
  return kOk;
}

int run_on_capture(const TailsOptions& o, const Globals& globals) {
  const std::string bytes = read_file(o.a);
  if (!capture::is_capture(std::as_bytes(std::span(bytes))))
    throw InputError(printable_name(o.a) +
                     ": expected a second body, or a capture as the only argument; give A B or run.lrbcap");
  const capture::Capture c = capture::parse_capture(std::as_bytes(std::span(bytes)), o.a);
  const std::vector<tails::Tail> tails = {tails::tail_of(c, o.a)};
  const std::size_t count = tails[0].samples.size();
  const std::string title = std::filesystem::path(o.a).filename().string() + ": " + c.engine + ", " +
                            std::to_string(count) + (count == 1 ? " pose" : " poses");
  const int rounds = tails[0].rounds;
  return finish(o, tails, title,
                "Times as captured, the least of " + std::to_string(rounds) +
                    (rounds == 1 ? " repeat; tests by events." : " repeats; tests by events."),
                "", globals);
}

int run_tails(const TailsOptions& o, const Globals& globals) {
  if (!o.record.empty() && o.folder.empty())
    throw InputError("--record: expected a folder for the recordings; add -o DIR");
  for (const std::string& at : o.record) tails::percentile_share(at);
  if (o.b.empty()) {
    if (!o.methods.empty() || !o.command.empty())
      throw InputError("expected two bodies for --method and --command, found only " + in_quotes(o.a));
    return run_on_capture(o, globals);
  }
  const Contest contest = make_contest(o);
  Random random(o.seed);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < o.poses; ++i)
    poses.push_back(contest.space.pose(tails::random_placement(random)));
  const run::ProgressReport progress = progress_report(globals.quiet);
  std::vector<tails::Tail> tails;
  for (const auto& engine : contest.engines) tails.push_back(tails::measure(*engine, poses, progress));
  const std::string title = std::filesystem::path(o.a).filename().string() + " and " +
                            std::filesystem::path(o.b).filename().string() + ", " + std::to_string(o.poses) +
                            " random poses, seed " + std::to_string(o.seed);
  return finish(o, tails, title,
                std::string("All pairs of intersecting faces at random poses: ") + kSampling +
                    ". Times are the least of three separate rounds.",
                bench::machine(), globals);
}

}  // namespace

Command add_tails(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "tails", "Measure the distribution of an engine's cost over random poses, or in a capture");
  const auto o = std::make_shared<TailsOptions>();
  app->add_option("A", o->a, "Mesh or .lrb file, 3D; does not move. Or a capture, alone")->required();
  app->add_option("B", o->b, "Mesh or .lrb file, 3D; moves");
  add_engine_options(*app, *o);
  app->add_option("--poses", o->poses, "N", std::string("Number of random poses: ") + kSampling + " [10000]")
      ->in_range(1, 1000000);
  app->add_option("--seed", o->seed, "S", "Random seed for the poses [1]")->not_negative();
  app->add_option("-o,--output", o->folder, "DIR",
                  "Write a page of the distributions and the costliest poses, and all samples");
  auto* record = app->add_option("--record", o->record, "P,...",
                                 "Record the poses at these percentiles of time into the folder: p99,max")
                     ->delimiter(',');
  app->add_flag("--json", o->json, "Print JSON, a line for each row of the table")->excludes(record);
  return {app, [o, &globals] { return run_tails(*o, globals); }};
}

}  // namespace lrb::cli
