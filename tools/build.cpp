#include <chrono>
#include <memory>
#include <sstream>

#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "scenarios/bodies/body_figures.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/parallel.hpp>
#include <lrbscope/validate.hpp>
#include <lrbscope/wrapper.hpp>

namespace lrb::tools {
namespace {

struct BuildCommandOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string mesh, out;
  BuildOptions build;
  bool json = false, no_validate = false;
};

constexpr double kMega = 1e6;

/// Returns the peak memory of this process, in bytes.
std::uint64_t peak_bytes() {
  rusage use{};
  getrusage(RUSAGE_SELF, &use);
  return 1024 * static_cast<std::uint64_t>(use.ru_maxrss);
}

std::string as_text(const nlohmann::ordered_json& j, const ValidateReport* report) {
  const auto figure = [&](const char* key) { return for_people(j[key], 4); };
  std::ostringstream out;
  out << j["name"].get<std::string>() << "\n"
      << "  faces    " << figure("real_faces") << " real + " << figure("pseudo_faces")
      << " pseudo = " << figure("total_faces") << " (" << figure("total_per_real") << " per real face), "
      << figure("outer_faces") << " outermost\n"
      << "  regions  " << figure("regions") << " in " << figure("layers") << " layers\n"
      << (j["dim"] == 2 ? "  area     solid " : "  volume   solid ") << figure("volume_solid")
      << ", outermost wrapper " << figure("volume_outer") << ", convex hull " << figure("volume_hull") << "\n"
      << "  memory   " << figure("bytes_per_real_face") << " bytes per real face; peak of the process "
      << for_people(j["peak_bytes"].get<double>() / kMega, 3) << " MB\n"
      << "  built in " << figure("seconds") << " s\n";
  if (report != nullptr) {
    out << "  valid    " << (report->valid ? "yes" : "NO") << "\n";
    for (const std::string& line : report->violations) out << "    " << line << "\n";
  }
  return out.str();
}

int run_build(const BuildCommandOptions& o, const Globals& globals) {
  std::vector<std::string> notes;
  Mesh mesh = bodies::read_body(o.mesh, o.corners, notes);
  const auto begin = std::chrono::steady_clock::now();
  const LrbRep rep =
      bodies::build_from_mesh(check(std::move(mesh)), with_progress(o.build, globals.quiet), notes);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (std::string line : {bodies::poor_line(rep, o.build), note_no_levels(rep)})
    if (!line.empty()) notes.push_back(std::move(line));
  note(globals, notes);

  nlohmann::ordered_json j = bodies::body_figures(rep);
  if (o.json)
    j["levels"] = bodies::level_json(bodies::level_figures(rep, bodies::kLevelShares, o.build.threads));
  j["seconds"] = seconds;
  j["peak_bytes"] = peak_bytes();
  j["notes"] = notes;  // repairs made to the mesh, and weaknesses of the result
  ValidateReport report;
  // Levels are made here, perhaps at the same time.
  const ValidateOptions validating{.threads = o.build.threads, .levels = false};
  Workers workers(o.build.threads);
  workers.both(
      [&] {
        if (!o.no_validate) report = validate(rep, validating);
      },
      [&] {
        if (!o.out.empty()) rep.levels(o.build.threads);
      });
  j["valid"] = nullptr;
  if (!o.no_validate) {
    j["valid"] = report.valid;
    j["real_pairs_meeting"] = report.real_pairs_meeting;
    j["violations"] = report.violations;
  }
  if (!o.out.empty()) {
    save_lrb(rep, o.out);
    j["file"] = o.out;
    note(globals, {"wrote " + o.out});
  }
  print(o.json ? one_line(j) : as_text(j, o.no_validate ? nullptr : &report));
  return o.no_validate || report.valid ? kOk : kMismatch;
}

}  // namespace

Command add_build(App& root, const Globals& globals) {
  App* app = root.add_subcommand("build", "Build the LRB-rep of a mesh, validate it and save it");
  const auto o = std::make_shared<BuildCommandOptions>();
  app->add_option("MESH", o->mesh, "Mesh: OBJ, STL, PLY or OFF")->required();
  app->add_option("-o,--output", o->out, "FILE.lrb", "LRB-rep to write");
  o->build.threads = 0;
  add_build_options(*app, o->build);
  app->add_flag("--json", o->json, "Print the figures as one JSON object");
  app->add_flag("--no-validate", o->no_validate, "Do not validate the LRB-rep");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_build(*o, globals); }};
}

}  // namespace lrb::tools
