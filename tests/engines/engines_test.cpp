/// Costs of engines over poses: percentiles, the search for the worst pose, hard poses, and engines in other
/// programs.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "bench/engines/costs.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/io/poses.hpp"
#include "tests/support/program.hpp"
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

TEST_CASE("equal queries of a capture are rounds of one pose") {
  using capture::EventKind;
  capture::Capture c;
  c.engine = "toy";
  c.queries = {query(1, 5, {}, 1), query(2, 9, {event(EventKind::nodes, 0, 0, 0)}, 2),
               query(3, 7, {event(EventKind::nodes, 0, 0, 0), event(EventKind::nodes, 1, 0, 0)}, 1),
               query(4, 8, {event(EventKind::nodes, 0, 0, 0)}, 2), query(5, 1, {}, 3)};
  c.queries[4].ended = false;
  const Samples samples = samples_of(c, "run.lrbcap");
  REQUIRE(samples.answers.size() == 2);
  CHECK(samples.rounds == 2);
  CHECK(samples.with_events);
  CHECK(samples.answers[0].us == 5);
  CHECK(samples.answers[0].tests == 2);
  CHECK(samples.answers[1].us == 8);
  CHECK(samples.poses[1].t.x() == 2);
  c.queries = {c.queries[4]};
  CHECK_THROWS_WITH_AS(samples_of(c, "run.lrbcap"), "run.lrbcap: expected queries that ended, found none",
                       InputError);
}

namespace {

const std::vector<std::string> kPercentiles = {"bench", "--percentiles"}, kSearch = {"stability", "--search"};

/// Two bodies centred at 0, and the arguments of a command about them.
struct Two {
  Folder folder;
  Two() {
    write_mesh(shapes::box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}), folder / "a.obj");
    write_mesh(shapes::torus(8, 6, 0.5, 0.2), folder / "b.obj");
  }
  static std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), {"a.obj", "b.obj", "--quiet"});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// Returns the lines of JSON that the command prints.
  std::vector<nlohmann::json> rows(const std::vector<std::string>& words,
                                   const std::vector<std::string>& more) const {
    std::vector<std::string> all = with(words, more);
    all.emplace_back("--json");
    const Outcome o = run(folder, all);
    CAPTURE(o.err);
    CHECK(o.code == 0);
    std::istringstream in(o.out);
    std::vector<nlohmann::json> out;
    for (std::string line; std::getline(in, line);) out.push_back(nlohmann::json::parse(line));
    return out;
  }
};

}  // namespace

TEST_CASE("the same seed gives the same tests, as table and as JSON") {
  const Two two;
  const auto tests = [&](const char* seed) {
    std::vector<double> numbers;
    for (const auto& row : two.rows(kPercentiles, {"--poses", "100", "--seed", seed}))
      if (row.at("what") != "us") numbers.push_back(row.at("p90"));
    return numbers;
  };
  CHECK(tests("1").size() == 3);
  CHECK(tests("1") == tests("1"));
  CHECK(tests("1") != tests("2"));
  const auto worst = [&](const char* seed) { return two.rows(kSearch, {"--budget", "200", "--seed", seed}); };
  CHECK(!worst("1").empty());
  CHECK(worst("1") == worst("1"));
  CHECK(worst("1") != worst("2"));
  CHECK(run(two.folder, Two::with(kPercentiles, {"--poses", "50"})).out.find("face tests") !=
        std::string::npos);
  const Outcome wrong = run(two.folder, Two::with(kSearch, {"--budget", "72", "--goal", "wrong"}));
  CHECK(wrong.out.find("parallel edges") != std::string::npos);
}

TEST_CASE("the scenario of the worst poses meets its own expectations") {
  const Two two;
  const Outcome found = run(two.folder, Two::with(kSearch, {"--budget", "150", "-o", "out"}));
  CAPTURE(found.err);
  CHECK(found.code == 0);
  const auto scenario = nlohmann::json::parse(slurp(two.folder / "out/worst.scenario.json"));
  CHECK(scenario.at("expect").size() == scenario.at("motion").at("poses").size());
  const auto code_of = [&](const std::string& file) {
    return run(two.folder, {"run", file, "-o", "again", "--frames", "none", "-q"}).code;
  };
  CHECK(code_of("out/worst.scenario.json") == 0);
  auto tighter = scenario;
  auto& budget = tighter["expect"][0]["max_tests"];
  budget = budget.get<int>() - 1;
  two.folder.write("out/tighter.scenario.json", tighter.dump());
  CHECK(code_of("out/tighter.scenario.json") == 1);
}

TEST_CASE("a method in a worker has lrbscope's pairs and the same tests") {
  const Two two;
  const auto ours = two.rows(kPercentiles, {"--poses", "100"});
  const auto rows = two.rows(kPercentiles, {"--poses", "100", "--method", "ours-paper,ours"});
  const auto of_paper = std::find_if(rows.begin(), rows.end(),
                                     [](const auto& row) { return row.at("engine") == "ours-paper"; });
  REQUIRE(of_paper != rows.end());
  CHECK(of_paper->at("poses") == 100);
  CHECK(of_paper->at("failed") == 0);
  for (std::size_t i = 1; i < ours.size(); ++i)
    CHECK(std::find(rows.begin(), rows.end(), ours[i]) != rows.end());
  // The paper's recursion misses pairs that only touch, which hard poses have.
  CHECK(!two.rows(kSearch, {"--budget", "44", "--goal", "wrong", "--method", "ours-paper"}).empty());
  check_rejected(two.folder, Two::with(kSearch, {"--method", "no-such"}));
}

TEST_CASE("a program of another engine: the search finds where it tests most") {
  const Two two;
  const std::string program = "command:" LRB_PLANTED_ENGINE;
  const auto found = two.rows(kSearch, {"--method", program, "--budget", "600"});
  REQUIRE(!found.empty());
  CHECK(found[0].at("tests") == 1 + 12 * 96);
  CHECK(found[0].at("box_tests") == 1 + 12 * 96);
  CHECK(two.rows(kSearch, {"--method", program, "--budget", "600"}) == found);
  const auto wasted = two.rows(kSearch, {"--method", program, "--budget", "16", "--goal", "wasted"});
  REQUIRE(!wasted.empty());
  CHECK(wasted[0].at("cost") == 0);  // its volumes contain both bodies, so that no visit could be saved
  const auto tails = two.rows(kPercentiles, {"--method", program, "--poses", "300"});
  CHECK(tails.back().at("what") == "tests in phase roots");
}

TEST_CASE("a program that fails, hangs, or records nothing or something else is refused in one line") {
  const Two two;
  const auto says = [&](const std::string& planted, const std::string& words) {
    const Environment fault("PLANTED", planted);
    for (const auto& command : {kSearch, kPercentiles}) {
      const Outcome o = check_rejected(
          two.folder, Two::with(command, {"--method", "command:" LRB_PLANTED_ENGINE, "--timeout", "2"}));
      CAPTURE(o.err);
      CHECK(o.err.find(words) != std::string::npos);
    }
  };
  says("fail", "exited with code 3 after 'the planted fault'");
  says("crash", "killed by signal 6");
  says("hang", "expected its end within 2 s, found it still running");
  says("nothing", "expected a capture in $LRBCAP_OUT, found nothing");
  says("junk", "its capture");
  says("short", "expected 256 queries, one for each pose, found 1");
  says("shift", "query 1: expected the pose of line 1, found another");
  CHECK(check_rejected(two.folder, Two::with(kSearch, {"--method", "command:./no-such-program"}))
            .err.find("exited with code 127") != std::string::npos);
}

TEST_CASE("percentiles of a capture, and rejected captures") {
  const Two two;
  io::save_poses(two.folder / "poses.txt",
                 std::vector<Pose>{Pose::translation({0.1, 0, 0}), Pose::translation({3, 0, 0}),
                                   Pose::translation({0.1, 0, 0})});
  REQUIRE(std::system(("cd '" + two.folder.path.string() +
                       "' && LRBCAP_OUT=run.lrbcap " LRB_PLANTED_ENGINE " a.obj b.obj poses.txt")
                          .c_str()) == 0);
  const Outcome o = run(two.folder, {"bench", "--percentiles", "run.lrbcap", "--json"});
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
  for (const std::vector<std::string>& more : std::vector<std::vector<std::string>>{
           {"a.obj"}, {"missing.lrbcap"}, {"run.lrbcap", "--method", "fcl"}}) {
    std::vector<std::string> words = kPercentiles;
    words.insert(words.end(), more.begin(), more.end());
    check_rejected(two.folder, words);
  }
}

}  // namespace lrb::test
