#include "bench/stability/case_meshes.hpp"

#include <nlohmann/json.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/stability/rational_oracles.hpp"
#include "bench/workers/worker_json.hpp"
#include "bench/workers/workers.hpp"
#include "render/pictures/marks.hpp"
#include "scenarios/io/poses.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::stability {

CaseMeshes meshes_of(const cases::Case& c) {
  return {methods::real_mesh(*c.a), methods::real_mesh(*c.b), c.pose_a, c.pose_b};
}

cases::Case case_of(const CaseMeshes& meshes) {
  cases::Case c;
  c.a = cases::body(meshes.a);
  c.b = cases::body(meshes.b);
  c.pose_a = meshes.pose_a;
  c.pose_b = meshes.pose_b;
  return c;
}

PosedPair::PosedPair(const cases::Case& c, const SimplexPair& pair)
    : x{pictures::corners_of(*c.a, c.pose_a, pair.a), pictures::corners_of(*c.b, c.pose_b, pair.b)} {}

exact::PairContact PosedPair::contact() const {
  const double* p[2][3] = {};
  for (std::size_t side = 0; side < 2; ++side)
    for (std::size_t k = 0; k < x[side].size(); ++k) p[side][k] = x[side][k].data();
  return x[0].size() == 3 ? exact::contact_of_triangles(p[0], p[1]) : exact::contact_of_segments(p[0], p[1]);
}

oracle::RationalClosest PosedPair::closest() const {
  return oracle::closest_points(oracle::rational(x[0]), oracle::rational(x[1]));
}

Corners PosedPair::place() const {
  const exact::PairContact found = contact();
  Corners out;
  for (std::size_t k = 0; k < found.corner_count; ++k) out.push_back(found.corners[k].x);
  if (!out.empty()) return out;
  const oracle::RationalClosest points = closest();
  for (const oracle::RationalPoint& p : {points.on_f, points.on_g})
    out.emplace_back(p[0].convert_to<double>(), p[1].convert_to<double>(), p[2].convert_to<double>());
  return out;
}

// Cases in files, for workers: each mesh as its corners' coordinates, and the numbers of its faces' corners.

namespace {

using Json = nlohmann::ordered_json;

Json finite(const std::vector<double>& numbers) {
  for (const double x : numbers)
    if (!std::isfinite(x)) throw InputError("a vertex or a pose of the case is not finite");
  return numbers;
}

Json pose_json(const Pose& pose) {
  const auto rows = io::rows_of(pose);
  return finite({rows.begin(), rows.end()});
}

Json mesh_json(const Mesh& mesh) {
  std::vector<double> points;
  for (const Eigen::Vector3d& x : mesh.vertices) points.insert(points.end(), x.begin(), x.end());
  Json faces = Json::array();
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    faces.push_back(Json::array());
    for (const VertexId v : mesh.face(f)) faces.back().push_back(v.value());
  }
  return {{"dim", mesh.dim}, {"points", finite(points)}, {"faces", std::move(faces)}};
}

Mesh mesh_from(const nlohmann::json& value) {
  Mesh mesh;
  mesh.dim = value.at("dim");
  const std::vector<double> x = value.at("points");
  for (std::size_t i = 0; i < x.size(); i += 3) mesh.vertices.emplace_back(x[i], x[i + 1], x[i + 2]);
  for (const std::vector<std::uint32_t> face : value.at("faces"))
    mesh.add_face(std::vector<VertexId>(face.begin(), face.end()));
  return mesh;
}

}  // namespace

std::string text_of(const CaseMeshes& c) {
  return Json{{"a", mesh_json(c.a)},
              {"b", mesh_json(c.b)},
              {"pose_a", pose_json(c.pose_a)},
              {"pose_b", pose_json(c.pose_b)}}
      .dump();
}

Replay CaseWorker::ask(const CaseMeshes& meshes) {
  const RightAnswer right = expected_answer(case_of(meshes));
  const workers::MemoryFile file("case");
  file.write(text_of(meshes));
  return {{}, info_, workers::answer_of(worker_, {{"saved", file.path()}}, timeout_), right};
}

cases::Case read_case(const std::string& path) {
  const auto value = nlohmann::json::parse(read_file(path));
  const auto pose = [&](const char* key) { return io::pose_of(value.at(key).get<std::array<double, 12>>()); };
  return case_of({mesh_from(value.at("a")), mesh_from(value.at("b")), pose("pose_a"), pose("pose_b")});
}

}  // namespace lrb::stability
