#pragma once
/// The stability experiment: puts every case to every method, in processes that may die or hang.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/cases/families.hpp"
#include "bench/rivals/method.hpp"
#include "bench/stability/judge.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/workers/workers.hpp"

namespace lrb::stability {

struct ExperimentOptions {
  Quantity quantity = Quantity::pairs;         ///< what is asked for; the methods are of workers that know it
  std::vector<std::string> families;           ///< by name
  std::vector<workers::WorkerMethod> methods;  ///< absent ones are skipped
  std::uint64_t cases = 1;                     ///< for each setting of the dial
  std::uint64_t seed = 1;
  std::optional<int> dial;  ///< only this setting; nothing: all
  unsigned jobs = 2;        ///< number of workers at a time
  double timeout = 5;       ///< time in seconds that a method has for a case before it counts as hanging
};

using ProgressFunction =
    std::function<void(std::uint64_t done, std::uint64_t total, const std::string& what)>;

/// Returns one record for every method and case, in the order of families, methods, dial and case: the same,
/// except for times, for any number of jobs. Finds a family's right answers once, by exact brute force.
/// Throws EnvironmentError if a worker cannot work.
std::vector<Record> run_experiment(const ExperimentOptions& options, const ProgressFunction& progress);

/// One case again, in a process of its own.
struct Replay {
  Record record;
  std::vector<SimplexPair> expected;
  std::optional<std::vector<SimplexPair>> answered;  ///< nothing: no answer, or one without a list
};

Replay replay(const workers::WorkerMethod& method, const std::string& family, int dial,
              std::uint64_t case_index, std::uint64_t seed, double timeout,
              Quantity quantity = Quantity::pairs);

// Puts cases to one method.

class StabilityRunner {
 public:
  /// The method must be present.
  explicit StabilityRunner(const methods::MethodEntry& entry) : info_(entry.info), method_(entry.make()) {}

  /// Puts a case to the method and fills in outcome, counts, relations, time and message of the record; keeps
  /// what the method answered.
  void ask(const cases::Family& family, const cases::Case& c, const RightAnswer& expected, Record& record);

  /// Returns the pairs of the last ask(); nothing if there was no answer, or none that lists pairs.
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
  std::map<std::pair<std::uint64_t, int>, BodyPointer> kept_;  ///< by hash and side: families share bodies
  std::optional<std::vector<SimplexPair>> pairs_;
};

}  // namespace lrb::stability
