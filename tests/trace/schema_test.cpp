/// The schema in the repository against traces and broken traces, by an independent validator.

#include <functional>

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

TEST_CASE("broken traces do not satisfy the schema") {
  const Json good = box_run(Clock::event);
  const auto find = [](Json& document, const char* name, const char* phase) -> Json& {
    for (Json& e : document["traceEvents"])
      if (e["name"] == name && e["ph"] == phase) return e;
    FAIL("no event " << name);
    return document;
  };
  const auto test = [&](Json& d) -> Json& { return find(d, "face test", "X"); };
  const auto refine = [&](Json& d) -> Json& { return find(d, "refine", "X"); };
  const std::pair<const char*, std::function<void(Json&)>> breaks[] = {
      {"no metadata", [](Json& d) { d.erase("metadata"); }},
      {"no events", [](Json& d) { d.erase("traceEvents"); }},
      {"a slice without duration", [&](Json& d) { test(d).erase("dur"); }},
      {"a counter with a duration", [&](Json& d) { find(d, "work", "C")["dur"] = 1; }},
      {"a flow without id", [&](Json& d) { find(d, "cause", "s").erase("id"); }},
      {"another phase", [&](Json& d) { test(d)["ph"] = "B"; }},
      {"an unknown kind", [&](Json& d) { test(d)["name"] = "box test"; }},
      {"an unknown meet", [&](Json& d) { test(d)["args"]["meet"] = "yes"; }},
      {"a negative simplex", [&](Json& d) { test(d)["args"]["simplex of A"] = -1; }},
      {"a depth beyond 16 bits", [&](Json& d) { test(d)["args"]["depth of B"] = 65536; }},
      {"an unknown argument", [&](Json& d) { refine(d)["args"]["colour"] = 1; }},
      {"another format", [](Json& d) { d["metadata"]["format"] = "other"; }},
      {"a newer version", [](Json& d) { d["metadata"]["version"] = 6; }},
      {"a contact without simplex",
       [&](Json& d) { find(d, "contact", "X")["args"].erase("real simplex of A"); }},
      {"a certificate of one body",
       [](Json& d) {
         d["metadata"]["steps"][0]["result"]["separation"] = {{"faces", {1, 2}}, {"refined", {{1}}}};
       }},
      {"a short hash", [](Json& d) { d["metadata"]["bodies"][0]["hash"] = "abc"; }},
      {"a fourth dimension", [](Json& d) { d["metadata"]["bodies"][1]["dim"] = 4; }},
      {"a pose of 11 numbers", [](Json& d) { d["metadata"]["steps"][0]["pose_b"].erase(0); }},
      {"an unknown relation", [](Json& d) { d["metadata"]["steps"][0]["result"]["relation"] = "near"; }},
  };
  REQUIRE(test::trace_faults(good) == "");
  for (const auto& broken : breaks) {
    CAPTURE(broken.first);
    Json bad = good;
    broken.second(bad);
    CHECK(test::trace_faults(bad) != "");
  }
}
