#pragma once
/// Finds where two runs begin to differ: what a golden trace reports when it no longer matches.

#include <cstddef>
#include <optional>
#include <string>

#include <lrbscope/trace/trace.hpp>

namespace lrb::trace {

struct Divergence {
  std::optional<EventId> event;     ///< the first event that differs (or that only one of the runs has)
  std::optional<std::size_t> step;  ///< index into Trace::steps; nothing: the runs differ before any step
  std::string what;                 ///< the field, e.g. "meet" or "body B: hash"
  std::string expected, actual;     ///< its values, in words

  /// Returns one line, e.g. "event 12 (step 0): meet: expected cross, found touch".
  std::string message() const;
};

/// Returns the first difference in causal order: bodies and request, then step by step poses, events and
/// results. Ignores wall-clock times, names, sources, versions and caps. Returns nothing if the runs are the
/// same.
std::optional<Divergence> first_divergence(const Trace& expected, const Trace& actual);

/// Describes an event in words, e.g. "refine: region 3 of A, faces added 5, wrapper faces 14, cause 7".
std::string describe(const Event& event);

}  // namespace lrb::trace
