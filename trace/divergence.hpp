#pragma once
/// Where two runs part: what a golden trace reports when it no longer matches.

#include <cstddef>
#include <optional>
#include <string>

#include "trace/trace.hpp"

namespace lrb::trace {

struct Divergence {
  std::optional<EventId> event;     ///< the first event that differs (or that only one of the runs has)
  std::optional<std::size_t> step;  ///< index into Trace::steps; nothing: the runs differ before any step
  std::string what;                 ///< the field, e.g. "meet" or "body B: hash"
  std::string expected, actual;     ///< its values, in words

  /// One line, e.g. "event 12 (step 0): meet: expected cross, found touch".
  std::string message() const;
};

/// The first difference in causal order: bodies and request, then step by step poses, events and results.
/// Ignored: wall-clock times, names, sources, versions and caps. Nothing: the runs are the same.
std::optional<Divergence> first_divergence(const Trace& expected, const Trace& actual);

/// An event in words, e.g. "refine: region 3 of A, faces added 5, wrapper faces 14, cause 7".
std::string describe(const Event& event);

}  // namespace lrb::trace
