#pragma once
/// Poses at which engines in floating point may answer wrongly: at first contact, with coplanar faces, with
/// parallel edges in contact, with a vertex on a vertex; and a few units in the last place beside each.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/tails/engine.hpp"
#include "bench/tails/pose_space.hpp"
#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/enum_names.hpp>

namespace lrb::tails {

enum class Hard : std::uint8_t {
  first_contact,   ///< the last double before the surfaces meet on a straight motion, and the next
  coplanar_faces,  ///< a face of B in the plane of a face of A, with a common point
  parallel_edges,  ///< an edge of B along an edge of A, with a common midpoint
  vertices,        ///< a vertex of B on one of A; axes of B along axes of A
};
constexpr auto enum_names(Hard) {
  return std::to_array<EnumName<Hard>>({{Hard::first_contact, "first_contact"},
                                        {Hard::coplanar_faces, "coplanar_faces"},
                                        {Hard::parallel_edges, "parallel_edges"},
                                        {Hard::vertices, "vertices"}});
}

struct HardPose {
  Hard kind = Hard::first_contact;
  int ulps = 0;  ///< moved by this many units in the last place of the bodies' size
  Pose pose;
};

/// Returns `count` poses: of each kind in turn, and at each of kUlps. Without a first contact on the drawn
/// path another is drawn.
std::vector<HardPose> hard_poses(const LrbRep& a, const LrbRep& b, const PoseSpace& space, std::size_t count,
                                 std::uint64_t seed, const run::ProgressReport& progress);
/// Up to the rounding of poses in single precision.
inline constexpr std::array<int, 11> kUlps = {0,          1,       -1,         16,      -16,       1 << 12,
                                              -(1 << 12), 1 << 24, -(1 << 24), 1 << 30, -(1 << 30)};

/// Returns the largest gap of two triangles along the axes that can separate them (normals, and products of
/// two edges); negative: the least translation along one of them that separates the triangles. A lower bound
/// of their distance, in doubles.
double signed_gap(const std::array<Eigen::Vector3d, 3>& a, const std::array<Eigen::Vector3d, 3>& b);

/// An answer beside the exact one.
struct Judged {
  HardPose at;
  EngineAnswer answer;
  std::uint64_t exact_pairs = 0, missed = 0, extra = 0;
  /// Largest distance of a wrong pair from the right answer, in units of the space: the gap of triangles that
  /// do not intersect, the depth of those that do.
  double error = 0;

  bool wrong_pairs() const { return missed + extra > 0; }
  bool wrong_contact() const { return answer.failure.empty() && (answer.pairs > 0) != (exact_pairs > 0); }
};

struct WrongSearch {
  std::string engine;
  std::uint64_t seed = 1;
  std::vector<Judged> poses;  ///< in order

  /// Returns the worst, at most `most`: wrong contacts first, then by error.
  std::vector<Judged> worst(std::size_t most = 8) const;
};

/// Asks an engine at hard poses and compares its pairs with the exact ones. Throws InputError if it reports
/// pairs of faces that the bodies do not have.
WrongSearch find_wrong(Engine& engine, const LrbRep& a, const LrbRep& b, const PoseSpace& space,
                       std::size_t budget, std::uint64_t seed, const run::ProgressReport& progress);

/// Returns a table of the kinds of poses, and the worst poses as JSON, an object for each line.
std::string table_of(const WrongSearch& search);
std::vector<nlohmann::ordered_json> json_of(const WrongSearch& search);

/// Writes folder/index.html with both, and the scenario. `recorders`: the commands that record the worst
/// poses. Returns notes as text.
std::vector<std::string> write_wrong_page(const WrongSearch& search, const std::string& title,
                                          const std::string& command, const std::string& scenario,
                                          const std::vector<std::string>& recorders,
                                          const std::string& folder);

}  // namespace lrb::tails
