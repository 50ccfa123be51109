#pragma once
/// The poses at which an engine does worst, found by search.

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

/// The cost that a search raises.
enum class Goal : std::uint8_t {
  tests_per_answer,  ///< tests / (1 + pairs)
  tests,
  wasted,  ///< EngineAnswer::wasted
  time,    ///< microseconds, the least of kRounds
  wrong,   ///< wrong pairs, which are not searched but tried: wrong_poses.hpp
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

}  // namespace lrb::tails
