/// Commands that answer a question for each pose of B: distance, near, manifold, clash.
#include <cmath>
#include <iomanip>
#include <optional>
#include <sstream>
#include <utility>

#include "scenarios/report/document.hpp"
#include "tools/pose_lines.hpp"
#include "trace/trace_json_parts.hpp"
#include <lrbscope/contact_manifold.hpp>
#include <lrbscope/near_pairs.hpp>

namespace lrb::tools {
namespace {

using pictures::PosedBodies;
using trace::JsonWriter;

constexpr const char* kWorkOfDistance = "pairs of boxes expanded, pairs of faces measured";

struct DistanceQuestion : PosedQuestion {
  static constexpr const char* kName = "distance";
  static constexpr const char* kHelp =
      "Compute the distance between two bodies, as a proven interval, for each pose of B; one JSON line per pose";
  DistanceRequest request;
  bool features = false;
  BoundsHistory reported;

  void add_options(App& app) {
    app.add_option("--within", request.within, "D", "Only test whether the distance is at most D");
    app.add_option("--tolerance", request.tolerance, "E",
                   "Stop once the interval is at most this wide, in mesh units");
    app.add_option("--relative-tolerance", request.relative_tolerance, "E",
                   "Stop once the interval is at most this wide, relative to the distance");
    app.add_option("--budget", request.max_steps, "N", "Stop after expanding N pairs of boxes")
        ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 62);
    app.add_flag("--features", features, "Add the closest features (vertex, edge or face) of the bodies");
    add_draw_options(app, draw, "Draw the bodies with the segment between their closest points");
  }
  void check() const { check_request(request); }

  DistanceResult ask(const PosedBodies& p, Workspace& workspace, bool watched) {
    if (watched) reported = {};  // kept for the chart while the query is timed
    return distance(p.a, p.pose_a, p.b, p.pose_b, request, workspace, watched ? &reported : nullptr).value();
  }

  static void write_feature(JsonWriter& w, const char* name, const Witness& witness) {
    w.key(name).begin_object().member("face", witness.face).member("simplex", witness.simplex);
    write_feature_of(w, witness);
    w.end_object();
  }
  void write(JsonWriter& w, const DistanceResult& result, const PosedBodies&, const auto& us) const {
    w.member("lower", result.lower).member("upper", result.upper);
    w.member("point_a", result.witness[0].point).member("point_b", result.witness[1].point);
    if (result.solids_meet() && result.upper > 0) w.member("solids", 0.0);
    if (request.within) {
      w.key("within");
      result.within ? w.value(*result.within) : w.null();
    }
    if (request.max_steps > 0) w.member("finished", result.finished);
    if (features) {
      write_feature(w, "on_a", result.witness[0]);
      write_feature(w, "on_b", result.witness[1]);
    }
    if (draw.history) trace::write_history(w, reported.history);
    us(w);
  }

  std::optional<report::Gnuplot> chart() const {
    return bounds_chart(reported.history, "distance", kWorkOfDistance);
  }
};

/// Adds --max-pairs.
void add_max_pairs(App& app, std::uint64_t& max_pairs, std::uint64_t usual) {
  app.add_option("--max-pairs", max_pairs, "N",
                 "Reject poses with more pairs than N [" + std::to_string(usual) + "]")
      ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 40);
}

struct NearQuestion : PosedQuestion {
  static constexpr const char* kName = "near";
  static constexpr const char* kHelp =
      "Find all pairs of triangles within a distance, exactly, with their distances and closest points, for each pose of B; one JSON line per pose";
  NearPairsRequest request;

  void add_options(App& app) {
    app.add_option("--within", request.within, "D",
                   "Maximum distance, in mesh units; 0: pairs that intersect")
        ->required();
    app.add_option("--nearest", request.nearest, "K",
                   "List only the K nearest pairs, in ascending order of the lower bounds of their distances")
        ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 40);
    add_max_pairs(app, request.max_pairs, kMaxPairs);
    add_picture_options(app, draw, "Draw the bodies with the faces and closest points of the pairs");
  }
  void check() const { check_request(request); }

  NearPairsResult& ask(const PosedBodies& p, Workspace& workspace, bool /*watched*/) const {
    return near_pairs(p.a, p.pose_a, p.b, p.pose_b, request, workspace).value();
  }

  static void write(JsonWriter& w, const NearPairsResult& result, const PosedBodies& p, const auto& us) {
    for (const auto& n : NearPairsNumbers::kShown) w.member(n.name, result.*n.member);
    us(w);
    w.key("pairs").begin_array();
    for (const NearPair& pair : result.pairs) {
      w.begin_object().member("triangles", std::array{pair.a, pair.b});
      w.member("faces", std::array{p.a.face_of_simplex(pair.a), p.b.face_of_simplex(pair.b)});
      w.member("meet", name_of(pair.meet)).member("lower", pair.lower).member("upper", pair.upper);
      w.member("point_a", pair.point[0]).member("point_b", pair.point[1]).end_object();
    }
    w.end_array();
  }

  auto picture(const NearPairsResult& result, const PosedBodies& p, const pictures::Look& look) const {
    return pictures::picture_of(result, request.within, p, look);
  }
};

struct ManifoldQuestion : PosedQuestion {
  static constexpr const char* kName = "manifold";
  static constexpr const char* kHelp =
      "Find the contact manifolds for a solver: a normal and at most 4 points with depths for each contact region, with ids that persist from pose to pose; one JSON line per pose of B";
  ManifoldRequest request;
  bool pairs = false;
  std::optional<ManifoldResult> previous;  ///< of the last pose

  void add_options(App& app) {
    app.add_option("--margin", request.margin, "D",
                   "Maximum distance of speculative contacts, in mesh units [0: only pairs that intersect]");
    app.add_flag("--pairs", pairs, "List the pairs of triangles of each manifold");
    add_max_pairs(app, request.max_pairs, kMaxPairsWithContacts);
    add_picture_options(app, draw, "Draw the bodies with the points and normals of the manifolds");
  }
  void check() const { check_request(request); }

  ManifoldResult& ask(const PosedBodies& p, Workspace& workspace, bool /*watched*/) const {
    return contact_manifolds(p.a, p.pose_a, p.b, p.pose_b, request, workspace,
                             previous ? &*previous : nullptr)
        .value();
  }
  void keep(ManifoldResult& result) { previous = std::move(result); }

  /// Writes a feature by its kind: "vertex":3, "edge":[1,2] or "triangle":5.
  static void write_feature(JsonWriter& w, const char* name, const SurfaceFeatureId& f) {
    w.key(name).begin_object();
    if (f.kind == FeatureKind::edge)
      w.member("edge", std::array{f.first, f.second});
    else
      w.member(f.kind == FeatureKind::vertex ? "vertex" : "triangle", f.first);
    w.end_object();
  }
  void write(JsonWriter& w, const ManifoldResult& result, const PosedBodies&, const auto& us) const {
    w.member("pairs", std::uint64_t{result.pairs.size()});
    us(w);
    w.key("manifolds").begin_array();
    for (const ContactManifold& manifold : result.manifolds) {
      w.begin_object().member("region", manifold.region).member("intersects", manifold.intersects);
      w.member("normal", manifold.normal).key("points").begin_array();
      for (const ManifoldPoint& point : manifold.points) {
        w.begin_object().member("id", point.id).member("depth", point.depth);
        w.member("point_a", point.point[0]).member("point_b", point.point[1]);
        write_feature(w, "on_a", point.on[0]);
        write_feature(w, "on_b", point.on[1]);
        w.end_object();
      }
      w.end_array();
      if (pairs) {
        w.key("list").begin_array();
        for (const std::uint32_t i : manifold.pairs)
          w.value(std::array{result.pairs[i].a, result.pairs[i].b});
        w.end_array();
      }
      w.end_object();
    }
    w.end_array();
  }

  auto picture(const ManifoldResult& result, const PosedBodies& p, const pictures::Look& look) const {
    return pictures::picture_of(result, request.margin, p, look);
  }
};

/// Returns an interval as the digits common to both bounds, or as both bounds.
std::string interval_text(const std::optional<ProvedInterval>& interval) {
  if (!interval) return "-";
  std::ostringstream out;
  out << std::setprecision(9);
  if (interval->upper - interval->lower <= 1e-9 * interval->upper)
    out << interval->upper;
  else
    out << std::setprecision(6) << interval->lower << " .. " << interval->upper;
  return out.str();
}

struct ClashQuestion : PosedQuestion {
  static constexpr const char* kName = "clash";
  static constexpr const char* kHelp =
      "Classify the contact between two solids and compute its penetration depth, for each pose of B";
  ClashRequest request;
  std::vector<double> along;
  bool table = false;
  ClashHistory reported;
  std::vector<std::vector<std::string>> rows;  ///< of the table

  void add_options(App& app) {
    app.add_option("--clearance", request.clearance, "D",
                   "Distance up to which disjoint bodies are reported as \"within_clearance\"");
    app.add_option(
           "--along", along, "X,Y,Z",
           "Also compute the directional penetration depth: how far B must move this way to separate from A")
        ->delimiter(',')
        ->expected(3);
    app.add_option("--budget", request.max_steps, "N",
                   "Stop narrowing depths after N queries and points located in the bodies")
        ->in_hidden_range(std::uint64_t{1}, std::uint64_t{1} << 62);
    app.add_flag("--table", table, "Print a human-readable table instead of JSON");
    add_draw_options(app, draw, "Draw the solids with the separation vector");
  }
  void check(const LrbRep& rep_a) {
    if (!along.empty()) request.along = Eigen::Vector3d(along[0], along[1], along[2]);
    check_request(rep_a, request);
    rows = {{"pose", "kind", "shares faces", "distance", "depth", "translation"}};
    if (request.along) rows[0].emplace_back("along");
    rows[0].emplace_back("volume");
  }

  ClashResult ask(const PosedBodies& p, Workspace& workspace, bool watched) {
    if (watched) reported = {};  // kept for the chart while the query is timed
    return clash(p.a, p.pose_a, p.b, p.pose_b, request, workspace, watched ? &reported : nullptr).value();
  }

  /// The history of the depth, or of the distance if the bodies are separate.
  const std::vector<Bounds>& history() const {
    return reported.of_depth.empty() ? reported.of_distance : reported.of_depth;
  }

  static void write_interval(JsonWriter& w, const char* name, const std::optional<ProvedInterval>& interval) {
    if (interval) w.member(name, std::array{interval->lower, interval->upper});
  }
  static void write_pieces(JsonWriter& w, const char* name, const SurfacePieces& pieces) {
    w.key(name).begin_object().member("inside", pieces.inside).member("outside", pieces.outside).end_object();
  }
  void write(JsonWriter& w, const ClashResult& r, const PosedBodies&, const auto& us) const {
    w.member("kind", to_string(r.kind));
    if (r.reason != ClashReason::none) w.member("reason", name_of(r.reason));
    if (r.shares_faces) w.member("shares_faces", true);
    write_interval(w, "distance", r.distance);
    write_interval(w, "depth", r.depth);
    if (r.depth && std::isfinite(r.depth->upper)) w.member("translation", r.translation);
    write_interval(w, "along", r.along);
    write_interval(w, "volume", r.volume);
    if (request.max_steps > 0) w.member("finished", r.finished);
    if (r.kind != ClashKind::apart && r.kind != ClashKind::within_clearance &&
        r.kind != ClashKind::undecided) {
      write_pieces(w, "pieces_a", r.pieces[0]);
      write_pieces(w, "pieces_b", r.pieces[1]);
    }
    if (draw.history) trace::write_history(w, history());
    us(w);
  }

  bool show(std::size_t pose, const ClashResult& r) {
    if (!table) return false;
    const std::string reason(name_of(r.reason));
    std::ostringstream move;
    move << std::setprecision(6) << r.translation.x() << " " << r.translation.y() << " " << r.translation.z();
    rows.push_back({std::to_string(pose), to_string(r.kind) + (reason.empty() ? "" : ": " + reason),
                    r.shares_faces ? "yes" : "no", interval_text(r.distance), interval_text(r.depth),
                    r.depth && std::isfinite(r.depth->upper) ? move.str() : "-"});
    if (request.along) rows.back().push_back(interval_text(r.along));
    rows.back().push_back(interval_text(r.volume));
    return true;
  }
  void end() const {
    if (table) print(report::in_columns(rows, rows[0].size()));
  }

  std::optional<report::Gnuplot> chart() const {
    if (history().empty()) return std::nullopt;
    return reported.of_depth.empty()
               ? bounds_chart(history(), "distance", kWorkOfDistance)
               : bounds_chart(history(), "depth", "queries, expansion steps of the EPA polytope");
  }
};

}  // namespace

Command add_distance(App& root, const Globals& globals) {
  return add_question<DistanceQuestion>(root, globals);
}
Command add_near(App& root, const Globals& globals) {
  return add_question<NearQuestion>(root, globals);
}
Command add_manifold(App& root, const Globals& globals) {
  return add_question<ManifoldQuestion>(root, globals);
}
Command add_clash(App& root, const Globals& globals) {
  return add_question<ClashQuestion>(root, globals);
}

}  // namespace lrb::tools
