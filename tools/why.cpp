#include <memory>
#include <optional>

#include <nlohmann/json.hpp>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/run/explanations.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/explain.hpp>

namespace lrb::tools {
namespace {

struct WhyOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string a, b, poses, run, picture;
  std::size_t pose = 0;
  std::optional<std::uint32_t> step;
  std::vector<std::uint32_t> pair;
  bool json = false;
};

Pose pose_of(const WhyOptions& o) {
  if (o.poses.empty()) return {};
  const std::vector<Pose> poses = io::open_poses(o.poses).poses;
  if (o.pose >= poses.size())
    throw InputError(printable_name(o.poses) + ": expected a pose number below " +
                     std::to_string(poses.size()) + ", found " + std::to_string(o.pose));
  return poses[o.pose];
}

int explain(const WhyOptions& o, const pictures::PosedBodies& bodies) {
  const auto& [a, pose_a, b, pose_b] = bodies;
  if (o.pair.empty()) {
    const WalkExplanation e = explain_walk(a, pose_a, b, pose_b);
    if (!o.picture.empty() && !e.result.pairs.empty())
      throw InputError(
          "-o: the bodies intersect, so there is no separation to draw; use --pair to draw two of their faces");
    if (!o.picture.empty()) pictures::write_picture(pictures::picture_of(e, bodies), o.picture);
    print(o.json ? one_line(run::explanation_json(e)) : run::explanation_text(e));
    return kOk;
  }
  const PairExplanation e = explain_pair(a, pose_a, b, pose_b, {SimplexId(o.pair[0]), SimplexId(o.pair[1])});
  if (!o.picture.empty()) pictures::write_picture(pictures::picture_of(e, bodies), o.picture);
  print(o.json ? one_line(run::explanation_json(e, a, b)) : run::explanation_text(e, a, b));
  return kOk;
}

int run_why(const WhyOptions& o, const Globals& globals) {
  if (!o.run.empty()) {
    const record::OpenStep open = record::open_step(o.run, o.step);
    return explain(o, {open.bodies[0].rep, open.step.pose_a, open.bodies[1].rep, open.step.pose_b});
  }
  if (o.b.empty()) throw InputError("why: expected two bodies A and B, or --run DIR");
  const Pose pose = pose_of(o);
  const auto loaded = bodies::load_two_bodies(o.a, o.b, with_progress({}, globals.quiet), o.corners);
  const bodies::LoadedBody &a = loaded[0], &b = loaded[1];
  note(globals, a.notes);
  note(globals, b.notes);
  return explain(o, {a.rep, {}, b.rep, pose});
}

}  // namespace

Command add_why(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "why", "Explain why two faces are or are not reported as a pair, or why two bodies are separate");
  const auto o = std::make_shared<WhyOptions>();
  auto* a = app->add_option("A", o->a, "Mesh or .lrb file; does not move");
  app->add_option("B", o->b, "Mesh or .lrb file; moved to the pose");
  auto* poses = app->add_option("--poses", o->poses, "File with poses, as for `query` [B stays in place]");
  app->add_option("--pose", o->pose, "Number of the pose in the file, from 0")
      ->needs(poses)
      ->capture_default_str();
  auto* run = app->add_option("--run", o->run, "DIR", "A recorded run (folder or trace) instead of A and B")
                  ->excludes(a)
                  ->excludes(poses);
  app->add_option("--step", o->step, "N", "Time step of the run [the last]")->needs(run);
  app->add_option("--pair", o->pair, "I,J", "A simplex of A and one of B, numbered as in `query --pairs`")
      ->delimiter(',')
      ->expected(2);
  app->add_option("-o,--output", o->picture, "FILE.png",
                  "Draw the two faces and their surroundings; without --pair, the separating plane or boxes "
                  "of the bodies");
  app->add_flag("--json", o->json, "Print one JSON object");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_why(*o, globals); }};
}

}  // namespace lrb::tools
