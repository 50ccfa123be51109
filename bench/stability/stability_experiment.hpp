#pragma once
/// The stability experiment: runs every method on every case, in worker processes that may crash or hang.

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

// Whether an answer is right: the right one, by exact arithmetic, and the judgement.

struct RightAnswer {
  std::vector<SimplexPair> pairs;
  Relation relation = Relation::separate;
  /// For a number: the interval [least, most] that contains it. Without a first contact both are 2.
  std::optional<double> least = {}, most = {};
  double size = 0;        ///< for a number: diagonal of the larger body's box
  bool several = false;   ///< both bodies have several pieces, so that each may contain a piece of the other
  std::string rejection;  ///< reason why the query has no answer; empty: it has one
};

/// Returns the pairs and the relation, by brute force.
RightAnswer expected_answer(const cases::Case& c);

nlohmann::ordered_json to_json(const RightAnswer& e);
/// Reads it from a line. Throws InputError, or nlohmann's exceptions if it is not JSON.
RightAnswer expected_from(const std::string& line);

/// Sets outcome, message, time, counts and relations of the record.
///
/// Pairs: wrong if pairs are missed or in excess, or the relation is wrong. For a method that lists no pairs,
/// counts are of contacts (0 or 1), and relations are "contact", "inside", "separate". A method that was
/// asked for exchanged bodies as well is compared with itself: the answer to (B, A) must be the transpose of
/// the answer to (A, B).
///
/// Numbers, as relations: wrong if it is 0 (or never) and the true value is not, or the reverse; if a proven
/// interval does not contain the number; or if the error exceeds a millionth of the bodies' size, or a
/// thousandth of the motion.
void judge(Record& record, const methods::MethodInfo& info, const methods::Answer& answer,
           const RightAnswer& expected);

/// A judged answer with its pairs.
struct Replay {
  Record record;
  std::vector<SimplexPair> expected;
  std::optional<std::vector<SimplexPair>> answered =
      {};  ///< nullopt: no answer, or one without a list of pairs

  Replay() = default;
  /// Judges an answer to the case of a record.
  Replay(const Record& of, const methods::MethodInfo& info, methods::Answer answer, const RightAnswer& right);
};

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

/// Runs the case of a record again, in its own process.
Replay replay(const workers::WorkerMethod& method, const Record& of, double timeout,
              Quantity quantity = Quantity::pairs);

// Runs one method on cases.

class StabilityRunner {
 public:
  /// The method must be present.
  explicit StabilityRunner(const methods::MethodEntry& entry) : info_(entry.info), method_(entry.make()) {}

  const methods::MethodInfo& info() const { return info_; }
  /// Returns the method's answer to a case; with `both_ways` also that for exchanged bodies. Failures are its
  /// outcome.
  methods::Answer ask(const cases::Case& c, bool both_ways);

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
};

}  // namespace lrb::stability
