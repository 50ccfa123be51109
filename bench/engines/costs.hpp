#pragma once
/// The cost of an engine's answers over poses: its percentiles, the poses at which it is highest, and wrong
/// answers at poses that are hard in floating point.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bench/engines/engine.hpp"
#include "bench/engines/poses.hpp"
#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/enum_names.hpp>

namespace lrb::engines {

/// A table for a terminal, and the same as lines of JSON.
struct Rows {
  std::string table;
  std::vector<std::string> lines;
};

// Percentiles.

/// Answers at poses, with the least time of some rounds.
struct Samples {
  std::string engine;
  std::vector<Pose> poses;               ///< of B relative to A
  std::vector<methods::Answer> answers;  ///< (|poses|)
  int rounds = 0;                        ///< least number of queries of a pose
  bool with_events = false;              ///< events were recorded during the timed queries
};

inline constexpr int kRounds = 3;

/// Queries every pose in kRounds separate rounds, so that a slow moment of the machine does not affect all
/// repeats of a pose. Tests are counted in a round of their own, because counting may take time.
Samples measure(Engine& engine, std::span<const Pose> poses, const record::ProgressReport& progress);

/// Returns the queries of a capture that ended, with their times as captured. Equal queries (trees and poses)
/// count as rounds of one. Throws InputError that names the file for a capture without a query that ended.
Samples samples_of(const capture::Capture& capture, const std::string& file);

struct Percentiles {
  std::string what;  ///< "us", "tests", "box_tests", "face_tests", "tests in phase NAME"
  std::size_t count = 0;
  double p50 = 0, p90 = 0, p99 = 0, max = 0;  ///< by nearest rank
};
/// Returns the percentiles of each quantity that the engine reported at every answered pose.
std::vector<Percentiles> percentiles(const Samples& samples);

Rows rows_of(const std::vector<Samples>& engines);
/// Returns notes on failures, and on captures with events; one line each.
std::vector<std::string> notes_of(const std::vector<Samples>& engines);

// The search for the highest cost, and for wrong answers.

enum class Goal : std::uint8_t {
  tests_per_answer,  ///< tests / (1 + pairs)
  tests,
  wasted,  ///< methods::Answer::wasted
  time,    ///< microseconds, the least of kRounds
  wrong,   ///< wrong pairs, which are not searched but tried, at hard poses
};
constexpr auto enum_names(Goal) {
  return std::to_array<EnumName<Goal>>({{Goal::tests_per_answer, "tests-per-answer"},
                                        {Goal::tests, "tests"},
                                        {Goal::wasted, "wasted"},
                                        {Goal::time, "time"},
                                        {Goal::wrong, "wrong"}});
}

/// The worst poses, the worst first, at most eight.
struct Found {
  std::vector<Pose> poses;
  Rows rows;
  std::vector<std::string> failures;  ///< "query 17: killed by signal 11"
};

/// Searches for the poses of the highest cost. A pose without an answer has no cost, and is listed among the
/// failures. Texts have no times, unless these are the goal, so that equal seeds give equal texts. Throws
/// InputError if the goal needs what the engine does not count.
Found find_costly(Engine& engine, const PoseSpace& space, Goal goal, const SearchOptions& options,
                  const record::ProgressReport& progress);

/// Asks an engine at hard poses and compares its pairs with the exact ones: wrong contacts first, then by the
/// largest gap of a false pair or depth of a missed one, in units of the space. Throws InputError if it
/// reports pairs of faces that the bodies do not have.
Found find_wrong(Engine& engine, const LrbRep& a, const LrbRep& b, const PoseSpace& space,
                 const SearchOptions& options, const record::ProgressReport& progress);

/// Returns a scenario, for regression tests, of B at some poses, with the exact relations, numbers of pairs
/// and fingerprints as expectations, and lrbscope's numbers of tests as limits. `a` and `b`: the bodies'
/// files, relative to the scenario's folder.
std::string scenario_text(const std::string& purpose, std::span<const Pose> poses, const LrbRep& rep_a,
                          const LrbRep& rep_b, const std::string& a, const std::string& b);

}  // namespace lrb::engines
