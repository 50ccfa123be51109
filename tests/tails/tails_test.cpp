/// Costs over poses: percentiles, noise, the search for the worst pose, hard poses, and engines in other
/// programs.

#include "bench/tails/tails.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "bench/tails/engine.hpp"
#include "bench/tails/pose_space.hpp"
#include "bench/tails/worst.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/io/poses.hpp"
#include "tests/support/program.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/mesh.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::test {
namespace {

using namespace lrb::tails;

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
  std::size_t queries(std::size_t i) const { return queries_[i]; }

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
  Tail tail;
  tail.engine = "fake";
  tail.poses = numbered_poses(kPoses);
  std::vector<double> us;
  for (std::size_t i = 0; i < kPoses; ++i) {
    us.push_back(random.in(1, 100));
    tail.samples.emplace_back().answer.us = us.back();
  }
  // A failure counts nowhere.
  tail.poses.emplace_back();
  tail.samples.emplace_back().answer.failure = "killed";
  std::sort(us.begin(), us.end());
  const std::vector<Percentiles> found = percentiles(tail);
  REQUIRE(found.size() == 1);
  CHECK(found[0].what == "us");
  CHECK(found[0].count == kPoses);
  CHECK(found[0].p50 == us[124]);
  CHECK(found[0].p90 == us[224]);
  CHECK(found[0].p99 == us[247]);
  CHECK(found[0].max == us[249]);
  CHECK(tail.samples[pose_at(tail, "p99")].answer.us == us[247]);
  CHECK(tail.samples[pose_at(tail, "p0.4")].answer.us == us[0]);
  CHECK(tail.samples[pose_at(tail, "max")].answer.us == us[249]);
  CHECK(tail.samples[costliest(tail, 3)[1]].answer.us == us[248]);
  for (const char* word : {"", "p", "p0", "p101", "max1", "99", "p-3", "pinf"})
    CHECK_THROWS_AS(pose_at(tail, word), InputError);
  for (Sample& s : tail.samples) s.answer.failure = "killed";
  CHECK(percentiles(tail).empty());
  CHECK_THROWS_AS(pose_at(tail, "p99"), InputError);
}

TEST_CASE("the least of three rounds counts, and a time per test that does not repeat is noise") {
  // Pose 1 is slow in all three rounds, but not afterwards; pose 2 is always slow for its tests; pose 3 is
  // slow in one round; pose 4 has many tests, which explain its time.
  // Pose 8 has one test, and is fast all the same.
  FakeEngine engine({{10}, {90, 95, 99, 11}, {80}, {70, 10, 12}, {1000}, {10}, {10}, {10}, {9, 9, 9, 1}},
                    {10, 10, 10, 10, 1000, 10, 10, 10, 1});
  const Tail tail = measure(engine, numbered_poses(9), run::kSilent);
  CHECK(tail.rounds == kRounds);
  const auto us = [&](std::size_t i) { return tail.samples[i].answer.us; };
  CHECK(us(0) == 10);
  CHECK(us(1) == 11);
  CHECK(us(2) == 80);
  CHECK(us(3) == 10);
  CHECK(us(4) == 1000);
  for (std::size_t i = 0; i < 9; ++i) CHECK(tail.samples[i].noise == (i == 1));
  // Unusual poses are repeated after their predecessors.
  CHECK(engine.queries(0) == 6);
  CHECK(engine.queries(1) == 9);
  CHECK(engine.queries(2) == 6);
  CHECK(engine.queries(3) == 3);
  CHECK(engine.queries(8) == 3);
  CHECK(notes_of({tail}).size() == 1);
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

TEST_CASE("the search finds a planted maximum that three times as many random poses do not") {
  SearchOptions options;
  for (options.seed = 1; options.seed <= 3; ++options.seed) {
    options.budget = 3000;
    const Search found = search(options, planted_cost, kNoProgress);
    REQUIRE(found.trials.size() == 3000);
    CHECK(found.random == 1800);
    SearchOptions many = options;
    many.budget = 10000;
    const Search other = random_search(many, planted_cost, kNoProgress);
    CHECK(found.highest(3000) > 0.99);
    CHECK(other.highest(10000) < 0.9);
    CHECK(found.highest(1800) < 0.9);
    // Equal seeds, equal trials.
    const Search again = search(options, planted_cost, kNoProgress);
    CHECK(std::equal(found.trials.begin(), found.trials.end(), again.trials.begin(),
                     [](const Trial& p, const Trial& q) {
                       return p.cost == q.cost && p.number == q.number && p.at.offset == q.at.offset &&
                              p.at.turn.coeffs() == q.at.turn.coeffs();
                     }));
    const std::vector<Trial> worst = found.worst();
    CHECK(worst.size() == 8);
    CHECK(worst[0].cost == found.highest(3000));
    for (std::size_t i = 0; i < worst.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        CHECK(worst[i].cost <= worst[j].cost);
        CHECK_FALSE(alike(worst[i].at, worst[j].at));
      }
  }
}

TEST_CASE("a search spends its budget exactly, however small") {
  for (const std::size_t budget : {8, 9, 13, 20, 257, 700}) {
    std::size_t queried = 0, said = 0;
    SearchOptions options;
    options.budget = budget;
    const Search found = search(
        options,
        [&](std::span<const Placement> at) {
          queried += at.size();
          return planted_cost(at);
        },
        [&](std::size_t done) { said = done; });
    CHECK(queried == budget);
    CHECK(said == budget);
    CHECK(found.trials.back().number == budget);
  }
}

TEST_CASE("the worst poses of an engine: goals, failures, and engines that do not count") {
  const LrbRep a = body(shapes::torus(12, 8)), b = body(shapes::bumpy_sphere(2, 1));
  const PoseSpace space = space_of(a, b);
  SearchOptions options;
  options.budget = 300;
  const auto ours = our_engine(a, b);
  const Worst worst = find_worst(*ours, space, Goal::tests_per_answer, options, true, run::kSilent);
  REQUIRE(!worst.poses.empty());
  CHECK(worst.failures.empty());
  for (const QueriedTrial& t : worst.poses) {
    CHECK(t.trial.cost == static_cast<double>(*t.answer.tests) / (1 + static_cast<double>(t.answer.pairs)));
    const Pose pose = space.pose(t.trial.at);
    const EngineAnswer again = ours->ask({&pose, 1}, {.tests = true}, kNoProgress).front();
    CHECK(again.tests == t.answer.tests);
    CHECK(again.pairs == t.answer.pairs);
  }
  CHECK(worst.found.highest(300) >= worst.found.highest(180));
  const Worst again = find_worst(*ours, space, Goal::tests_per_answer, options, true, run::kSilent);
  CHECK(table_of(again) == table_of(worst));
  CHECK(json_of(again, space) == json_of(worst, space));
  const Worst tests = find_worst(*ours, space, Goal::tests, options, false, run::kSilent);
  CHECK(tests.poses[0].trial.cost == static_cast<double>(*tests.poses[0].answer.tests));
  CHECK(*tests.poses[0].answer.tests >= *worst.poses[0].answer.tests);

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
  CHECK_THROWS_WITH_AS(find_worst(uncounted, space, Goal::tests, options, false, run::kSilent),
                       "fake: expected an engine that counts its tests, found none counted; use --goal time",
                       InputError);
  const Worst times = find_worst(uncounted, space, Goal::time, options, false, run::kSilent);
  CHECK(times.poses[0].trial.cost > 0);
  CHECK(times.failures.size() > 50);
  for (const QueriedTrial& t : times.poses) CHECK(t.answer.failure.empty());
}

TEST_CASE("the map has a cell for every direction, in its range of distances") {
  std::vector<Trial> trials(1);
  trials[0].at.offset = {0.1, 0, 0};
  trials[0].cost = 7;
  const std::string one = cost_map(trials, "tests");
  CHECK(one.find("<title>7</title>") != std::string::npos);
  const auto count = [](const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
    return n;
  };
  CHECK(count(one, "no query") == 4 * 24 * 12 - 1);
  // Random directions fill the cells evenly, because their areas are equal.
  Random random(1);
  trials.clear();
  for (int i = 0; i < 30000; ++i) trials.push_back({random_placement(random), 5, 1});
  CHECK(count(cost_map(trials, "tests"), "no query") < 10);
  CHECK(cost_map({}, "tests").find("NaN") == std::string::npos);
}

TEST_CASE("gaps of triangles along separating axes are distances, or depths") {
  using Corners = std::array<Eigen::Vector3d, 3>;
  const Corners flat = {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}};
  const auto moved = [](Corners t, const Eigen::Vector3d& by) {
    for (Eigen::Vector3d& x : t) x += by;
    return t;
  };
  CHECK(signed_gap(flat, moved(flat, {0, 0, 0.5})) == doctest::Approx(0.5));
  CHECK(signed_gap(flat, moved(flat, {0.1, 0.1, 0})) == doctest::Approx(0));
  CHECK(signed_gap(flat, moved(flat, {5, 0, 0})) == doctest::Approx(1));
  const Corners upright = {{{1, 1, -0.25}, {1, 2, 1}, {1, 1, 1}}};
  CHECK(signed_gap(flat, upright) == doctest::Approx(-0.25));
  CHECK(signed_gap(upright, flat) == doctest::Approx(-0.25));
  CHECK(signed_gap(flat, moved(upright, {0, 0, 1})) == doctest::Approx(0.75));
}

TEST_CASE("hard poses are hard: in contact or within rounding of it") {
  const LrbRep a = body(shapes::box()), b = body(shapes::bumpy_sphere(1, 1));
  const PoseSpace space = space_of(a, b);
  const std::vector<HardPose> hard = hard_poses(a, b, space, 4 * kUlps.size() * 5, 1, run::kSilent);
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
  const std::vector<HardPose> again = hard_poses(a, b, space, hard.size(), 1, run::kSilent);
  for (std::size_t i = 0; i < hard.size(); ++i) CHECK(hard[i].pose.t == again[i].pose.t);
}

TEST_CASE("wrong pairs of an engine in single precision are found, exact answers have none") {
  const LrbRep a = body(shapes::box()), b = body(shapes::bumpy_sphere(1, 1));
  const PoseSpace space = space_of(a, b);
  const auto ours = our_engine(a, b);
  const WrongSearch right = find_wrong(*ours, a, b, space, 220, 1, run::kSilent);
  CHECK(right.poses.size() == 220);
  CHECK(right.worst().empty());
  FloatEngine floats(a, b);
  const WrongSearch wrong = find_wrong(floats, a, b, space, 220, 1, run::kSilent);
  REQUIRE(!wrong.worst().empty());
  CHECK(wrong.worst()[0].wrong_contact());
  double error = 0;
  for (const Judged& j : wrong.poses) error = std::max(error, j.error);
  CHECK(error > 1e-10);
  CHECK(error < 1e-6);
  CHECK(json_of(wrong).size() == wrong.worst().size());
  CHECK(table_of(wrong) != table_of(right));
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

TEST_CASE("equal queries of a capture are rounds of one pose") {
  using capture::EventKind;
  capture::Capture c;
  c.engine = "toy";
  c.queries = {query(1, 5, {}, 1), query(2, 9, {event(EventKind::nodes, 0, 0, 0)}, 2),
               query(3, 7, {event(EventKind::nodes, 0, 0, 0), event(EventKind::nodes, 1, 0, 0)}, 1),
               query(4, 8, {event(EventKind::nodes, 0, 0, 0)}, 2), query(5, 1, {}, 3)};
  c.queries[4].ended = false;
  const Tail tail = tail_of(c, "run.lrbcap");
  REQUIRE(tail.samples.size() == 2);
  CHECK(tail.rounds == 2);
  CHECK(tail.with_events);
  CHECK(tail.samples[0].answer.us == 5);
  CHECK(tail.samples[0].answer.tests == 2);
  CHECK(tail.samples[1].answer.us == 8);
  CHECK(tail.queries == std::vector<std::uint32_t>{1, 4});
  CHECK(tail.poses[1].t.x() == 2);
  c.queries = {c.queries[4]};
  CHECK_THROWS_WITH_AS(tail_of(c, "run.lrbcap"), "run.lrbcap: expected queries that ended, found none",
                       InputError);
}

TEST_CASE("requests and replies of a worker") {
  Folder folder;
  write_mesh(shapes::box(), folder / "a.obj");
  write_mesh(shapes::box({0.5, 0.5, 0.5}, {2, 2, 2}), folder / "b.obj");
  const BodyFiles files = {folder / "a.obj", folder / "b.obj"};
  methods::MethodEntry ours;
  for (const methods::MethodEntry& e : methods::registered_methods())
    if (e.info.name == "ours") ours = e;
  std::stringstream requests(request_line(Pose{}, {.tests = true, .list = true}) +
                             request_line(Pose::translation({9, 0, 1.0 / 3}), {}));
  std::vector<std::string> lines;
  serve(ours, files, requests, [&](const std::string& line) { lines.push_back(line); });
  REQUIRE(lines.size() == 3);
  CHECK(nlohmann::json::parse(lines[0]).at("ready") == true);
  const EngineAnswer near = reply_from(lines[1]), far = reply_from(lines[2]);
  const LrbRep a = body(shapes::box()), b = body(shapes::box({0.5, 0.5, 0.5}, {2, 2, 2}));
  const CollideResult exact = collide(a, Pose{}, b, Pose{});
  CHECK(near.list == exact.pairs);
  CHECK(near.pairs == exact.pairs.size());
  CHECK(near.kinds->boxes == exact.counters.box_tests);
  CHECK(near.us > 0);
  CHECK(far.pairs == 0);
  CHECK_FALSE(far.tests);
  std::stringstream bad("0 1 2\n");
  CHECK_THROWS_AS(serve(ours, files, bad, [](const std::string&) {}), InputError);
  CHECK_THROWS_AS(reply_from("{}"), InputError);
}

namespace {

/// Two bodies centred at 0, and the arguments of a command about them.
struct Two {
  Folder folder;
  Two() {
    write_mesh(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), folder / "a.obj");
    write_mesh(shapes::torus(8, 6, 0.5, 0.2), folder / "b.obj");
  }
  static std::vector<std::string> with(const std::string& command, const std::vector<std::string>& more) {
    std::vector<std::string> all = {command, "a.obj", "b.obj", "--quiet"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
};

}  // namespace

TEST_CASE("tails: a table, the same as JSON, and a page with what records the costliest poses") {
  const Two two;
  const Outcome table = run(two.folder, Two::with("tails", {"--poses", "200"}));
  CHECK(table.code == 0);
  CHECK(table.err.empty());
  CHECK(table.out.find("face tests") != std::string::npos);
  const std::vector<std::string> page = {"--poses", "60", "-o", "out", "--record", "p50,max"};
  const Outcome written = run(two.folder, Two::with("tails", page));
  CAPTURE(written.err);
  CHECK(written.code == 0);
  const std::string html = slurp(two.folder / "out/index.html");
  CHECK(html.find("lrbscope collide a.obj b.obj --poses out/poses/ours-") != std::string::npos);
  std::size_t lines = 0, runs = 0;
  std::istringstream samples(slurp(two.folder / "out/tails.jsonl"));
  for (std::string line; std::getline(samples, line); ++lines)
    CHECK(nlohmann::json::parse(line).at("tests") > 0);
  CHECK(lines == 60);
  for (const std::string& file : two.folder.tree()) runs += file.ends_with("trace.json") ? 1 : 0;
  CHECK(runs == 2);
}

TEST_CASE("tails and worst: the same seed gives the same tests") {
  const Two two;
  const auto tests = [&](const char* seed) {
    std::istringstream out(
        run(two.folder, Two::with("tails", {"--json", "--poses", "100", "--seed", seed})).out);
    std::vector<double> numbers;
    for (std::string line; std::getline(out, line);)
      if (const auto row = nlohmann::json::parse(line); row.at("what") != "us")
        numbers.push_back(row.at("p90"));
    return numbers;
  };
  CHECK(tests("1").size() == 3);
  CHECK(tests("1") == tests("1"));
  CHECK(tests("1") != tests("2"));
  const auto worst = [&](const char* seed) {
    return run(two.folder, Two::with("worst", {"--budget", "200", "--json", "--seed", seed})).out;
  };
  CHECK(!worst("1").empty());
  CHECK(worst("1") == worst("1"));
  CHECK(worst("1") != worst("2"));
}

TEST_CASE("worst: the page has a scenario whose expectations are met") {
  const Two two;
  const Outcome found = run(two.folder, Two::with("worst", {"--budget", "150", "-o", "out"}));
  CAPTURE(found.err);
  CHECK(found.code == 0);
  CHECK(found.out.find("At random, 150 queries find") != std::string::npos);
  const auto scenario = nlohmann::json::parse(slurp(two.folder / "out/worst.scenario.json"));
  CHECK(scenario.at("expect").size() == scenario.at("motion").at("poses").size());
  const Outcome ran =
      run(two.folder, {"run", "out/worst.scenario.json", "-o", "again", "--frames", "none", "-q"});
  CAPTURE(ran.err);
  CHECK(ran.code == 0);
  auto tighter = scenario;
  auto& budget = tighter["expect"][0]["max_tests"];
  budget = budget.get<int>() - 1;
  two.folder.write("out/tighter.scenario.json", tighter.dump());
  CHECK(
      run(two.folder, {"run", "out/tighter.scenario.json", "-o", "tighter", "--frames", "none", "-q"}).code ==
      1);
  CHECK(slurp(two.folder / "out/index.html").find("map.svg") != std::string::npos);
  CHECK(slurp(two.folder / "out/poses/1.txt").size() > 20);
}

TEST_CASE("worst: wrong pairs are none for the exact query") {
  const Two two;
  const Outcome found =
      run(two.folder, Two::with("worst", {"--budget", "72", "--goal", "wrong", "-o", "out"}));
  CAPTURE(found.err);
  CHECK(found.code == 0);
  CHECK(found.out.find("parallel edges") != std::string::npos);
  CHECK(slurp(two.folder / "out/index.html").find("No pair was missed") != std::string::npos);
}

TEST_CASE("a program of another engine: the search finds where it tests most") {
  const Two two;
  const std::vector<std::string> program = {"--command", LRB_PLANTED_ENGINE, "--budget", "600", "--json"};
  const Outcome found = run(two.folder, Two::with("worst", program));
  CAPTURE(found.err);
  REQUIRE(found.code == 0);
  const auto worst = nlohmann::json::parse(found.out.substr(0, found.out.find('\n')));
  CHECK(worst.at("tests") == 1 + 12 * 96);
  CHECK(worst.at("box_tests") == 1 + 12 * 96);
  CHECK(run(two.folder, Two::with("worst", program)).out == found.out);
  const Outcome tails =
      run(two.folder, Two::with("tails", {"--command", LRB_PLANTED_ENGINE, "--poses", "300"}));
  CAPTURE(tails.err);
  CHECK(tails.code == 0);
  CHECK(tails.out.find("tests in phase leaves") != std::string::npos);
}

TEST_CASE("a program that fails, hangs, or records nothing or something else is refused in one line") {
  const Two two;
  const auto says = [&](const std::string& planted, const std::string& words) {
    const Environment fault("PLANTED", planted);
    for (const char* command : {"worst", "tails"}) {
      const Outcome o = check_rejected(
          two.folder, Two::with(command, {"--command", LRB_PLANTED_ENGINE, "--timeout", "2", "-o", "out"}));
      CAPTURE(o.err);
      CHECK(o.err.find(words) != std::string::npos);
    }
  };
  says("fail", "exited with code 3 after 'the planted fault'");
  says("crash", "was killed by signal 6");
  says("hang", "expected its end within 2 s, found it still running");
  says("nothing", "expected a capture in $LRBCAP_OUT, found nothing");
  says("junk", "its capture");
  says("short", "expected 256 queries, one for each pose, found 1");
  says("shift", "query 1: expected the pose of line 1, found another");
  const Outcome missing = check_rejected(two.folder, Two::with("worst", {"--command", "./no-such-program"}));
  CHECK(missing.err.find("exited with code 127") != std::string::npos);
}

TEST_CASE("tails of a capture, and rejected captures") {
  const Two two;
  io::save_poses(two.folder / "poses.txt",
                 std::vector<Pose>{Pose::translation({0.1, 0, 0}), Pose::translation({3, 0, 0}),
                                   Pose::translation({0.1, 0, 0})});
  REQUIRE(std::system(("cd '" + two.folder.path.string() +
                       "' && LRBCAP_OUT=run.lrbcap " LRB_PLANTED_ENGINE " a.obj b.obj poses.txt")
                          .c_str()) == 0);
  const Outcome o = run(two.folder, {"tails", "run.lrbcap", "--json", "-o", "out"});
  CAPTURE(o.err);
  REQUIRE(o.code == 0);
  CHECK(o.err.find("events were recorded") != std::string::npos);
  std::istringstream lines(o.out);
  std::size_t rows = 0;
  for (std::string line; std::getline(lines, line); ++rows) {
    const auto row = nlohmann::json::parse(line);
    CHECK(row.at("engine") == "planted engine");
    CHECK(row.at("poses") == 2);
    if (row.at("what") == "tests") CHECK(row.at("max") == 1 + 12 * 96);
  }
  CHECK(rows == 6);
  CHECK(slurp(two.folder / "out/index.html").find("lrbscope import run.lrbcap --queries ") !=
        std::string::npos);
  CHECK(check_rejected(two.folder, {"tails", "a.obj"}).err.find("expected a second body, or a capture") !=
        std::string::npos);
  two.folder.write("cut.lrbcap", slurp(two.folder / "run.lrbcap").substr(0, 40));
  check_rejected(two.folder, {"tails", "cut.lrbcap"});
  check_rejected(two.folder, {"tails", "run.lrbcap", "--method", "ours"});
  check_rejected(two.folder, {"tails", "run.lrbcap", "--record", "p99"});
  check_rejected(two.folder, {"tails", "run.lrbcap", "--record", "often", "-o", "elsewhere"});
  check_rejected(two.folder, Two::with("tails", {"--method", "no-such"}));
  check_rejected(two.folder, Two::with("worst", {"--method", "ours", "--command", "true"}));
  check_rejected(two.folder, Two::with("worst", {"--budget", "0"}));
  check_rejected(two.folder, Two::with("worst", {"--goal", "best"}));
}

TEST_CASE("a worker that crashes or hangs loses the pose, not the measurement") {
  const Two two;
  const Environment fakes("LRBSCOPE_FAKE_METHODS", "1");
  const auto failed = [&](const char* method, const char* limit) {
    const Outcome o = run(two.folder, Two::with("tails", {"--method", method, "--poses", "6", "--seed", "2",
                                                          "--json", "--timeout", limit}));
    CAPTURE(o.err);
    CHECK(o.code == 0);
    const auto row = nlohmann::json::parse(o.out.substr(0, o.out.find('\n')));
    CHECK(row.at("poses").get<int>() + row.at("failed").get<int>() == 6);
    CHECK(row.at("poses") > 0);
    return row.at("failed").get<int>();
  };
  CHECK(failed("fake-miss", "60") == 0);
  const int in_contact = failed("fake-throw", "60");
  CHECK(in_contact > 0);
  CHECK(failed("fake-crash", "60") == in_contact);
  CHECK(failed("fake-hang", "0.3") >= in_contact);  // the rest is skipped after three in a row
}

}  // namespace lrb::test
