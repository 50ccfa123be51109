#include <algorithm>
#include <memory>
#include <span>

#include "tools/pose_lines.hpp"
#include <lrbscope/point_distance.hpp>

namespace lrb::tools {
namespace {

struct PointsOptions {
  bodies::Corners corners = bodies::Corners::joined;
  std::string body, points;
  PointDistanceRequest request;
  unsigned threads = 0;
  DrawOptions draw;
};

std::string line_of(std::size_t point, const PointDistance& d) {
  return trace::json_text(trace::JsonWriter::kCompact, [&](trace::JsonWriter& w) {
    w.begin_object().member("point", std::uint64_t{point});
    w.member("lower", d.signed_lower()).member("upper", d.signed_upper());
    w.key("side");
    d.side ? w.value(name_of(*d.side)) : w.null();
    w.member("closest", d.closest.point).member("face", d.closest.face);
    write_feature_of(w, d.closest);
    w.end_object();
  });
}

int run_points(const PointsOptions& o, const Globals& globals) {
  DrawOptions draw = o.draw;
  look_of(draw);  // throws before the body is loaded
  const std::vector<Eigen::Vector3d> points = io::read_points(o.points);
  const bodies::LoadedBody body = bodies::load_faces(o.body, o.corners);
  note(globals, body.notes);
  resolve_up(draw.look.camera.up, body.rep, globals);
  const pictures::Look look = look_of(draw);
  if (body.rep.tree().empty()) throw InputError(o.body + ": expected a body with faces, found none");
  if (!body.rep.closed() && o.request.side)
    note(globals, {"the body is not closed: it has no inside, and distances have no sign"});
  // Batches bound the memory, show progress and print the first answers early.
  constexpr std::size_t kBatch = 4096;
  pictures::ShownPoints shown(points.size());
  Progress progress("points", points.size(), globals.quiet);
  for (std::size_t i = 0; i < points.size(); i += kBatch) {
    const auto batch = std::span(points).subspan(i, std::min(kBatch, points.size() - i));
    const std::vector<PointDistance> found = point_distances(body.rep, Pose{}, batch, o.request, o.threads);
    std::string lines;
    for (std::size_t k = 0; k < found.size(); ++k) lines += line_of(i + k, found[k]);
    print(lines);
    shown.add(batch, found);
    progress.set(i + batch.size());
  }
  progress.finish();
  if (!o.draw.picture.empty())
    pictures::write_picture(pictures::picture_of(shown, body.rep, look), o.draw.picture);
  return kOk;
}

}  // namespace

Command add_points(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "points",
      "Compute the signed distance of points to a body, as a proven interval, negative inside; one JSON line "
      "per point");
  const auto o = std::make_shared<PointsOptions>();
  app->add_option("BODY", o->body, "Mesh or .lrb file")->required();
  app->add_option("POINTS", o->points, "File with points: lines of 3 numbers, x y z")->required();
  app->add_option("--tolerance", o->request.tolerance, "E",
                  "Stop once the interval is at most this wide, in mesh units");
  app->add_option("--relative-tolerance", o->request.relative_tolerance, "E",
                  "Stop once the interval is at most this wide, relative to the distance");
  app->add_option("--threads", o->threads, "N",
                  "Number of threads [all cores]; the result does not depend on it")
      ->in_range(1, 1024);
  add_picture_options(*app, o->draw,
                      "Draw the body with the points in the colours of their sides, and segments to the "
                      "closest points");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_points(*o, globals); }};
}

}  // namespace lrb::tools
