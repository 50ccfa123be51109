#include "bench/stability/saved_case.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/stability/minimise.hpp"
#include "bench/stability/rational_oracles.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>

namespace lrb::stability {
namespace {

using Json = nlohmann::ordered_json;

/// Returns the corners of a simplex in the world, as every exact method defines them: rounded to doubles.
oracle::Corners world_corners(const LrbRep& rep, const Pose& pose, SimplexId s) {
  VertexId v[3] = {};
  rep.simplex(s, v);
  oracle::Corners out;
  for (int k = 0; k < rep.dim(); ++k) {
    const Eigen::Vector3d x = pose.apply(rep.vertices()[v[k]]);
    out.push_back({x.x(), x.y(), x.z()});
  }
  return out;
}

Json point_json(const std::array<oracle::Rational, 3>& x) {
  return {x[0].str(), x[1].str(), x[2].str()};
}

Json corners_json(const oracle::Corners& corners) {
  Json out = Json::array();
  for (const auto& x : corners) out.push_back(point_json(oracle::rational(x)));
  return out;
}

/// Returns the pairs as [[a, b], ...].
Json pairs_json(const std::vector<SimplexPair>& pairs) {
  Json out = Json::array();
  for (const SimplexPair& p : pairs) out.push_back({p.a.value(), p.b.value()});
  return out;
}

Json engine_json(const Replay& r) {
  Json out = {{"method", r.record.method}, {"outcome", name_of(r.record.outcome)}};
  if (!r.record.message.empty()) out["message"] = r.record.message;
  if (!r.record.relation.empty()) {
    out["relation"] = r.record.relation;
    out["expected_relation"] = r.record.expected_relation;
  }
  out["missed"] = r.record.missed;
  out["extra"] = r.record.extra;
  if (r.answered) out["pairs"] = pairs_json(*r.answered);
  return out;
}

}  // namespace

Json pair_proof(const cases::Case& c, const SimplexPair& pair) {
  const oracle::Corners a = world_corners(*c.a, c.pose_a, pair.a), b = world_corners(*c.b, c.pose_b, pair.b);
  const oracle::RationalClosest closest = oracle::closest_points(a, b);
  Json out = {{"pair", {pair.a.value(), pair.b.value()}}, {"a", corners_json(a)}, {"b", corners_json(b)}};
  out["intersect"] = closest.distance_sq == 0;
  if (closest.distance_sq == 0) {
    out["common_point"] = point_json(closest.on_f);
    return out;
  }
  // The planes through the closest points, across the segment between them, separate convex sets.
  const std::array<oracle::Rational, 3> way = oracle::minus(closest.on_g, closest.on_f);
  out["closest_points"] = {point_json(closest.on_f), point_json(closest.on_g)};
  out["direction"] = point_json(way);
  out["largest_of_a"] = oracle::dot(way, closest.on_f).str();
  out["least_of_b"] = oracle::dot(way, closest.on_g).str();
  // The square may be less than the least double.
  using Wide = boost::multiprecision::cpp_bin_float_100;
  const Wide distance_sq = Wide(boost::multiprecision::numerator(closest.distance_sq)) /
                           Wide(boost::multiprecision::denominator(closest.distance_sq));
  out["distance"] = io::number_text(sqrt(distance_sq).convert_to<double>(), 3);
  return out;
}

std::optional<SimplexPair> deciding_pair(const cases::Case& c, const std::vector<Replay>& replays) {
  for (const Replay& r : replays)
    if (const auto pair = failing_pair(c, r)) return pair;
  for (const Replay& r : replays)
    if (!r.expected.empty()) return r.expected.front();
  return std::nullopt;
}

std::vector<std::string> save_case(const cases::Case& c, const std::vector<Replay>& replays,
                                   const std::string& folder, const Json& minimised) {
  std::vector<std::string> files;
  const auto write = [&](const LrbRep& rep, const std::string& name) {
    write_mesh(methods::real_mesh(rep), folder + "/" + name);
    files.push_back(name);
  };
  const Record& r = replays.front().record;
  const RightAnswer right = expected_answer(c);
  Json j = Json::object();
  if (!r.family.empty())
    j = {{"family", r.family}, {"difficulty", r.difficulty}, {"case", r.case_index}, {"seed", r.seed}};
  if (!minimised.is_null()) j["minimised"] = minimised;
  j["what"] =
      "Do the simplices (triangles; segments in the plane) of A and of B intersect, each pair of them? They are numbered from "
      "0 in file order, polygons as fans. A vertex is at the doubles next to pose * vertex, as in a_world.obj and b_world.obj.";
  j["pose_a"] = workers::pose_json(c.pose_a);
  j["pose_b"] = workers::pose_json(c.pose_b);
  make_folder(folder);
  write(*c.a, "a.obj");
  write(*c.b, "b.obj");
  if (right.rejection.empty()) {
    write(methods::at_pose(*c.a, c.pose_a), "a_world.obj");
    write(methods::at_pose(*c.b, c.pose_b), "b_world.obj");
    j["expected"] = {{"relation", to_string(right.relation)}, {"pairs", pairs_json(right.pairs)}};
    const std::optional<SimplexPair> pair = deciding_pair(c, replays);
    j["proof"] = pair ? pair_proof(c, *pair) : Json(nullptr);
  } else {
    j["expected"] = {{"rejected", right.rejection}};
  }
  j["engines"] = Json::array();
  for (const Replay& replay : replays) j["engines"].push_back(engine_json(replay));
  io::write_text(folder + "/case.json", j.dump(1) + "\n");
  files.emplace_back("case.json");
  return files;
}

SavedCase load_case(const std::string& folder) {
  const std::string file = folder + "/case.json";
  const auto value = nlohmann::json::parse(io::read_text(file), nullptr, false);
  const auto fail = [&](const std::string& found) -> InputError {
    return InputError(printable_name(file) + ": expected a case as `stability --save` writes it, found " +
                      found);
  };
  if (!value.is_object()) throw fail("no JSON object");
  SavedCase out;
  const auto pose = [&](const char* key) {
    try {
      return io::pose_of(value.at(key).get<std::array<double, 12>>());
    } catch (const nlohmann::json::exception&) {
      throw fail(std::string("no 12 numbers under \"") + key + "\"");
    }
  };
  out.meshes.pose_a = pose("pose_a");
  out.meshes.pose_b = pose("pose_b");
  out.meshes.a = read_mesh(folder + "/a.obj");
  out.meshes.b = read_mesh(folder + "/b.obj");
  if (out.meshes.a.dim != out.meshes.b.dim) throw fail("a 2D and a 3D mesh");
  try {
    if (!value.contains("family")) return out;
    out.origin.family = value.at("family");
    out.origin.difficulty = value.at("difficulty");
    out.origin.case_index = value.at("case");
    out.origin.seed = value.at("seed");
  } catch (const nlohmann::json::exception&) {
    throw fail("a family without difficulty, case and seed");
  }
  return out;
}

}  // namespace lrb::stability
