// Crowds: each pair has the answers of queries of its own, and the number of threads shows in times alone.
#include <filesystem>
#include <set>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "scenarios/crowd/crowd_pairs.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/io/poses.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/json_schema.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/clash.hpp>
#include <lrbscope/collide.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/near_pairs.hpp>

using namespace lrb;
using nlohmann::json;

namespace {

/// A dozen small bodies, close together: some cross, some lie in others.
json good() {
  return json::parse(R"({"name": "few", "purpose": "p", "seed": 3, "room": [3, 3, 3], "arrangement": "random",
    "bodies": [
      {"name": "ball", "body": {"generator": "ball", "parameters": {"frequency": 3, "radius": 1.1}}, "count": 3},
      {"name": "bead", "body": {"generator": "ball", "parameters": {"frequency": 2, "radius": 0.1}}, "count": 4},
      {"name": "bowl", "body": {"generator": "bowl", "parameters": {"segments": 10, "rows": 4}}, "count": 2},
      {"name": "stick", "body": {"generator": "stick", "parameters": {"segments": 6, "rows": 3},
                                 "pose": {"position": [0, 0, 0.4], "axis": [1, 0, 0], "degrees": 20}}, "count": 3}],
    "motion": {"steps": 5, "speed": [0.05, 0.2], "spin": 7}})");
}

json good_2d() {
  return json::parse(R"({"name": "flat", "purpose": "p", "room": [6, 4, 0],
    "bodies": [
      {"name": "island", "body": {"generator": "island", "parameters": {"levels": 2, "radius": 0.8}}, "count": 5},
      {"name": "cog", "body": {"generator": "cog2d", "parameters": {"radius": 0.6}}, "count": 6}],
    "motion": {"steps": 4, "speed": 0.1, "spin": [2, 9]}})");
}

spec::Crowd crowd_of(const json& j) {
  return spec::parse_crowd(j.dump(1), "dir/c.json");
}

std::string error_of(const json& j, const std::string& file) {
  return test::error_of([&] { return spec::parse_crowd(j.dump(1), file); });
}

bool schema_accepts(const json& j) {
  static const json document = json::parse(io::embedded_file("crowd.schema.json"));
  static const json scenario = json::parse(io::embedded_file("scenario.schema.json"));
  return test::schema_faults(document, j, scenario).empty();
}

}  // namespace

TEST_CASE("answers and work do not depend on the number of threads") {
  for (const json& j : {good(), good_2d()}) {
    const spec::Crowd crowd = crowd_of(j);
    const std::string one = crowd::crowd_summary(crowd, crowd::run_crowd(crowd, 1, record::kSilent));
    for (const std::uint32_t threads : {2U, 5U})
      CHECK(crowd::crowd_summary(crowd, crowd::run_crowd(crowd, threads, record::kSilent)) == one);
  }
}

TEST_CASE("pairs are listed by their cost, with the sums over all steps") {
  const spec::Crowd crowd = crowd_of(good());
  const crowd::CrowdRun run = crowd::run_crowd(crowd, 1, record::kSilent);
  const std::vector<crowd::PairHistory> pairs = crowd::pair_histories(run);
  REQUIRE(pairs.size() > 3);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const crowd::PairHistory& p = pairs[i];
    if (i > 0) CHECK(pairs[i - 1].face_tests >= p.face_tests);
    std::uint64_t tests = 0, most = 0;
    std::uint32_t steps = 0;
    for (const crowd::CrowdStep& s : run.steps)
      for (const crowd::CrowdQuery& q : s.queries) {
        if (q.bodies != p.bodies) continue;
        tests += q.result.counters.face_tests;
        steps += q.meets();
        most = std::max(most, q.result.pair_count);
      }
    CHECK(p.face_tests == tests);
    CHECK(p.steps == steps);
    CHECK(p.most_pairs == most);
  }
  const std::string table = crowd::pair_table(run, 2);
  CHECK(std::ranges::count(table, '\n') == 4);  // titles, two pairs, and how many are left out
  CHECK(table.find(run.names[pairs[0].bodies.i]) != std::string::npos);
  const json summary = json::parse(crowd::crowd_summary(crowd, run));
  CHECK(summary["pairs_by_cost"].size() == pairs.size());
  CHECK(summary["pairs_by_cost"][0]["face_tests"] == pairs[0].face_tests);
}

TEST_CASE("the shipped crowd is valid and has about forty bodies") {
  const spec::Crowd crowd = spec::open_crowd("crowd");
  CHECK(crowd.body_count() == 40);
  CHECK(schema_accepts(json::parse(io::embedded_file("crowd.crowd.json"))));
}

TEST_CASE("bodies of a crowd follow poses from files, one for all steps or one for each") {
  const test::Folder folder;
  json moved = good_2d();
  moved["motion"] = {{"steps", 11}, {"speed", 0.1}, {"spin", 5}};
  const spec::Crowd crowd = crowd_of(moved);
  const crowd::CrowdRun run = crowd::run_crowd(crowd, 1, record::kSilent);
  std::vector<Pose> all;
  std::filesystem::create_directory(folder / "steps");
  for (std::uint32_t step = 0; step < crowd.steps; ++step) {
    std::vector<Pose> of_step;
    for (std::uint32_t body = 0; body < crowd.body_count(); ++body)
      of_step.push_back(run.motion.pose(body, step));
    // Without leading zeros, steps 9 and 10 would be exchanged in the order of letters.
    io::save_poses(folder / ("steps/at" + std::to_string(step) + ".csv"), of_step);
    all.insert(all.end(), of_step.begin(), of_step.end());
  }
  io::save_poses(folder / "all.txt", all);
  folder.write("steps/.hidden", "not a pose");
  json given = moved;
  given.erase("room");
  const auto parse = [&](const std::string& poses) {
    given["motion"] = {{"poses", poses}};
    CHECK(schema_accepts(given));
    return spec::parse_crowd(given.dump(1), folder / "c.json");
  };
  const auto summary_of = [](spec::Crowd c, const crowd::CrowdRun& played) {
    c.hash = 0;
    return crowd::crowd_summary(c, played);
  };
  std::uint64_t hash = 0;
  for (const char* poses : {"all.txt", "steps"}) {
    CAPTURE(poses);
    const spec::Crowd read = parse(poses);
    CHECK(read.steps == 11);
    CHECK(read.hash != hash);
    hash = read.hash;
    CHECK(summary_of(read, crowd::run_crowd(read, 2, record::kSilent)) == summary_of(crowd, run));
  }
  // A body's own pose comes first, and a part of the steps can be chosen.
  given["bodies"][0]["body"]["pose"] = {{"position", {1, 0, 0}}};
  given["motion"]["steps"] = 2;
  const spec::Crowd read = spec::parse_crowd(given.dump(1), folder / "c.json");
  CHECK(read.steps == 2);
  const crowd::CrowdRun shifted = crowd::run_crowd(read, 1, record::kSilent);
  const Pose& pose = all[crowd.body_count()];
  CHECK(shifted.motion.pose(0, 1).t == pose.r * Eigen::Vector3d(1, 0, 0) + pose.t);
  CHECK(shifted.motion.pose(10, 1).t == all[crowd.body_count() + 10].t);

  const auto error = [&](const json& motion) -> std::string {
    given["motion"] = motion;
    return error_of(given, folder / "c.json");
  };
  all.pop_back();
  io::save_poses(folder / "all.txt", all);
  CHECK(error({{"poses", "all.txt"}})
            .find("all.txt: expected for each step, a pose for each of the 11 bodies") != std::string::npos);
  CHECK(error({{"poses", "none.txt"}}).find("none.txt") != std::string::npos);
  CHECK(error({{"poses", "all.txt"}, {"speed", 1}}).find("given poses; remove it") != std::string::npos);
  CHECK_FALSE(schema_accepts(given));
  CHECK(error({{"steps", 3}}).find("room") != std::string::npos);
  CHECK_FALSE(schema_accepts(given));  // neither poses nor a room
}

TEST_CASE("a crowd keeps the answers of bodies that have not moved; they equal those of new queries") {
  json start = good();
  start["motion"] = {{"steps", 9}, {"speed", 0.3}, {"spin", 20}};
  start["query"] = {{"contacts", true}, {"distance", true}};
  spec::Crowd crowd = crowd_of(start);
  const crowd::CrowdRun all = crowd::run_crowd(crowd, 1, record::kSilent);
  // At step s only bodies with a number divisible by s + 1 have moved; at step 5 none.
  for (std::uint32_t step = 0; step < crowd.steps; ++step) {
    std::vector<Pose>& poses = crowd.poses.emplace_back();
    for (std::uint32_t body = 0; body < crowd.body_count(); ++body) {
      const bool moves = step == 0 || (step != 5 && body % (step + 1) == 0);
      poses.push_back(moves ? all.motion.pose(body, step) : crowd.poses[step - 1][body]);
    }
  }
  for (spec::CrowdKind& kind : crowd.kinds) kind.body.pose = {};  // the poses contain it
  const crowd::CrowdRun run = crowd::run_crowd(crowd, 2, record::kSilent);
  std::size_t kept = 0, queried = 0;
  for (std::uint32_t step = 0; step < crowd.steps; ++step) {
    CAPTURE(step);
    spec::Crowd alone = crowd;
    alone.steps = 1;
    alone.poses = {crowd.poses[step]};
    const crowd::CrowdRun anew = crowd::run_crowd(alone, 2, record::kSilent);
    const auto &found = run.steps[step].queries, &expected = anew.steps[0].queries;
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const crowd::CrowdQuery &x = found[i], &y = expected[i];
      const auto stays = [&](std::uint32_t body) {
        return step > 0 && trace::equal(crowd.poses[step][body], crowd.poses[step - 1][body]);
      };
      CHECK(x.bodies == y.bodies);
      CHECK(x.is_kept == (stays(x.bodies.i) && stays(x.bodies.j)));
      trace::StepResult result = x.result;
      CHECK(result.counters == (x.is_kept ? Counters() : y.result.counters));
      result.counters = y.result.counters;
      CHECK(result == y.result);
      (x.is_kept ? kept : queried) += 1;
    }
  }
  CHECK(kept > 20);
  CHECK(queried > 20);
  CHECK(std::ranges::all_of(run.steps[5].queries, [](const crowd::CrowdQuery& q) { return q.is_kept; }));
}

TEST_CASE("two bodies of a crowd are a run of their own, with the same answers") {
  for (const json& j : {good(), good_2d()}) {
    const spec::Crowd crowd = crowd_of(j);
    const crowd::CrowdRun run = crowd::run_crowd(crowd, 1, record::kSilent);
    std::set<BodyPair> pairs = {{0, 1}};
    for (const crowd::CrowdStep& s : run.steps)
      for (const crowd::CrowdQuery& q : s.queries) pairs.insert(q.bodies);
    for (const BodyPair& pair : pairs) {
      // The names in either order.
      CHECK((crowd::find_pair(crowd, run.names[pair.j] + "," + run.names[pair.i]) == pair));
      const spec::Scenario scenario = crowd::scenario_of_pair(crowd, run.motion, pair);
      const record::Recording recording = record::record(scenario, record::kSilent);
      REQUIRE(recording.trace.steps.size() == crowd.steps);
      for (std::uint32_t step = 0; step < crowd.steps; ++step) {
        CHECK(trace::equal(recording.trace.steps[step].pose_a, run.motion.pose(pair.i, step)));
        CHECK(trace::equal(recording.trace.steps[step].pose_b, run.motion.pose(pair.j, step)));
        const CollideResult& found = recording.results[step];
        const auto& queries = run.steps[step].queries;
        const auto query =
            std::ranges::find_if(queries, [&](const crowd::CrowdQuery& q) { return q.bodies == pair; });
        // A pair that was not queried has disjoint boxes.
        CHECK(found.relation == (query == queries.end() ? Relation::separate : query->result.relation));
        CHECK(fingerprint(found.pairs) ==
              (query == queries.end() ? fingerprint({}) : query->result.fingerprint));
      }
    }
    for (const auto& [given, expected] :
         {std::pair{std::string("ball 1"), "expected the names of two bodies"},
          {"", "expected the names of two bodies"},
          {run.names[1] + "," + run.names[1], "twice"},
          {run.names[1] + ",cat 1", "has no body cat 1"}}) {
      const std::string names = given;  // clang 14 captures no structured binding
      CAPTURE(names);
      CHECK_THROWS_WITH_AS(static_cast<void>(crowd::find_pair(crowd, names)), doctest::Contains(expected),
                           InputError);
    }
  }
}

TEST_CASE("distance, clash and near pairs of a crowd are those of each pair of bodies") {
  json j = good();
  constexpr double kWithin = 0.3;
  j["query"] = {{"distance", true}, {"clash", true}, {"near", kWithin}};
  const spec::Crowd crowd = crowd_of(j);
  const crowd::CrowdRun run = crowd::run_crowd(crowd, 2, record::kSilent);
  NearPairsRequest near;
  near.within = kWithin;
  std::size_t queried = 0, separate = 0, deep = 0, near_by = 0;
  const std::uint32_t n = run.motion.body_count();
  for (std::uint32_t step = 0; step < run.steps.size(); step += 2) {
    auto next = run.steps[step].queries.begin();
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j2 = i + 1; j2 < n; ++j2) {
        const LrbRep &a = run.rep(i), &b = run.rep(j2);
        const Pose pose_a = run.motion.pose(i, step), pose_b = run.motion.pose(j2, step);
        const auto pairs = trace::measured(near_pairs(a, pose_a, b, pose_b, near), kWithin);
        if (next == run.steps[step].queries.end() || next->bodies != BodyPair{i, j2}) {
          CHECK(pairs.found == 0);  // no face of the one is near one of the other
          continue;
        }
        const trace::StepResult& r = next->result;
        ++next;
        ++queried;
        REQUIRE(r.distance);
        REQUIRE(r.clash);
        REQUIRE(r.near);
        CHECK(*r.near == pairs);
        CHECK(*r.distance == trace::measured(distance(a, pose_a, b, pose_b), {}));
        CHECK(*r.clash == trace::measured(clash(a, pose_a, b, pose_b), {}));
        separate += r.distance->lower > 0;
        deep += r.clash->depth && (*r.clash->depth)[0] > 0;
        near_by += r.relation == Relation::separate && r.near->found > 0;
      }
    CHECK(next == run.steps[step].queries.end());
  }
  CHECK(queried > 50);
  CHECK(separate > 5);
  CHECK(deep > 5);
  CHECK(near_by > 0);

  const json first = json::parse(crowd::crowd_summary(crowd, run))["steps"][0]["queries"][0];
  CHECK(first["distance"]["upper"] == run.steps[0].queries[0].result.distance->upper);
  CHECK(first["clash"]["kind"] == std::string(name_of(run.steps[0].queries[0].result.clash->kind)));
  CHECK(first["near"]["pairs"] == run.steps[0].queries[0].result.near->found);
  const spec::Scenario pair = crowd::scenario_of_pair(crowd, run.motion, {0, 1});
  CHECK(pair.more.clash);
  CHECK(pair.more.near == kWithin);

  j["query"] = {{"clash", 1}};
  const crowd::CrowdRun limited = crowd::run_crowd(crowd_of(j), 1, record::kSilent);
  const json steps = json::parse(crowd::crowd_summary(crowd_of(j), limited))["steps"];
  std::set<bool> finished;
  for (std::size_t step = 0; step < steps.size(); ++step)
    for (std::size_t k = 0; k < limited.steps[step].queries.size(); ++k) {
      const trace::MeasuredClash& r = *limited.steps[step].queries[k].result.clash;
      CHECK(steps[step]["queries"][k]["clash"].value("finished", true) == r.finished);
      finished.insert(r.finished);
    }
  CHECK(finished.size() == 2);

  json flat = good_2d();
  flat["query"] = {{"clash", true}};
  CHECK_THROWS_AS(static_cast<void>(crowd::run_crowd(crowd_of(flat), 1, record::kSilent)), InputError);
  flat["query"] = {{"distance", true}, {"near", 0.2}};
  CHECK_NOTHROW(static_cast<void>(crowd::run_crowd(crowd_of(flat), 1, record::kSilent)));
}

TEST_CASE("crowds that cannot be run are rejected; keys without effect are noted") {
  json timed = good();
  timed["trace"] = {{"clock", "wall"}};
  CHECK(crowd_of(good()).notes.empty());
  REQUIRE(crowd_of(timed).notes.size() == 1);
  CHECK(crowd_of(timed).notes[0].find("c.json: trace has no effect") != std::string::npos);
  json mixed = good();
  mixed["bodies"].push_back({{"name", "flat"}, {"body", {{"generator", "island"}}}});
  CHECK_THROWS_WITH_AS(static_cast<void>(crowd::run_crowd(crowd_of(mixed), 1, record::kSilent)),
                       "crowd few: flat is 2D and ball is 3D; expected bodies of the same dimension",
                       InputError);
  CHECK_THROWS_WITH_AS(static_cast<void>(spec::open_crowd("crowds")),
                       "crowds: neither a shipped crowd nor a file; did you mean \"crowd\"? known: crowd",
                       InputError);
}
