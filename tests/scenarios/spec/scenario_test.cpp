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

namespace {

/// Whether an independent validator accepts a scenario by our schema.
bool schema_accepts(const std::string& text) {
  static const json document = json::parse(io::embedded_file("scenario.schema.json"));
  return test::schema_faults(document, json::parse(text)).empty();
}

std::string error_of(const std::string& text) {
  try {
    spec::parse_scenario(text, "dir/s.json");
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

/// A good scenario to spoil.
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

template <class Enum>
json words() {
  json out = json::array();
  for (const EnumName<Enum>& entry : kEnumNames<Enum>) out.push_back(entry.name);
  return out;
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
  CHECK(at("/definitions/frames/properties/at") == words<render::FrameSpec::At>());
  CHECK(at("/definitions/frames/properties/colour_by") == words<render::FrameSpec::ColourBy>());
  CHECK(at("/definitions/frames/properties/colour_per") == words<render::FrameSpec::ColourPer>());
  CHECK(at("/definitions/view/properties/camera") == words<render::FrameSpec::Camera>());
  json kinds = json::array();
  for (const json& kind : document["definitions"]["motion"]["oneOf"])
    kinds.push_back(kind["properties"]["kind"]["const"]);
  CHECK(kinds == words<spec::Motion::Kind>());
}

TEST_CASE("schema and reader agree on valid and invalid files") {
  const std::string scenarios[] = {
      good().dump(),
      with("/name", "../escape"),
      with("/seed", -1),
      with("/motoin", 1),
      with("/show", "refinement"),
      with("/bodies/a/generator", "bal"),
      with("/bodies/a/file", "x.obj"),
      with("/bodies/b/parameters/frequency", "3"),
      with("/bodies/b", json{{"generator", "fractal"}, {"build", {{"patch_interior", 3}}}}),
      with("/bodies/a/pose", json{1, 2, 3}),
      with("/motion/from", json{1, 2}),
      with("/motion", json{{"kind", "sweep"}, {"from", {1, 2, 3}}, {"to", {0, 0, 0}}}),
      with("/motion", json{{"kind", "spin"}}),
      with("/motion", json{{"kind", "keyframes"}, {"keyframes", {{{"step", 0}, {"position", {0, 0, 0}}}}}}),
      with("/query", json{{"recursion", "paper"}, {"wrapper", "unregularised"}}),
      with("/query", json{{"recursion", "papr"}}),
      with("/query", json{{"tolerance", 0.1}, {"max_tests", 200}, {"separation", true}}),
      with("/query", json{{"separation", true}, {"recursion", "paper"}}),
      with("/query", json{{"tolerance", -0.1}}),
      with("/query", json{{"max_tests", 0}}),
      with("/query", json{{"max_time", 1}}),
      with("/query", json{{"max_pairs", 0}}),
      with("/query", json{{"tolerance", 0.1}, {"contacts", true}}),
      with("/query", json{{"tolerance", 0.1}, {"recursion", "paper"}}),
      with("/query", json{{"tolerance", 0.1}, {"wrapper", "unregularised"}}),
      with("/expect", json::array({{{"step", 3}, {"relation", "unresolved"}}})),
      with("/trace", json{{"clock", "wall"}, {"gzip", true}, {"max_events", 10}}),
      with("/frames",
           json{{"at", "refinement"}, {"every", 3}, {"size", {320, 200}}, {"montage", {{"panels", 4}}}}),
      with("/frames", json{{"dpi", 300}, {"format", "svg"}, {"transparent", true}}),
      with("/frames", json{{"style", "dark"}}),
      with("/frames", json{{"format", "gif"}}),
      with("/frames", json{{"size", {32, 200}}}),
      with("/frames", json{{"views", json::array()}}),
      with("/expect", json::array({{{"step", 3},
                                    {"relation", "crossing"},
                                    {"pairs", 4},
                                    {"fingerprint", "cbf29ce484222325"},
                                    {"max_tests", 100}}})),
      with("/expect", json::array({{{"step", 3}, {"relation", "cross"}}})),
  };
  for (const std::string& text : scenarios) {
    CAPTURE(text);
    CAPTURE(error_of(text));
    CHECK(schema_accepts(text) == error_of(text).empty());
  }
}

TEST_CASE("errors name file, line, column and the nearest known word") {
  CHECK(error_of("{\n \"name\": \"n\",\n \"purpos\": \"p\"}")
            .rfind("dir/s.json:3:2: /purpos: unknown key; did you mean \"purpose\"?", 0) == 0);
  const std::string kind = error_of(with("/motion/kind", "aproach"));
  CHECK(kind.find("/motion/kind: \"aproach\": unknown word; did you mean \"approach\"?") !=
        std::string::npos);
  const std::string generator = error_of(with("/bodies/a/generator", "bal"));
  CHECK(generator.find("did you mean \"ball\"?") != std::string::npos);
  const std::string parameter = error_of(with("/bodies/b/parameters/freqency", 3));
  CHECK(parameter.find("did you mean \"frequency\"?") != std::string::npos);
  CHECK(error_of(with("/bodies/a/pose", json{1, 2, 3})).find("expected 12 numbers, found 3") !=
        std::string::npos);
}

TEST_CASE("minimal scene queries: read unchanged, or rejected in one line") {
  const CollideRequest r =
      spec::parse_scenario(
          with("/query", json{{"tolerance", 0.25}, {"max_tests", 200}, {"separation", true}}), "s")
          .request;
  CHECK(r.tolerance == 0.25);
  CHECK(r.max_tests == 200);
  CHECK(r.separation);
  CHECK(!r.contacts);  // which exact queries have by default
  CHECK(spec::parse_scenario(with("/query", json{{"separation", true}}), "s").request.contacts);
  const auto error = [](const json& query) { return error_of(with("/query", query)); };
  CHECK(
      error({{"max_time", 2}})
          .find(
              "/query/max_time: a time limit would make the trace differ from run to run; use max_tests instead") !=
      std::string::npos);
  CHECK(error({{"tolerance", -1}}).find("/query/tolerance: expected a number from 0 to ") !=
        std::string::npos);
  CHECK(error({{"tolerence", 1}}).find("unknown key; did you mean \"tolerance\"?") != std::string::npos);
  CHECK(error({{"tolerance", 1}, {"contacts", true}})
            .find("/query: contacts and interiors_overlap are exact") != std::string::npos);
  CHECK(error({{"max_tests", 9}, {"recursion", "paper"}}).find("requires recursion") != std::string::npos);
}

TEST_CASE("body files are looked up from the scenario's folder") {
  json s = good();
  s["bodies"]["a"] = {{"file", "../meshes/x.obj"}};
  CHECK(spec::parse_scenario(s.dump(), "some/dir/s.json").bodies[0].file == "some/meshes/x.obj");
}

TEST_CASE("a word that is neither scenario nor file gets a suggestion") {
  CHECK_THROWS_WITH_AS(spec::open_scenario("colision"), doctest::Contains("did you mean \"collision\"?"),
                       InputError);
  CHECK_THROWS_AS(spec::open_scenario("no/such/file.json"), InputError);
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
