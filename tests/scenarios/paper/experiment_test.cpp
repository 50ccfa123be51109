/// The paper's experiment as a file, and close-ups of single collisions.

#include "scenarios/paper/experiment.hpp"

#include <numeric>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/paper/paper_pictures.hpp"
#include "scenarios/paper/sweep.hpp"
#include "tests/support/json_schema.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/counters.hpp>

using namespace lrb;
using nlohmann::json;

namespace {

bool schema_accepts_experiment(const std::string& text) {
  const json document = json::parse(io::embedded_file("experiment.schema.json"));
  const json scenario = json::parse(io::embedded_file("scenario.schema.json"));
  return test::schema_faults(document, json::parse(text), scenario).empty();
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

TEST_CASE("an experiment with a 2D body is rejected") {
  std::vector<std::string> notes;
  CHECK_THROWS_WITH_AS(paper::make_objects(paper::parse_experiment(
                                               R"({"name": "n", "purpose": "p", "protocol": {"collisions": 3},
        "objects": [{"name": "A", "body": {"generator": "rock"}}, {"name": "B", "body": {"generator": "island"}}]})",
                                               "e"),
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

TEST_CASE("a close-up is the recorded collision, event by event") {
  const auto objects = small_objects();
  paper::SweepOptions sweep;
  sweep.protocol.collisions = 3;
  const auto records = paper::run_sweep(objects, sweep);
  const paper::PaperPair pair{objects[0], objects[1]};
  const paper::CloseUp c = paper::close_up(pair, 1, sweep.protocol);
  std::uint64_t sum = 0;
  for (const paper::ContactStep& s : records) sum += s.collision == 1 ? s.counts[0].comparisons : 0;
  CHECK(c.comparisons == sum);
  CHECK(trace::count_events(c.trace.events).face_tests == sum);
  for (const Side side : {Side::a, Side::b}) {
    const auto tests = trace::count_faces(pair.rep(side), side, c.trace.events).tests;
    CHECK(std::accumulate(tests.begin(), tests.end(), std::uint64_t{0}) == sum);
  }
}
