#include <memory>
#include <optional>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/pose_lines.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::cli {
namespace {

struct ManifoldOptions : PosedFiles {
  ManifoldRequest request;
  bool pairs = false;
  std::uint32_t repeat = 0;
  DrawOptions draw;
};

/// Writes a feature by its kind: "vertex":3, "edge":[1,2] or "triangle":5.
void write_feature(trace::JsonWriter& w, const char* name, const SurfaceFeatureId& f) {
  w.key(name).begin_object();
  if (f.kind == FeatureKind::edge)
    w.key("edge").begin_array().value(f.first).value(f.second).end_array();
  else
    w.member(f.kind == FeatureKind::vertex ? "vertex" : "triangle", f.first);
  w.end_object();
}

void write_point(trace::JsonWriter& w, const ManifoldPoint& point) {
  w.begin_object().member("id", point.id).member("depth", point.depth);
  write_vector(w, "point_a", point.point[0]);
  write_vector(w, "point_b", point.point[1]);
  write_feature(w, "on_a", point.on[0]);
  write_feature(w, "on_b", point.on[1]);
  w.end_object();
}

std::string line_of(std::size_t pose, const ManifoldResult& result, const ManifoldOptions& o, double us) {
  return trace::json_text(trace::JsonWriter::kCompact, [&](trace::JsonWriter& w) {
    w.begin_object().member("pose", std::uint64_t{pose}).member("pairs", std::uint64_t{result.pairs.size()});
    if (o.repeat > 0) w.member("us", us);
    w.key("manifolds").begin_array();
    for (const ContactManifold& manifold : result.manifolds) {
      w.begin_object().member("region", manifold.region).member("intersects", manifold.intersects);
      write_vector(w, "normal", manifold.normal);
      w.key("points").begin_array();
      for (const ManifoldPoint& point : manifold.points) write_point(w, point);
      w.end_array();
      if (o.pairs) {
        w.key("list").begin_array();
        for (const std::uint32_t i : manifold.pairs) {
          const NearPair& pair = result.pairs[i];
          w.begin_array().value(pair.a.value()).value(pair.b.value()).end_array();
        }
        w.end_array();
      }
      w.end_object();
    }
    w.end_array().end_object();
  });
}

int run_manifold(const ManifoldOptions& o, const Globals& globals) {
  const PoseLines list(o.poses);
  check_request(o.request);
  const render::Look look = look_of(o.draw);
  Workspace workspace;
  std::optional<ManifoldResult> previous;
  for_each_pose(o, list, "manifold", globals, [&](const run::PosedBodies& bodies, std::size_t i) {
    const auto run_query = [&]() -> ManifoldResult& {
      return contact_manifolds(bodies.a, bodies.pose_a, bodies.b, bodies.pose_b, o.request, workspace,
                               previous ? &*previous : nullptr)
          .value();
    };
    ManifoldResult result = list.at(i, run_query);
    print(line_of(i, result, o, o.repeat > 0 ? median_us(o.repeat, run_query) : 0));
    if (!o.draw.picture.empty())
      run::write_picture(run::picture_of(result, o.request.margin, bodies, look),
                         picture_name(o.draw.picture, i, list.poses.size()));
    previous = std::move(result);
  });
  return kOk;
}

}  // namespace

Command add_manifold(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "manifold",
      "Find the contact manifolds for a solver: a normal and at most 4 points with depths for each contact "
      "region, with ids that persist from pose to pose; one JSON line per pose of B");
  const auto o = std::make_shared<ManifoldOptions>();
  add_posed_files(*app, *o);
  app->add_option("--margin", o->request.margin, "D",
                  "Maximum distance of speculative contacts, in mesh units [0: only pairs that intersect]");
  app->add_flag("--pairs", o->pairs, "List the pairs of triangles of each manifold");
  app->add_option("--max-pairs", o->request.max_pairs, "N",
                  "Reject poses with more pairs than N [" + std::to_string(kMaxPairsWithContacts) + "]")
      ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 40);
  add_picture_options(*app, o->draw, "Draw the bodies with the points and normals of the manifolds");
  add_repeat_option(*app, o->repeat, "pose");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_manifold(*o, globals); }};
}

}  // namespace lrb::cli
