#include "bench/stability/case_meshes.hpp"

#include <nlohmann/json.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/workers/worker_json.hpp"
#include "bench/workers/workers.hpp"
#include "scenarios/io/poses.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::stability {
namespace {

using Json = nlohmann::ordered_json;

Json mesh_json(const Mesh& mesh) {
  Json points = Json::array(), faces = Json::array();
  for (const Eigen::Vector3d& x : mesh.vertices) {
    if (!x.allFinite()) throw InputError("a vertex of the case is not finite");
    points.push_back({x.x(), x.y(), x.z()});
  }
  for (FaceId f = 0; f < mesh.face_count(); ++f) {
    Json corners = Json::array();
    for (const VertexId v : mesh.face(f)) corners.push_back(v.value());
    faces.push_back(std::move(corners));
  }
  return {{"dim", mesh.dim}, {"vertices", std::move(points)}, {"faces", std::move(faces)}};
}

Mesh mesh_from(const nlohmann::json& value) {
  Mesh mesh;
  mesh.dim = value.at("dim");
  for (const auto& x : value.at("vertices")) mesh.vertices.emplace_back(x.at(0), x.at(1), x.at(2));
  std::vector<VertexId> corners;
  for (const auto& face : value.at("faces")) {
    corners.clear();
    for (const auto& v : face) corners.emplace_back(v.get<std::uint32_t>());
    mesh.add_face(corners);
  }
  return mesh;
}

Json finite_pose(const Pose& pose) {
  if (!pose.r.allFinite() || !pose.t.allFinite()) throw InputError("a pose of the case is not finite");
  return workers::pose_json(pose);
}

Pose pose_from(const nlohmann::json& value) {
  return io::pose_of(value.get<std::array<double, 12>>());
}

std::string to_text(const CaseMeshes& c, const RightAnswer& right) {
  const Json out = {{"a", mesh_json(c.a)},
                    {"b", mesh_json(c.b)},
                    {"pose_a", finite_pose(c.pose_a)},
                    {"pose_b", finite_pose(c.pose_b)},
                    {"right", to_json(right)}};
  return out.dump();
}

}  // namespace

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

Replay CaseWorker::ask(const CaseMeshes& meshes) {
  const RightAnswer right = expected_answer(case_of(meshes));
  const std::string text = to_text(meshes, right);
  Replay out;
  out.expected = right.pairs;
  if (!worker_) worker_.emplace(std::vector<std::string>{method_.program, "--method", method_.info.name});
  const workers::MemoryFile file("case");
  file.write(text);
  worker_->ask(nlohmann::json{{"saved", file.path()}}.dump());
  workers::WorkerFailure failure;
  if (const auto line = worker_->answer(timeout_, failure)) {
    if (const std::string error = workers::error_in(*line); !error.empty())
      throw EnvironmentError(method_.program + ": " + error);
    out.take(*line);
    return out;
  }
  worker_.reset();
  out.record.method = method_.info.name;
  out.record.expected = right.pairs.size();
  workers::note_failure(out.record, failure);
  return out;
}

nlohmann::ordered_json answer_saved(const methods::MethodEntry& entry, const std::string& path) {
  static const cases::Family kNoFamily = {"", "", nullptr};
  const auto value = nlohmann::json::parse(read_file(path));
  const cases::Case c = case_of({mesh_from(value.at("a")), mesh_from(value.at("b")),
                                 pose_from(value.at("pose_a")), pose_from(value.at("pose_b"))});
  // A new runner for each case, so that an answer does not depend on the cases before it.
  StabilityRunner runner(entry);
  Record record;
  record.method = entry.info.name;
  runner.ask(kNoFamily, c, expected_from(value.at("right").dump()), record);
  Json reply = to_json(record);
  if (runner.pairs()) reply["answered_pairs"] = workers::PairsJson::write(*runner.pairs());
  return reply;
}

}  // namespace lrb::stability
