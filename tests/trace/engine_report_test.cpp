/// Answers of other engines in traces, and trees that are none.

#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/support/trace_schema.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/divergence.hpp>
#include <lrbscope/trace/trace_json.hpp>
#include <lrbscope/trace/work.hpp>

using namespace lrb;
using namespace lrb::trace;
using Json = nlohmann::json;

namespace {

/// Two queries of another engine on two threads, with counters, phases and axes.
Trace engine_run() {
  RecorderSettings settings;
  settings.engine = "Toy 1.0";
  settings.level = EventLevel::nodes;
  settings.names = {"cache hits", "descent", "leaves"};
  Recorder recorder(runs::plate(), runs::plate(), settings);
  for (std::uint32_t step : {3U, 5U}) {
    recorder.begin_step(step, {}, {});
    EngineReport report{EngineQuery::any, EngineVerdict::intersecting, 1, true, step, 1234567, 890, {}, {}};
    report.phases.push_back({1, 1, 0});
    recorder.begin(Phase::walk, 0, 0);
    recorder.node_pair({.a = 0, .b = 0, .parent = kNull, .step = NodeStep::leaves, .box_tests = 3, .met = 1});
    recorder.node_pair(
        {.a = 0, .b = 0, .parent = kNull, .step = NodeStep::descend_a, .box_tests = 1, .met = 0});
    recorder.set_engine_axis(step == 3 ? 0 : 14);
    report.phases.push_back({2, 4, 0});
    recorder.face_test(0, 0, exact::Meet::cross, 0, 0);
    report.counts.push_back({0, 5, 42});
    recorder.contact(0, 0, exact::Meet::cross);
    recorder.end(Phase::walk, 4);
    recorder.add(report);
    CollideResult result;
    result.pairs = {{0, 0}};
    result.relation = Relation::crossing;
    recorder.end_step(result);
  }
  return recorder.take();
}

}  // namespace

TEST_CASE("an engine's answers, counters, phases and axes survive a file, which fulfils the schema") {
  const Trace t = engine_run();
  const std::string text = trace_to_json(t);
  CHECK(trace_from_json(text, "t.json") == t);
  const Json document = Json::parse(text);
  CHECK(test::trace_faults(document) == "");
  CHECK(document["metadata"]["version"] == 4);
  CHECK(t.events.at(3).node_pair().engine_axis == 1);
  // The view of Perfetto: a slice for each query on its thread, in its own time, phases and counters.
  const auto find = [&](const std::string& name) {
    std::vector<Json> out;
    for (const Json& e : document["traceEvents"])
      if (e["name"] == name) out.push_back(e);
    return out;
  };
  const auto slices = find("query 5: intersecting, 1 pair");
  REQUIRE(slices.size() == 1);
  CHECK(slices[0]["pid"] == 2);
  CHECK(slices[0]["tid"] == 5);
  CHECK(slices[0]["ts"] == 1234.567);
  CHECK(slices[0]["dur"] == 0.89);
  CHECK(slices[0]["args"]["cache hits"] == 42);
  const auto phases = find("descent");
  REQUIRE(phases.size() == 2);
  CHECK(phases[0]["dur"] == 3);
  const auto counts = find("engine: cache hits");
  REQUIRE(counts.size() == 2);
  CHECK(counts[0]["args"]["value"] == 42);
  CHECK(find("node pair").at(1)["args"]["axis"] == 0);
}

TEST_CASE("counters without a name, or at a place that does not exist, are refused") {
  for (const int fault : {0, 1, 2}) {
    CAPTURE(fault);
    Trace t = engine_run();
    EngineReport& report = *t.steps[0].result.engine;
    if (fault == 0) report.counts[0].name = 3;
    if (fault == 1) report.phases[1].at = 100;
    if (fault == 2) report.phases[0].at = 5;
    CHECK_THROWS_AS(check_trace(t, "t.json"), InputError);
  }
}
