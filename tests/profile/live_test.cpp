// The queries of a running engine: which are kept, their verdicts, and the bound on memory.
#include "scenarios/profile/live.hpp"

#include <random>

#include <doctest/doctest.h>

#include "tests/support/capture_file.hpp"
#include "tests/support/faulty_engine.hpp"

namespace lrb::profile {

using namespace lrb::test;

namespace {

/// A capture with a right query and a wrong one, that are added again and again.
struct Running {
  FaultyEngine engine;
  capture::Query right, wrong;

  Running() {
    std::mt19937_64 random(7);
    const std::uint32_t a = engine.grow(engine.add(sheet_mesh(5)), random),
                        b = engine.grow(engine.add(sheet_mesh(4)), random);
    const Pose pose = Pose::rotation({1, 0.2, 0.1}, 1.1, {0.03, 0.45, -0.4});
    engine.ask(a, {}, b, pose);
    FaultyQuery how;
    for (const capture::Event& e : engine.capture.queries[0].events)
      if (e.kind == capture::EventKind::triangles && e.met > 0 && how.lies.empty()) how.lies = {{e.a, e.b}};
    engine.ask(a, {}, b, pose, how);
    right = engine.capture.queries[0];
    wrong = engine.capture.queries[1];
  }
  static capture::Query with(capture::Query query, std::uint32_t number, double us) {
    query.number = number;
    query.duration_ns = 1000 * us;
    return query;
  }
};

std::vector<std::uint32_t> numbers_of(const LiveQueries& live) {
  std::vector<std::uint32_t> out;
  for (const LiveQuery& q : live.kept()) out.push_back(q.query.number);
  return out;
}

}  // namespace

TEST_CASE("a running percentile is within its factor of the exact one") {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> times(8, 2);
  for (const double share : {0.5, 0.99}) {
    CAPTURE(share);
    RunningPercentile p(share);
    CHECK(p.value() == 0);
    std::vector<double> all;
    for (int i = 0; i < 5000; ++i) {
      all.push_back(1 + times(random));
      p.add(all.back());
    }
    std::sort(all.begin(), all.end());
    const double exact = all[static_cast<std::size_t>(std::ceil(share * 5000)) - 1];
    CHECK(p.value() >= exact);
    CHECK(p.value() <= exact * std::exp2(1.0 / 8));
    CHECK(p.count() == 5000);
  }
}

TEST_CASE("a live query has the verdict, explanation and prices of check") {
  Running r;
  LiveQueries live(r.engine.capture);
  live.add(r.right, true);
  live.add(r.wrong, true);
  const Check expected = check(r.engine.capture, {});
  CHECK(live.sums().prices == expected.sum().prices);
  CHECK(live.sums().outcomes == expected.sum().outcomes);
  REQUIRE(live.kept().size() == 2);
  CHECK(live.kept()[1].is_wrong());
  CHECK("query 2: " + live.kept()[1].explanation == expected.wrong.front());
  const auto json = live.json_of(live.kept()[1]);
  CHECK(json["verdict"] == "wrong");
  CHECK(json["run"] == true);
  CHECK(live.summary().find("2 queries: 1 right, 1 wrong") == 0);
  const capture::Capture one = live.capture_of(live.kept()[1]);
  CHECK(check(one, {}).wrong == expected.wrong);
}

TEST_CASE("the last queries are kept, and of those before the wrong and the slow ones") {
  Running r;
  LiveSettings settings;
  settings.last = 5;
  settings.remarkable = 4;
  LiveQueries live(r.engine.capture, settings);
  for (std::uint32_t n = 1; n <= 300; ++n) {
    const bool is_wrong = n == 3 || n == 4, is_slow = n == 150 || n == 160;
    live.add(Running::with(is_wrong ? r.wrong : r.right, n, is_slow ? 500 : 10), true);
  }
  CHECK(numbers_of(live) == std::vector<std::uint32_t>{3, 4, 150, 160, 296, 297, 298, 299, 300});
  CHECK(live.find(150)->is_slow);
  CHECK(live.find(7) == nullptr);
  // More remarkable ones than are kept: the newest remain.
  for (std::uint32_t n = 301; n <= 320; ++n) live.add(Running::with(r.wrong, n, 10), true);
  CHECK(numbers_of(live) == std::vector<std::uint32_t>{312, 313, 314, 315, 316, 317, 318, 319, 320});
  CHECK(live.count() == 320);
}

TEST_CASE("old events are dropped, and queries without them remain") {
  Running r;
  LiveSettings settings;
  settings.events = 3 * r.right.events.size();
  LiveQueries live(r.engine.capture, settings);
  for (std::uint32_t n = 1; n <= 10; ++n) live.add(Running::with(r.right, n, 10), true);
  REQUIRE(live.kept().size() == 10);
  for (const LiveQuery& q : live.kept()) {
    CHECK(q.has_events == (q.query.number > 7));
    CHECK(q.query.events.empty() != q.has_events);
    CHECK(live.json_of(q)["run"] == q.has_events);
  }
}

TEST_CASE("queries that were left out are checked later, the newest first") {
  Running r;
  LiveQueries live(r.engine.capture);
  live.add(Running::with(r.wrong, 1, 10), false);
  live.add(Running::with(r.right, 2, 10), false);
  CHECK(live.unchecked() == 2);
  CHECK(live.json_of(*live.find(1))["verdict"] == "not checked");
  CHECK(live.summary().find("2 queries: 2 not checked") == 0);
  CHECK(live.check_one() == 2);
  CHECK(live.check_one() == 1);
  CHECK(live.check_one() == std::nullopt);
  CHECK(live.unchecked() == 0);
  CHECK(live.find(1)->is_wrong());
}

TEST_CASE("trees that the engine describes later are used") {
  Running r;
  capture::Capture described;
  described.meshes = {r.engine.capture.meshes[0]};
  LiveQueries live(described);
  described = r.engine.capture;
  live.add(r.wrong, true);
  CHECK(live.kept()[0].is_wrong());
}

}  // namespace lrb::profile
