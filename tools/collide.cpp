#include <charconv>
#include <filesystem>
#include <iterator>
#include <memory>

#include <Eigen/Geometry>

#include "render/pictures/panel.hpp"
#include "scenarios/frames/animation.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/hash.hpp>
#include <lrbscope/core/random.hpp>
#include <lrbscope/error.hpp>

namespace lrb::tools {
namespace {

struct CollideOptions {
  TwoMeshes meshes;
  std::string folder;
  PictureOptions picture;
  bool json = false;
};

/// Returns a motion that moves B's centre towards A's, from a separate position until some distance past the
/// first contact.
spec::Motion approach_from(const Eigen::Vector3d& direction, const LrbRep& a, const LrbRep& b) {
  const Eigen::AlignedBox3d box_a = pictures::box_of(a), box_b = pictures::box_of(b);
  spec::Motion m;
  m.kind = spec::Motion::Kind::approach;
  m.target = box_a.center() - box_b.center();
  constexpr double kClear = 1.02;  // in distances at which the bounding spheres of both boxes touch
  m.from = deterministic::scaled_direction(direction).normalized() * kClear *
           (box_a.diagonal().norm() + box_b.diagonal().norm()) / 2;
  m.step_length = 0.004;
  m.steps = 100'000;
  m.before = 12;
  m.into = 18;
  m.exact = true;
  return m;
}

/// Chooses the axis that points up: without --up the one on which A is most stable, else B. An axis along
/// --from is not chosen. Returns a note if it is not z, else an empty text.
std::string choose_up(CameraOptions& camera, const std::vector<bodies::LoadedBody>& bodies,
                      const Globals& globals) {
  const bool is_given = !camera.up.empty();
  resolve_up(camera.up, bodies[0].rep, globals);
  if (is_given || bodies[0].rep.dim() == 2) return {};
  for (const bodies::LoadedBody& body : bodies) {
    const std::optional<int> guess = pictures::likely_up(body.rep);
    if (!guess) continue;
    const bool along_view =
        !camera.from.empty() &&
        io::parse_vector(camera.from, "--from").cross(Eigen::Vector3d::Unit(*guess)).isZero();
    if (*guess == 2 || along_view) return {};
    camera.up = {"xyz"[*guess]};
    return "up is " + camera.up + ", on which " + body.rep.name() + " is most stable; --up sets another axis";
  }
  return {};
}

/// Returns some of the poses; steps: "FROM:TO" or "FROM:TO:EVERY".
std::vector<Pose> some_of(const std::vector<Pose>& poses, const std::string& steps) {
  std::size_t number[] = {0, 0, 1}, count = 0;
  const char *next = steps.data(), *const end = next + steps.size();
  while (count < 3) {
    const auto [rest, error] = std::from_chars(next, end, number[count]);
    next = rest;
    if (error != std::errc() || ++count == 3 || next == end || *next != ':') break;
    ++next;
  }
  const auto [from, to, every] = number;
  if (next != end || count < 2 || steps.back() == ':' || every == 0 || from > to || to >= poses.size())
    throw InputError("--steps " + steps + ": expected FROM:TO or FROM:TO:EVERY with numbers of poses up to " +
                     std::to_string(poses.size() - 1));
  std::vector<Pose> out;
  for (std::size_t i = 0; i <= (to - from) / every; ++i) out.push_back(poses[from + i * every]);
  return out;
}

spec::Scenario make_scenario(const TwoMeshes& o, const std::vector<bodies::LoadedBody>& bodies,
                             std::vector<Pose> poses, const PictureOptions& picture) {
  spec::Scenario s;
  s.name = std::filesystem::path(o.a).stem().string() + "-" + std::filesystem::path(o.b).stem().string();
  s.bodies = {{}, {}};
  s.bodies[0].file = o.a;
  s.bodies[1].file = o.b;
  s.request = o.request;
  s.request.contacts = o.request.mode == Mode::all_pairs;
  s.more = o.more;
  if (o.events) s.events = *o.events;
  if (o.clock) s.clock = *o.clock;
  s.gzip = o.gzip;
  s.frames.montage = 6;
  s.frames.views = frames::whole_and_contact();
  if (!o.poses.empty()) {
    s.motion.kind = spec::Motion::Kind::poses;
    s.motion.poses = std::move(poses);
  } else {
    // The default direction is oblique: along an axis, the first contact of axis-aligned bodies would be
    // entire faces.
    Eigen::Vector3d direction(1, 0.35, 0.25);
    if (!o.approach.empty()) direction = io::parse_vector(o.approach, "--approach");
    if (direction.isZero(0)) throw InputError("--approach: expected a direction other than zero");
    if (bodies[0].rep.dim() == 2) {
      if (!o.approach.empty() && direction.z() != 0)
        throw InputError("--approach: expected z = 0 because the bodies are 2D, found " + o.approach);
      direction.z() = 0;
    }
    s.motion = approach_from(direction, bodies[0].rep, bodies[1].rep);
  }
  Fnv64 hash;
  for (const bodies::LoadedBody& body : bodies) hash.add_value(body.rep.hash());
  for (const Pose& pose : s.motion.poses) {
    hash.add_bytes(pose.r.data(), sizeof(double) * 9);
    hash.add_bytes(pose.t.data(), sizeof(double) * 3);
  }
  hash.add_bytes(s.motion.from.data(), sizeof(double) * 3);
  s.hash = hash.value();
  apply(picture, s.frames);
  return s;
}

int run_collide(const CollideOptions& o, const Globals& globals) {
  if (!o.picture.animation.empty()) frames::check_animation(o.picture.animation);
  const auto [scenario, recording] = record_meshes(o.meshes, o.picture, globals);
  const std::string folder = o.folder.empty() ? "out/" + scenario.name : o.folder;
  const run::RunOutcome outcome =
      run::write_run(scenario, recording, folder, globals.command_line, progress_report(globals.quiet));
  animate_frames(o.picture, folder);
  return report_outcome(outcome, folder, o.json, globals);
}

}  // namespace

void add_motion_options(App& app, TwoMeshes& meshes) {
  auto* poses = app.add_option("--poses", meshes.poses, "FILE",
                               "File with the pose of B at each step: lines of 12 numbers (3x4, row by row), "
                               ".csv or .json");
  app.add_option("--approach", meshes.approach, "X,Y,Z", "Direction from A to the start position of B")
      ->excludes(poses);
}

std::pair<spec::Scenario, record::Recording> record_meshes(const TwoMeshes& meshes,
                                                           const PictureOptions& given,
                                                           const Globals& globals) {
  // Check everything before an expensive build. Pipes are read once, because they are empty the second time.
  check_view(given, frames::whole_and_contact().size());
  std::vector<Pose> poses;
  if (!meshes.poses.empty()) poses = io::open_poses(meshes.poses).poses;
  if (!meshes.steps.empty()) poses = some_of(poses, meshes.steps);
  const spec::StepQuestions& more = meshes.more;
  if (more.near) check_request(NearPairsRequest{.within = *more.near});
  if (!more.points.empty() && !std::filesystem::is_fifo(more.points)) io::read_points(more.points);
  if (more.manifold) check_request(ManifoldRequest{.margin = *more.manifold});
  auto both = bodies::load_two_bodies(meshes.a, meshes.b, with_progress({}, globals.quiet), meshes.corners);
  std::vector<bodies::LoadedBody> bodies(std::make_move_iterator(both.begin()),
                                         std::make_move_iterator(both.end()));
  if (bodies[0].rep.dim() != bodies[1].rep.dim())
    throw InputError(meshes.a + " and " + meshes.b +
                     ": expected two bodies of the same dimension, found a 2D and a 3D body");
  PictureOptions picture = given;
  const std::string up_note = choose_up(picture.camera, bodies, globals);
  spec::Scenario scenario = make_scenario(meshes, bodies, std::move(poses), picture);
  record::Recording recording = record::record(scenario, std::move(bodies), progress_report(globals.quiet));
  choose_views(picture.camera, scenario, recording);
  if (!up_note.empty()) recording.notes.insert(recording.notes.begin(), up_note);
  return {std::move(scenario), std::move(recording)};
}

Command add_collide(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "collide", "Move your own mesh B into mesh A and write an interactive page of the collision");
  const auto o = std::make_shared<CollideOptions>();
  app->add_option("A", o->meshes.a, "Mesh or .lrb file; does not move")->required();
  app->add_option("B", o->meshes.b, "Mesh or .lrb file; moves")->required();
  app->add_option("-o,--output", o->folder, "DIR", "Output folder [out/A-B]");
  TwoMeshes& meshes = o->meshes;
  add_motion_options(*app, meshes);
  add_request_options(*app, meshes.request);
  app->add_flag("--distance", meshes.more.distance,
                "Also compute the distance between the bodies at each step");
  app->add_flag_callback(
      "--clash", [&meshes] { meshes.more.clash.emplace(); },
      "Also classify the contact and compute its penetration depth at each step");
  app->add_option("--near", meshes.more.near, "D",
                  "Also list the pairs of triangles at most this far apart at each step, in mesh units");
  app->add_option("--manifold", meshes.more.manifold, "D",
                  "Also find the contact manifolds at each step, with speculative contacts up to this "
                  "distance, in mesh units");
  app->add_option("--points", meshes.more.points, "FILE",
                  "Also compute the signed distances of points to A at each step: lines of 3 numbers, x y z, "
                  "in B's frame");
  app->add_option(
         "--steps", meshes.steps, "FROM:TO[:EVERY]",
         "Use only poses FROM to TO of the file, numbered from 0, or every EVERY-th of them; the run's steps "
         "are numbered from 0")
      ->needs(app->get_option("--poses"));
  app->add_flag("--gzip", meshes.gzip, "Compress the trace: trace.json.gz");
  add_events_option(*app, meshes.events);
  add_clock_option(*app, meshes.clock);
  add_picture_options(*app, o->picture, true);
  add_animation_option(*app, o->picture);
  app->add_flag("--json", o->json, "Print the summary as JSON instead of the page's path");
  add_join_option(*app, meshes.corners);
  return {app, [o, &globals] { return run_collide(*o, globals); }};
}

}  // namespace lrb::tools
