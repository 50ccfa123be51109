#pragma once
/// The poses at which an engine does worst: those of the highest cost, found by search; and wrong answers, at
/// poses that are hard in floating point: at first contact, with coplanar faces, with parallel edges in
/// contact, with a vertex on a vertex; and a few units in the last place beside each.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/tails/engine.hpp"
#include "bench/tails/pose_space.hpp"
#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/enum_names.hpp>

namespace lrb::tails {

// Cost.

/// The cost that a search raises.
enum class Goal : std::uint8_t {
  tests_per_answer,  ///< tests / (1 + pairs)
  tests,
  wasted,  ///< EngineAnswer::wasted
  time,    ///< microseconds, the least of kRounds
  wrong,   ///< wrong pairs, which are not searched but tried: find_wrong()
};
constexpr auto enum_names(Goal) {
  return std::to_array<EnumName<Goal>>({{Goal::tests_per_answer, "tests-per-answer"},
                                        {Goal::tests, "tests"},
                                        {Goal::wasted, "wasted"},
                                        {Goal::time, "time"},
                                        {Goal::wrong, "wrong"}});
}

/// The answer of an engine at a placement of the search.
struct QueriedTrial {
  Trial trial;
  EngineAnswer answer;
};

struct Worst {
  std::string engine;
  Goal goal = Goal::tests_per_answer;
  SearchOptions options;
  std::vector<QueriedTrial> poses;    ///< distinct, the worst first
  Search found;                       ///< all trials
  std::optional<Search> at_random;    ///< the same budget at random
  std::vector<std::string> failures;  ///< "query 17: killed by signal 11"
};

/// Searches for the poses of the highest cost; `compare`: also spends the same budget at random. A pose
/// without an answer has no cost, and is listed among the failures. Throws InputError if the goal counts
/// tests and the engine does not.
Worst find_worst(Engine& engine, const PoseSpace& space, Goal goal, const SearchOptions& options,
                 bool compare, const run::ProgressReport& progress);

/// Returns the table for a terminal, and the same as JSON with the poses, an object for each line. Without
/// times, unless these are the goal, so that equal seeds give equal texts.
std::string table_of(const Worst& worst);
std::vector<nlohmann::ordered_json> json_of(const Worst& worst, const PoseSpace& space);

/// Returns the sentence that says how the poses of a scenario were found.
std::string purpose_of(const Worst& worst);

/// Returns a scenario, for regression tests, of B at some poses, with the exact relations, numbers of pairs
/// and fingerprints as expectations. `a` and `b`: the bodies' files, relative to the scenario's folder.
std::string scenario_text(const std::string& purpose, std::span<const Pose> poses, const LrbRep& rep_a,
                          const LrbRep& rep_b, const std::string& a, const std::string& b);

/// Returns the highest cost over the direction from A to B, in maps of equal area (Lambert's cylindrical
/// projection) for some ranges of the distance, as SVG.
std::string cost_map(const std::vector<Trial>& trials, const std::string& unit);

struct WorstPage {
  std::string title, purpose, command, machine;
  std::string scenario;                ///< text of the scenario; empty: none
  std::vector<std::string> recorders;  ///< (|poses|) the commands that record them
};

/// Writes folder/index.html with the poses, the map, the progress of the search and its scenario. Returns
/// notes as text.
std::vector<std::string> write_worst_page(const Worst& worst, const WorstPage& page,
                                          const std::string& folder);

// Wrong answers.

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
