#pragma once
/// Finds what a run answers otherwise than was approved, step by step, whatever the cause.

#include <cstdint>
#include <string>
#include <vector>

#include "scenarios/golden/golden.hpp"
#include "scenarios/golden/golden_run.hpp"

namespace lrb::golden {

struct Effect {
  /// Answers decide whether a run passes where only these are compared.
  enum class Kind : std::uint8_t { answer, measure, work };
  std::uint32_t step = 0;  ///< the number that the scenario gives it
  std::string what;        ///< e.g. "relation", "pairs", "face tests"
  std::string expected, found;
  Kind kind = Kind::answer;
};

/// Returns all of them: answers, then what is measured of them, then the work that led to them, each in the
/// order of the steps.
std::vector<Effect> find_effects(const Golden& golden, const GoldenRun& run);

/// Returns the total length of the contact curves of each step, in the scenario's unit; nothing where the
/// run did not ask for contacts.
std::vector<double> contact_lengths(const run::Recording& recording);

}  // namespace lrb::golden
