#include "bench/stability/case_meshes.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <istream>
#include <optional>

#include <nlohmann/json.hpp>
#include <poll.h>

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
                    {"right", nlohmann::json::parse(to_line(right))}};
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

/// A worker process and the pipe of its requests.
class CaseWorker::Running {
 public:
  explicit Running(const workers::WorkerMethod& method)
      : program_(method.program),
        child_({method.program, "--method", method.info.name, "--saved"}, pipe_.reading_end()) {}

  /// Returns the worker's line about a case, or a failure, after which the worker has to be replaced.
  std::optional<std::string> line_for(const std::string& text, double timeout,
                                      workers::WorkerFailure& failure) {
    using Clock = std::chrono::steady_clock;
    const workers::MemoryFile file("lrbscope-case");
    file.write(text);
    pipe_.write(file.path() + "\n");
    const auto limit = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(timeout));
    const Clock::time_point deadline = Clock::now() + limit;
    std::vector<std::string> lines;
    while (lines.empty()) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
      if (left.count() <= 0) {
        failure = {true, workers::text_of_timeout(timeout)};
        return std::nullopt;
      }
      pollfd waiting{child_.output(), POLLIN, 0};
      if (poll(&waiting, 1, static_cast<int>(left.count())) <= 0) continue;
      if (child_.read(lines) || !lines.empty()) continue;
      const int status = child_.wait();
      if (status == workers::kNoSuchProgram)
        throw EnvironmentError(program_ + ": cannot be started; rebuild it");
      failure = {false, workers::text_of_end(status)};
      return std::nullopt;
    }
    return lines.front();
  }

 private:
  std::string program_;
  workers::Pipe pipe_;
  workers::Child child_;
};

CaseWorker::CaseWorker(const workers::WorkerMethod& method, double timeout)
    : method_(method), timeout_(timeout) {}
CaseWorker::~CaseWorker() = default;

Replay CaseWorker::ask(const CaseMeshes& meshes) {
  const RightAnswer right = expected_answer(case_of(meshes));
  const std::string text = to_text(meshes, right);
  Replay out;
  out.expected = right.pairs;
  if (!running_) running_ = std::make_unique<Running>(method_);
  workers::WorkerFailure failure;
  if (const auto line = running_->line_for(text, timeout_, failure)) {
    const auto value = nlohmann::json::parse(*line, nullptr, false);
    if (value.is_object() && value.contains("error"))
      throw EnvironmentError(method_.program + ": " + value.at("error").get<std::string>());
    out.record = record_from(value);
    if (value.contains("answered_pairs")) out.answered = workers::PairsJson::read(value.at("answered_pairs"));
    return out;
  }
  running_.reset();
  out.record.method = method_.info.name;
  out.record.expected = right.pairs.size();
  out.record.outcome = failure.timed_out ? Outcome::timed_out : Outcome::crashed;
  out.record.message = failure.message;
  return out;
}

void serve_cases(const methods::MethodEntry& entry, std::istream& requests,
                 const std::function<void(const std::string& line)>& say) {
  static const cases::Family kNoFamily = {"", "", nullptr};
  for (std::string path; std::getline(requests, path);) {
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
    say(reply.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  }
}

}  // namespace lrb::stability
