#pragma once
/// The queries of a running engine, checked as they end. Memory is bounded: only the last queries and the
/// remarkable ones are kept.

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "scenarios/profile/check.hpp"
#include "scenarios/profile/query_walk.hpp"
#include "scenarios/profile/verdicts.hpp"
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

/// Estimates a percentile of numbers as they come, to a factor of 2^(1/8), in constant memory.
class RunningPercentile {
 public:
  explicit RunningPercentile(double share) : share_(share) {}
  void add(double value);
  /// Returns the upper end of the interval that contains the percentile; 0 without numbers.
  double value() const;
  std::uint64_t count() const { return count_; }

 private:
  static constexpr int kPerOctave = 8, kOctaves = 64;  ///< intervals of values from 1 to 2^64
  double share_;
  std::uint64_t count_ = 0;
  std::array<std::uint64_t, kPerOctave * kOctaves> counts_{};
};

struct LiveSettings {
  std::size_t last = 200;            ///< number of last queries that are kept
  std::size_t remarkable = 200;      ///< maximum number of older queries kept because wrong or slow
  std::uint64_t events = 8'000'000;  ///< number of events that are kept, of the newest kept queries
};

struct LiveQuery {
  capture::Query query;
  bool is_checked = false;  ///< false: left out because the engine was faster
  CheckedQuery checked;     ///< if is_checked
  bool is_slow = false;     ///< slower than 99 % of the queries before it, of which there are at least 100
  bool has_events = true;   ///< the events are still stored
  std::uint64_t tests = 0;  ///< of volumes and of triangles
  std::string explanation;  ///< of wrong answers and pairs; may be empty

  bool is_wrong() const { return is_checked && checked.verdict.outcome == Judgement::wrong; }
};

class LiveQueries {
 public:
  /// `descriptions`: of the engine; grows while queries are added, and must outlive this object.
  explicit LiveQueries(const capture::Capture& descriptions, const LiveSettings& settings = {});

  /// Adds a query that ended. `check`: compare it with the exact answer, which takes time.
  void add(capture::Query query, bool check);

  /// Checks the newest kept query that was left out. Returns its number, or nullopt if there is none.
  std::optional<std::uint32_t> check_one();

  /// All kept queries by number.
  const std::deque<LiveQuery>& kept() const { return kept_; }
  /// Returns a kept query, or nullptr.
  const LiveQuery* find(std::uint32_t number) const;
  const CheckSums& sums() const { return sums_; }  ///< of the checked queries
  std::uint64_t count() const { return count_; }
  std::uint64_t unchecked() const { return unchecked_; }  ///< left out, and not checked since

  /// Returns the sums for the page.
  nlohmann::ordered_json sums_json() const;
  /// Returns a query for the page.
  nlohmann::ordered_json json_of(const LiveQuery& query) const;
  /// Returns a line for the end: "1 200 queries: 1 190 right, 2 wrong, 8 not checked; 12 us (99 %: 80 us)".
  std::string summary() const;
  /// Returns a capture of one kept query with the descriptions, which run pages can be made from.
  capture::Capture capture_of(const LiveQuery& query) const;

 private:
  void check(LiveQuery& query);
  void forget();

  const capture::Capture& descriptions_;
  LiveSettings settings_;
  CapturedBodies bodies_;
  std::optional<Checker> checker_;
  std::array<std::size_t, 2> known_{};  ///< number of meshes and trees in `bodies_`
  std::deque<LiveQuery> kept_;
  CheckSums sums_;
  std::uint64_t count_ = 0, unchecked_ = 0, events_ = 0;
  RunningPercentile median_{0.5}, p99_{0.99};
};

}  // namespace lrb::profile
