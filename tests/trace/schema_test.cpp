/// Traces against the schema in the repository, by an independent validator.

#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/support/trace_schema.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;
using Json = nlohmann::json;
using namespace nlohmann::literals;

TEST_CASE("reasons of undecided clashes are those of the schema, which may be words of earlier versions") {
  Json run = Json::parse(trace_to_json(runs::record(runs::box(), runs::box(), runs::kBoxPoses).trace));
  Json::json_pointer place(
      "/definitions/time_step/properties/result/properties/clash/properties/reason/enum");
  std::set<ClashReason> seen;
  for (const Json& word : test::trace_schema()[place]) {
    Json& clash = run["metadata"]["steps"][0]["result"]["clash"];
    clash = R"({"kind": "undecided", "shares_faces": false, "distance": [0, 0], "course": []})"_json;
    clash["reason"] = word;
    CHECK(test::trace_faults(run) == "");
    seen.insert(trace_from_json(run.dump(), "old").steps[0].result.clash.value().reason);
  }
  CHECK(seen.size() == kEnumNames<ClashReason>.size() - 1);  // all but none
}
