/// Traces against the schema in the repository, by an independent validator.
#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/support/trace_schema.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;
using Json = nlohmann::json;

namespace {

Json box_run(Clock clock) {
  static const LrbRep box(toy::dented_box());
  RecorderSettings settings;
  settings.clock = clock;
  return Json::parse(trace_to_json(runs::record(box, box, runs::kBoxPoses, settings).trace));
}

}  // namespace

TEST_CASE("traces satisfy the schema") {
  CHECK(test::trace_faults(box_run(Clock::event)) == "");
  CHECK(test::trace_faults(box_run(Clock::wall)) == "");
  const LrbRep plate(toy::notched_plate());
  RecorderSettings settings;
  settings.event_cap = 30;
  CHECK(test::trace_faults(
            Json::parse(trace_to_json(runs::record(plate, plate, runs::kPlatePoses, settings).trace))) == "");
  Recorder alone(plate, RecorderSettings{});
  CHECK(test::trace_faults(Json::parse(trace_to_json(alone.take()))) == "");
  alone.begin_step(0, {});
  alone.refine(Side::a, 2, 3);
  alone.coarsen(Side::a, 2, 3);
  CHECK(test::trace_faults(Json::parse(trace_to_json(alone.take()))) == "");
}
