/// Whole captures and recorded runs checked, and the command.

#include "scenarios/profile/check.hpp"

#include <doctest/doctest.h>

#include "scenarios/bodies/shapes.hpp"
#include "scenarios/profile/captured_run.hpp"
#include "tests/support/faulty_engine.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/recorder.hpp>

namespace lrb::profile {

using namespace lrb::test;

namespace {

/// Records queries of two tori of our own at poses that intersect more or less deeply.
record::Recording recorded_tori(EventLevel level, Mode mode = Mode::all_pairs,
                                std::uint32_t cap = 1'000'000) {
  record::Recording out;
  for (int k = 0; k < 2; ++k)
    out.bodies.push_back({LrbRep::without_regions(shapes::torus(24, 16), true, false), {}, 0});
  trace::RecorderSettings settings;
  settings.level = level;
  settings.event_cap = cap;
  settings.request.mode = mode;
  trace::Recorder recorder(out.bodies[0].rep, out.bodies[1].rep, settings);
  for (std::uint32_t i = 0; i < 5; ++i) {
    const Pose pose = Pose::rotation({1, 0.3, 0.2}, 1.3, {0.45 * i, 0.1, 0.2});
    recorder.begin_step(i, {}, pose);
    out.results.push_back(
        collide(out.bodies[0].rep, {}, out.bodies[1].rep, pose, settings.request, recorder));
    recorder.end_step(out.results.back());
  }
  out.trace = recorder.take();
  if (level != EventLevel::faces)
    for (const bodies::LoadedBody& body : out.bodies) out.trees.emplace_back(body.rep.tree());
  return out;
}

/// A capture of two sheets, and of the same with a test that lies.
struct Captures {
  FaultyEngine engine;
  std::uint32_t a, b;
  Pose pose = Pose::rotation({1, 0.2, 0.1}, 1.1, {0.03, 0.45, -0.4});

  Captures() {
    std::mt19937_64 random(7);
    a = engine.grow(engine.add(sheet_mesh(5)), random);
    b = engine.grow(engine.add(sheet_mesh(4)), random);
    engine.ask(a, {}, b, pose);
  }
  /// Adds a query in which the first intersecting pair of the first is missed. Returns the pair.
  NumberPair lie() {
    FaultyQuery how;
    for (const capture::Event& e : engine.capture.queries[0].events)
      if (e.kind == capture::EventKind::triangles && e.met > 0 && how.lies.empty()) how.lies = {{e.a, e.b}};
    engine.ask(a, {}, b, pose, how);
    return *how.lies.begin();
  }
};

}  // namespace

TEST_CASE("A capture's sums are those of its queries") {
  Captures c;
  const NumberPair lost = c.lie();
  const Check checked = check(c.engine.capture, {});
  CHECK(checked.is_wrong());
  const CheckSums sum = checked.sum();
  CHECK(sum.queries == 2);
  CHECK(sum.outcomes[static_cast<std::size_t>(Judgement::right)] == 1);
  CHECK(sum.outcomes[static_cast<std::size_t>(Judgement::wrong)] == 1);
  CHECK(sum.missed == 1);
  CHECK(sum.right == sum.exact_pairs - 1);
  c.engine.capture.every = 3;
  const Check scaled = check(c.engine.capture, {});
  CHECK(scaled.sum().queries == 6);
  CHECK(scaled.sum().prices.visits == 3 * sum.prices.visits);
  CHECK(scaled.sample.ends_with("that of visits has a standard error of 0 %."));  // all have as many
  capture::Capture part = c.engine.capture;
  part.queries[1].events.resize(part.queries[1].events.size() / 2);
  FaultyEngine::close(part.queries[1]);
  const Check uneven = check(part, {});
  const auto x = static_cast<double>(uneven.queries[0].prices.visits),
             y = static_cast<double>(uneven.queries[1].prices.visits);
  const long percent = std::lround(std::ceil(100 * std::abs(x - y) * std::sqrt(2.0 / 3) / (x + y)));
  CHECK(uneven.sample.ends_with(" error of " + std::to_string(percent) + " %."));
  c.engine.capture.every = 1;
  REQUIRE(checked.wrong.size() == 1);
  CHECK(checked.wrong[0].words == "missed; cause: triangle test");
  CHECK(checked.wrong[0].lines.at(0).starts_with("query 2: missed " + std::to_string(lost[0]) + "," +
                                                 std::to_string(lost[1]) + ": the triangle test"));
  Prices prices;
  for (const CheckedQuery& q : checked.queries) prices += q.prices;
  CHECK(prices == sum.prices);
  CHECK(prices.unsplit == 0);
  CheckSettings settings;
  settings.split = false;
  CHECK(check(c.engine.capture, settings).sum().prices.unsplit == prices.wasted());
  // All nodes below the root of A are elsewhere: a more frequent cause, which comes first.
  std::vector<double>& volumes = c.engine.capture.trees[c.a].volumes;
  for (std::size_t i = 8; i < volumes.size(); i += 3) volumes[i] += 100;
  c.engine.ask(c.a, {}, c.b, c.pose);
  const Check more = check(c.engine.capture, {});
  REQUIRE(more.wrong.size() == 3);
  CHECK(more.wrong[0].words.starts_with("missed; cause: volumes"));
  CHECK(more.wrong[1].words == checked.wrong[0].words);
}

TEST_CASE("Poses that are recorded wrongly are named, and only these") {
  Captures c;
  const Pose pose_a = Pose::rotation({0.2, 1, 0.4}, 0.7, {0.3, -0.2, 0.5});
  for (int i = 0; i < 4; ++i)
    c.engine.ask(c.a, pose_a, c.b,
                 {pose_a.r * c.pose.r, pose_a.apply(c.pose.t + Eigen::Vector3d(0.02 * i, 0, 0.01 * i))});
  CHECK(check(c.engine.capture, {}).pose_error.empty());
  using Wrong = Pose (*)(const Pose&);
  const std::pair<PoseError, Wrong> errors[] = {{PoseError::inverted,
                                                 [](const Pose& p) {
                                                   return Pose{p.r.transpose(), -(p.r.transpose() * p.t)};
                                                 }},
                                                {PoseError::transposed,
                                                 [](const Pose& p) {
                                                   return Pose{p.r.transpose(), p.t};
                                                 }},
                                                {PoseError::rotated_last, [](const Pose& p) {
                                                   return Pose{p.r, p.r.transpose() * p.t};
                                                 }}};
  const auto checked_with = [&](const auto& change) {
    capture::Capture wrong = c.engine.capture;
    for (capture::Query& q : wrong.queries) change(q.poses);
    return check(wrong, {});
  };
  for (const auto& [error, wrong] : errors) {
    const Check found = checked_with([wrong = wrong](auto& poses) {
      for (Pose& p : poses) p = wrong(p);
    });
    const std::string expected(words(error));
    CAPTURE(expected);
    CHECK(found.is_wrong());
    CHECK(found.pose_error.find(expected) != std::string::npos);
    for (const auto& [other, unused] : errors)
      if (other != error) CHECK(found.pose_error.find(words(other)) == std::string::npos);
  }
  const Check exchanged = checked_with([](auto& poses) { std::swap(poses[0], poses[1]); });
  CHECK(exchanged.pose_error.find("exchanged") != std::string::npos);
  // Another error, and a single wrong pair.
  const Check shifted = checked_with([](auto& poses) { poses[1].t.x() += 0.1; });
  CHECK(shifted.is_wrong());
  CHECK(shifted.pose_error.empty());
  // Triangles with other numbers.
  capture::Capture renumbered = c.engine.capture;
  for (capture::Query& q : renumbered.queries)
    for (capture::Event& e : q.events)
      if (e.kind == capture::EventKind::triangles)
        e.a = static_cast<std::uint32_t>(c.engine.capture.meshes[0].triangles.size()) - 1 - e.a;
  CHECK(check(renumbered, {}).pose_error.find("numbers the triangles in another way") != std::string::npos);
  c.lie();
  CHECK(check(c.engine.capture, {}).pose_error.empty());
}

TEST_CASE("Faults of the trees are noted, because they make prices wrong") {
  Captures c;
  c.engine.ask(c.a, {}, c.b, c.pose);
  CHECK(check(c.engine.capture, {}).tree_faults.empty());
  // A volume in another frame.
  c.engine.capture.trees[c.b].volumes[0] += 100;
  c.engine.capture.trees[c.b].volumes[3] += 100;
  const std::string faults = check(c.engine.capture, {}).tree_faults;
  CHECK(faults.find("The trees have ") == 0);
  CHECK(faults.find("lies outside node 0") != std::string::npos);
}

TEST_CASE("A recording of lrbscope is a capture whose answers are right and whose visits are the counters'") {
  for (const Mode mode : {Mode::all_pairs, Mode::any_pair}) {
    const record::Recording recorded = recorded_tori(EventLevel::nodes, mode);
    const capture::Capture c = captured(recorded);
    const Check checked = check(c, {});
    REQUIRE(checked.queries.size() == 5);
    std::uint64_t pairs = 0;
    for (std::size_t i = 0; i < 5; ++i) {
      CAPTURE(i);
      const CheckedQuery& q = checked.queries[i];
      const Counters& counters = recorded.results[i].counters;
      CHECK(q.verdict.outcome == Judgement::right);
      CHECK(c.queries[i].complete());
      CHECK(q.prices.unattributed == 0);
      CHECK(q.prices.visits >= counters.node_pairs);  // with those that the nodes' own boxes reject
      CHECK(q.prices.volume_tests == counters.box_tests);
      CHECK(q.prices.triangle_tests == counters.face_tests);
      pairs += q.verdict.exact_pairs;
    }
    CHECK(pairs > 100);
    CHECK(checked.sum().prices.needed > 0);
    CHECK(checked.sum().prices.unsplit == 0);
  }
}

TEST_CASE("Recordings without pairs of nodes are refused, and those that were cut off are incomplete") {
  CHECK_THROWS_WITH_AS(captured(recorded_tori(EventLevel::faces)), doctest::Contains("--events nodes"),
                       InputError);
  const capture::Capture cut = captured(recorded_tori(EventLevel::nodes, Mode::all_pairs, 100));
  CHECK_FALSE(cut.queries.back().complete());
  CHECK_FALSE(check(cut, {}).is_wrong());
}

}  // namespace lrb::profile
