/// Costs of engines over poses: percentiles, and answers of captures. The search for the worst pose and
/// engines in other programs: tests/commands/engines.txt.

#include <algorithm>

#include <doctest/doctest.h>

#include "bench/engines/costs.hpp"
#include "bench/workers/workers.hpp"
#include <lrbscope/error.hpp>

namespace lrb::test {
namespace {

using namespace lrb::engines;

/// An engine with a clock of its own: the time of pose i when it is timed for the k-th time.
class FakeEngine : public Engine {
 public:
  FakeEngine(std::vector<std::vector<double>> times, std::vector<std::uint64_t> tests)
      : times_(std::move(times)), tests_(std::move(tests)), queries_(times_.size(), 0) {}

  std::string name() const override { return "fake"; }
  std::vector<methods::Answer> ask(std::span<const Pose> poses, Wanted wanted,
                                   const Progress& progress) override {
    std::vector<methods::Answer> out;
    for (const Pose& pose : poses) {
      const auto i = static_cast<std::size_t>(pose.t.x());
      methods::Answer& answer = out.emplace_back();
      if (wanted.tests) {
        answer.microseconds = 1e6;  // counting takes long, and must not count as time
        answer.tests = tests_[i];
        continue;
      }
      answer.microseconds = times_[i][std::min(queries_[i]++, times_[i].size() - 1)];
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

TEST_CASE("an error in place of an answer is that of one question; three in a row end the run") {
  const char* const script =
      "while read -r x <&3; do [ $x != bad ] || { echo '{\"error\": \"no\"}'; exit 2; }; echo $x; done";
  workers::Worker worker({"/bin/sh", "-c", script});
  std::vector<std::string> out;
  const auto ask = [&](const std::vector<std::string>& questions) {
    out.clear();
    worker.run({0, questions.size(), [&](std::uint64_t k) { return questions[k]; }, std::chrono::seconds(60),
                [&](std::uint64_t, const std::string& line) { out.push_back(line); },
                [&](std::uint64_t, const workers::WorkerFailure& why) { out.push_back(why.message); }});
    return out;
  };
  CHECK(ask({"1", "bad", "bad", "2", "bad"}) == std::vector<std::string>{"1", "no", "no", "2", "no"});
  CHECK_THROWS_WITH_AS(ask({"bad", "bad", "bad", "1"}), "/bin/sh: no", EnvironmentError);
}

TEST_CASE("percentiles are values of the sorted list, and quantities that are not reported have none") {
  constexpr std::size_t kPoses = 250;
  Random random(5);
  Samples samples;
  samples.engine = "fake";
  samples.poses = numbered_poses(kPoses + 1);
  std::vector<double> us;
  for (std::size_t i = 0; i < kPoses; ++i) {
    us.push_back(random.in(1, 100));
    samples.answers.emplace_back().microseconds = us.back();
  }
  const auto kill = [](methods::Answer& a) { a.outcome = methods::Outcome::crashed, a.message = "killed"; };
  kill(samples.answers.emplace_back());  // counts nowhere
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
  for (methods::Answer& a : samples.answers) kill(a);
  CHECK(percentiles(samples).empty());
}

TEST_CASE("the least of three rounds counts, and counting tests takes no time") {
  FakeEngine engine({{10}, {90, 95, 11}, {70, 10, 12}}, {10, 1000, 1});
  const Samples samples = measure(engine, numbered_poses(3), record::kSilent);
  CHECK(samples.rounds == kRounds);
  CHECK(samples.answers[0].microseconds == 10);
  CHECK(samples.answers[1].microseconds == 11);
  CHECK(samples.answers[2].microseconds == 10);
  CHECK(samples.answers[1].tests == 1000);
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
  const methods::Answer a = answer_of(q, names, true);
  CHECK(a.microseconds == 2.5);
  CHECK(a.count == 1);
  CHECK(a.tests == 8);
  CHECK(a.kinds->boxes == 5);
  CHECK(a.kinds->faces == 3);
  CHECK(a.phases.at("broad") == 5);
  CHECK(a.phases.at("narrow") == 3);
  const std::vector<SimplexPair> list = {{SimplexId(3), SimplexId(2)}, {SimplexId(7), SimplexId(2)}};
  CHECK(a.pairs == list);
  q.events.pop_back();  // not all were kept
  q.parts[0].count = q.events.size();
  CHECK(answer_of(q, names, false).tests == 8);
  CHECK_FALSE(answer_of(q, names, false).kinds);
  CHECK_FALSE(answer_of(query(1, 2, {}), names, false).tests);
}

}  // namespace lrb::test
