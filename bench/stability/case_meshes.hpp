#pragma once
/// A case as two meshes at two poses, and a method that is queried about such cases one after the other.

#include <array>
#include <chrono>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/cases/families.hpp"
#include "bench/methods/method.hpp"
#include "bench/stability/stability_experiment.hpp"
#include <lrbscope/contact.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/pose.hpp>

namespace lrb::oracle {
struct RationalClosest;
}

namespace lrb::stability {

struct CaseMeshes {
  Mesh a, b;
  Pose pose_a, pose_b;
};

/// Returns the meshes of a case: the real faces of its bodies.
CaseMeshes meshes_of(const cases::Case& c);
/// Returns the case of two meshes. A body is closed if its mesh bounds a solid; it has no regions. Throws
/// InputError if a mesh cannot be queried.
cases::Case case_of(const CaseMeshes& meshes);

inline bool is_identity(const Pose& pose) {
  return pose.r == Eigen::Matrix3d::Identity() && pose.t == Eigen::Vector3d::Zero();
}

/// The corners of a simplex, or of a part of it, in the world.
using Corners = std::vector<Eigen::Vector3d>;

/// A simplex of each body, as every exact method defines them: with corners rounded to doubles.
struct PosedPair {
  std::array<Corners, 2> x;

  PosedPair(const cases::Case& c, const SimplexPair& pair);
  exact::PairContact contact() const;
  oracle::RationalClosest closest() const;
  /// Returns the corners of the intersection, or the closest points.
  Corners place() const;
};

/// A method in a worker.
class CaseWorker {
 public:
  /// `timeout`: seconds per case. The method must be present.
  CaseWorker(const workers::WorkerMethod& method, double timeout)
      : info_(method.info), worker_(method.command), timeout_(timeout) {}

  /// Returns the judged answer to a case. The right answer is computed in this process, by exact brute force.
  /// The record names no family. Throws InputError if a number of the case is not finite, EnvironmentError if
  /// the worker does not start.
  Replay ask(const CaseMeshes& meshes);

 private:
  methods::MethodInfo info_;
  workers::Worker worker_;
  std::chrono::duration<double> timeout_;
};

/// Returns a case as the text of a file for workers. Throws InputError if a number is not finite.
std::string text_of(const CaseMeshes& c);
/// The worker's side: the case of such a file.
cases::Case read_case(const std::string& path);

}  // namespace lrb::stability
