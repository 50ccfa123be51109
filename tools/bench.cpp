#include <algorithm>
#include <memory>

#include "bench/speed/build_times.hpp"
#include "bench/speed/peer_table.hpp"
#include "bench/speed/survey.hpp"
#include "scenarios/io/files.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::cli {
namespace {

using namespace lrb::bench;
using workers::WorkerMethod;

struct BenchOptions : MeasureOptions {
  BenchOptions() { folder = folder_help = "out/bench"; }
  std::vector<std::uint32_t> faces = {20000, 100000};
  bool build = false;
  unsigned rounds = 5;
};

/// Seconds. LRB-reps of large bodies take longer than queries.
constexpr double kLeastBuildTimeout = 120;

/// Returns true for lrbscope and for engines that answer the same query.
bool is_peer(const workers::WorkerMethod& m) {
  return !m.info.has(methods::Trait::approximate) && !m.info.has(methods::Trait::convex) &&
         m.info.role != methods::Role::no_peer;
}

/// The option --build.
int run_build_survey(const BenchOptions& o, std::vector<bench::BodyPair> bodies,
                     std::vector<workers::WorkerMethod> methods, const Globals& globals) {
  // lrbscope's methods differ in their queries; bench::own_structures() are what it builds.
  std::erase_if(methods, [](const workers::WorkerMethod& m) {
    return !m.info.present || m.info.has(methods::Trait::own_rep);
  });
  const report::Folder folder(o.folder);
  const bench::BuildResults results = bench::survey_builds(
      {std::move(bodies), std::move(methods), o.rounds, std::max(o.timeout, kLeastBuildTimeout), o.folder},
      progress_report(globals.quiet));
  const std::string head = bench::machine() + "; built with " + bench::build_flags() + "\n";
  const std::string text = head + bench::build_text(results);
  print(text);
  report::Document page = bench::build_page(results, o.tex);
  page.number({"Machine", bench::machine(), bench::build_flags()}).command(globals.command_line);
  page.file("builds.csv", bench::build_csv(results), "every build");
  page.file("builds.txt", text, "the tables as text");
  page.write(folder);
  for (const std::string& file : page.written()) print(o.folder + "/" + file + "\n");
  return kOk;
}

int run_bench(const BenchOptions& o, const Globals& globals) {
  std::vector<workers::WorkerMethod> methods = workers::find_all_methods();
  std::erase_if(methods, [](const workers::WorkerMethod& m) { return !is_peer(m); });
  methods = chosen_methods(methods, o.methods);
  std::vector<bench::BodyPair> pairs;
  if (!o.models.empty()) pairs = bench::pairs_of_models(o.models);
  for (const std::uint32_t n : o.faces)
    if (n > 0)
      for (bench::BodyPair& p : bench::generated_pairs(n)) {
        pairs.push_back(std::move(p));
        if (n != o.faces.front()) break;
      }
  if (o.build) return run_build_survey(o, std::move(pairs), std::move(methods), globals);
  make_folder(o.folder);
  const io::FolderLock lock(o.folder);
  bench::SurveyOptions survey_options;
  survey_options.folder = o.folder;
  survey_options.timeout = o.timeout;
  survey_options.contestants = bench::contestants(methods);
  {
    Progress bar("bodies", pairs.size(), globals.quiet);
    for (const bench::BodyPair& p : pairs) {
      bar.set(survey_options.sets.size(), p.what);
      survey_options.sets.push_back(bench::make_data_set(p, o.set, o.folder));
    }
  }
  Progress bar("bench", 0, globals.quiet);
  const std::vector<bench::Record> records =
      bench::survey(survey_options, [&](std::uint64_t done, std::uint64_t total, const std::string& what) {
        bar.set_total(total);
        bar.set(done, what);
      });
  bar.finish();
  std::vector<methods::MethodInfo> infos;
  for (const workers::WorkerMethod& m : methods) infos.push_back(m.info);
  const bench::PeerTable table = bench::peer_table(survey_options.sets, infos, records);
  const std::string head = bench::machine() + "; built with " + bench::build_flags() + "\n\n";
  print(head + bench::in_brief(table));
  const report::Table cells = bench::table_of_cells(table);
  io::write_text(o.folder + "/peers.txt",
                 head + bench::in_brief(table) + "\n" + report::in_columns(cells, 4));
  io::write_text(o.folder + "/peers.csv", report::csv(cells));
  print(o.folder + "/peers.txt\n" + o.folder + "/peers.csv\n" + o.folder + "/records.jsonl\n");
  if (!o.tex) return kOk;
  for (const auto& [mode, name] :
       {std::pair{Mode::all_pairs, "/all_pairs.tex"}, std::pair{Mode::first_pair, "/first_pair.tex"}}) {
    io::write_text(o.folder + name, report::booktabs(bench::table_of_ratios(table, mode)));
    print(o.folder + name + "\n");
  }
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
  app->add_option("--rounds", o->rounds, "N",
                  "With --build: number of times that each structure is built [5]")
      ->in_range(1, 1000);
  return {app, [o, &globals] { return run_bench(*o, globals); }};
}

}  // namespace lrb::cli
