#include <filesystem>
#include <iterator>
#include <memory>

#include "bench/methods/triangles.hpp"
#include "bench/xray/foreign_walk.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/io/poses.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>

namespace lrb::cli {
namespace {

struct XrayOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string a, b, method = "fcl", poses, folder;
  PictureOptions picture;
};

spec::Scenario scenario_of(const XrayOptions& o, const std::vector<bodies::LoadedBody>& bodies) {
  spec::Scenario s;
  s.name = std::filesystem::path(o.a).stem().string() + "-" + std::filesystem::path(o.b).stem().string() +
           ", " + o.method;
  s.bodies = {{}, {}};
  s.bodies[0].file = o.a;
  s.bodies[1].file = o.b;
  s.motion.kind = spec::Motion::Kind::poses;
  s.motion.poses = io::open_poses(o.poses).poses;
  s.request.contacts = true;
  s.events = EventLevel::nodes;
  s.event_cap = 20'000'000;  // half a gigabyte
  s.frames.views = run::whole_and_contact();
  s.frames.views[0].wrapper = false;
  s.frames.views[0].title = "Overview";
  s.frames.most = 12;
  s.frames.colour_by = render::FrameSpec::ColourBy::box_tests;
  Fnv64 hash;
  for (const bodies::LoadedBody& body : bodies) hash.add_value(body.rep.hash());
  for (const Pose& pose : s.motion.poses) {
    hash.add_bytes(pose.r.data(), sizeof(double) * 9);
    hash.add_bytes(pose.t.data(), sizeof(double) * 3);
  }
  s.hash = hash.value();
  apply(o.picture, s.frames);
  return s;
}

/// Reads the poses of B. Throws InputError with file and line for a pose that is not a rotation and a
/// translation.
std::vector<xray::PosePair> rigid_poses(const std::string& path) {
  const io::PoseList list = io::open_poses(path);
  std::vector<xray::PosePair> out;
  for (const Pose& pose : list.poses) {
    try {
      methods::check_rigid(pose);
    } catch (const InputError& e) {
      throw InputError(list.places[out.size()] + ": pose " + std::to_string(out.size()) + ": " + e.what());
    }
    out.push_back({{}, pose});
  }
  return out;
}

int run_xray(const XrayOptions& o, const Globals& globals) {
  const std::vector<xray::PosePair> poses = rigid_poses(o.poses);
  const run::ProgressReport progress = progress_report(globals.quiet);
  std::optional<BuildOptions> building = with_progress({}, globals.quiet);
  auto both = bodies::load_two(o.a, o.b, [&](const std::string& path) {
    bodies::LoadedBody body = bodies::load_body(path, *building, o.corners);
    if (body.rep.dim() != 3)
      throw InputError(printable_name(path) +
                       ": expected a 3D body, found a 2D body; the other engines support only 3D");
    return body;
  });
  building.reset();
  std::vector<bodies::LoadedBody> bodies(std::make_move_iterator(both.begin()),
                                         std::make_move_iterator(both.end()));
  const capture::Capture walk = xray::walk_of(o.method, bodies[0].rep, bodies[1].rep, poses);
  const spec::Scenario scenario = scenario_of(o, bodies);
  const run::Recording ours = run::record(scenario, std::move(bodies), progress);
  const run::Recording theirs = xray::recording_of(walk, ours, scenario);
  const std::string folder = o.folder.empty() ? "out/xray-" + o.method : o.folder;
  note(globals, xray::write_xray({scenario, theirs, ours, o.method, globals.command_line,
                                  "lrbscope why " + shell_word(o.a) + " " + shell_word(o.b) + " --poses " +
                                      shell_word(o.poses)},
                                 folder, progress));
  print(folder + "/index.html\n");
  return kOk;
}

}  // namespace

Command add_xray(App& root, const Globals& globals) {
  App* app = root.add_subcommand("xray", "Record another engine's traversal and show it next to lrbscope's");
  const auto o = std::make_shared<XrayOptions>();
  app->add_option("A", o->a, "Mesh or .lrb file, 3D; does not move")->required();
  app->add_option("B", o->b, "Mesh or .lrb file, 3D; moves")->required();
  app->add_option("--method", o->method, "fcl|cgal",
                  "The other engine; it must have been installed when lrbscope was built")
      ->one_of({"fcl", "cgal"})
      ->capture_default_str();
  app->add_option("--poses", o->poses, "FILE",
                  "File with the poses of B: lines of 12 numbers (3x4, row by row), .csv or .json")
      ->required();
  app->add_option("-o,--output", o->folder, "DIR", "Output folder [out/xray-METHOD]");
  add_picture_options(*app, o->picture);
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_xray(*o, globals); }};
}

}  // namespace lrb::cli
