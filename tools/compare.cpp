#include "scenarios/compare/compare.hpp"

#include <filesystem>
#include <memory>

#include "scenarios/record/recorded_run.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"

namespace lrb::tools {
namespace {

struct CompareOptions {
  std::string first, second, folder, up;
};

/// Returns the scenario for the pictures of a run: its name, and the view direction.
spec::Scenario scenario_of(const record::Recording& recording, const std::string& up) {
  spec::Scenario s;
  s.name = recording.trace.header.scenario;
  s.frames.views.emplace_back();
  PictureOptions picture;
  picture.camera.up = up;
  apply(picture, s.frames);
  return s;
}

/// Returns short names of two folders: their last components, if they differ.
std::array<std::string, 2> names_of(const std::string& first, const std::string& second) {
  const auto last = [](const std::string& path) {
    const std::filesystem::path p(path);
    return (p.has_filename() ? p.filename() : p.parent_path().filename()).string();
  };
  if (last(first) == last(second)) return {first, second};
  return {last(first), last(second)};
}

/// Returns the page of a run that is given by its folder or by its trace.
std::string page_of(const std::string& run) {
  const std::filesystem::path p(run);
  return ((std::filesystem::is_directory(p) ? p : p.parent_path()) / "index.html").string();
}

int run_compare(const CompareOptions& o, const Globals& globals) {
  const std::array<record::Recording, 2> recordings = {record::open_run(o.first), record::open_run(o.second)};
  std::string up = o.up;
  resolve_up(up, recordings[0].bodies[0].rep, globals);
  const std::array<spec::Scenario, 2> scenarios = {scenario_of(recordings[0], up),
                                                   scenario_of(recordings[1], up)};
  const compare::Runs runs{{&recordings[0], &recordings[1]},
                           names_of(o.first, o.second),
                           {&scenarios[0], &scenarios[1]},
                           {page_of(o.first), page_of(o.second)}};
  const std::string folder = o.folder.empty() ? "out/compare" : o.folder;
  const compare::Difference difference =
      compare::write_comparison(runs, globals.command_line, folder, progress_report(globals.quiet));
  print(difference.first.value_or("the runs are identical") + "\n" +
        (difference.first ? difference.regions : std::string()) + folder + "/index.html\n");
  return difference.first ? kMismatch : kOk;
}

}  // namespace

Command add_compare(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "compare",
      "Show two recorded runs side by side, with their first difference; exit code 1 if they differ");
  const auto o = std::make_shared<CompareOptions>();
  app->add_option("RUN1", o->first, "Folder or trace of a run, as written by run, collide or import")
      ->required();
  app->add_option("RUN2", o->second, "Folder or trace of the run to compare with")->required();
  app->add_option("-o,--output", o->folder, "DIR", "Output folder [out/compare]");
  add_up_option(*app, o->up);
  return {app, [o, &globals] { return run_compare(*o, globals); }};
}

}  // namespace lrb::tools
