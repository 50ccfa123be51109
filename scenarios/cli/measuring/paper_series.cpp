#include "scenarios/cli/measuring/paper_series.hpp"

#include <filesystem>

#include "scenarios/cli/progress.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/paper/protocol.hpp"

namespace lrb::cli {

void add_series_options(CLI::App& app, PaperSeriesOptions& o) {
  app.add_option("--meshes", o.meshes,
                 "Meshes, or folders of meshes, to collide at several resolutions [two bodies of our own]")
      ->type_name("PATH...");
  app.add_option(
         "--resolutions", o.resolutions.most,
         "Number of resolutions of each body, each with half as many faces as the one before; 0 leaves this "
         "part out")
      ->check(CLI::Range(0, 30))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--subdivide", o.resolutions.subdivisions,
                 "How often to subdivide each body first; each time replaces a face by four")
      ->check(CLI::Range(0, 4))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("--lean", o.lean,
               "Build these bodies with fewer faces in all, for wrappers that fit less well");
}

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

std::vector<paper::ContactStep> run_series(const LrbRep& a, std::span<const paper::SeriesObject> objects,
                                           const paper::SweepOptions& sweep, const Globals& globals) {
  Progress progress("resolutions collide", 0, globals.quiet);
  return paper::run_series(a, objects, sweep, [&](std::uint64_t done, std::uint64_t of) {
    progress.set_total(of);
    progress.set(done);
  });
}

void write_series_shard(const std::vector<paper::ContactStep>& steps, const std::string& folder) {
  io::write_text(folder + "/series.jsonl", paper::to_json_lines(steps));
  io::write_text(folder + "/series_times.jsonl", paper::times_to_json_lines(steps));
}

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

}  // namespace lrb::cli
