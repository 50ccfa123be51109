#pragma once
/// The distribution of an engine's cost over poses: times, and numbers of tests beside them.

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/tails/engine.hpp"
#include "scenarios/record/recorded_run.hpp"

namespace lrb::tails {

/// One pose: the answer, with the least time of some rounds.
struct Sample {
  EngineAnswer answer;
  /// Its time per test was unusually long in all rounds, but not when it was measured again.
  bool noise = false;
};

struct Tail {
  std::string engine;
  std::vector<Pose> poses;      ///< of B relative to A
  std::vector<Sample> samples;  ///< (|poses|)
  /// (|poses|) numbers of the queries of a capture; of several at the same pose the fastest. Otherwise empty.
  std::vector<std::uint32_t> queries;
  int rounds = 0;            ///< least number of queries of a pose
  bool with_events = false;  ///< events were recorded during the timed queries
};

inline constexpr int kRounds = 3;
/// A pose that takes longer than the median, and per test longer than this multiple of the median, is
/// measured again.
inline constexpr double kNoiseFactor = 5;

/// Queries every pose in kRounds separate rounds, so that a slow moment of the machine does not affect all
/// repeats of a pose. Then repeats the poses with an unusual time per test in as many rounds: a pose that now
/// takes less than half the time is marked as noise. Keeps the least time.
Tail measure(Engine& engine, std::span<const Pose> poses, const run::ProgressReport& progress);

/// Returns the queries of a capture that ended, with their times as captured. Equal queries (trees and poses)
/// count as rounds of one. Throws InputError that names the file for a capture without a query that ended.
Tail tail_of(const capture::Capture& capture, const std::string& file);

struct Percentiles {
  std::string what;  ///< "us", "tests", "box_tests", "face_tests", "tests in phase NAME"
  std::size_t count = 0;
  double p50 = 0, p90 = 0, p99 = 0, max = 0;  ///< by nearest rank
};

/// Returns the percentiles of each quantity that the engine reported at every answered pose.
std::vector<Percentiles> percentiles(const Tail& tail);

/// Returns the share of poses below a percentile, given by its name: 0.99 for "p99", 1 for "max". Throws
/// InputError for other names.
double percentile_share(const std::string& word);
/// Returns the index of the pose at a percentile of time, by nearest rank. Throws InputError if no pose was
/// answered.
std::size_t pose_at(const Tail& tail, const std::string& word);

/// Returns the indices of the poses with the longest times, longest first.
std::vector<std::size_t> costliest(const Tail& tail, std::size_t most);

/// Returns the table for a terminal, and the same as JSON, an object for each line.
std::string table_of(const std::vector<Tail>& tails);
std::vector<nlohmann::ordered_json> json_of(const std::vector<Tail>& tails);

/// Returns notes on failures, noise, and captures with events; one line each.
std::vector<std::string> notes_of(const std::vector<Tail>& tails);

struct TailsPage {
  std::string title, purpose, command;
  std::string machine;  ///< where times were measured; empty: not known
  /// Returns the command that records a pose of a tail.
  std::function<std::string(const Tail& tail, std::size_t pose)> record_command;
};

/// Writes folder/index.html with the distributions and the costliest poses, and folder/tails.jsonl with every
/// sample. Returns notes as text.
std::vector<std::string> write_tails_page(const std::vector<Tail>& tails, const TailsPage& page,
                                          const std::string& folder);

}  // namespace lrb::tails
