#include <cmath>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/bodies/generators.hpp"
#include "scenarios/paper/series_report.hpp"
#include "scenarios/paper/tables.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>

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

TEST_CASE("the paper's sweep: jobs and shards change nothing") {
  const auto objects = few_objects();
  paper::SweepOptions options = few_collisions();
  const std::string whole = paper::to_json_lines(paper::run_sweep(objects, options, {}));
  options.jobs = 3;
  std::uint64_t calls = 0;
  CHECK(paper::to_json_lines(paper::run_sweep(
            objects, options, [&](std::uint64_t, std::uint64_t of) { calls += of == 12; })) == whole);
  CHECK(calls == 12);
  std::vector<paper::ContactStep> parts;
  for (std::uint32_t i = 0; i < 5; ++i) {
    options.shard = {4 - i, 5};
    for (paper::ContactStep& s : paper::run_sweep(objects, options, {})) parts.push_back(std::move(s));
  }
  CHECK(paper::to_json_lines(paper::merged(parts)) == whole);
  parts.push_back(parts.front());
  CHECK_THROWS_AS(paper::merged(parts), InputError);
}

TEST_CASE("the paper's sweep: every collision ends in contact, and the complete recursion misses nothing") {
  const auto objects = few_objects();
  const auto steps = paper::run_sweep(objects, few_collisions(), {});
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
  const auto steps = paper::run_sweep(few_objects(), few_collisions(), {});
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
  const auto j = nlohmann::json::parse(paper::tables_json(objects, rows, {}));
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
  CHECK(steps[5].counts[0].comparisons == 879);
  CHECK(steps[5].counts[1].comparisons == 133);
  CHECK(steps[5].counts[2].comparisons == 466);
}

TEST_CASE("paper: the program's shards make the report of the whole, and bad input is refused") {
  const test::Folder folder;
  const auto run = [&](std::vector<std::string> args) {
    args.insert(args.begin(), "paper");
    return test::run(folder, args);
  };
  const auto shard = [&](const char* collisions, const std::string& i, const std::string& out) {
    CHECK(run({"--collisions", collisions, "--resolutions", "0", "--shard", i, "-o", out}).code == 0);
  };
  CHECK(run({"--collisions", "2", "--resolutions", "0", "-o", "whole", "--jobs", "2"}).code == 0);
  shard("2", "0/2", "part0");
  shard("2", "1/2", "part1");
  shard("3", "1/2", "other");
  CHECK(run({"--merge", "part1/records.jsonl", "part0/records.jsonl", "-o", "all"}).code == 0);
  for (const char* file : {"/records.jsonl", "/tables.json"})
    CHECK(test::slurp(folder / (std::string("all") + file)) ==
          test::slurp(folder / (std::string("whole") + file)));
  const auto rejected = [&](std::vector<std::string> args, const char* why) {
    args.insert(args.end(), {"-o", "none"});
    const auto o = run(args);
    CHECK(o.code == 2);
    CHECK(o.err.find(why) != std::string::npos);
  };
  rejected({"--merge", "part1/records.jsonl", "part1/records.jsonl"}, "shard 0/2 is missing");
  rejected({"--merge", "part0/records.jsonl", "part1/records.jsonl", "part1/records.jsonl"},
           "1/2 occurs twice");
  rejected({"--merge", "part1/records.jsonl"}, "shard 0/2 is missing");
  rejected({"--merge", "part0/records.jsonl", "other/records.jsonl"}, "another experiment");
  rejected({"--merge", "whole/records.jsonl"}, "whole/shard.json");
  rejected({"--collisions", "2", "--merge", "part0/records.jsonl"}, "--collisions");
  rejected({"--lean", "--merge", "part0/records.jsonl"}, "--lean");
  folder.write("part0/shard.json", "{\"shard\": -1}");
  rejected({"--merge", "part0/records.jsonl", "part1/records.jsonl"}, "part0/shard.json");
  for (const char* bad : {"2/2", "x", "1", "0/0", "-1/2", "0/2x"})
    CHECK(run({"--shard", bad, "-o", "none"}).code == 2);
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
  paper::SweepOptions options;
  options.protocol.collisions = 3;
  auto steps = paper::run_series(a, objects, options, {});
  const std::string whole = paper::to_json_lines(steps);
  options.jobs = 3;
  CHECK(paper::to_json_lines(paper::run_series(a, objects, options, {})) == whole);
  const auto rows = paper::series_rows(a, objects, steps);
  REQUIRE(rows.size() == 6);
  for (const paper::SeriesRow& row : rows) {
    CHECK(row.counts.steps == 18);
    CHECK(row.counts.recursions[2].missed == 0);
    CHECK(row.microseconds[2] > 0);
  }
  CHECK(rows[3].partner == paper::SeriesPartner::itself);
  CHECK(rows[3].counts.n_squared == std::pow(rows[0].counts.total_faces, 2));
  const auto fits = paper::series_fits(rows);
  REQUIRE(fits.size() == 6);
  CHECK(fits[5].comparisons->exponent > 0.1);  // complete, against itself: about the square root
  CHECK(fits[5].comparisons->exponent < 0.9);

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

TEST_CASE("paper: an interrupted run keeps the results of the objects, and goes on with the resolutions") {
  const test::Folder folder;
  write_mesh(generators::generate("ball", {{"frequency", 4}}), folder / "ball.ply");
  folder.write("few.json",
               R"({"name": "few", "purpose": "Few.", "report": ["table2"], "protocol": {"collisions": 2},
    "objects": [{"name": "A", "body": {"generator": "ball", "parameters": {"frequency": 3}}},
                {"name": "B", "body": {"generator": "rock", "parameters": {"frequency": 4}}}]})");
  const auto paper = [&](const std::string& out) {
    return test::run(folder, {"paper", "--experiment", "few.json", "--meshes", "ball.ply", "--resolutions",
                              "2", "-o", out});
  };
  REQUIRE(paper("whole").code == 0);
  CHECK(!std::filesystem::exists(folder / "whole/unfinished.jsonl"));
  // The run ends when it writes the series, because there is a folder of that name.
  std::filesystem::create_directories(folder / "out/series.jsonl/in the way");
  CHECK(paper("out").code != 0);
  CHECK(test::slurp(folder / "out/index.html").find("Table 2") != std::string::npos);
  const std::string records = test::slurp(folder / "whole/records.jsonl");
  CHECK(test::slurp(folder / "out/records.jsonl") == records);
  const std::string unfinished = test::slurp(folder / "out/unfinished.jsonl");
  CHECK(std::count(unfinished.begin(), unfinished.end(), '\n') == 1 + 1 + 2);  // head, objects, series
  // Without the last step of the objects, to see that the parts are those of the interrupted run.
  std::istringstream in(unfinished);
  std::string text;
  for (std::string line; std::getline(in, line);) {
    auto value = nlohmann::ordered_json::parse(line);
    if (value.value("part", "") == "objects")
      for (const char* key : {"records", "times"}) {
        std::string lines = value[key];
        lines.pop_back();
        value[key] = lines.substr(0, lines.rfind('\n') + 1);
      }
    text += value.dump() + "\n";
  }
  folder.write("out/unfinished.jsonl", text);
  std::filesystem::remove_all(folder / "out/series.jsonl");
  REQUIRE(paper("out").code == 0);
  CHECK(!std::filesystem::exists(folder / "out/unfinished.jsonl"));
  const std::string again = test::slurp(folder / "out/records.jsonl");
  CHECK(again.size() < records.size());
  CHECK(records.compare(0, again.size(), again) == 0);
  CHECK(test::slurp(folder / "out/series.jsonl") == test::slurp(folder / "whole/series.jsonl"));
}

TEST_CASE("paper: meshes at several resolutions, in shards and as a whole" * doctest::test_suite("long")) {
  const test::Folder folder;
  const auto paper = [&](const std::string& meshes, std::vector<std::string> more) {
    std::vector<std::string> args = {"paper", "--meshes", meshes};
    args.insert(args.end(), more.begin(), more.end());
    return test::run(folder, args);
  };
  const auto run = [&](const std::string& meshes, std::vector<std::string> more) {
    more.insert(more.end(), {"--collisions", "2", "--resolutions", "2", "--subdivide", "1"});
    return paper(meshes, std::move(more));
  };
  std::filesystem::create_directory(folder.path / "meshes");
  Mesh ball = generators::generate("ball", {{"frequency", 4}});
  write_mesh(ball, folder / "meshes/ball.ply");
  write_mesh(generators::generate("knot", {{"segments", 60}, {"sides", 6}}), folder / "meshes/knot.obj");
  folder.write("meshes/open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto whole = run("meshes", {"-o", "whole"});
  CHECK(whole.code == 0);
  CHECK(whole.err.find("open.obj: skipped") != std::string::npos);
  for (const char* i : {"0/3", "1/3", "2/3"})
    CHECK(run("meshes", {"--shard", i, "-o", std::string("part") + i[0], "--jobs", "2"}).code == 0);
  CHECK(paper("meshes",
              {"--merge", "part2/records.jsonl", "part0/records.jsonl", "part1/records.jsonl", "-o", "all"})
            .code == 0);
  for (const char* file : {"/records.jsonl", "/tables.json", "/series.jsonl", "/series.json"})
    CHECK(test::slurp(folder / (std::string("all") + file)) ==
          test::slurp(folder / (std::string("whole") + file)));
  const auto j = nlohmann::json::parse(test::slurp(folder / "whole/series.json"));
  CHECK(j["rows"].size() == 8);
  CHECK(j["rows"][0]["body"] == "ball");
  CHECK(j["rows"][0]["real_faces"] == 1280);
  CHECK(j["powers_of_total_faces"].size() == 12);
  CHECK(test::slurp(folder / "whole/report.md").find("Growth with the resolution") != std::string::npos);
  const auto rejected = [&](const std::string& meshes, std::vector<std::string> more, const char* why) {
    const auto o = paper(meshes, std::move(more));
    CHECK(o.code == 2);
    CHECK(o.err.find(why) != std::string::npos);
  };
  rejected("meshes/ball.ply",
           {"--merge", "part0/records.jsonl", "part1/records.jsonl", "part2/records.jsonl", "-o", "x"},
           "not in the series");
  rejected("meshes/open.obj", {"-o", "x"}, "no mesh from which an LRB-rep can be built");
  rejected("none.obj", {"-o", "x"}, "none.obj");
  std::filesystem::create_directory(folder.path / "other");
  write_mesh(ball, folder / "other/ball.ply");
  write_mesh(ball, folder / "other/ball.obj");
  rejected("other", {"-o", "x"}, "another mesh has the name ball");
}
