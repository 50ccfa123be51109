#include <nlohmann/json.hpp>

#include "scenarios/report/assets.hpp"
#include "scenarios/run/scene_json.hpp"
#include <lrbscope/trace/counters.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/work.hpp>

namespace lrb::run {
namespace {

using nlohmann::json;
using report::packed;

/// The tests that have no events at EventLevel::faces, in the names of the full chart. Counters have their
/// numbers.
struct Unrecorded {
  std::string_view outcome;
  std::uint64_t Counters::*count;
};
constexpr Unrecorded kUnrecorded[] = {{"boxes", &Counters::box_tests},
                                      {"planes of faces", &Counters::prefilter_tests}};

/// Returns true if the work of a trace without node pairs is known from the counters of its steps.
bool counts_work(const trace::Trace& trace) {
  return trace.header.level == EventLevel::faces && trace.header.bodies.size() == 2 &&
         trace.header.request.recursion == Recursion::complete && !trace.has_engine_reports();
}

/// Returns the counters of the parts in each step, step by step.
json work_by_step(const trace::Trace& trace, const trace::WorkChart& chart) {
  constexpr double kMicros = 1e6;
  std::vector<std::uint32_t> index, events, operations;
  std::vector<float> micros;
  for (std::size_t step = 0; step < trace.steps.size(); ++step) {
    index.push_back(trace.steps[step].index);
    std::vector<trace::WorkOutcome> outcomes = trace::outcomes_of_step(trace, chart, step);
    if (counts_work(trace))
      for (std::size_t i = 0; i < std::size(kUnrecorded); ++i)
        outcomes[i].operations = trace.steps[step].result.counters.*kUnrecorded[i].count;
    for (const trace::WorkOutcome& o : outcomes) {
      events.push_back(static_cast<std::uint32_t>(o.events));
      operations.push_back(static_cast<std::uint32_t>(o.operations));
      micros.push_back(static_cast<float>(kMicros * o.seconds));
    }
  }
  return {{"index", packed(index)},
          {"events", packed(events)},
          {"operations", packed(operations)},
          {"micros", packed(micros)}};
}

}  // namespace

trace::WorkChart work_of(const trace::Trace& trace) {
  trace::WorkChart chart = trace::work_chart(trace);
  if (!counts_work(trace)) return chart;
  std::vector<trace::WorkOutcome> counted;
  for (const auto& [outcome, count] : kUnrecorded) {
    trace::WorkOutcome& part = counted.emplace_back();
    part.phase = "walk of the bodies", part.outcome = outcome;
    for (const trace::Step& step : trace.steps) part.operations += step.result.counters.*count;
  }
  chart.outcomes.insert(chart.outcomes.begin(), counted.begin(), counted.end());
  for (std::uint8_t& part : chart.of_event)
    if (part != trace::WorkChart::kNone) part = static_cast<std::uint8_t>(part + std::size(kUnrecorded));
  return chart;
}

json work_json(const trace::Trace& trace, const trace::WorkChart& chart) {
  if (chart.outcomes.empty() || (trace.header.level == EventLevel::faces && !counts_work(trace)))
    return nullptr;
  constexpr double kMicros = 1e6;
  json out = json::array();
  for (const trace::WorkOutcome& o : chart.outcomes)
    out.push_back({{"phase", o.phase},
                   {"outcome", o.outcome},
                   {"events", o.events},
                   {"operations", o.operations},
                   {"micros", kMicros * o.seconds}});
  return {{"outcomes", std::move(out)},
          // At EventLevel::faces, the times of box and plane tests are unknown.
          {"timed", !trace.wall_ns.empty() && !counts_work(trace)},
          {"steps", work_by_step(trace, chart)}};
}

}  // namespace lrb::run
