/// The tables of fields and words against the published schema, and against all that is made from them.

#include <limits>
#include <set>
#include <string>
#include <type_traits>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/support/trace_schema.hpp"
#include "tests/trace/runs.hpp"
#include <lrbscope/trace/divergence.hpp>
#include <lrbscope/trace/record_fields.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;
using Json = nlohmann::json;
using test::words;
using namespace nlohmann::literals;

namespace {

Json resolved(const Json& node) {
  if (!node.contains("$ref")) return node;
  return test::trace_schema().at(Json::json_pointer(node.at("$ref").get<std::string>().substr(1)));
}

/// The schema of a field, by its type.
template <class Value>
void check_type(const Json& field, Form form) {
  if constexpr (std::is_enum_v<Value>)
    CHECK(field.at("enum") == words<Value>());
  else if constexpr (std::is_same_v<Value, bool>)
    CHECK(field.at("type") == "boolean");
  else if constexpr (std::is_same_v<Value, std::string>)
    CHECK(field.at("type") == "string");
  else if constexpr (std::is_same_v<Value, double>)
    CHECK((form == Form::or_infinite ? field.at("oneOf").at(0) : field).at("type") == "number");
  else if constexpr (std::is_integral_v<Value>)
    CHECK((form == Form::hash || field.contains("enum") || field.at("type") == "integer"));
}

template <class Record>
void check_schema(const std::string& pointer) {
  CAPTURE(pointer);
  const Json& object = test::trace_schema().at(Json::json_pointer(pointer));
  std::set<std::string> fields, required;
  for_each_field<Record>([&](const auto& f) {
    const std::string name(f.name);
    CAPTURE(name);
    fields.insert(name);
    if (f.kept == Kept::always) required.insert(name);
    REQUIRE(object.at("properties").contains(name));
    using Value = std::remove_cvref_t<decltype(Record{}.*f.member)>;
    check_type<Value>(resolved(object.at("properties").at(name)), f.form);
  });
  std::set<std::string> known;
  for (const auto& [name, value] : object.at("properties").items()) known.insert(name);
  CHECK(known == fields);
  CHECK(object.at("required").get<std::set<std::string>>() == required);
}

/// Makes a value another one.
template <class Value>
void change(Value& value) {
  if constexpr (std::is_enum_v<Value>)
    value = value == Value{} ? static_cast<Value>(1) : Value{};
  else if constexpr (std::is_same_v<Value, bool>)
    value = !value;
  else if constexpr (std::is_same_v<Value, std::string>)
    value += "x";
  else if constexpr (std::is_same_v<Value, std::vector<std::uint32_t>>)
    value.push_back(7);
  else if constexpr (std::is_same_v<Value, std::optional<Separation>>)
    value = Separation{{{{0}, {}}}, {7, 6}};
  else if constexpr (std::is_same_v<Value, std::optional<MeasuredDistance>>)
    value = MeasuredDistance{0.25,
                             0.5,
                             true,
                             {{{1, -2, 3}, {4, 5, 6}}},
                             {{1, 0, std::numeric_limits<double>::infinity()}, {2, 0.25, 0.5}}};
  else if constexpr (std::is_same_v<Value, std::optional<MeasuredClash>>)
    value = MeasuredClash{ClashKind::undecided,
                          ClashReason::b_overlaps,
                          true,
                          {0, 0},
                          {{0.25, std::numeric_limits<double>::infinity()}},
                          {{0.125, 0.126}},
                          {0, -1, 2},
                          {{1, 0.1, 0.5}},
                          false};
  else if constexpr (std::is_same_v<Value, std::optional<MeasuredNearPairs>>)
    value = MeasuredNearPairs{{3}, 0.5, {{7, 8, 0.25, 0.375, {{{1, -2, 3}, {4, 5, 6}}}}}};
  else if constexpr (std::is_same_v<Value, std::optional<MeasuredManifolds>>)
    value = MeasuredManifolds{0.5, 2, 3, {{1ULL << 33, 1, -0.25, {0, 0, 1}, {{{1, -2, 3}, {4, 5, 6}}}}}};
  else if constexpr (std::is_same_v<Value, std::optional<MeasuredPoints>>)
    value = MeasuredPoints{4, 1, 2, true, {{3, 8, -0.25, -0.125, {{{1, -2, 3}, {4, 5, 6}}}}}};
  else if constexpr (std::is_same_v<Value, std::optional<EngineReport>>)
    value = EngineReport{EngineQuery::self, EngineVerdict::intersecting, 7, false, 2, 3, 4, {}, {}};
  else if constexpr (std::is_same_v<Value, Counters>)
    ++value.box_tests;
  else
    value = static_cast<Value>(value + 1);
}

Trace read_back(const Trace& trace) {
  return trace_from_json(trace_to_json(trace), "t.json");
}

Trace plain_box_run() {
  const LrbRep box(toy::dented_box());
  return runs::record(box, box, runs::kBoxPoses).trace;
}

}  // namespace

TEST_CASE("the tables have the fields and words of the published schema") {
  check_schema<CollideRequest>("/definitions/request");
  check_schema<Counters>("/definitions/counters");
  check_schema<BodyInfo>("/definitions/body");
  check_schema<StepResult>("/definitions/time_step/properties/result");
  CHECK(test::trace_schema().at("/definitions/relation/enum"_json_pointer) == words<Relation>());
  CHECK(test::trace_schema().at("/definitions/meet/enum"_json_pointer) == words<exact::Meet>());
  CHECK(test::trace_schema().at("/definitions/side/enum"_json_pointer) == words<Side>());
  CHECK(test::trace_schema().at("/definitions/metadata/properties/clock/enum"_json_pointer) ==
        words<Clock>());
  std::vector<std::string> of_faces = words<EventKind>();
  of_faces.resize(static_cast<std::size_t>(EventKind::result) +
                  1);  // the others are there from EventLevel::nodes on
  CHECK(test::trace_schema().at("/definitions/metadata/properties/totals/required"_json_pointer) == of_faces);
  CHECK(test::trace_schema().at("/definitions/phase/enum"_json_pointer) == words<Phase>());
  CHECK(test::trace_schema().at("/definitions/box_axis/enum"_json_pointer) == words<BoxAxis>());
  CHECK(test::trace_schema().at("/definitions/stage/enum"_json_pointer) == words<BuildStage>());
  CHECK(test::trace_schema().at("/definitions/verdict/enum"_json_pointer) == words<CapVerdict>());
}

TEST_CASE("every changed field of a request is detected and read back") {
  const Trace x = plain_box_run();
  for_each_field<CollideRequest>([&](const auto& field) {
    CAPTURE(field.name);
    Trace y = x;
    change(y.header.request.*field.member);
    CHECK_FALSE(x == y);
    const auto d = first_divergence(x, y);
    REQUIRE(d);
    CHECK(d->message().starts_with("run: request: " + std::string(field.name) + ": expected "));
    CHECK(read_back(y).header.request == y.header.request);
  });
}

TEST_CASE("every changed field of an answer is detected and read back") {
  Trace x = plain_box_run();
  x.header.request.tolerance = 1;  // or error bounds are not kept
  for_each_field<StepResult>([&](const auto& field) {
    CAPTURE(field.name);
    Trace y = x;
    change(y.steps[1].result.*field.member);
    CHECK_FALSE(x == y);
    const auto d = first_divergence(x, y);
    REQUIRE(d);
    CHECK(d->message().starts_with("step 1: "));
    CHECK(d->message().find(field.name == "counters" ? "counter box_tests" : field.name) !=
          std::string::npos);
    if (field.name == "separation") return;  // its region is checked against the body's
    CHECK(read_back(y) == y);
  });
  for_each_field<Counters>([&](const auto& field) {
    CAPTURE(field.name);
    Trace y = x;
    change(y.steps[1].result.counters.*field.member);
    const auto d = first_divergence(x, y);
    REQUIRE(d);
    CHECK(d->message().starts_with("step 1: counter " + std::string(field.name)));
    CHECK(read_back(y) == y);
  });
  for_each_field<BodyInfo>([&](const auto& field) {
    CAPTURE(field.name);
    Trace y = x;
    change(y.header.bodies[1].*field.member);
    if (field.name == "dim") y.header.bodies[1].dim = 2;
    CHECK_FALSE(x == y);
    CHECK(read_back(y) == y);
  });
}

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
