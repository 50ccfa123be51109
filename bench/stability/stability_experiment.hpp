#pragma once
/// The stability experiment: runs every method on every case, in worker processes that may crash or hang.

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/cases/families.hpp"
#include "bench/methods/method.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/workers/workers.hpp"
#include <lrbscope/collide.hpp>

namespace lrb::stability {

// Whether an answer is right: the right one, by exact brute force, and the judgement.

struct RightAnswer {
  std::vector<SimplexPair> pairs;
  Relation relation = Relation::separate;
  /// For a number: the interval [least, most] that contains it. Without a first contact both are 2.
  std::optional<double> least = {}, most = {};
  std::string rejection;  ///< reason why the query has no answer; empty: it has one
};

RightAnswer expected_answer(const cases::Case& c);

nlohmann::ordered_json to_json(const RightAnswer& e);
/// Reads it from a line. Throws InputError, or nlohmann's exceptions if it is not JSON.
RightAnswer expected_from(const std::string& line);

/// Sets outcome, counts and relations of the record. For a method that lists no pairs, counts are of contacts
/// (0 or 1), and relations are "contact", "inside", "separate".
void judge(Record& record, const methods::MethodInfo& info, const methods::MethodAnswer& answer,
           const RightAnswer& expected);

/// Compares a method with itself for exchanged bodies: the answer to (B, A) must be the transpose of the
/// answer to (A, B). `several`: both bodies have several pieces. Each body may then contain a piece of the
/// other, and the relation names only one of these.
void judge_swapped(Record& record, const methods::MethodInfo& info, const methods::MethodAnswer& answer,
                   const methods::MethodAnswer& swapped, bool several);

// The experiment.

struct ExperimentOptions {
  Quantity quantity = Quantity::pairs;  ///< queried quantity; the workers of the methods must support it
  std::vector<std::string> families;    ///< by name
  std::vector<workers::WorkerMethod> methods;  ///< absent ones are skipped
  std::uint64_t cases = 1;                     ///< per difficulty
  std::uint64_t seed = 1;
  std::optional<int> difficulty;  ///< only this difficulty; nullopt: all
  unsigned jobs = 2;              ///< number of concurrent workers
  double timeout = 5;             ///< time limit per case in seconds, after which a method counts as hanging
  /// File to which records are appended as they come; those of an interrupted run of the same version are
  /// taken from it, and it is removed at the end. Empty: no file.
  std::string unfinished_file = {};
};

using ProgressFunction =
    std::function<void(std::uint64_t done, std::uint64_t total, const std::string& what)>;

/// Returns one record per method and case, in the order of families, methods, difficulty and case. Except for
/// times the records do not depend on the number of jobs. The right answers of a family are computed once, by
/// exact brute force. Throws EnvironmentError if a worker cannot run.
std::vector<Record> run_experiment(const ExperimentOptions& options, const ProgressFunction& progress);

/// A single case, run again in its own process.
struct Replay {
  Record record;
  std::vector<SimplexPair> expected;
  std::optional<std::vector<SimplexPair>> answered;  ///< nullopt: no answer, or one without a list of pairs

  /// Asks a worker, and takes record and pairs from its answer. `right`: a file with the right answer.
  /// Returns false, with the failure in the record, if there is no answer.
  bool ask(workers::Worker& worker, nlohmann::ordered_json question, const std::string& right,
           std::chrono::duration<double> limit);
};

/// Runs the case of a record.
Replay replay(const workers::WorkerMethod& method, const Record& of, double timeout,
              Quantity quantity = Quantity::pairs);

// Runs one method on cases.

class StabilityRunner {
 public:
  /// The method must be present.
  explicit StabilityRunner(const methods::MethodEntry& entry) : info_(entry.info), method_(entry.make()) {}

  /// Runs the method on a case. Sets outcome, counts, relations, time and message of the record, and stores
  /// the answer.
  void ask(const cases::Family& family, const cases::Case& c, const RightAnswer& expected, Record& record);

  /// Returns the pairs of the last ask(), or nullopt if there was no answer or it contains no list of pairs.
  const std::optional<std::vector<SimplexPair>>& pairs() const { return pairs_; }

 private:
  using BodyPointer = std::shared_ptr<methods::MethodBody>;
  struct Posed {
    BodyPointer body;
    Pose pose;
  };

  Posed place(const LrbRep& rep, const Pose& pose, int side);

  methods::MethodInfo info_;
  std::unique_ptr<methods::Method> method_;
  std::map<std::pair<std::uint64_t, int>, BodyPointer>
      kept_;  ///< by hash and side, because families share bodies
  std::optional<std::vector<SimplexPair>> pairs_;
};

}  // namespace lrb::stability
