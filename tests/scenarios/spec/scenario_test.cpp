#include "scenarios/spec/scenario.hpp"

#include <string>
#include <type_traits>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/io/files.hpp"
#include "tests/support/json_schema.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/record_fields.hpp>

using namespace lrb;
using nlohmann::json;
using test::words;

namespace {

/// Whether an independent validator accepts a scenario by our schema.
bool schema_accepts(const std::string& text) {
  static const json document = json::parse(io::embedded_file("scenario.schema.json"));
  return test::schema_faults(document, json::parse(text)).empty();
}

/// A good scenario.
json good() {
  return json::parse(R"({"name": "n", "purpose": "p",
    "bodies": {"a": {"generator": "ball"}, "b": {"generator": "rock", "parameters": {"frequency": 3}}},
    "motion": {"kind": "approach", "from": [3, 0, 0]}})");
}

std::string with(const std::string& pointer, const json& value) {
  json s = good();
  s[json::json_pointer(pointer)] = value;
  return s.dump(1);
}

}  // namespace

TEST_CASE("every shipped scenario is valid according to schema and reader, and states its purpose") {
  int count = 0;
  for (const io::EmbeddedFile& file : io::embedded_files()) {
    if (!file.name.ends_with(".scenario.json")) continue;
    CAPTURE(std::string(file.name));
    CHECK(schema_accepts(std::string(file.text)));
    const spec::Scenario s = spec::parse_scenario(std::string(file.text), std::string(file.name));
    CHECK(s.name + ".scenario.json" == file.name);
    CHECK(s.purpose.size() > 30);
    ++count;
  }
  CHECK(count >= 6);
}

TEST_CASE("a scenario's query has the fields and enumerators of requests") {
  const json document = json::parse(io::embedded_file("scenario.schema.json"));
  json keys = json::object();
  const json& query = document["properties"]["query"]["properties"];
  for_each_field<CollideRequest>([&](const auto& field) {
    const std::string name(field.name);
    CAPTURE(name);
    if (name == "max_time") return;  // differs from run to run
    keys[name] = query.at(name);
    using Value = std::remove_cvref_t<decltype(CollideRequest{}.*field.member)>;
    if constexpr (std::is_enum_v<Value>) CHECK(query.at(name).at("enum") == words<Value>());
  });
  // The sequence of steps, and the other queries.
  for (const char* key : {"coherent", "distance", "clash", "near", "manifold", "points"})
    keys[key] = query.at(key);
  CHECK(keys == query);
  const auto at = [&](const char* pointer) { return document.at(json::json_pointer(pointer)).at("enum"); };
  CHECK(at("/properties/show") == words<spec::Show>());
  CHECK(at("/properties/trace/properties/clock") == words<trace::Clock>());
  CHECK(at("/properties/expect/items/properties/relation") == words<Relation>());
  CHECK(at("/definitions/frames/properties/at") == words<pictures::FrameSpec::At>());
  CHECK(at("/definitions/frames/properties/colour_by") == words<pictures::FrameSpec::ColourBy>());
  CHECK(at("/definitions/frames/properties/colour_per") == words<pictures::FrameSpec::ColourPer>());
  CHECK(at("/definitions/view/properties/camera") == words<pictures::FrameSpec::Camera>());
  json kinds = json::array();
  for (const json& kind : document["definitions"]["motion"]["oneOf"])
    kinds.push_back(kind["properties"]["kind"]["const"]);
  CHECK(kinds == words<spec::Motion::Kind>());
}

TEST_CASE("minimal scene queries are read unchanged") {
  const CollideRequest r =
      spec::parse_scenario(
          with("/query", json{{"tolerance", 0.25}, {"max_tests", 200}, {"separation", true}}), "s")
          .request;
  CHECK(r.tolerance == 0.25);
  CHECK(r.max_tests == 200);
  CHECK(r.separation);
  CHECK(!r.contacts);  // which exact queries have by default
  CHECK(spec::parse_scenario(with("/query", json{{"separation", true}}), "s").request.contacts);
}

TEST_CASE("body files are looked up from the scenario's folder") {
  json s = good();
  s["bodies"]["a"] = {{"file", "../meshes/x.obj"}};
  CHECK(spec::parse_scenario(s.dump(), "some/dir/s.json").bodies[0].file == "some/meshes/x.obj");
}

TEST_CASE("motions pass through their key poses") {
  spec::Motion m;
  m.kind = spec::Motion::Kind::sweep;
  m.from = {0, 0, 0};
  m.to = {4, 0, 2};
  m.steps = 5;
  const std::vector<Pose> sweep = spec::poses_of(m, Pose{});
  REQUIRE(sweep.size() == 5);
  CHECK(sweep.front().t == Eigen::Vector3d(0, 0, 0));
  CHECK(sweep[2].t == Eigen::Vector3d(2, 0, 1));
  CHECK(sweep.back().t == Eigen::Vector3d(4, 0, 2));
  CHECK(sweep[2].r == Eigen::Matrix3d::Identity());

  m.kind = spec::Motion::Kind::keyframes;
  m.keyframes = {{0, {0, 0, 0}, {0, 0, 1}, 0}, {4, {4, 0, 0}, {0, 0, 1}, 90}};
  const std::vector<Pose> keys = spec::poses_of(m, Pose{});
  REQUIRE(keys.size() == 5);
  CHECK(keys[2].t.x() == doctest::Approx(2));
  CHECK(keys[2].r(0, 0) == doctest::Approx(std::sqrt(0.5)));
  CHECK(keys[4].r(1, 0) == doctest::Approx(1));

  m.kind = spec::Motion::Kind::spin;
  m.degrees = 360;
  m.steps = 4;
  const std::vector<Pose> spin = spec::poses_of(m, Pose::translation({1, 2, 3}));
  REQUIRE(spin.size() == 4);
  CHECK(spin[1].t.x() == doctest::Approx(-2));  // the body's own pose comes first, the motion after it
}
