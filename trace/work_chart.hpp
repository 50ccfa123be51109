#pragma once
/// The work of a run's queries as a chart of nested parts shows it: query, phase, what decided. From a
/// trace's events from EventLevel::nodes on.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "trace/trace.hpp"

namespace lrb::trace {

/// What one thing decided in one phase, over all steps.
struct WorkOutcome {
  std::string_view phase;    ///< such as "walk of the bodies"
  std::string_view outcome;  ///< such as "boxes of nodes"; empty: the phase is not divided
  std::uint64_t events = 0;
  /// Tests of boxes, of planes (one for each pair of faces whose boxes meet) and of faces; regions refined or
  /// taken back, pairs sorted, points located, faces of separating wrappers, contact regions.
  std::uint64_t operations = 0;
  double seconds = 0;  ///< as WorkShare::seconds
};

struct WorkChart {
  static constexpr std::uint8_t kNone = 255;
  std::vector<WorkOutcome> outcomes;   ///< those that came, by phase, in the order of a query
  std::vector<std::uint8_t> of_event;  ///< (|events|) index of each event's; kNone: it has none
};

/// Returns the chart's outcomes with what they count in one step, in the chart's order.
std::vector<WorkOutcome> outcomes_of_step(const Trace& trace, const WorkChart& chart, std::size_t step);

/// Returns the chart: the parts of work_shares(), with walks of bodies and of levels told apart.
WorkChart work_chart(const Trace& trace);

}  // namespace lrb::trace
