#pragma once
/// Runs of other engines: their trees in a file beside the trace, and their answers compared with exact ones.

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "render/pictures/marks.hpp"
#include "render/pictures/panel.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::record {

struct Recording;

/// File in a run's folder with the trees of another engine, because its trace names their nodes by number.
inline constexpr const char* kTreesFile = "trees.json";

/// Returns the trees of A and B as JSON: for each node its children, simplices and box.
std::string trees_text(std::span<const trace::TreeShape> trees);
/// Reads them. Throws InputError for a text that is not of two trees, or that names nodes or simplices that
/// do not exist. `simplices`: the numbers of simplices of A and B; `name` is used in messages.
std::vector<trace::TreeShape> read_trees(const std::string& text, const std::string& name,
                                         const std::array<std::uint32_t, 2>& simplices);

/// Returns lrbscope's answer, with contact regions, to a query that another engine answered with the pairs
/// `found`. For a query of a body with itself, in which all neighbouring faces touch: those of `found` that
/// intersect.
CollideResult exact_answer(const pictures::PosedBodies& bodies, const CollideRequest& request,
                           const std::optional<trace::EngineReport>& report,
                           std::span<const SimplexPair> found);

/// Returns the pairs that an engine found in a step, ascending.
std::vector<SimplexPair> pairs_found(std::span<const trace::Event> events);

/// Compares the pairs that an engine found, ascending, with the exact answer. Pairs found wrongly come first,
/// then those missed. A query for any pair misses one only if it found the bodies separate; a query of a body
/// with itself, or one without all its events, is not known to miss any. The pairs of a search for the first
/// contact are at other poses and not compared.
std::vector<pictures::WrongPair> wrong_pairs(std::span<const SimplexPair> found,
                                             std::span<const SimplexPair> exact,
                                             const std::optional<trace::EngineReport>& report);

/// Returns false for first contacts and shapes, whose answers are not checked.
bool is_compared(const std::optional<trace::EngineReport>& report);

/// The errors of an engine's answer to a query.
struct WrongAnswer {
  std::vector<pictures::WrongPair> pairs;  ///< first those reported wrongly, then those missed
  /// Wrong pairs that are not in `pairs`, because arithmetic of the engine's precision cannot decide them.
  std::uint64_t undecidable_missed = 0, undecidable_false = 0;
  bool is_verdict_undecidable = false;
  /// The error of the distance, empty for a right one; nullopt: none was reported. Not in traces.
  std::optional<std::string> distance;

  bool has_wrong_distance() const { return distance && !distance->empty(); }
};

/// The answer of an engine to a query, compared with the exact one.
struct AnswerScore {
  std::uint64_t right = 0, missed = 0, false_pairs = 0, undecidable = 0;  ///< pairs
  std::optional<bool> verdict;  ///< its verdict is right; nullopt: it has none that can be compared
  bool is_wrong = false;        ///< a pair, the verdict or the distance
};
AnswerScore score_of(const trace::StepResult& answer, const WrongAnswer& wrong, const CollideResult& exact);

/// Sums over the queries of an engine's run.
struct EngineTotals {
  std::uint64_t queries = 0, intersecting = 0;  ///< intersecting: by the engine's verdict
  std::uint64_t node_pairs = 0, box_tests = 0, face_tests = 0;
  std::uint64_t right = 0, missed = 0, false_pairs = 0, undecidable = 0;
  std::uint64_t verdicts = 0, wrong_verdicts = 0, distances = 0, wrong_distances = 0;
  std::uint64_t wrong_queries = 0;  ///< with a wrong pair, verdict or distance
  bool has_pairs = false;           ///< the tests of some query were captured
  bool checked = false;

  EngineTotals& operator+=(const EngineTotals& other);
  /// Returns "wrong answers in 2 of 40 queries: 30 of 732 intersecting pairs missed".
  std::string words() const;
};
/// Returns the sums of a run. Null: not known.
EngineTotals totals_of(const trace::Trace& trace, const std::vector<CollideResult>* results,
                       const std::vector<WrongAnswer>* wrong);
EngineTotals totals_of(const Recording& run);

/// Returns the name of an axis of a test of another engine: see capture::Event::axis.
std::string axis_words(std::uint32_t axis);

}  // namespace lrb::record
