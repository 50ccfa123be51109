/// The paper's experiment as a file, and close-ups of single collisions.

#include "scenarios/paper/experiment.hpp"

#include <memory>
#include <numeric>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/paper/paper_pictures.hpp"
#include "scenarios/paper/sweep.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/counters.hpp>

using namespace lrb;
using lrb::test::count;
using nlohmann::json;

namespace {

bool schema_accepts_experiment(const std::string& text) {
  const json document = json::parse(io::embedded_file("experiment.schema.json"));
  const json scenario = json::parse(io::embedded_file("scenario.schema.json"));
  return test::schema_faults(document, json::parse(text), scenario).empty();
}

std::string experiment_error(const std::string& text) {
  try {
    paper::parse_experiment(text, "dir/e.json");
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

json good_experiment() {
  return json::parse(R"({"name": "n", "purpose": "p", "protocol": {"collisions": 3},
    "objects": [{"name": "A", "body": {"generator": "fractal", "parameters": {"real_faces": 144, "total_faces": 168}}},
                {"name": "rock", "body": {"generator": "rock", "parameters": {"frequency": 4}}}]})");
}

std::string experiment_with(const std::string& pointer, const json& value) {
  json e = good_experiment();
  e[json::json_pointer(pointer)] = value;
  return e.dump(1);
}

std::vector<paper::PaperObject> small_objects() {
  std::vector<paper::PaperObject> objects;
  for (const std::size_t i : {3u, 2u})
    objects.push_back(
        {generators::paper_objects()[i].name, generators::fractal_body(generators::paper_objects()[i])});
  return objects;
}

}  // namespace

TEST_CASE(
    "shipped experiments: valid according to schema and reader, with the numbers of paper and protocol") {
  const std::vector<std::string> names = paper::shipped_experiments();
  CHECK(names.size() == 5);
  for (const std::string& name : names) {
    CAPTURE(name);
    CHECK(schema_accepts_experiment(paper::shipped_experiment(name)));
    const paper::PaperExperiment e = paper::open_experiment(name);
    CHECK(e.name == name);
    CHECK(e.protocol.collisions == paper::PaperProtocol{}.collisions);
    CHECK(e.protocol.steps_after == paper::PaperProtocol{}.steps_after);
    CHECK(e.protocol.step == paper::PaperProtocol{}.step);
    CHECK(e.protocol.seed == paper::PaperProtocol{}.seed);
    CHECK(e.protocol.seeds == paper::PaperProtocol{}.seeds);
    if (name != "close_up") CHECK(e.objects.size() == generators::paper_objects().size());
    for (const paper::PaperExperiment::Object& o : e.objects) {
      const auto p = std::find_if(generators::paper_objects().begin(), generators::paper_objects().end(),
                                  [&](const generators::FractalSpec& s) { return s.name == o.name; });
      REQUIRE(p != generators::paper_objects().end());
      CHECK(o.body.generator == "fractal");
      CHECK(o.body.parameters.at("real_faces") == p->real_faces);
      CHECK(o.body.parameters.at("total_faces") == p->total_faces);
      CHECK(o.body.build.seed == p->seed);
    }
  }
  CHECK_FALSE(paper::open_experiment("table1").collides());
}

TEST_CASE("experiments: schema and reader agree on valid and invalid files") {
  json lone = good_experiment();
  lone["objects"].erase(1);
  lone["report"] = {"table1"};
  const std::string experiments[] = {
      good_experiment().dump(),
      lone.dump(),
      experiment_with("/name", "../n"),
      experiment_with("/protocl", 1),
      experiment_with("/protocol", json{{"collisions", 0}}),
      experiment_with("/protocol", json{{"collisions", 2.5}}),
      experiment_with("/protocol", json{{"step", 0}}),
      experiment_with("/protocol", json{{"steps_after", -1}}),
      experiment_with("/protocol", json{{"steps", 1}}),
      experiment_with("/protocol", json{{"seed", 7}, {"step", 0.01}, {"steps_after", 0}}),
      experiment_with("/protocol", json{{"seeds", 10}}),
      experiment_with("/protocol", json{{"seeds", 0}}),
      experiment_with("/protocol", json{{"seeds", 1001}}),
      experiment_with("/report", json::array()),
      experiment_with("/report", json{"table2", "settings", "heat_maps"}),
      experiment_with("/report", json{"table3"}),
      experiment_with("/report", json{"table1", "table1"}),
      experiment_with("/close_up", "rock"),
      experiment_with("/objects", json::array()),
      experiment_with("/objects/0/name", "A-B"),
      experiment_with("/objects/0/name", ""),
      experiment_with("/objects/0/body", json{{"file", "x.obj"}}),
      experiment_with("/objects/0/body", json{{"generator", "rok"}}),
      experiment_with("/objects/0/body", json{{"generator", "rock"}, {"pose", {{"degrees", 3}}}}),
      experiment_with("/objects/0/pose", json::object()),
  };
  for (const std::string& text : experiments) {
    CAPTURE(text);
    CAPTURE(experiment_error(text));
    CHECK(schema_accepts_experiment(text) == experiment_error(text).empty());
  }
}

TEST_CASE("experiments: errors name file, line, column and the nearest word") {
  CHECK(experiment_error("{\n \"name\": \"n\",\n \"purpos\": \"p\"}")
            .rfind("dir/e.json:3:2: /purpos: unknown key; did you mean \"purpose\"?", 0) == 0);
  CHECK(experiment_error(experiment_with("/close_up", "rok")).find("did you mean \"rock\"?") !=
        std::string::npos);
  CHECK(experiment_error(experiment_with("/objects/1/name", "A")).find("another object has the name A") !=
        std::string::npos);
  json lone = good_experiment();
  lone["objects"].erase(1);
  CHECK(experiment_error(lone.dump()).find("expected a second object") != std::string::npos);
  CHECK_THROWS_WITH_AS(paper::open_experiment("tabel1"), doctest::Contains("did you mean \"table1\"?"),
                       InputError);
  std::vector<std::string> notes;
  CHECK_THROWS_WITH_AS(
      paper::make_objects(
          paper::parse_experiment(experiment_with("/objects/1/body", json{{"generator", "island"}}), "e"),
          notes),
      doctest::Contains("expected a 3D body"), InputError);
}

TEST_CASE("easiest and hardest collision: by comparisons over all time steps; ties go to the first") {
  std::vector<paper::ContactStep> steps(5);
  const std::uint32_t collisions[] = {3, 3, 5, 7, 9}, comparisons[] = {10, 10, 15, 15, 20};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i].object = "C";
    steps[i].collision = collisions[i];
    steps[i].counts[0].comparisons = comparisons[i];
  }
  CHECK(paper::easiest_and_hardest(steps, "C") == std::array<std::uint32_t, 2>{5, 3});
  CHECK_THROWS_AS(paper::easiest_and_hardest(steps, "D"), InputError);
}

TEST_CASE("a close-up is the recorded collision, event by event; records of another one are rejected") {
  const auto objects = small_objects();
  paper::SweepOptions sweep;
  sweep.protocol.collisions = 3;
  const auto records = paper::run_sweep(objects, sweep);
  const paper::PaperPair pair{objects[0], objects[1]};
  const paper::CloseUp c = paper::close_up(pair, 1, sweep.protocol, records);
  std::uint64_t sum = 0;
  for (const paper::ContactStep& s : records) sum += s.collision == 1 ? s.counts[0].comparisons : 0;
  CHECK(c.comparisons == sum);
  CHECK(trace::count_events(c.trace.events).face_tests == sum);
  for (const Side side : {Side::a, Side::b}) {
    const auto tests = trace::count_faces(pair.rep(side), side, c.trace.events).tests;
    CHECK(std::accumulate(tests.begin(), tests.end(), std::uint64_t{0}) == sum);
  }
  paper::PaperProtocol other = sweep.protocol;
  other.seed = 2;
  CHECK_THROWS_WITH_AS(paper::close_up(pair, 1, other, records), doctest::Contains("another experiment"),
                       InputError);
}
