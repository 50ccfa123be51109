// Distances, kinds of contact and searches for a first contact in traces: kept by files, told to viewers as
// counters.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/trace_schema.hpp"
#include <lrbscope/trace/divergence.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;
using Json = nlohmann::json;

namespace {

const LrbRep& ball() {
  static const LrbRep rep = LrbRep::without_regions(shapes::icosphere(2), true, false);
  return rep;
}

/// Two balls that come together in three steps: apart, apart, one in the other; each step measured.
Trace measured_run(Clock clock) {
  RecorderSettings settings;
  settings.clock = clock;
  Recorder recorder(ball(), ball(), settings);
  QueryContext context;
  for (std::uint32_t step = 0; step < 3; ++step) {
    const Pose pose = Pose::translation({3.2 - 0.8 * step, 0.1, 0.2});
    recorder.begin_step(step, {}, pose);
    const CollideResult result = collide(ball(), {}, ball(), pose, {}, context, recorder);
    BoundsHistory gap;
    const DistanceResult apart = distance(ball(), {}, ball(), pose, {}, gap);
    recorder.add(measured(apart, gap.history));
    ClashHistory clashed;
    const ClashResult kind = clash(ball(), {}, ball(), pose, {}, clashed);
    recorder.add(measured(kind, clashed.of_depth));
    recorder.add(measured(near_pairs(ball(), {}, ball(), pose, {.within = 0.5}), 0.5));
    recorder.add(measured(contact_manifolds(ball(), {}, ball(), pose, {.margin = 0.1}), 0.1));
    recorder.add(measured(point_distances(ball(), {}, std::array{pose.t}), std::array{pose.t}, true));
    recorder.end_step(result);
  }
  Trace trace = recorder.take();
  FirstContactHistory search;
  const Motion motion = Motion::linear(Pose::translation({3.2, 0.1, 0.2}), {0, 0.1, 0.2});
  const FirstContactResult found = first_contact(ball(), Motion::still({}), ball(), motion, {}, search);
  trace.header.first_contact = measured(found, search.history);
  return trace;
}

std::vector<Json> counters(const Json& document, const std::string& name) {
  std::vector<Json> out;
  for (const Json& e : document["traceEvents"])
    if (e["ph"] == "C" && e["name"] == name) out.push_back(e);
  return out;
}

}  // namespace

TEST_CASE(
    "measurements are read back; bounds are counters within the step's last event, and times do not fall") {
  for (const Clock clock : {Clock::event, Clock::wall}) {
    const Trace trace = measured_run(clock);
    const Json document = Json::parse(trace_to_json(trace));
    CHECK(test::trace_faults(document) == "");
    CHECK(trace.steps[2].result.clash->history.size() > 2);
    CHECK(trace_from_json(trace_to_json(trace), "t.json") == trace);
    Trace other = trace;
    other.header.first_contact->history.pop_back();
    REQUIRE(first_divergence(trace, other).has_value());
    CHECK(first_divergence(trace, other)->message().starts_with("run: first contact: expected contact ["));
    double before = 0;
    for (const Json& e : document["traceEvents"]) {
      const auto now = e["ts"].get<double>();
      if (e["ph"] != "X") CHECK(now >= before);
      if (e["ph"] == "C") before = now;
    }
    std::size_t looks = 0, depths = 0;
    for (const Step& step : trace.steps) {
      looks += step.result.distance->history.size();
      depths += step.result.clash->history.size();
    }
    const std::vector<Json> gaps = counters(document, "distance");
    REQUIRE(gaps.size() == looks);
    CHECK(counters(document, "depth").size() == depths);
    CHECK(gaps[0]["args"]["lower"] == trace.steps[0].result.distance->history[0].lower);
    if (clock == Clock::wall) continue;
    CHECK(counters(document, "first contact").size() == trace.header.first_contact->history.size());
    const double last = trace.steps[1].first_event - 1;
    CHECK(gaps[0]["ts"].get<double>() >= last);
    CHECK(gaps[0]["ts"].get<double>() < last + 1);
  }
}
