#pragma once
/// Puts cases to one method.

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scenarios/cases/families.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/stability/expected.hpp"
#include "scenarios/stability/outcome_grid.hpp"

namespace lrb::stability {

class StabilityRunner {
 public:
  /// Of a method that is present.
  explicit StabilityRunner(const methods::MethodEntry& entry) : info_(entry.info), method_(entry.make()) {}

  /// Outcome, counts, relations, time and message of a record; what the method answered is kept.
  void ask(const cases::Family& family, const cases::Case& c, const Expected& expected, Record& record);

  /// The pairs of the last ask(); nothing if there was no answer, or none that lists pairs.
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
