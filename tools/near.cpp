#include <memory>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/pose_lines.hpp"
#include "tools/terminal.hpp"
#include <lrbscope/near_pairs.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::cli {
namespace {

struct NearOptions : PosedFiles {
  NearPairsRequest request;
  std::uint32_t repeat = 0;
  DrawOptions draw;
};

std::string line_of(std::size_t pose, const NearPairsResult& result, const LrbRep& a, const LrbRep& b,
                    const NearOptions& o, double us) {
  return trace::json_text(trace::JsonWriter::kCompact, [&](trace::JsonWriter& w) {
    w.begin_object().member("pose", std::uint64_t{pose}).member("found", result.found);
    if (o.repeat > 0) w.member("us", us);
    w.key("pairs").begin_array();
    for (const NearPair& pair : result.pairs) {
      w.begin_object();
      w.key("triangles").begin_array().value(pair.a.value()).value(pair.b.value()).end_array();
      w.key("faces")
          .begin_array()
          .value(a.face_of_simplex(pair.a).value())
          .value(b.face_of_simplex(pair.b).value());
      w.end_array();
      w.member("meet", name_of(pair.meet)).member("lower", pair.lower).member("upper", pair.upper);
      write_vector(w, "point_a", pair.point[0]);
      write_vector(w, "point_b", pair.point[1]);
      w.end_object();
    }
    w.end_array().end_object();
  });
}

int run_near(const NearOptions& o, const Globals& globals) {
  const PoseLines list(o.poses);
  check_request(o.request);
  const render::Look look = look_of(o.draw);
  Workspace workspace;
  for_each_pose(o, list, "near", globals, [&](const run::PosedBodies& bodies, std::size_t i) {
    const auto run_query = [&]() -> NearPairsResult& {
      return near_pairs(bodies.a, bodies.pose_a, bodies.b, bodies.pose_b, o.request, workspace).value();
    };
    const NearPairsResult result = list.at(i, run_query);
    print(line_of(i, result, bodies.a, bodies.b, o, o.repeat > 0 ? median_us(o.repeat, run_query) : 0));
    if (!o.draw.picture.empty())
      run::write_picture(run::picture_of(result, o.request.within, bodies, look),
                         picture_name(o.draw.picture, i, list.poses.size()));
  });
  return kOk;
}

}  // namespace

Command add_near(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "near",
      "Find all pairs of triangles within a distance, exactly, with their distances and closest points, for "
      "each pose of B; one JSON line per pose");
  const auto o = std::make_shared<NearOptions>();
  add_posed_files(*app, *o);
  app->add_option("--within", o->request.within, "D",
                  "Maximum distance, in mesh units; 0: pairs that intersect")
      ->required();
  app->add_option("--nearest", o->request.nearest, "K",
                  "List only the K nearest pairs, in ascending order of the lower bounds of their distances")
      ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 40);
  app->add_option("--max-pairs", o->request.max_pairs, "N",
                  "Reject poses with more pairs than N [" + std::to_string(kMaxPairs) + "]")
      ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 40);
  add_picture_options(*app, o->draw, "Draw the bodies with the faces and closest points of the pairs");
  add_repeat_option(*app, o->repeat, "pose");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_near(*o, globals); }};
}

}  // namespace lrb::cli
