#include <cmath>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/paper/series.hpp"
#include "scenarios/paper/tables.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;

namespace {

std::vector<paper::PaperObject> few_objects() {
  std::vector<paper::PaperObject> objects;
  for (const std::size_t i : {3u, 1u, 2u})
    objects.push_back(
        {generators::paper_objects()[i].name, generators::fractal_body(generators::paper_objects()[i])});
  return objects;
}

paper::SweepOptions few_collisions() {
  paper::SweepOptions o;
  o.protocol.collisions = 6;
  return o;
}

}  // namespace

TEST_CASE("the paper's sweep: every collision ends in contact, and the complete recursion misses nothing") {
  const auto objects = few_objects();
  const auto steps = paper::run_sweep(objects, few_collisions());
  std::vector<std::uint32_t> firsts;
  for (const paper::ContactStep& s : steps) {
    CHECK(s.step <= 5);
    CHECK((s.relation == Relation::crossing || s.relation == Relation::touching));
    CHECK(s.counts.back().missed == 0);
    CHECK(s.counts.back().pairs > 0);
    for (const paper::RecursionCount& n : s.counts) CHECK(n.pairs + n.missed == s.counts.back().pairs);
    CHECK(s.counts[1].pairs <= s.counts[0].pairs);
    if (s.step == 0) firsts.push_back(s.collision);
  }
  CHECK(firsts.size() == 12);
}

TEST_CASE("the paper's records: round trip as JSON Lines; other lines are rejected by line") {
  const auto steps = paper::run_sweep(few_objects(), few_collisions());
  const std::string text = paper::to_json_lines(steps);
  CHECK(paper::to_json_lines(paper::read_json_lines(text, "r.jsonl")) == text);
  for (const std::string bad : {"{}", "[1]", "{\"object\":\"B\"", "\xff", ""})
    CHECK(test::error_of([&] {
            return paper::read_json_lines(paper::to_json_lines({steps.data(), 2}) + bad + "\n", "r.jsonl");
          }).starts_with("r.jsonl:3: "));
}

TEST_CASE("the paper's tables: averages, and the paper's own columns") {
  const auto objects = few_objects();
  std::vector<paper::ContactStep> steps(3);
  for (std::size_t i = 0; i < 3; ++i) {
    steps[i].object = "B";
    steps[i].counts[0].comparisons = 10 * (i + 1);
    steps[i].counts[0].missed = i;
  }
  const auto rows = paper::make_table(objects, steps);
  REQUIRE(rows.size() == 2);
  CHECK(rows[0].object == "B");
  CHECK(rows[0].steps == 3);
  CHECK(rows[0].recursions[0].comparisons.min == 10);
  CHECK(rows[0].recursions[0].comparisons.average == 20);
  CHECK(rows[0].recursions[0].comparisons.max == 30);
  CHECK(rows[0].recursions[0].missed == 3);
  CHECK(rows[0].n_squared == 2532.0 * 168);
  CHECK(rows[1].steps == 0);
  const auto j = nlohmann::json::parse(paper::tables_json(objects, {{paper::Run{{}, rows}}}, {}));
  CHECK(j["table1_object_sizes"]["D"]["total_faces"] == 2532);
  CHECK(j["table2_face_comparisons_of_object_A_with"]["B"]["avg"] == 20);
  CHECK(j["table2_face_comparisons_of_object_A_with_complete"].contains("C"));
}

TEST_CASE("the paper's experiment: approved counts") {
  const LrbRep a = generators::fractal_body(generators::paper_objects()[0]),
               e = generators::fractal_body(generators::paper_objects()[4]);
  Workspace workspace;
  const auto steps = paper::run_collision(a, e, "E", 0, {}, workspace);
  REQUIRE(steps.size() == 6);
  CHECK(steps[5].counts[0].comparisons == 994);
  CHECK(steps[5].counts[1].comparisons == 685);
  CHECK(steps[5].counts.back().comparisons == 369);
}

TEST_CASE("the series: exact powers are recovered, and the errors of others") {
  const double x[] = {1, 10, 100, 1000}, exact[] = {3, 3 * std::sqrt(10.0), 30, 30 * std::sqrt(10.0)};
  CHECK(resolutions::fit_power(x, exact).exponent == doctest::Approx(0.5));
  CHECK(resolutions::fit_power(x, exact).factor == doctest::Approx(3));
  CHECK(resolutions::fit_power(x, exact).error < 1e-7);
  // By hand: logarithms to base 10 are 0, 1, 1, 2 at 0, 1, 2, 3: slope 0.6, residuals -0.1, 0.3, -0.3, 0.1,
  // error sqrt(0.2 / 2 / 5).
  const double y[] = {1, 10, 10, 100};
  CHECK(resolutions::fit_power(x, y).exponent == doctest::Approx(0.6));
  CHECK(resolutions::fit_power(x, y).error == doctest::Approx(std::sqrt(0.02)));
}

TEST_CASE("the series: rows and powers from records; records of other bodies are rejected") {
  const LrbRep a = generators::fractal_body(generators::paper_objects()[1]);
  const Mesh rock = [] {
    Mesh m = generators::generate("rock", {{"frequency", 10}});
    m.name = "rock";
    return m;
  }();
  const auto objects = paper::make_series({&rock, 1}, {0, 3, 100}, {}, paper::diagonal(a), {});
  REQUIRE(objects.size() == 3);
  BuildOptions lean;
  lean.lean = true;
  const auto leaner = paper::make_series({&rock, 1}, {0, 1, 100}, lean, paper::diagonal(a), {});
  CHECK(leaner[0].rep.real_face_count() == 2000);
  CHECK(leaner[0].rep.face_count() < objects[0].rep.face_count());
  CHECK(objects[0].rep.real_face_count() == 2000);
  CHECK(objects[2].rep.real_face_count() <= 500);
  CHECK(objects[2].rep.real_face_count() > 400);
  CHECK(paper::diagonal(objects[2].rep) == doctest::Approx(paper::diagonal(a)));
  CHECK(resolutions::resolution_sizes(rock, {0, 3, 100}) == std::vector<std::uint32_t>{2000, 1000, 500});
  CHECK(resolutions::resolution_sizes(rock, {1, 9, 3000}) == std::vector<std::uint32_t>{8000, 4000});
  paper::SweepOptions options;
  options.protocol.collisions = 3;
  auto steps = paper::run_series(a, objects, options);
  const std::string whole = paper::to_json_lines(steps);
  options.jobs = 3;
  CHECK(paper::to_json_lines(paper::run_series(a, objects, options)) == whole);
  const auto rows = paper::series_rows(a, objects, steps);
  REQUIRE(rows.size() == 6);
  for (const paper::SeriesRow& row : rows) {
    CHECK(row.counts.steps == 18);
    CHECK(row.counts.recursions.back().missed == 0);
    CHECK(row.microseconds.back() > 0);
  }
  CHECK(rows[3].partner == paper::SeriesPartner::itself);
  CHECK(rows[3].counts.n_squared == std::pow(rows[0].counts.total_faces, 2));
  const auto fits = paper::series_fits(rows);
  REQUIRE(fits.size() == 6);
  CHECK(fits[5].comparisons->exponent > 0.1);  // complete, against itself: about the square root
  CHECK(fits[5].comparisons->exponent < 0.9);

  const std::string timed = paper::to_json_lines(steps, true);
  CHECK(paper::to_json_lines(paper::read_json_lines(timed, "kept.jsonl"), true) == timed);
  steps[0].object = "another/2000/A";
  CHECK_THROWS_AS(paper::series_rows(a, objects, steps), InputError);
}
