/// The stability experiment: what becomes of methods that misbehave, records and counting. The command:
/// tests/commands/stability.txt.

#include <csignal>
#include <cstdlib>
#include <map>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "bench/cases/families.hpp"
#include "bench/methods/triangles.hpp"
#include "bench/stability/outcome_grid.hpp"
#include "bench/stability/rational_oracles.hpp"
#include "bench/stability/saved_case.hpp"
#include "bench/stability/stability_experiment.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "tests/support/program.hpp"
#include "tests/support/workers.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace.hpp>

using namespace lrb;
using namespace lrb::stability;
using lrb::test::Environment;
using lrb::test::Folder;
using lrb::test::run;
using lrb::test::slurp;
using lrb::test::worker_method;
using lrb::test::WorkerPrograms;

namespace {

std::vector<Record> ask(const std::vector<std::string>& methods, std::uint64_t cases, double timeout = 20,
                        unsigned jobs = 2) {
  ExperimentOptions o;
  o.families = {"shared", "identical"};
  for (const std::string& name : methods) o.methods.push_back(worker_method(name));
  o.cases = cases;
  o.difficulty = 10;
  o.jobs = jobs;
  o.timeout = timeout;
  return run_experiment(o, {});
}

Record some_record() {
  Record r;
  r.family = "touch";
  r.method = "fcl";
  r.difficulty = 7;
  r.case_index = 12;
  r.seed = 18446744073709551615u;
  r.outcome = Outcome::wrong;
  r.expected = 5;
  r.missed = 2;
  r.extra = 1;
  r.relation = "separate";
  r.expected_relation = "touching";
  r.microseconds = 0.25;
  r.message = "a \"quoted\" word, and \n a line";
  return r;
}

}  // namespace

TEST_CASE("outcomes of methods that crash, hang or return garbage") {
  const WorkerPrograms workers;
  const auto outcome_of_contact = [](const std::string& name, double timeout) {
    std::map<Outcome, int> with, without;
    for (const Record& r : ask({name}, 6, timeout)) {
      ++(r.expected > 0 ? with : without)[r.outcome];
      if (r.outcome != Outcome::right && name != "fake-miss") CHECK(!r.message.empty());
    }
    CHECK(with.size() == 1);
    CHECK(without.size() <= 1);
    CHECK(without.count(Outcome::right) == without.size());
    return with.begin()->first;
  };
  CHECK(outcome_of_contact("ours", 20) == Outcome::right);
  CHECK(outcome_of_contact("fake-crash", 20) == Outcome::crashed);
  CHECK(outcome_of_contact("fake-refuse", 20) == Outcome::rejected);
  CHECK(outcome_of_contact("fake-throw", 20) == Outcome::crashed);
  CHECK(outcome_of_contact("fake-miss", 20) == Outcome::wrong);
}

TEST_CASE("a method that hangs on three consecutive cases skips the rest of its family") {
  const WorkerPrograms workers;
  std::map<std::string, int> in_a_row, runs;
  for (const Record& r : ask({"fake-hang"}, 12, 0.4)) {
    const bool given_up = in_a_row[r.family] == 3, hung = r.outcome == Outcome::timed_out;
    CHECK((r.message.compare(0, 7, "skipped") == 0) == given_up);
    CHECK(hung == (given_up || r.expected > 0));
    if (given_up) continue;
    ++runs[r.family];
    in_a_row[r.family] = hung ? in_a_row[r.family] + 1 : 0;
  }
  for (const char* family : {"shared", "identical"}) {
    CHECK(in_a_row[family] == 3);
    CHECK(runs[family] < 12);
  }
}

TEST_CASE("every case has its record, in order, despite crashes and parallel runs") {
  const WorkerPrograms workers;
  const auto key = [](const Record& r) {
    return r.family + " " + r.method + " " + std::to_string(r.difficulty) + " " +
           std::to_string(r.case_index) + " " + std::string(name_of(r.outcome)) + " " +
           std::to_string(r.missed);
  };
  std::vector<std::string> expected;
  for (const char* family : {"shared", "identical"})
    for (const char* name : {"fake-crash", "plain", "fake-miss"})
      for (int i = 0; i < 5; ++i)
        expected.push_back(std::string(family) + " " + name + " 10 " + std::to_string(i));
  const std::vector<Record> two = ask({"fake-crash", "plain", "fake-absent", "fake-miss"}, 5),
                            one = ask({"fake-crash", "plain", "fake-absent", "fake-miss"}, 5, 20, 1);
  REQUIRE(two.size() == expected.size());
  REQUIRE(one.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    CHECK(key(two[i]).compare(0, expected[i].size(), expected[i]) == 0);
    CHECK(key(one[i]) == key(two[i]));
    CHECK(two[i].expected > 0);  // known even of those that died
  }
}

TEST_CASE("a missing or invalid worker") {
  const Folder folder;
  const Environment where("LRBSCOPE_METHODS", folder.path.string());
  CHECK_THROWS_AS(workers::find_methods(), EnvironmentError);
  const test::Outcome o = run(folder, {"stability"});
  CHECK(o.code == 3);
  CHECK(o.out.empty());
  CHECK(o.error_lines() == 1);
  CHECK(o.err.find("lrbscope-methods: not found. Build it with") != std::string::npos);
  CHECK(o.err.find("cmake --build --preset release --target lrbscope-workers,") != std::string::npos);
  CHECK(folder.tree().empty());
  std::filesystem::permissions(folder.write("lrbscope-methods", "#!/bin/sh\nexit 9\n"),
                               std::filesystem::perms::owner_all);
  CHECK_THROWS_AS(workers::find_methods(), EnvironmentError);
}

TEST_CASE("records are read back unchanged from their lines; invalid ones are rejected") {
  const std::string line = to_lines({some_record()});
  CHECK(to_lines({record_from(nlohmann::json::parse(line))}) == line);
  const auto with = [&](const std::string& what, const std::string& other) {
    std::string text = line;
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), other);
  };
  for (const std::string& bad : {with("\"wrong\"", "\"odd\""), with("\"dial\":7", "\"dial\":11"),
                                 with("7", "\"7\""), with("\"missed\":2,", ""), std::string("[]")}) {
    CAPTURE(bad);
    CHECK_THROWS_AS(record_from(nlohmann::json::parse(bad)), InputError);
  }
}

TEST_CASE("stability: failures are counted per method, family and difficulty") {
  std::vector<methods::MethodInfo> methods(2);
  methods[0].name = "ours";
  methods[1].name = "fcl";
  std::vector<FamilyRow> families(1);
  families[0].name = "touch";
  std::vector<Record> records;
  const auto add = [&](int difficulty, Outcome o, std::uint64_t missed) {
    Record r = some_record();
    r.difficulty = difficulty;
    r.outcome = o;
    r.missed = missed;
    r.extra = 0;
    r.case_index = records.size();
    records.push_back(r);
  };
  add(2, Outcome::right, 0);
  add(5, Outcome::wrong, 3);
  add(4, Outcome::wrong, 3);
  add(3, Outcome::wrong, 1);
  add(1, Outcome::rejected, 0);
  records.push_back(some_record());
  records.back().method = "unknown";
  Grid g = count_grid(methods, families, records);
  const Cell& cell = g.at(0, 1);
  CHECK(g.at(0, 0).cases() == 0);
  CHECK(cell.cases() == 5);
  CHECK(cell.failures() == 3);
  CHECK(cell.answered() == 4);
  CHECK(cell.of(Outcome::wrong)[4] == 1);
  CHECK(cell.of(Outcome::rejected)[1] == 1);
  REQUIRE(cell.worst);
  CHECK(cell.worst->case_index == 2);  // as bad as that at 5, but sooner
  CHECK(table(g).find("3/4 @3") != std::string::npos);
  add(9, Outcome::timed_out, 0);
  CHECK(count_grid(methods, families, records).at(0, 1).worst->outcome == Outcome::timed_out);
  add(10, Outcome::crashed, 0);
  CHECK(count_grid(methods, families, records).at(0, 1).worst->outcome == Outcome::crashed);
}

TEST_CASE("stability: judge() compares pairs and relation with the right answer") {
  methods::MethodInfo info;
  methods::Answer answer;
  RightAnswer expected;
  expected.pairs = {{0, 1}, {2, 3}};
  expected.relation = Relation::crossing;
  answer.contact = true;
  answer.pairs = {{0, 1}, {4, 4}};
  Record r;
  judge(r, info, answer, expected);
  CHECK(r.outcome == Outcome::wrong);
  CHECK(r.missed == 1);
  CHECK(r.extra == 1);

  info.traits.set(methods::Trait::loose);  // pairs too many are no fault of a list that is meant to have them
  judge(r, info, answer, expected);
  CHECK(r.outcome == Outcome::wrong);
  answer.pairs = {{0, 1}, {2, 3}, {4, 4}};
  judge(r, info, answer, expected);
  CHECK(r.outcome == Outcome::right);
  CHECK(r.extra == 1);
  judge(r, info, answer, RightAnswer{});
  CHECK(r.outcome == Outcome::wrong);
  info.traits.set(methods::Trait::loose, false);
  judge(r, info, answer, expected);
  CHECK(r.outcome == Outcome::wrong);

  info.pairs = false;  // only yes or no, and that is right
  answer.inside = false;
  judge(r, info, answer, expected);
  CHECK(r.outcome == Outcome::right);
  CHECK(r.expected_relation == "contact");

  expected = RightAnswer{};
  expected.relation = Relation::b_inside_a;
  answer = methods::Answer{};
  answer.inside = false;
  judge(r, info, answer, expected);
  CHECK(r.outcome == Outcome::wrong);
  expected.relation = Relation::undefined;  // nothing to be inside of
  judge(r, info, answer, expected);
  CHECK(r.outcome == Outcome::right);

  expected.rejection = "body A, vertex 3 is not representable as double";
  judge(r, info, answer, expected);
  CHECK(r.outcome == Outcome::wrong);
}

TEST_CASE("judging a method by itself, with the bodies exchanged") {
  methods::MethodInfo info;
  methods::Answer ab, ba;
  RightAnswer right;
  const auto outcome = [&] {
    ab.exchanged = {ba};
    Record r;
    judge(r, info, ab, right);
    CHECK((r.missed == 1) == (ba.pairs.size() < ab.pairs.size()));
    return r.outcome;
  };
  ab.pairs = {{0, 1}, {0, 2}, {3, 1}};
  ba.pairs = {{1, 0}, {1, 3}, {2, 0}};
  CHECK(outcome() == Outcome::right);
  ba.pairs = {{1, 0}, {2, 0}};
  CHECK(outcome() == Outcome::wrong);
  ab.pairs = ba.pairs = {};
  ab.relation = Relation::a_inside_b;
  ba.relation = Relation::b_inside_a;
  CHECK(outcome() == Outcome::right);
  ba.relation = Relation::a_inside_b;
  CHECK(outcome() == Outcome::wrong);
  right.several = true;  // each may hold a piece of the other
  CHECK(outcome() == Outcome::right);
}

// If the benign end were not benign the grid could not say where along the difficulty a method starts to
// fail.
TEST_CASE(
    "the textbook's method is right at the lowest difficulty of every family, and wrong at the highest; an index of "
    "the faces changes nothing at the lowest") {
  const std::vector<methods::MethodEntry> all = methods::registered_methods();
  StabilityRunner plain(methods::find_method(all, "plain")), bsp(methods::find_method(all, "bsp")),
      halved(methods::find_method(all, "brep-index")), grids(methods::find_method(all, "grids"));
  int failing = 0, failed = 0, by_bsp = 0, wrong_bsp = 0, by_index = 0;
  for (const cases::Family& f : cases::all_families()) {
    CAPTURE(f.name);
    CHECK(std::string(f.benign) != "");
    CHECK(std::string(f.degenerate) != "");
    const auto failures = [&](int difficulty) {
      int n = 0;
      for (std::uint64_t i = 0; i < 8; ++i) {
        CAPTURE(i);
        const cases::Case c = cases::make_case(f, 1, difficulty, i);
        const RightAnswer right = expected_answer(c);
        const auto ask = [&](StabilityRunner& method) {
          Record r;
          judge(r, method.info(), method.ask(c, f.both_ways), right);
          return r;
        };
        const Record r = ask(plain);
        n += r.outcome == Outcome::wrong;
        if (difficulty > 0) continue;
        for (StabilityRunner* index : {&halved, &grids}) {
          const Record same = ask(*index);
          if (same.outcome == Outcome::rejected) continue;  // 2D
          ++by_index;
          CHECK(same.outcome == r.outcome);
          CHECK(same.missed == r.missed);
          CHECK(same.extra == r.extra);
        }
        const Outcome cut = ask(bsp).outcome;
        by_bsp += cut == Outcome::right;
        wrong_bsp += cut == Outcome::wrong;
      }
      return n;
    };
    const int benign = failures(0);
    CHECK(benign <= 1);
    failed += benign;
    failing += failures(8) > 0;
  }
  CHECK(failed <= 3);
  CHECK(failing > 15);
  CHECK(by_index > 300);
  CHECK(by_bsp > 100);
  CHECK(wrong_bsp <= 3);
}

namespace {

oracle::Rational fraction(const nlohmann::json& text) {
  return oracle::Rational(text.get<std::string>());
}

oracle::RationalPoint fractions(const nlohmann::json& point) {
  return {fraction(point[0]), fraction(point[1]), fraction(point[2])};
}

}  // namespace

TEST_CASE("a pair's proof: a point of both faces, or a direction in which A is before B") {
  std::size_t intersecting = 0;
  for (const char* family : {"identical", "touch", "plane"})
    for (const int difficulty : {0, 10}) {
      CAPTURE(family);
      const cases::Case c = cases::make_case(*cases::find_family(family), 1, difficulty, 1);
      const std::vector<SimplexPair> pairs = brute_force(*c.a, c.pose_a, *c.b, c.pose_b).pairs;
      const SimplexPair pair = pairs.empty() ? SimplexPair{SimplexId(0), SimplexId(0)} : pairs.back();
      const nlohmann::json proof = nlohmann::json(pair_proof(c, pair));
      REQUIRE(proof["intersect"] == !pairs.empty());
      intersecting += !pairs.empty();
      for (const char* body : {"a", "b"}) {
        oracle::RationalPoints corners;
        for (const auto& corner : proof[body]) corners.push_back(fractions(corner));
        if (pairs.empty()) {
          for (const oracle::RationalPoint& x : corners) {
            const oracle::Rational along = oracle::dot(fractions(proof["direction"]), x);
            CHECK((body[0] == 'a' ? along <= fraction(proof["largest_of_a"])
                                  : along >= fraction(proof["least_of_b"])));
          }
          CHECK(fraction(proof["largest_of_a"]) < fraction(proof["least_of_b"]));
          continue;
        }
        const oracle::RationalPoint p = fractions(proof["common_point"]);
        if (corners.size() == 3)
          CHECK(oracle::simplices_meet(corners, {p, p, p}));
        else
          CHECK(oracle::closest_of_features(corners, {p})->distance_sq == 0);
      }
    }
  CHECK(intersecting > 1);
  CHECK(intersecting < 6);
}

TEST_CASE("lrbscope stability: an interruption leaves no result and no worker") {
  const WorkerPrograms workers;
  const Folder folder;
  const std::string line =
      "cd '" + folder.path.string() +
      "' && timeout -s INT 1.5 '" LRBSCOPE_BINARY
      "' stability --family identical --method fake-hang --seed 7203954 --timeout 600 2>err; "
      "echo $? >code; sleep 0.3; ps -eo args | grep -c '[l]rbscope-methods .*--seed 7203954' >left";
  CHECK(std::system(line.c_str()) != -1);
  CHECK(slurp(folder / "left") == "0\n");
  CHECK(slurp(folder / "err").find("interrupted by SIGINT") != std::string::npos);
  CHECK(!std::filesystem::exists(folder / "out/stability/records.jsonl"));
}
