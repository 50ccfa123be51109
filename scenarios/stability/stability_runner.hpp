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
