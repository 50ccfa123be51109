// The cost of keeping what a query does: recording and writing traces, capturing from another engine, and
// drawing frames of a recorded run.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <benchmark/benchmark.h>
#include <unistd.h>

#define LRBCAP_ENABLE
#define LRBCAP_IMPLEMENTATION
#include <lrbscope_capture.h>

#include "engine/collide/collide_into.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/frames/frames.hpp"
#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/build.hpp>
#include <lrbscope/trace/recorder.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace_json.hpp>

using namespace lrb;
using namespace lrb::trace;

namespace {

/// A file or folder that only this process uses.
std::string scratch() {
  return std::filesystem::temp_directory_path() / ("record_bench." + std::to_string(getpid()));
}

// Recording, writing, reading and replaying traces, per event.
namespace traces {

/// A call of the probe.
struct Call {
  EventKind kind;
  Side side;
  std::uint32_t a, b;
  exact::Meet meet;
};

constexpr std::size_t kEvents = 200'000;

const LrbRep& body() {
  static const LrbRep rep = build_lrb(shapes::bumpy_sphere(6, 7, 0.3));  // look-ups miss caches, as in use
  return rep;
}

/// A mixture typical of the paper's runs: mostly tests, every tenth event a refinement, every hundredth a
/// contact.
const std::vector<Call>& calls() {
  static const std::vector<Call> all = [] {
    std::mt19937 random(1);
    std::vector<Call> out;
    const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
    for (std::size_t i = 0; i < kEvents; ++i) {
      const std::uint32_t dice = below(100);
      const EventKind kind = dice < 89   ? EventKind::face_test
                             : dice < 99 ? EventKind::refine
                                         : EventKind::contact;
      const bool refine = kind == EventKind::refine;
      out.push_back({kind, static_cast<Side>(below(2)),
                     below(refine ? body().region_count() : body().face_count()),
                     refine ? 2 + below(4) : below(body().face_count()), static_cast<exact::Meet>(below(3))});
    }
    return out;
  }();
  return all;
}

template <class Probe>
void replay_calls(Probe& probe) {
  for (const Call& c : calls()) {
    if (c.kind == EventKind::face_test)
      probe.face_test(SimplexId(c.a), SimplexId(c.b), c.meet, 1, 2);
    else if (c.kind == EventKind::refine)
      probe.refine(c.side, RegionId(c.a), c.b);
    else
      probe.contact(SimplexId(c.a), SimplexId(c.b), c.meet);
  }
}

Trace recorded(Clock clock) {
  RecorderSettings settings;
  settings.clock = clock;
  settings.request.recursion = Recursion::paper;
  Recorder recorder(body(), body(), settings);
  recorder.begin_step(0, {}, {});
  replay_calls(recorder);
  return recorder.take();
}

void report(benchmark::State& state) {
  state.counters["per_event"] = benchmark::Counter(static_cast<double>(state.iterations()) * kEvents,
                                                   benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

/// Only the calls, with a probe that only counts: subtract this time.
void calls_alone(benchmark::State& state) {
  struct Sum {
    std::uint64_t sum = 0;
    void face_test(SimplexId a, SimplexId b, exact::Meet m, std::uint32_t, std::uint32_t) {
      sum += a + b + static_cast<std::uint32_t>(m);
    }
    void refine(Side s, RegionId r, std::uint32_t n) { sum += static_cast<std::uint32_t>(s) + r + n; }
    void contact(SimplexId a, SimplexId b, exact::Meet m) { sum += a + b + static_cast<std::uint32_t>(m); }
  };
  calls();
  for (auto _ : state) {
    Sum sum;
    replay_calls(sum);
    benchmark::DoNotOptimize(sum.sum);
  }
  report(state);
}
BENCHMARK(calls_alone);

void record(benchmark::State& state) {
  RecorderSettings settings;
  settings.clock = static_cast<Clock>(state.range(0));
  settings.request.recursion = Recursion::paper;
  calls();
  for (auto _ : state) {
    state.PauseTiming();
    {
      Recorder recorder(body(), body(), settings);
      recorder.begin_step(0, {}, {});
      state.ResumeTiming();
      replay_calls(recorder);
      benchmark::DoNotOptimize(recorder.events_stored());
      state.PauseTiming();
    }
    state.ResumeTiming();
  }
  report(state);
}
BENCHMARK(record)->ArgName("wall")->Arg(0)->Arg(1);

/// A query of two intersecting bodies, alone (-1) or recorded at an event level. The cost of an event is the
/// additional time divided by the number of events.
void watched_query(benchmark::State& state) {
  static const LrbRep rock = build_lrb(shapes::bumpy_sphere(5, 7, 0.3));
  const Pose pose = Pose::translation({0.9, 0.3, 0.2});
  const bool alone = state.range(0) < 0;
  RecorderSettings settings;
  settings.level = static_cast<EventLevel>(std::max<std::int64_t>(state.range(0), 0));
  QueryContext context;
  std::uint64_t events = 0;
  for (auto _ : state) {
    if (alone) {
      NullProbe probe;
      benchmark::DoNotOptimize(collide(rock, {}, rock, pose, {}, context, probe).pairs.size());
      continue;
    }
    state.PauseTiming();
    {
      Recorder recorder(rock, rock, settings);
      recorder.begin_step(0, {}, pose);
      state.ResumeTiming();
      benchmark::DoNotOptimize(collide(rock, {}, rock, pose, {}, context, recorder).pairs.size());
      state.PauseTiming();
      events = recorder.events_stored();
    }
    state.ResumeTiming();
  }
  state.counters["events"] = static_cast<double>(events);
}
BENCHMARK(watched_query)->ArgName("level")->DenseRange(-1, 2)->Unit(benchmark::kMicrosecond);

/// A sink that discards its bytes.
struct Nowhere final : ByteSink {
  void write(std::string_view bytes) override { size += bytes.size(); }
  std::size_t size = 0;
};

void write_json(benchmark::State& state) {
  const Trace trace = recorded(static_cast<Clock>(state.range(0)));
  Nowhere sink;
  for (auto _ : state) {
    sink.size = 0;
    write_trace(trace, sink);
  }
  report(state);
  state.counters["bytes_per_event"] = static_cast<double>(sink.size) / kEvents;
}
BENCHMARK(write_json)->ArgName("wall")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void save_file(benchmark::State& state) {
  const Trace trace = recorded(Clock::event);
  const std::string path = scratch() + (state.range(0) ? ".json.gz" : ".json");
  for (auto _ : state) save_trace(trace, path);
  report(state);
  state.counters["bytes_per_event"] = static_cast<double>(std::filesystem::file_size(path)) / kEvents;
  std::filesystem::remove(path);
}
BENCHMARK(save_file)->ArgName("gz")->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

void read_json(benchmark::State& state) {
  const std::string text = trace_to_json(recorded(Clock::event));
  for (auto _ : state) benchmark::DoNotOptimize(trace_from_json(text, "bench").events.size());
  report(state);
}
BENCHMARK(read_json)->Unit(benchmark::kMillisecond);

void replay(benchmark::State& state) {
  const Trace trace = recorded(Clock::event);
  for (auto _ : state) {
    Cursor cursor(trace, body(), body());
    cursor.seek(static_cast<EventId>(trace.events.size() - 1));
    benchmark::DoNotOptimize(cursor.boundary_size(Side::a));
  }
  report(state);
}
BENCHMARK(replay)->Unit(benchmark::kMillisecond);

}  // namespace traces

// lrbscope_capture.h in a bare loop, per event: without it, dormant, and recording.
namespace captures {

constexpr std::uint32_t kEvents = 1'000'000;

/// The loop of an engine that only counts its tests; `event` reports a test.
template <class Event>
void run(benchmark::State& state, const Event& event) {
  for (auto _ : state) {
    LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, 0, nullptr, 0, nullptr);
    for (std::uint32_t i = 0; i < kEvents; ++i) {
      event(i);
      benchmark::DoNotOptimize(i);
    }
    LRBCAP_END(LRBCAP_UNREPORTED, 0);
  }
  state.counters["event"] = benchmark::Counter(
      kEvents, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// Ids that go up and down as in a traversal; every second event has an axis.
void report(std::uint32_t i) {
  LRBCAP_NODE(i * 2, i * 3, i & 1, i % 2 == 0 ? i % 15 : 255u);
}

void nothing(benchmark::State& state) {
  run(state, [](std::uint32_t) {});
}
void dormant(benchmark::State& state) {
  run(state, report);
}

void recording(benchmark::State& state) {
  for (const char* name : {"LRBCAP_EVENTS", "LRBCAP_QUERIES", "LRBCAP_SLOWER_US"}) unsetenv(name);
  setenv("LRBCAP_MAX_MB", "0", 1);
  LRBCAP_OPEN("bare loop", scratch().c_str());
  run(state, report);
  LRBCAP_CLOSE();
  std::filesystem::remove(scratch());
}

void queries_only(benchmark::State& state) {
  setenv("LRBCAP_EVENTS", "0", 1);
  LRBCAP_OPEN("bare loop", scratch().c_str());
  run(state, report);
  LRBCAP_CLOSE();
  unsetenv("LRBCAP_EVENTS");
  std::filesystem::remove(scratch());
}

BENCHMARK(nothing);
BENCHMARK(dormant);
BENCHMARK(queries_only);
BENCHMARK(recording)->Iterations(50);

}  // namespace captures

// Encoding and writing frames: a sequence drawn and discarded, and the same frames drawn, encoded and
// written, as `lrbscope run` does it. The target is at most 1.25 times the time of drawing.
namespace frames {

/// A rock rotates beside a ball.
const spec::Scenario& scenario() {
  static const spec::Scenario scenario = spec::parse_scenario(
      R"({"name": "rate", "purpose": "A rock turns beside a ball.", "bodies": {"a": {"generator": "ball"}, "b": {"generator": "rock",
          "parameters": {"frequency": 50}, "pose": {"position": [2.5, 0, 0]}}},
          "motion": {"kind": "spin", "axis": [0, 0, 1], "degrees": 90, "steps": 40},
          "frames": {"at": "step", "size": [1280, 720]}})",
      "record_bench");
  return scenario;
}

const run::RecordedRun& recorded() {
  static const run::Recording recording = run::record(scenario(), run::kSilent);
  static const run::RecordedRun recorded = [] {
    run::RecordedRun r;
    r.title = scenario().name;
    for (const bodies::LoadedBody& body : recording.bodies) r.reps.push_back(&body.rep);
    r.trace = &recording.trace;
    r.results = &recording.results;
    return r;
  }();
  return recorded;
}

void draw(benchmark::State& state) {
  for (auto _ : state) run::paint_frames(recorded(), scenario().frames, run::kSilent, nullptr);
}
BENCHMARK(draw)->Unit(benchmark::kMillisecond)->UseRealTime();

void draw_encode_write(benchmark::State& state) {
  for (auto _ : state)
    run::draw_frames(recorded(), scenario().frames, scratch() + "/sequence", {}, run::kSilent);
  std::filesystem::remove_all(scratch());
}
BENCHMARK(draw_encode_write)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace frames

}  // namespace

BENCHMARK_MAIN();
