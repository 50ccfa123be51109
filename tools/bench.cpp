#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <span>

#include "bench/speed/build_times.hpp"
#include "bench/speed/peer_table.hpp"
#include "bench/speed/survey.hpp"
#include "scenarios/io/files.hpp"
#include "tools/bench_options.hpp"
#include "tools/commands.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::tools {

using workers::WorkerMethod;

namespace {

struct BenchOptions : MeasureOptions {
  BenchOptions() { folder = folder_help = "out/bench"; }
  std::vector<std::uint32_t> faces = {20000, 100000};
  std::vector<std::string> percentiles;
  bool build = false, json = false;
  unsigned rounds = 5;
};

/// Seconds. LRB-reps of large bodies take longer than queries.
constexpr double kLeastBuildTimeout = 120;

/// Returns lrbscope, with each of its kernels, and engines that answer the same query exactly.
std::vector<WorkerMethod> peers_for(methods::Quantity quantity) {
  std::vector<WorkerMethod> out;
  for (WorkerMethod& m : workers::find_methods(quantity)) {
    const bool is_other = quantity != methods::Quantity::pairs && m.info.role == methods::Role::ours_other;
    if (is_other || m.info.has(methods::Trait::approximate) || m.info.has(methods::Trait::convex) ||
        m.info.role == methods::Role::no_peer)
      continue;
    m.info.settings.clear();  // exact
    out.push_back(m);
    if (m.info.role != methods::Role::ours) continue;
    m.info.role = methods::Role::ours_other;
    for (const std::string simd : {"avx2", "baseline"}) {  // chosen when a process first asks for its kernels
      WorkerMethod& older = out.emplace_back(m);
      older.info.name += "-" + simd;
      older.info.title += ", limited to " + simd;
      older.command.insert(older.command.begin(), {"/usr/bin/env", "LRB_SIMD=" + simd});
    }
  }
  return out;
}

/// The option --build.
int run_build_survey(const BenchOptions& o, std::vector<speed::BodyPair> bodies,
                     std::vector<WorkerMethod> methods, const Globals& globals) {
  // lrbscope's methods differ in their queries; speed::own_structures() are what it builds.
  std::erase_if(methods, [](const WorkerMethod& m) {
    return !m.info.present || m.info.has(methods::Trait::own_rep) ||
           m.info.quantity != methods::Quantity::pairs;
  });
  const report::Folder folder(o.folder);
  const speed::BuildResults results = speed::survey_builds(
      {std::move(bodies), std::move(methods), o.rounds, std::max(o.timeout, kLeastBuildTimeout), o.folder},
      progress_report(globals.quiet));
  const std::string head = speed::machine() + "; built with " + speed::build_flags() + "\n";
  const std::string text = head + speed::build_text(results);
  print(text);
  report::Document page = speed::build_page(results, o.tex);
  page.number({"Machine", speed::machine(), speed::build_flags()}).command(globals.command_line);
  page.file("builds.csv", speed::build_csv(results), "every build");
  page.file("builds.txt", text, "the tables as text");
  page.write(folder);
  for (const std::string& file : page.written()) print(o.folder + "/" + file + "\n");
  return kOk;
}

/// The option --percentiles of a capture.
engines::Samples captured_samples(const BenchOptions& o) {
  const std::string& file = o.percentiles[0];
  if (!o.methods.empty())
    throw InputError("--percentiles: expected two bodies with --method, found only " + in_quotes(file));
  const std::string bytes = read_file(file);
  if (!capture::is_capture(std::as_bytes(std::span(bytes))))
    throw InputError(printable_name(file) + ": expected a capture or two bodies; give A B or run.lrbcap");
  return engines::samples_of(capture::parse_capture(std::as_bytes(std::span(bytes)), file), file);
}

/// The option --percentiles.
int run_percentiles(const BenchOptions& o, const Globals& globals) {
  std::vector<engines::Samples> all;
  std::string title = std::filesystem::path(o.percentiles[0]).filename().string();
  if (o.percentiles.size() == 1) {
    all.push_back(captured_samples(o));
    title += ": " + render::counted(all[0].poses.size(), "pose", "poses") + ", the least of " +
             render::counted(static_cast<std::size_t>(all[0].rounds), "query", "queries");
  } else {
    const Contest contest = make_contest(o.percentiles[0], o.percentiles[1], o.methods, o.timeout);
    Random random(o.set.seed);
    std::vector<Pose> poses;
    for (int i = 0; i < o.set.poses; ++i)
      poses.push_back(contest.space.pose(engines::random_placement(random)));
    for (const auto& engine : contest.engines)
      all.push_back(engines::measure(*engine, poses, progress_report(globals.quiet)));
    title += " and " + std::filesystem::path(o.percentiles[1]).filename().string() + ", " +
             std::to_string(poses.size()) + " random poses, seed " + std::to_string(o.set.seed);
  }
  note(globals, engines::notes_of(all));
  print_rows(title, engines::rows_of(all), o.json);
  return kOk;
}

int run_bench(const BenchOptions& o, const Globals& globals) {
  if (!o.percentiles.empty()) return run_percentiles(o, globals);
  std::vector<WorkerMethod> methods = peers_for(methods::Quantity::pairs);
  for (WorkerMethod& m : peers_for(methods::Quantity::distance)) methods.push_back(std::move(m));
  methods = chosen_methods(methods, o.methods);
  std::vector<speed::BodyPair> pairs;
  if (!o.models.empty()) pairs = speed::pairs_of_models(o.models);
  for (const std::uint32_t n : o.faces)
    if (n > 0)
      for (speed::BodyPair& p : speed::generated_pairs(n)) {
        pairs.push_back(std::move(p));
        if (n != o.faces.front()) break;
      }
  if (o.build) return run_build_survey(o, std::move(pairs), std::move(methods), globals);
  make_folder(o.folder);
  const io::FolderLock lock(o.folder);
  std::string text = speed::machine() + "; built with " + speed::build_flags() + "\n\n";
  report::Table cells;
  std::vector<std::string> files = {"/peers.txt", "/peers.csv", "/records.jsonl"};
  for (const auto& [quantity, of_quantity] :
       {std::pair{methods::Quantity::pairs, pairs},
        std::pair{methods::Quantity::distance, speed::interlocked_pairs(o.faces.front())}}) {
    speed::SurveyOptions survey_options;
    survey_options.folder = o.folder;
    survey_options.timeout = o.timeout;
    for (const WorkerMethod& m : methods)
      if (m.info.quantity == quantity && m.info.present) survey_options.contestants.push_back({m, {}});
    if (survey_options.contestants.empty() || of_quantity.empty()) continue;
    speed::SetOptions set = o.set;
    set.quantity = quantity;
    {
      Progress bar("bodies", of_quantity.size(), globals.quiet);
      for (const speed::BodyPair& p : of_quantity) {
        bar.set(survey_options.sets.size(), p.what);
        survey_options.sets.push_back(speed::make_data_set(p, set, o.folder));
      }
    }
    Progress bar("bench", 0, globals.quiet);
    const std::vector<speed::Record> records = speed::survey(survey_options, bar.setter());
    bar.finish();
    std::vector<methods::MethodInfo> infos = workers::infos_of(methods);
    std::erase_if(infos, [&](const methods::MethodInfo& m) { return m.quantity != quantity; });
    const speed::PeerTable table = speed::peer_table(survey_options.sets, infos, records);
    text += speed::in_brief(table);
    report::Table part = speed::table_of_cells(table);
    cells.columns = part.columns;
    std::move(part.rows.begin(), part.rows.end(), std::back_inserter(cells.rows));
    if (!o.tex || quantity != methods::Quantity::pairs) continue;
    for (const auto& [mode, name] :
         {std::pair{Mode::all_pairs, "/all_pairs.tex"}, std::pair{Mode::first_pair, "/first_pair.tex"}}) {
      io::write_text(o.folder + name, report::booktabs(speed::table_of_ratios(table, mode)));
      files.emplace_back(name);
    }
  }
  print(text);
  io::write_text(o.folder + "/peers.txt", text + "\n" + report::in_columns(cells, 4));
  io::write_text(o.folder + "/peers.csv", report::csv(cells));
  for (const std::string& file : files) print(o.folder + file + "\n");
  return kOk;
}

}  // namespace

Command add_bench(App& root, const Globals& globals) {
  App* app =
      root.add_subcommand("bench", "Compare query times with other engines on the same bodies and poses");
  const auto o = std::make_shared<BenchOptions>();
  add_measure_options(*app, *o);
  app->add_option("--faces", o->faces, "N",
                  "Face counts of the generated bodies: every kind at the first count, only rocks at the "
                  "others; 0: none [20000 100000]")
      ->in_range(0, 2000000);
  add_tex_option(*app, o->tex, "the tables");
  app->add_flag("--build", o->build,
                "Compare the time to build, the first answer and memory instead of queries");
  auto* percentiles =
      app->add_option(
             "--percentiles", o->percentiles, "A B | CAPTURE",
             "Only print the distribution of times and tests of the methods, ours by default, for two 3D "
             "bodies at random poses: rotations are uniform, and the direction and distance of B's centre, "
             "up to the mean of both diagonals; or in a capture. A method may also be "
             "command:PROGRAM, started as PROGRAM A B POSES, which records its queries with "
             "lrbscope_capture.h")
          ->expected(1, 2);
  app->add_flag("--json", o->json, "With --percentiles: print JSON, a line for each row of the table")
      ->needs(percentiles);
  Option* poses = app->get_option("--poses");
  poses->description("Number of poses per class [" + std::to_string(o->set.poses) +
                     "; with --percentiles in all, 10000]");
  app->add_option("--rounds", o->rounds, "N",
                  "With --build: number of times that each structure is built [5]")
      ->in_range(1, 1000);
  return {app, [o, poses, &globals] {
            if (!o->percentiles.empty() && !poses->given()) o->set.poses = 10000;
            return run_bench(*o, globals);
          }};
}

}  // namespace lrb::tools
