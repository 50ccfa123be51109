/// Costs of engines over poses: percentiles, the search for the worst pose, and hard poses. The commands, and
/// engines in other programs: tests/commands/engines.txt.

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "bench/engines/costs.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/bodies/shapes.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::test {
namespace {

using namespace lrb::engines;

/// An engine with a clock of its own: the time of pose i when it is timed for the k-th time.
class FakeEngine : public Engine {
 public:
  FakeEngine(std::vector<std::vector<double>> times, std::vector<std::uint64_t> tests)
      : times_(std::move(times)), tests_(std::move(tests)), queries_(times_.size(), 0) {}

  std::string name() const override { return "fake"; }
  std::vector<EngineAnswer> ask(std::span<const Pose> poses, Wanted wanted,
                                const Progress& progress) override {
    std::vector<EngineAnswer> out;
    for (const Pose& pose : poses) {
      const auto i = static_cast<std::size_t>(pose.t.x());
      EngineAnswer& answer = out.emplace_back();
      if (wanted.tests) {
        answer.us = 1e6;  // counting takes long, and must not count as time
        answer.tests = tests_[i];
        continue;
      }
      answer.us = times_[i][std::min(queries_[i]++, times_[i].size() - 1)];
    }
    progress(out.size());
    return out;
  }

 private:
  std::vector<std::vector<double>> times_;
  std::vector<std::uint64_t> tests_;
  std::vector<std::size_t> queries_;
};

std::vector<Pose> numbered_poses(std::size_t n) {
  std::vector<Pose> out;
  for (std::size_t i = 0; i < n; ++i) out.push_back(Pose::translation({static_cast<double>(i), 0, 0}));
  return out;
}

LrbRep body(const Mesh& mesh) {
  return bodies::faces_of_mesh(mesh).rep;
}

/// Our own query at the pose rounded to floats: an engine in single precision.
class FloatEngine : public Engine {
 public:
  FloatEngine(const LrbRep& a, const LrbRep& b) : exact_(our_engine(a, b)) {}
  std::string name() const override { return "floats"; }
  std::vector<EngineAnswer> ask(std::span<const Pose> poses, Wanted wanted,
                                const Progress& progress) override {
    std::vector<Pose> rounded;
    for (const Pose& p : poses)
      rounded.push_back({p.r.cast<float>().cast<double>(), p.t.cast<float>().cast<double>()});
    return exact_->ask(rounded, wanted, progress);
  }

 private:
  std::unique_ptr<Engine> exact_;
};

PoseSpace space_of(const LrbRep& a, const LrbRep& b) {
  return {shapes::box_of(a), shapes::box_of(b)};
}

/// A cost with one narrow peak of height 1 among many low hills.
std::vector<double> planted_cost(std::span<const Placement> at) {
  Placement peak;
  peak.turn = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5);
  peak.offset = {0.2, -0.3, 0.4};
  std::vector<double> out;
  for (const Placement& p : at) {
    const double turn = 1 - std::abs(p.turn.dot(peak.turn)), way = (p.offset - peak.offset).squaredNorm();
    out.push_back(1 / (1 + 20 * turn + 20 * way) + 0.01 * std::sin(40 * p.offset.x()));
  }
  return out;
}

const SearchProgress kNoProgress = [](std::size_t) {};

capture::Query query(std::uint32_t number, double us, std::vector<capture::Event> events, double x = 0) {
  capture::Query q;
  q.number = number;
  q.duration_ns = us * 1e3;
  q.ended = true;
  q.pairs = 1;
  q.poses[1].t.x() = x;
  q.events = std::move(events);
  q.events_seen = q.events.size();
  if (!q.events.empty()) q.parts = {{0, 0, q.events.size()}};
  return q;
}

capture::Event event(capture::EventKind kind, std::uint32_t a, std::uint32_t b, std::uint8_t met,
                     std::uint8_t tests = 1) {
  return {a, b, kind, met, tests, capture::kNoAxis};
}

}  // namespace

TEST_CASE("percentiles are values of the sorted list, and quantities that are not reported have none") {
  constexpr std::size_t kPoses = 250;
  Random random(5);
  Samples samples;
  samples.engine = "fake";
  samples.poses = numbered_poses(kPoses + 1);
  std::vector<double> us;
  for (std::size_t i = 0; i < kPoses; ++i) {
    us.push_back(random.in(1, 100));
    samples.answers.emplace_back().us = us.back();
  }
  samples.answers.emplace_back().failure = "killed";  // counts nowhere
  std::sort(us.begin(), us.end());
  const std::vector<Percentiles> found = percentiles(samples);
  REQUIRE(found.size() == 1);
  CHECK(found[0].what == "us");
  CHECK(found[0].count == kPoses);
  CHECK(found[0].p50 == us[124]);
  CHECK(found[0].p90 == us[224]);
  CHECK(found[0].p99 == us[247]);
  CHECK(found[0].max == us[249]);
  CHECK(notes_of({samples}) ==
        std::vector<std::string>{"fake: no answer at 1 of 251 poses; pose 250: killed"});
  for (EngineAnswer& a : samples.answers) a.failure = "killed";
  CHECK(percentiles(samples).empty());
}

TEST_CASE("the least of three rounds counts, and counting tests takes no time") {
  FakeEngine engine({{10}, {90, 95, 11}, {70, 10, 12}}, {10, 1000, 1});
  const Samples samples = measure(engine, numbered_poses(3), run::kSilent);
  CHECK(samples.rounds == kRounds);
  CHECK(samples.answers[0].us == 10);
  CHECK(samples.answers[1].us == 11);
  CHECK(samples.answers[2].us == 10);
  CHECK(samples.answers[1].tests == 1000);
}

TEST_CASE("random placements are uniform in rotation, direction and distance") {
  constexpr int kMany = 20000;
  Random random(1);
  Eigen::Matrix3d rotations = Eigen::Matrix3d::Zero();
  Eigen::Vector3d directions = Eigen::Vector3d::Zero();
  double length = 0, trace_sq = 0;
  for (int i = 0; i < kMany; ++i) {
    const Placement p = random_placement(random);
    const Eigen::Matrix3d r = p.turn.toRotationMatrix();
    CHECK(p.offset.norm() < 1);
    rotations += r / kMany;
    directions += p.offset.normalized() / kMany;
    length += p.offset.norm() / kMany;
    trace_sq += r.trace() * r.trace() / kMany;
  }
  // Means of uniform ones: 0, 0, 1/2; the squared trace of a rotation has mean 1 (orthogonality of
  // characters). A uniform angle about a uniform axis would give 3.
  CHECK(rotations.norm() < 0.03);
  CHECK(directions.norm() < 0.03);
  CHECK(length == doctest::Approx(0.5).epsilon(0.02));
  CHECK(trace_sq == doctest::Approx(1).epsilon(0.05));
}

TEST_CASE("a pose puts the centres of both boxes as far apart as the placement says") {
  const LrbRep a = body(shapes::box({1, 2, 3}, {3, 4, 5})), b = body(shapes::box({-9, 0, 0}, {-8, 2, 2}));
  const PoseSpace space = space_of(a, b);
  CHECK(space.unit() == doctest::Approx((std::sqrt(12.0) + 3) / 2));
  Random random(3);
  const Placement at = random_placement(random);
  const Eigen::Vector3d centre = space.pose(at).apply({-8.5, 1, 1});
  CHECK((centre - Eigen::Vector3d(2, 3, 4) - space.unit() * at.offset).norm() < 1e-12);
}

TEST_CASE("the search finds a planted maximum that random poses do not, and spends its budget exactly") {
  SearchOptions options;
  for (options.seed = 1; options.seed <= 3; ++options.seed) {
    options.budget = 3000;
    const Search found = search(options, planted_cost, kNoProgress);
    REQUIRE(found.trials.size() == 3000);
    CHECK(found.random == 1800);
    const auto highest = [&](std::size_t n) {
      return std::max_element(found.trials.begin(), found.trials.begin() + static_cast<std::ptrdiff_t>(n),
                              [](const Trial& p, const Trial& q) { return p.cost < q.cost; })
          ->cost;
    };
    CHECK(highest(3000) > 0.99);
    CHECK(highest(1800) < 0.9);
    // Equal seeds, equal trials.
    const Search again = search(options, planted_cost, kNoProgress);
    CHECK(std::equal(found.trials.begin(), found.trials.end(), again.trials.begin(),
                     [](const Trial& p, const Trial& q) {
                       return p.cost == q.cost && p.number == q.number && p.at.offset == q.at.offset &&
                              p.at.turn.coeffs() == q.at.turn.coeffs();
                     }));
    const std::vector<Trial> worst = found.worst();
    CHECK(worst.size() == 8);
    CHECK(worst[0].cost == highest(3000));
    for (std::size_t i = 0; i < worst.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        CHECK(worst[i].cost <= worst[j].cost);
        CHECK_FALSE(alike(worst[i].at, worst[j].at));
      }
  }
  for (const std::size_t budget : {8, 9, 257, 700}) {
    std::size_t queried = 0;
    options.budget = budget;
    const auto counted = [&](std::span<const Placement> at) {
      queried += at.size();
      return planted_cost(at);
    };
    CHECK(search(options, counted, kNoProgress).trials.back().number == budget);
    CHECK(queried == budget);
  }
}

TEST_CASE("the worst poses of an engine: goals, failures, and engines that do not count") {
  const LrbRep a = body(shapes::torus(12, 8)), b = body(shapes::bumpy_sphere(2, 1));
  const PoseSpace space = space_of(a, b);
  SearchOptions options;
  options.budget = 300;
  const auto ours = our_engine(a, b);
  const Found worst = find_costly(*ours, space, Goal::tests_per_answer, options, run::kSilent);
  REQUIRE(!worst.poses.empty());
  CHECK(worst.failures.empty());
  for (std::size_t i = 0; i < worst.poses.size(); ++i) {
    const auto row = nlohmann::json::parse(worst.rows.lines[i]);
    CHECK(row["cost"] == row["tests"].get<double>() / (1 + row["pairs"].get<double>()));
    const EngineAnswer again = ours->ask({&worst.poses[i], 1}, {.tests = true}, kNoProgress).front();
    CHECK(again.tests == row["tests"].get<std::uint64_t>());
    CHECK(again.pairs == row["pairs"].get<std::uint64_t>());
  }
  const Found tests = find_costly(*ours, space, Goal::tests, options, run::kSilent);
  CHECK(nlohmann::json::parse(tests.rows.lines[0])["tests"] >=
        nlohmann::json::parse(worst.rows.lines[0])["tests"]);

  class Uncounted : public FakeEngine {
   public:
    Uncounted() : FakeEngine({}, {}) {}
    std::vector<EngineAnswer> ask(std::span<const Pose> poses, Wanted, const Progress&) override {
      std::vector<EngineAnswer> out(poses.size());
      for (std::size_t i = 0; i < poses.size(); ++i) {
        out[i].us = poses[i].t.norm();
        if (i % 2 == 1) out[i].failure = "killed";
      }
      return out;
    }
  } uncounted;
  CHECK_THROWS_WITH_AS(find_costly(uncounted, space, Goal::tests, options, run::kSilent),
                       "fake: expected an engine that counts its tests, found none counted; use --goal time",
                       InputError);
  const Found times = find_costly(uncounted, space, Goal::time, options, run::kSilent);
  CHECK(nlohmann::json::parse(times.rows.lines[0])["cost"] > 0);
  CHECK(times.failures.size() > 50);
}

TEST_CASE("hard poses are hard: in contact or within rounding of it") {
  const LrbRep a = body(shapes::box()), b = body(shapes::bumpy_sphere(1, 1));
  const PoseSpace space = space_of(a, b);
  const std::vector<HardPose> hard = hard_poses(a, b, space, 4 * kUlps.size() * 5, 1);
  REQUIRE(hard.size() == 220);
  Workspace workspace;
  std::size_t first = 0;
  for (const HardPose& h : hard) {
    CHECK((h.pose.r * h.pose.r.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-12);
    const bool meets = !collide(a, Pose{}, b, h.pose, CollideRequest{}, workspace).value().pairs.empty();
    if (h.kind != Hard::first_contact) continue;
    ++first;
    // B moves away from A by positive numbers of units.
    if (h.ulps <= 0 && h.ulps >= -(1 << 12)) CHECK(meets);
    if (h.ulps >= 1 << 12) CHECK_FALSE(meets);
  }
  CHECK(first == 55);
  // A second time, the same.
  const std::vector<HardPose> again = hard_poses(a, b, space, hard.size(), 1);
  for (std::size_t i = 0; i < hard.size(); ++i) CHECK(hard[i].pose.t == again[i].pose.t);
}

TEST_CASE("wrong pairs of an engine in single precision are found, exact answers have none") {
  const LrbRep a = body(shapes::box()), b = body(shapes::bumpy_sphere(1, 1));
  const PoseSpace space = space_of(a, b);
  SearchOptions options;
  options.budget = 220;
  const auto ours = our_engine(a, b);
  const Found right = find_wrong(*ours, a, b, space, options, run::kSilent);
  CHECK(right.poses.empty());
  FloatEngine floats(a, b);
  const Found wrong = find_wrong(floats, a, b, space, options, run::kSilent);
  REQUIRE(wrong.poses.size() == 8);
  const auto worst = nlohmann::json::parse(wrong.rows.lines[0]);
  CHECK((worst["pairs"] == 0) != (worst["exact_pairs"] == 0));  // wrong contacts come first
  CHECK(worst["error"] > 1e-10);
  CHECK(worst["error"] < 1e-6);
  CHECK(wrong.rows.table != right.rows.table);
}

TEST_CASE(
    "answers of captured queries: tests by kind and phase, pairs, and zero for events that were not kept") {
  using capture::EventKind;
  const std::vector<std::string> names = {"broad", "narrow"};
  capture::Query q = query(1, 2.5,
                           {event(EventKind::phase, 0, 0, 0), event(EventKind::nodes, 0, 0, 3, 4),
                            event(EventKind::nodes, 1, 1, 0), event(EventKind::phase, 1, 0, 0),
                            event(EventKind::triangles, 7, 2, 1), event(EventKind::triangles, 3, 2, 1),
                            event(EventKind::triangles, 3, 9, 0), event(EventKind::count, 0, 5, 0)});
  const EngineAnswer a = answer_of(q, names, true);
  CHECK(a.us == 2.5);
  CHECK(a.pairs == 1);
  CHECK(a.tests == 8);
  CHECK(a.kinds->boxes == 5);
  CHECK(a.kinds->faces == 3);
  CHECK(a.phases.at("broad") == 5);
  CHECK(a.phases.at("narrow") == 3);
  const std::vector<SimplexPair> list = {{SimplexId(3), SimplexId(2)}, {SimplexId(7), SimplexId(2)}};
  CHECK(a.list == list);
  q.events.pop_back();  // not all were kept
  q.parts[0].count = q.events.size();
  CHECK(answer_of(q, names, false).tests == 8);
  CHECK_FALSE(answer_of(q, names, false).kinds);
  CHECK_FALSE(answer_of(query(1, 2, {}), names, false).tests);
}

}  // namespace lrb::test
