#include <limits>
#include <memory>
#include <utility>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/pose_lines.hpp"
#include "tools/terminal.hpp"
#include "trace/trace_json_parts.hpp"
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::cli {
namespace {

struct DistanceOptions : PosedFiles {
  DistanceRequest request;
  std::uint32_t repeat = 0;
  bool features = false;
  DrawOptions draw;
};

void write_feature(trace::JsonWriter& w, const char* name, const Witness& witness) {
  w.key(name).begin_object().member("face", witness.face.value()).member("simplex", witness.simplex.value());
  write_feature_of(w, witness);
  w.end_object();
}

std::string line_of(std::size_t pose, const DistanceResult& result, const std::vector<Bounds>& history,
                    const DistanceOptions& o, double us) {
  return trace::json_text(trace::JsonWriter::kCompact, [&](trace::JsonWriter& w) {
    w.begin_object().member("pose", std::uint64_t{pose});
    w.member("lower", result.lower).member("upper", result.upper);
    write_vector(w, "point_a", result.witness[0].point);
    write_vector(w, "point_b", result.witness[1].point);
    if (result.solids_meet() && result.upper > 0) w.member("solids", 0.0);
    if (o.request.within) {
      w.key("within");
      result.within ? w.value(*result.within) : w.value(std::numeric_limits<double>::quiet_NaN());  // null
    }
    if (o.request.max_steps > 0) w.member("finished", result.finished);
    if (o.features) {
      write_feature(w, "on_a", result.witness[0]);
      write_feature(w, "on_b", result.witness[1]);
    }
    if (o.draw.history) trace::write_history(w, history);
    if (o.repeat > 0) w.member("us", us);
    w.end_object();
  });
}

int run_distance(const DistanceOptions& o, const Globals& globals) {
  const PoseLines list(o.poses);
  check_request(o.request);
  const render::Look look = look_of(o.draw);
  Workspace workspace;
  for_each_pose(o, list, "distance", globals, [&](const run::PosedBodies& bodies, std::size_t i) {
    const auto run_query = [&](BoundsProbe* probe) {
      return distance(bodies.a, bodies.pose_a, bodies.b, bodies.pose_b, o.request, workspace, probe).value();
    };
    BoundsHistory reported;
    const DistanceResult result = run_query(o.draw.is_watched() ? &reported : nullptr);
    print(line_of(i, result, reported.history, o,
                  o.repeat > 0 ? median_us(o.repeat, [&] { run_query(nullptr); }) : 0));
    if (!o.draw.picture.empty())
      run::write_picture(run::picture_of(result, bodies, look),
                         picture_name(o.draw.picture, i, list.poses.size()));
    if (!o.draw.chart.empty())
      report::draw(
          bounds_chart(reported.history, "distance", "pairs of boxes expanded, pairs of faces measured"),
          picture_name(o.draw.chart, i, list.poses.size()));
  });
  return kOk;
}

}  // namespace

Command add_distance(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "distance",
      "Compute the distance between two bodies, as a proven interval, for each pose of B; one JSON line "
      "per pose");
  const auto o = std::make_shared<DistanceOptions>();
  add_posed_files(*app, *o);
  app->add_option("--within", o->request.within, "D", "Only test whether the distance is at most D");
  app->add_option("--tolerance", o->request.tolerance, "E",
                  "Stop once the interval is at most this wide, in mesh units");
  app->add_option("--relative-tolerance", o->request.relative_tolerance, "E",
                  "Stop once the interval is at most this wide, relative to the distance");
  app->add_option("--budget", o->request.max_steps, "N", "Stop after expanding N pairs of boxes")
      ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 62);
  app->add_flag("--features", o->features, "Add the closest features (vertex, edge or face) of the bodies");
  add_draw_options(*app, o->draw, "Draw the bodies with the segment between their closest points");
  add_repeat_option(*app, o->repeat, "pose");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_distance(*o, globals); }};
}

}  // namespace lrb::cli
