#include <algorithm>
#include <atomic>
#include <cmath>
#include <sstream>
#include <tuple>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/paper/series.hpp"
#include "scenarios/paper/tables.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>

using namespace lrb;
using nlohmann::json;

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

TEST_CASE("the paper's sweep: jobs and shards change nothing") {
  const auto objects = few_objects();
  paper::SweepOptions options = few_collisions();
  const std::string whole = paper::to_json_lines(paper::run_sweep(objects, options));
  options.jobs = 3;
  std::atomic<int> calls = 0;
  options.runner = [&](const paper::CollisionTask& task, Workspace& workspace) {
    ++calls;
    return paper::run(task, workspace);
  };
  CHECK(paper::to_json_lines(paper::run_sweep(objects, options)) == whole);
  CHECK(calls == 12);
  std::vector<paper::ContactStep> parts;
  for (std::uint32_t i = 0; i < 5; ++i) {
    options.shard = {4 - i, 5};
    for (paper::ContactStep& s : paper::run_sweep(objects, options)) parts.push_back(std::move(s));
  }
  CHECK(paper::to_json_lines(paper::merged(parts)) == whole);
  parts.push_back(parts.front());
  CHECK_THROWS_AS(paper::merged(parts), InputError);
}

TEST_CASE("the paper's sweep: every collision ends in contact, and the complete recursion misses nothing") {
  const auto objects = few_objects();
  const auto steps = paper::run_sweep(objects, few_collisions());
  std::vector<std::uint32_t> firsts;
  for (const paper::ContactStep& s : steps) {
    CHECK(s.step <= 5);
    CHECK((s.relation == Relation::crossing || s.relation == Relation::touching));
    CHECK(s.counts[2].missed == 0);
    CHECK(s.counts[2].pairs > 0);
    for (std::size_t i = 0; i < 2; ++i) CHECK(s.counts[i].pairs + s.counts[i].missed == s.counts[2].pairs);
    CHECK(s.counts[1].pairs <= s.counts[0].pairs);
    if (s.step == 0) firsts.push_back(s.collision);
  }
  CHECK(firsts.size() == 12);
}

TEST_CASE("the paper's records: round trip as JSON Lines; other lines are rejected by line") {
  const auto steps = paper::run_sweep(few_objects(), few_collisions());
  const std::string text = paper::to_json_lines(steps);
  CHECK(paper::to_json_lines(paper::read_json_lines(text, "r.jsonl")) == text);
  for (const std::string bad : {"{}", "[1]", "{\"object\":\"B\"", "\xff", ""}) {
    try {
      paper::read_json_lines(paper::to_json_lines({steps.data(), 2}) + bad + "\n", "r.jsonl");
      FAIL("accepted: " << bad);
    } catch (const InputError& e) {
      CHECK(std::string(e.what()).rfind("r.jsonl:3: ", 0) == 0);
    }
  }
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
  CHECK(objects[2].rep.real_face_count() == 500);
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

  const std::string growth = paper::growth_text({a, objects, steps});
  CHECK(growth.find("rock " + paper::power_text(*fits[3].comparisons) + ", to " +
                    paper::whole(rows[3].counts.recursions[0].comparisons.average) + " at n = ") !=
        std::string::npos);
  CHECK(growth.find("(complete: " + paper::power_text(*fits[5].comparisons)) != std::string::npos);

  auto again = steps;
  for (paper::ContactStep& s : again)
    for (paper::RecursionCount& n : s.counts) n.nanoseconds = 0;
  paper::read_times(paper::times_to_json_lines(steps), "t.jsonl", again);
  CHECK(paper::times_to_json_lines(again) == paper::times_to_json_lines(steps));
  CHECK_THROWS_AS(paper::read_times("{}\n", "t.jsonl", again), InputError);
  again.pop_back();
  CHECK_THROWS_AS(paper::read_times(paper::times_to_json_lines(steps), "t.jsonl", again), InputError);
  steps[0].object = "another/2000/A";
  CHECK_THROWS_AS(paper::series_rows(a, objects, steps), InputError);
}

namespace {

/// Small objects of the paper with its names, and a mesh.
void write_few(const test::Folder& folder) {
  json few = {{"name", "few"},
              {"purpose", "Few."},
              {"protocol", {{"collisions", 12}, {"seeds", 4}}},
              {"report", {"table1", "table2", "figure3.1", "figure3.2", "settings"}}};
  for (const std::size_t i : {3u, 1u, 2u}) {
    const generators::FractalSpec& o = generators::paper_objects()[i];
    few["objects"].push_back(
        {{"name", o.name},
         {"body",
          {{"generator", "fractal"},
           {"parameters", {{"real_faces", o.real_faces}, {"total_faces", o.total_faces}}}}}});
  }
  folder.write("few.json", few.dump());
  write_mesh(generators::generate("ball", {{"frequency", 4}}), folder / "ball.ply");
}

std::vector<std::string> few_command(const std::string& out, const std::string& jobs) {
  return {"paper", "--experiment", "few.json", "--meshes", "ball.ply", "--resolutions",
          "2",     "--jobs",       jobs,       "-o",       out};
}

std::vector<json> lines_of(const std::string& path) {
  std::istringstream in(test::slurp(path));
  std::vector<json> out;
  for (std::string line; std::getline(in, line);) out.push_back(json::parse(line));
  return out;
}

std::size_t line_count(const std::string& path) {
  const std::string text = test::slurp(path);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// Starts the program and ends it by a signal, once it has kept so many collisions.
void interrupt(const test::Folder& folder, const std::vector<std::string>& command, const char* signal,
               const std::string& file, std::size_t collisions) {
  std::string line = "cd '" + folder.path.string() + "' && env --default-signal=INT '" LRBSCOPE_BINARY "'";
  for (const std::string& word : command) line += " '" + word + "'";
  line += " >stdout 2>stderr </dev/null & pid=$!; while kill -0 $pid 2>/dev/null && [ $(cat '" +
          folder / file + "' 2>/dev/null | wc -l) -lt " + std::to_string(collisions + 1) +
          " ]; do sleep 0.01; done; kill -" + signal + " $pid; { wait $pid; } 2>/dev/null";
  CHECK(std::system(line.c_str()) != 0);
}

}  // namespace

TEST_CASE(
    "paper: an interrupted run goes on where it stopped, and gives the same bytes for any number of jobs") {
  const test::Folder folder;
  write_few(folder);
  REQUIRE(test::run(folder, few_command("whole", "1")).code == 0);
  CHECK(!std::filesystem::exists(folder / "whole/unfinished.jsonl"));
  const std::string kept = folder / "out/unfinished.jsonl";
  interrupt(folder, few_command("out", "2"), "INT", "out/unfinished.jsonl", 10);
  CHECK(test::slurp(folder / "stderr")
            .find("interrupted by SIGINT: finished collisions are kept in "
                  "out/unfinished.jsonl; the same command goes on from there\n") != std::string::npos);
  const std::size_t first = line_count(kept);
  CHECK(first > 10);
  interrupt(folder, few_command("out", "3"), "KILL", "out/unfinished.jsonl", first + 40);
  const std::size_t second = line_count(kept);
  CHECK(second > first + 40);
  // Other settings are refused, and nothing is lost.
  const std::string before = test::slurp(kept);
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"--seed", "2"}, {"--step", "0.01"}, {"--steps-after", "4"}}) {
    std::vector<std::string> command = few_command("out", "2");
    command.insert(command.end(), other.begin(), other.end());
    const test::Outcome o = test::run(folder, command);
    CHECK(o.code == 2);
    CHECK(o.error_lines() == 1);
    CHECK(o.err.find("out/unfinished.jsonl: belongs to an interrupted run with other settings") !=
          std::string::npos);
  }
  CHECK(test::slurp(kept) == before);
  // The first collision loses its last step, to see that it is not run again.
  {
    std::vector<json> lines = lines_of(kept);
    std::string text = before.substr(0, before.find('\n') + 1);
    for (std::size_t i = 1; i < lines.size(); ++i) {
      for (const char* key : {"records", "times"}) {
        std::string& records = lines[i][key].get_ref<std::string&>();
        records.pop_back();
        if (i == 1) records.resize(records.rfind('\n'));
        records += '\n';
      }
      text += lines[i].dump() + "\n";
    }
    std::filesystem::copy(folder / "out", folder / "marked");
    folder.write("marked/unfinished.jsonl", text + "{\"collision\": \"cut o");
  }
  REQUIRE(test::run(folder, few_command("marked", "2")).code == 0);
  CHECK(line_count(folder / "marked/records.jsonl") + line_count(folder / "marked/settings.jsonl") + 1 ==
        line_count(folder / "whole/records.jsonl") + line_count(folder / "whole/settings.jsonl"));

  const test::Outcome rest = test::run(folder, few_command("out", "2"));
  REQUIRE(rest.code == 0);
  CHECK(rest.err.find("continues an interrupted run, of which " + std::to_string(second - 1) +
                      " collisions") != std::string::npos);
  CHECK(!std::filesystem::exists(kept));
  for (const char* file : {"/records.jsonl", "/settings.jsonl", "/series.jsonl", "/series.json",
                           "/tables.json", "/table1.csv", "/table2.csv", "/ratios.csv", "/settings.csv"})
    CHECK(test::slurp(folder / (std::string("out") + file)) ==
          test::slurp(folder / (std::string("whole") + file)));
}
