#pragma once
/// What the parts of a query cost, from a trace's events from EventLevel::nodes on.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "trace/trace.hpp"

namespace lrb::trace {

struct WorkShare {
  std::string_view name;  ///< snake_case, fixed: files use it
  std::string_view what;  ///< what `count` counts
  std::uint64_t events = 0, count = 0;
  std::uint64_t box_tests = 0;  ///< of pairs of nodes
  double seconds = 0;  ///< from the event before to each of them, recording included; 0 on the event clock
};

/// Returns the parts of the queries of a run, in the order of a query: traversal (pairs of inner nodes),
/// leaves (pairs of leaves), float_tests, shared_corner_tests, filter_tests and expansion_tests (face tests
/// by what decided them), other_tests (those of the paper's recursions), wrappers (refinements), sorting,
/// relation, separation, contact_geometry and cache_making (coherent queries).
std::vector<WorkShare> work_shares(const Trace& trace);

/// Returns which of these parts an event belongs to; nothing: none, it takes no work of its own.
std::optional<std::size_t> work_part(const Event& e);
/// Returns what an event adds to its part's `count`.
std::uint64_t work_count(const Event& e);

}  // namespace lrb::trace
