#pragma once
/// A whole capture checked: the verdicts and prices of its queries, added up, as text, tables and charts.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/profile/prices.hpp"
#include "scenarios/profile/verdicts.hpp"
#include "scenarios/record/recorded_run.hpp"
#include "scenarios/report/document.hpp"
#include <lrbscope/render/image.hpp>
#include <lrbscope/trace/capture.hpp>

namespace lrb::profile {

/// Where on a mesh the visits of an engine's traversal are wasted.
struct WasteMap {
  capture::Mesh mesh;
  std::vector<double> waste;  ///< (|triangles|) wasted visits: PriceBook::waste_by_triangle()
};

/// Captures with at most this many visits are split into volumes and order unless CheckSettings::split
/// decides otherwise. The split takes about 1 to 5 microseconds for each visit and for each pair that it
/// would save.
inline constexpr std::uint64_t kMaxVisitsToSplit = 2'000'000;

struct CheckSettings {
  std::optional<Precision> precision;  ///< nullopt: precision_of()
  std::optional<bool> split;           ///< nullopt: for at most kMaxVisitsToSplit visits
};

struct CheckedQuery {
  QueryVerdict verdict;  ///< without the list `exact`
  Prices prices;
};

/// Sums over queries of one kind.
struct CheckSums {
  std::uint64_t queries = 0;
  std::array<std::uint64_t, kEnumNames<Judgement>.size()> outcomes{};  ///< number of queries, by Judgement
  std::uint64_t exact_pairs = 0, right = 0, missed = 0, extra = 0, undecidable = 0;  ///< pairs of triangles
  Prices prices;

  CheckSums& operator+=(const CheckSums& other);
  CheckSums& operator*=(std::uint64_t factor);
};

/// Returns the sums over one query.
CheckSums sums_of(const CheckedQuery& query);

/// A wrong pair of two posed bodies.
struct ShownPair {
  std::array<capture::Mesh, 2> meshes;
  std::array<Pose, 2> poses;
  SimplexPair pair;
  std::string sentence;  ///< about it
};

/// Errors with the same cause.
struct Cause {
  std::string words;
  std::vector<std::string> lines;  ///< one for each error that was kept
};

struct Check {
  std::string engine;
  Precision precision = Precision::float64;
  std::vector<CheckedQuery> queries;
  std::map<capture::QueryKind, CheckSums> kinds;  ///< of a sample, scaled to all queries
  std::vector<WasteMap> waste;                    ///< of the two trees with most waste
  std::vector<Cause> wrong;                       ///< wrong pairs and answers; the most frequent cause first
  std::optional<ShownPair> first_wrong;           ///< beyond the error bound, of two bodies
  std::vector<Cause> undecidable;                 ///< the same, for those within the error bound

  /// A sentence if most reported pairs are wrong, but right after the reversal of a PoseError.
  std::string pose_error;
  /// A sentence if the capture has a sample of the queries.
  std::string sample;
  /// A sentence if trees of the queries have faults, as if their volumes are in another frame.
  std::string tree_faults;

  CheckSums sum() const;
  /// Returns true if an answer is wrong beyond the error bound.
  bool is_wrong() const { return sum().outcomes[static_cast<std::size_t>(Judgement::wrong)] > 0; }
};

/// Checks all queries of a capture. Throws InputError for meshes and poses that cannot be queried.
Check check(const capture::Capture& capture, const CheckSettings& settings,
            const record::ProgressReport& progress = record::kSilent);

/// Returns the prices by engine and kind of query, in percent of the visits.
report::Table price_table(std::span<const Check> checks);
/// Returns the verdicts by engine and kind of query.
report::Table verdict_table(std::span<const Check> checks);
/// Adds verdicts, prices, advice, the chart of prices by query, and pictures of the waste to a page. `up`: of
/// the pictures. Returns notes on pictures that could not be drawn.
std::vector<std::string> add_checks(report::Document& page, std::span<const Check> checks,
                                    const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

}  // namespace lrb::profile
