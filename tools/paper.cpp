#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <mutex>
#include <utility>

#include <nlohmann/json.hpp>

#include "scenarios/io/files.hpp"
#include "scenarios/paper/experiment.hpp"
#include "scenarios/paper/paper_report.hpp"
#include "scenarios/paper/protocol.hpp"
#include "scenarios/paper/series.hpp"
#include "scenarios/paper/sweep.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#ifdef LRB_BUILD_BENCH
#include "bench/methods/structures.hpp"
#endif
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::tools {

namespace {

// The series: its options and its files.

struct PaperSeriesOptions {
  std::vector<std::string> meshes;
  resolutions::ResolutionOptions resolutions;  ///< most = 0: no series
  bool lean = false;
};

void add_series_options(App& app, PaperSeriesOptions& o) {
  app.add_option("--meshes", o.meshes, "PATH...",
                 "Meshes, or folders of meshes, to collide at several resolutions [two generated bodies]");
  app.add_option(
         "--resolutions", o.resolutions.most, "N",
         "Number of resolutions per body, each with half as many faces as the one before; 0 omits this part")
      ->in_range(0, 30)
      ->capture_default_str();
  app.add_option("--subdivide", o.resolutions.subdivisions, "N",
                 "Number of subdivisions of each body; each one replaces a face by four")
      ->in_range(0, 4)
      ->capture_default_str();
  app.add_flag("--lean", o.lean, "Build these bodies with fewer pseudo faces; wrappers fit less tightly");
}

/// Returns the given meshes, or generated ones.
std::vector<Mesh> series_meshes(const PaperSeriesOptions& o, std::vector<std::string>& notes) {
  if (o.resolutions.most == 0) return {};
  return o.meshes.empty() ? paper::own_series_bodies() : paper::read_series_bodies(o.meshes, notes);
}

// The command.

struct PaperOptions {
  std::string folder = "out/paper", experiment = "paper", shard;
  std::vector<std::string> merge;
  std::optional<std::uint32_t> collisions, steps_after, seeds;  ///< these override the experiment
  std::optional<double> step;
  std::optional<std::uint64_t> seed;
  std::uint32_t jobs = 0;  ///< 0: all cores
  PaperSeriesOptions series;
  bool json = false, print = false, tex = false;
};

paper::PaperExperiment experiment_of(const PaperOptions& o) {
  paper::PaperExperiment e = paper::open_experiment(o.experiment);
  if (o.collisions) e.protocol.collisions = *o.collisions;
  if (o.steps_after) e.protocol.steps_after = *o.steps_after;
  if (o.step) e.protocol.step = *o.step;
  if (o.seed) e.protocol.seed = *o.seed;
  if (o.seeds) e.protocol.seeds = *o.seeds;
  if (e.protocol.seed > spec::kAnySeed - (e.protocol.seeds - 1))
    throw InputError("--seed " + std::to_string(e.protocol.seed) + ": expected seeds up to " +
                     std::to_string(spec::kAnySeed));
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

/// The work of a run: keeps each collision at once, so that an interrupted run can be continued, and shows
/// how much of the whole is done. Work is measured in seconds on one core, as expected from measurements.
class PaperWork {
 public:
  /// Keeps collisions in a file, and takes those that it has. An empty path: none are kept.
  PaperWork(std::string path, const std::string& head, const Globals& globals)
      : path_(std::move(path)),
        file_(path_, head, io::UnfinishedFile::Other::refused),
        bar_("paper", 0, globals.quiet) {
    for (const std::string& line : file_.lines())
      if (const auto kept = paper::kept_collision(line)) take(*kept, path_);
    if (!known_.empty())
      note(globals, {"continues an interrupted run, of which " + std::to_string(known_.size()) +
                     " collisions are in " + path_});
    if (!path_.empty())
      say_when_interrupted("finished collisions are kept in " + path_ +
                           "; the same command goes on from there");
  }

  /// Takes a collision that another run has finished. `source`: for errors in its records.
  void take(const paper::KeptCollision& kept, const std::string& source) {
    known_[kept.key] = paper::read_json_lines(kept.records, source);
  }

  /// `mesh_faces` 0: an object of the paper, instead of a mesh.
  static double expected_seconds(const paper::PaperProtocol& p, double mesh_faces, bool with_itself) {
    const double six_steps = mesh_faces == 0 ? 0.007
                             : with_itself   ? 5.3e-4 * std::pow(mesh_faces, 0.65)
                                             : 0.03;
    return six_steps * (1 + p.steps_after) / 6;
  }
  void plan(double seconds) { total_ += seconds; }
  void advance(double seconds, const std::string& what) {
    done_ += seconds;
    bar_.set_share(done_ / total_, what);
  }

  /// Runs a collision, or returns the steps of a known one. `merging`: all must be known. Called from several
  /// threads.
  std::vector<paper::ContactStep> collide(const paper::CollisionTask& task, bool merging,
                                          Workspace& workspace) {
    const std::uint64_t a = task.a.rep.hash(), x = task.x.rep.hash();
    const std::string key =
        nlohmann::json(task.protocol.step).dump() + " " + std::to_string(task.protocol.steps_after) + " " +
        std::to_string(task.protocol.seed) + " " + task.x.name + " " + trace::to_hex(a) + trace::to_hex(x) +
        " " + std::to_string(task.collision) + (task.scalable_only ? " scalable" : "");
    const double seconds =
        expected_seconds(task.protocol, task.x.draws.empty() ? 0 : task.x.rep.real_face_count(), a == x);
    const auto known = known_.find(key);
    if (merging && known == known_.end())
      throw InputError("--merge: the shards do not have collision " + std::to_string(task.collision) +
                       " with " + printable_name(task.x.name) +
                       "; finish them, and give the same --experiment and --meshes");
    std::vector<paper::ContactStep> steps =
        known != known_.end() ? known->second : paper::run(task, workspace);
    const std::lock_guard lock(one_at_a_time_);
    if (known != known_.end()) {
      total_ -= seconds;
      return steps;
    }
    file_.add(
        nlohmann::ordered_json{{"collision", key}, {"records", paper::to_json_lines(steps, true)}}.dump());
    advance(seconds, (task.a.name.empty() ? "" : task.a.name + " and ") + task.x.name);
    return steps;
  }

  void finish(bool keep) {
    bar_.finish();
    if (!keep) file_.remove();
  }

 private:
  std::string path_;
  io::UnfinishedFile file_;
  Progress bar_;
  std::map<std::string, std::vector<paper::ContactStep>> known_;  ///< by key
  std::mutex one_at_a_time_;
  double done_ = 0, total_ = 0;
};

/// Takes the protocol and the resolutions from the shards to be merged, and returns their collisions; drops
/// the series if the experiment defines none. Throws InputError if there is nothing to divide into shards.
std::vector<paper::KeptCollision> settle(PaperOptions& o, paper::PaperExperiment& experiment) {
  if (!experiment.collides() && (!o.shard.empty() || !o.merge.empty()))
    throw InputError("experiment " + experiment.name +
                     ": has no collisions, so it does not take --shard or --merge");
  if (!o.merge.empty()) {
    auto [whole, collisions] = paper::read_shards(o.merge);
    experiment.protocol = whole.protocol;
    o.series.resolutions = whole.resolutions;
    o.series.lean = whole.lean;
    return std::move(collisions);
  }
  if (!experiment.collides() || (experiment.name != "paper" && o.series.meshes.empty()))
    o.series.resolutions.most = 0;  // other experiments have a series only if meshes are given
  return {};
}

/// Number of first contacts with each object in the tables of these.
constexpr std::uint32_t kContacts = 4;

#ifdef LRB_BUILD_BENCH

/// Questions that a structure cannot answer, beside its name among the methods of `bench`.
struct Silence {
  const char *method, *about;
};
constexpr Silence kSilences[] = {
    {"spheres", "whether surfaces that are close intersect, and in which faces; adjacency"},
    {"bsp",
     "which faces of A; a contact of vertices or edges, which has no volume; adjacency; anything of open bodies"},
    {"brep-index", "whether one body is inside the other"},
    {"grids", "whether one body is inside the other"}};

/// Returns the work of the structures that the paper names, for A with the first and the last other object,
/// at the first contact of a few collisions.
report::Table structures_table(std::span<const paper::PaperObject> objects,
                               std::span<const paper::ContactStep> contacts) {
  const LrbRep& a = objects.front().rep;
  const std::array others = {&objects[1], &objects.back()};
  std::array<std::vector<paper::ContactStep>, 2> steps;
  for (std::size_t k = 0; k < others.size(); ++k)
    std::copy_if(contacts.begin(), contacts.end(), std::back_inserter(steps[k]),
                 [&](const paper::ContactStep& s) { return s.object == others[k]->name; });
  report::Table t{"The structures that the paper names, at first contact",
                  {"structure", "comparisons with " + others[0]->name, "with " + others[1]->name,
                   "contacts found", "bytes per face of " + objects.front().name, "cannot say"}};
  t.note =
      "Averages over the first contacts of at most " + std::to_string(kContacts) +
      " collisions each, all pairs. Compared are faces, boxes, spheres, cells, or a face and a plane. Bytes are of "
      "the structure alone; for LRB-reps, with faces and tree. Convex hulls (GJK) and octrees are methods of "
      "lrbscope bench, if FCL is installed.";
  /// compare(k, step): the number of comparisons, and whether a contact was found.
  const auto add = [&](const std::string& title, double bytes, const char* silence, const auto& compare) {
    double sums[2] = {};
    std::size_t found = 0;
    for (std::size_t k = 0; k < others.size(); ++k)
      for (const paper::ContactStep& s : steps[k]) {
        const std::pair<std::uint64_t, bool> one = compare(k, s);
        sums[k] += static_cast<double>(one.first) / static_cast<double>(steps[k].size());
        found += one.second;
      }
    t.rows.push_back({title, paper::whole(sums[0]), paper::whole(sums[1]),
                      std::to_string(found) + " of " + std::to_string(steps[0].size() + steps[1].size()),
                      paper::whole(bytes / a.real_face_count()), silence});
  };
  for (const std::size_t i : {paper::kPaper, std::size_t{3}})
    add(i == paper::kPaper ? "LRB-reps, the paper's recursion" : "tree of oriented boxes, complete",
        static_cast<double>(i == paper::kPaper ? a.memory_bytes()
                                               : LrbRep::without_regions(a).memory_bytes()),
        i == paper::kPaper ? "contacts under lids that nothing touches" : "",
        [&](std::size_t, const paper::ContactStep& s) {
          const paper::RecursionCount& n = s.counts[i];
          return std::pair(n.comparisons + n.bound_tests, n.pairs > 0);
        });
  for (const methods::MethodEntry& entry : methods::structures_methods()) {
    const auto* silence = std::find_if(std::begin(kSilences), std::end(kSilences),
                                       [&](const Silence& s) { return entry.info.name == s.method; });
    const std::unique_ptr<methods::Method> method = entry.make();
    method->set(64);  // spheres: down to the leaves
    try {
      const auto body_a = method->build(a), first = method->build(others[0]->rep),
                 last = method->build(others[1]->rep);
      add(entry.info.title, static_cast<double>(static_cast<const methods::SizedBody&>(*body_a).bytes()),
          silence->about, [&](std::size_t k, const paper::ContactStep& s) {
            const methods::MethodBody& x = k == 0 ? *first : *last;
            const auto tests = method->count_tests(*body_a, s.pose_a, x, s.pose_x);
            const auto answer = method->query(*body_a, s.pose_a, x, s.pose_x, Mode::all_pairs);
            return std::pair(answer.face_tests + (tests ? tests->boxes : 0), answer.contact);
          });
    } catch (const InputError& e) {
      t.rows.push_back({entry.info.title, e.what()});
      t.rows.back().resize(t.columns.size());
    }
  }
  return t;
}

#endif

/// The counted steps of all parts.
struct PaperSteps {
  std::vector<paper::ContactStep> objects, settings, series;
};

int run_paper(PaperOptions o, const Globals& globals) {
  if (o.print) {
    print(paper::shipped_experiment(o.experiment));
    return kOk;
  }
  paper::PaperExperiment experiment = experiment_of(o);
  const std::vector<paper::KeptCollision> merged = settle(o, experiment);
  const paper::PaperProtocol& protocol = experiment.protocol;
  const bool merging = !o.merge.empty(), is_shard = !o.shard.empty();
  paper::SweepOptions sweep{protocol, {}, o.jobs > 0 ? o.jobs : all_cores()};
  if (is_shard) sweep.shard = read_shard(o.shard);
  std::vector<std::string> notes;
  const std::vector<paper::PaperObject> objects = paper::make_objects(experiment, notes);
  const LrbRep& a = objects[0].rep;
  const std::vector<Mesh> meshes = series_meshes(o.series, notes);
  note(globals, notes);
  std::vector<paper::PaperProtocol> settings;
  if (experiment.reports(paper::PaperPart::settings) && paper::as_published(objects))
    settings = paper::other_settings(protocol);
  PaperSteps steps;
  const report::Folder folder(o.folder);
  const bool computes = experiment.collides();
  paper::KeptRun run{sweep.shard, protocol, o.series.resolutions, o.series.lean};
  if (!is_shard)
    run = {{}, {0, protocol.steps_after, protocol.step, protocol.seed, 0}, {0, 0}};  // the rest may grow
  PaperWork work(
      !computes || merging ? "" : o.folder + (is_shard ? "/collisions.jsonl" : "/unfinished.jsonl"),
      paper::head_of(run, objects), globals);
  for (const paper::KeptCollision& kept : merged) work.take(kept, "--merge");
  sweep.runner = [&](const paper::CollisionTask& task, Workspace& w) {
    return work.collide(task, merging, w);
  };

  // Plan the whole, so that the time left is that of the whole.
  const auto plan = [&](const paper::PaperProtocol& p, double pairs, double mesh_faces = 0,
                        bool with_itself = false) {
    work.plan(pairs * p.seeds * p.collisions / sweep.shard.count *
              PaperWork::expected_seconds(p, mesh_faces, with_itself));
  };
  const auto building_seconds = [&](double faces) { return 5.5e-5 * faces * sweep.jobs; };  // on one thread
  if (computes) {
    const auto others = static_cast<double>(objects.size() - 1);
    plan(protocol, others);
    for (const paper::PaperProtocol& p : settings) plan(p, others);
  }
  paper::PaperProtocol of_series = protocol;
  of_series.seeds = 1;
  for (const Mesh& mesh : meshes)
    for (const std::uint32_t faces : resolutions::resolution_sizes(mesh, o.series.resolutions)) {
      work.plan(building_seconds(faces));
      plan(of_series, 1, faces);
      plan(of_series, 1, faces, true);
    }
  const paper::PaperProtocol approaches = paper::first_contacts(protocol, paper::kAcceleratorCollisions);
  const auto accelerator_seconds = [&](const Mesh& mesh) {  // two builds and the approaches, on one thread
    const auto faces = static_cast<double>(mesh.face_count());
    return 2 * building_seconds(faces) +
           sweep.jobs * approaches.collisions * PaperWork::expected_seconds(approaches, faces, true);
  };
  if (!is_shard)
    for (const Mesh& mesh : meshes) work.plan(accelerator_seconds(mesh));

  std::vector<report::Table> more;
  const auto write = [&](const paper::SeriesReport* series) {
    return paper::write_paper_report(
        {objects, steps.objects, steps.settings, experiment, globals.command_line, series, o.tex, more},
        folder);
  };
  if (computes) {
    steps.objects = paper::sorted(paper::run_seeds(objects, sweep));
    for (const paper::PaperProtocol& p : settings) {
      paper::SweepOptions other = sweep;
      other.protocol = p;
      other.scalable_only = true;
      for (paper::ContactStep& s : paper::run_sweep(objects, other)) steps.settings.push_back(std::move(s));
    }
    if (!meshes.empty() && !is_shard &&
        !merging) {  // so that an interruption of the rest leaves these results
      write(nullptr);
      note(globals, {"wrote " + o.folder +
                     "/index.html; bodies at several resolutions follow (--resolutions 0: none)"});
    }
  }
  BuildOptions building;
  building.lean = o.series.lean;
  const std::vector<paper::SeriesObject> series = paper::make_series(
      meshes, o.series.resolutions, building, paper::diagonal(a),
      [&](const LrbRep& rep) { work.advance(building_seconds(rep.real_face_count()), "resolutions"); });
  steps.series = paper::run_series(a, series, sweep);
  if (is_shard) {
    work.finish(true);
    print(o.folder + "/collisions.jsonl\n");
    return kOk;
  }
  std::vector<paper::ContactStep> contacts;
  bool needs_contacts = experiment.reports(paper::PaperPart::incremental);
#ifdef LRB_BUILD_BENCH
  needs_contacts |= experiment.reports(paper::PaperPart::structures);
#endif
  if (needs_contacts)
    contacts = run_sweep(objects, {paper::first_contacts(protocol, kContacts), {}, sweep.jobs, true});
  if (experiment.reports(paper::PaperPart::incremental))
    more.push_back(paper::incremental_table(objects, contacts));
#ifdef LRB_BUILD_BENCH
  if (experiment.reports(paper::PaperPart::structures)) more.push_back(structures_table(objects, contacts));
#endif
  if (!meshes.empty())
    more.push_back(paper::accelerator_table(meshes, protocol, building, [&](const Mesh& mesh) {
      work.advance(accelerator_seconds(mesh), mesh.name + " as an accelerator");
    }));
  const paper::SeriesReport series_report{a, series, steps.series, sweep.jobs};
  note(globals, write(meshes.empty() ? nullptr : &series_report));
  work.finish(false);
  print(o.json ? io::read_text(o.folder + "/tables.json") : o.folder + "/index.html\n");
  return kOk;
}

}  // namespace

Command add_paper(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "paper",
      "Reproduce the paper's experiment: tables, figures, close-ups of single collisions, and the same on "
      "meshes");
  const auto o = std::make_shared<PaperOptions>();
  app->add_option("-o,--output", o->folder, "DIR", "Output folder")->capture_default_str();
  app->add_option("--experiment", o->experiment, "NAME|FILE",
                  "Experiment: paper, table1, table2, figures, close_up or a JSON file")
      ->capture_default_str();
  app->add_flag("--print", o->print, "Only print the shipped experiment, as a starting point for your own");
  app->add_option("--collisions", o->collisions, "N", "Number of collisions of A with each object [100]")
      ->in_range(1u, paper::kMaxCollisions);
  app->add_option("--step", o->step, "SHARE", "Time step, as a fraction of the diagonal [0.005]")
      ->in_range(paper::kMinStep, paper::kMaxStep);
  app->add_option("--steps-after", o->steps_after, "N",
                  "Number of time steps counted after first contact [5]")
      ->in_range(0u, paper::kMaxStepsAfter);
  app->add_option("--seed", o->seed, "N", "Random seed for directions and rotations [1]");
  app->add_option("--seeds", o->seeds, "N",
                  "Number of repetitions, with seed, seed + 1, and so on; the tables then show a band [1]")
      ->in_range(1u, paper::kMaxSeeds);
  app->add_option("--jobs", o->jobs, "N", "Number of threads [all cores]; the result does not depend on it")
      ->in_range(1u, 1024u);
  Option* shard =
      app->add_option("--shard", o->shard, "i/n",
                      "Run only part i of n (from 0) of the collisions, and keep them in collisions.jsonl");
  Option* merge = app->add_option("--merge", o->merge, "collisions.jsonl...",
                                  "Report the collisions of all shards without computing any; repeat the "
                                  "shards' --meshes, if any")
                      ->excludes(shard);
  add_series_options(*app, o->series);
  for (const char* of_shards : {"--collisions", "--step", "--steps-after", "--seed", "--seeds",
                                "--resolutions", "--subdivide", "--lean"})
    merge->excludes(app->get_option(of_shards));
  add_tex_option(*app, o->tex, "each table");
  app->add_flag("--json", o->json, "Print the tables as JSON instead of the page's path");
  return {app, [o, &globals] { return run_paper(*o, globals); }};
}

}  // namespace lrb::tools
