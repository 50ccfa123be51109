#pragma once
/// Finds the first difference between two runs, such as a golden trace and a new one.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

struct Divergence {
  std::optional<EventId> event;  ///< first event that differs or that only one run has
  /// Index into Trace::steps; nullopt: the runs differ before the first step.
  std::optional<std::size_t> step;
  std::uint32_t number = 0;      ///< of the step, as in Step::index
  std::string what;              ///< the field, e.g. "meet" or "body B: hash"
  std::string expected, actual;  ///< its values as text

  /// Returns one line, e.g. "event 12 (step 0): meet: expected cross, found touch".
  std::string message() const;
};

/// Returns the first difference in causal order: bodies and request, then per step poses, events and results.
/// Wall-clock times, names, sources, versions and event caps are ignored. Returns nullopt if the runs are
/// equal.
std::optional<Divergence> first_divergence(const Trace& expected, const Trace& actual);

/// A field in which two results differ, with its values as text.
struct FieldDifference {
  std::string name, expected, actual;
  bool is_counter = false;
};
std::vector<FieldDifference> differing_fields(const StepResult& expected, const StepResult& actual);

/// Returns a one-line summary of another engine's answer: "any, intersecting, 1 pair".
std::string to_text(const EngineReport& report);

/// Returns an event as text, e.g. "refine: region 3 of A, faces added 5, wrapper faces 14, cause 7".
std::string describe(const Event& event);

}  // namespace lrb::trace
