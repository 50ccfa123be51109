#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <memory>
#include <sstream>
#include <utility>

#include "render/pictures/answer_picture.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/report/document.hpp"
#include "tools/commands.hpp"
#include "tools/options.hpp"
#include "tools/pose_lines.hpp"
#include "tools/terminal.hpp"
#include "trace/trace_json_parts.hpp"
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::cli {
namespace {

struct ClashOptions : PosedFiles {
  ClashRequest request;
  std::vector<double> along;
  std::uint32_t repeat = 0;
  bool table = false;
  DrawOptions draw;
};

void write_interval(trace::JsonWriter& w, const char* name, const std::optional<ProvedInterval>& interval) {
  if (!interval) return;
  w.key(name).begin_array().value(interval->lower);
  w.value(std::isfinite(interval->upper) ? interval->upper : std::numeric_limits<double>::quiet_NaN());
  w.end_array();  // NaN is written as null
}

void write_pieces(trace::JsonWriter& w, const char* name, const SurfacePieces& pieces) {
  w.key(name).begin_object().member("inside", pieces.inside).member("outside", pieces.outside).end_object();
}

bool is_separated(const ClashResult& r) {
  return r.kind == ClashKind::apart || r.kind == ClashKind::within_clearance;
}

std::string line_of(std::size_t pose, const ClashResult& result, const std::vector<Bounds>& history,
                    const ClashOptions& o, double us) {
  return trace::json_text(trace::JsonWriter::kCompact, [&](trace::JsonWriter& w) {
    w.begin_object().member("pose", std::uint64_t{pose}).member("kind", to_string(result.kind));
    if (result.reason != ClashReason::none) w.member("reason", name_of(result.reason));
    if (result.shares_faces) w.member("shares_faces", true);
    w.key("distance").begin_array().value(result.distance.lower).value(result.distance.upper).end_array();
    write_interval(w, "depth", result.depth);
    if (result.depth && std::isfinite(result.depth->upper)) {
      w.key("translation").begin_array();
      for (int k = 0; k < 3; ++k) w.value(result.translation[k]);
      w.end_array();
    }
    write_interval(w, "along", result.along);
    write_interval(w, "volume", result.volume);
    if (!is_separated(result) && result.kind != ClashKind::undecided) {
      write_pieces(w, "pieces_a", result.pieces[0]);
      write_pieces(w, "pieces_b", result.pieces[1]);
    }
    if (o.draw.history) trace::write_history(w, history);
    if (o.repeat > 0) w.member("us", us);
    w.end_object();
  });
}

/// Returns an interval as the digits common to both bounds, or as both bounds.
std::string interval_text(const std::optional<ProvedInterval>& interval) {
  if (!interval) return "-";
  std::ostringstream out;
  out << std::setprecision(9);
  if (interval->upper - interval->lower <= 1e-9 * interval->upper) {
    out << interval->upper;
  } else {
    out << std::setprecision(6) << interval->lower << " .. " << interval->upper;
  }
  return out.str();
}

using Row = std::vector<std::string>;

Row row_of(std::size_t pose, const ClashResult& r, const ClashOptions& o) {
  const std::string reason(name_of(r.reason));
  Row row{std::to_string(pose), to_string(r.kind) + (reason.empty() ? "" : ": " + reason),
          r.shares_faces ? "yes" : "no", interval_text(r.distance), interval_text(r.depth)};
  std::ostringstream move;
  move << std::setprecision(6) << r.translation.x() << " " << r.translation.y() << " " << r.translation.z();
  row.push_back(r.depth && std::isfinite(r.depth->upper) ? move.str() : "-");
  if (r.along || o.request.along) row.push_back(interval_text(r.along));
  row.push_back(interval_text(r.volume));
  return row;
}

Row headings(const ClashOptions& o) {
  Row row{"pose", "kind", "shares faces", "distance", "depth", "translation"};
  if (o.request.along) row.push_back("along");
  row.push_back("volume");
  return row;
}

int run_clash(ClashOptions o, const Globals& globals) {
  if (!o.along.empty()) o.request.along = Eigen::Vector3d(o.along[0], o.along[1], o.along[2]);
  const PoseLines list(o.poses);
  const render::Look look = look_of(o.draw);
  const auto loaded = bodies::load_faces_of_two(o.a, o.b, o.corners);
  const bodies::LoadedBody &a = loaded[0], &b = loaded[1];
  check_request(a.rep, o.request);
  note(globals, a.notes);
  note(globals, b.notes);
  list.check(a.rep, b.rep);
  Workspace workspace;
  std::vector<Row> rows{headings(o)};
  Progress progress("clash", list.poses.size(), globals.quiet);
  for (std::size_t i = 0; i < list.poses.size(); ++i) {
    const auto run_query = [&](ClashProbe* probe) {
      return clash(a.rep, Pose{}, b.rep, list.poses[i], o.request, workspace, probe).value();
    };
    ClashHistory reported;
    const ClashResult result = run_query(o.draw.is_watched() ? &reported : nullptr);
    const bool has_depth = !reported.of_depth.empty();
    const std::vector<Bounds>& history = has_depth ? reported.of_depth : reported.of_distance;
    const double us = o.repeat > 0 ? median_us(o.repeat, [&] { run_query(nullptr); }) : 0;
    if (o.table)
      rows.push_back(row_of(i, result, o));
    else
      print(line_of(i, result, history, o, us));
    if (!o.draw.picture.empty())
      run::write_picture(run::picture_of(result, {a.rep, Pose{}, b.rep, list.poses[i]}, look),
                         picture_name(o.draw.picture, i, list.poses.size()));
    if (!o.draw.chart.empty() && !history.empty())
      report::draw(bounds_chart(history, has_depth ? "depth" : "distance",
                                has_depth ? "queries, expansion steps of the EPA polytope"
                                          : "pairs of boxes expanded, pairs of faces measured"),
                   picture_name(o.draw.chart, i, list.poses.size()));
    progress.set(i + 1);
  }
  if (o.table) print(report::in_columns(rows, rows[0].size()));
  return kOk;
}

}  // namespace

Command add_clash(App& root, const Globals& globals) {
  App* app = root.add_subcommand(
      "clash",
      "Classify the contact between two solids and compute its penetration depth, for each pose of B");
  const auto o = std::make_shared<ClashOptions>();
  add_posed_files(*app, *o);
  app->add_option("--clearance", o->request.clearance, "D",
                  "Distance up to which disjoint bodies are reported as \"within_clearance\"");
  app->add_option(
         "--along", o->along, "X,Y,Z",
         "Also compute the directional penetration depth: how far B must move this way to separate from A")
      ->delimiter(',')
      ->expected(3);
  app->add_flag("--table", o->table, "Print a human-readable table instead of JSON");
  add_draw_options(*app, o->draw, "Draw the solids with the separation vector");
  add_repeat_option(*app, o->repeat, "pose");
  add_join_option(*app, o->corners);
  return {app, [o, &globals] { return run_clash(*o, globals); }};
}

}  // namespace lrb::cli
