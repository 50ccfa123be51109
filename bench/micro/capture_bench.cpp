/// The cost of lrbscope_capture.h in a bare loop, per event: without it, dormant, and recording.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

#include <benchmark/benchmark.h>
#include <unistd.h>

#define LRBCAP_ENABLE
#define LRBCAP_IMPLEMENTATION
#include <lrbscope_capture.h>

namespace {

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

std::string file() {
  return std::filesystem::temp_directory_path() / ("capture_bench." + std::to_string(getpid()));
}
void recording(benchmark::State& state) {
  for (const char* name : {"LRBCAP_EVENTS", "LRBCAP_QUERIES", "LRBCAP_SLOWER_US"}) unsetenv(name);
  setenv("LRBCAP_MAX_MB", "0", 1);
  LRBCAP_OPEN("bare loop", file().c_str());
  run(state, report);
  LRBCAP_CLOSE();
  std::filesystem::remove(file());
}
void queries_only(benchmark::State& state) {
  setenv("LRBCAP_EVENTS", "0", 1);
  LRBCAP_OPEN("bare loop", file().c_str());
  run(state, report);
  LRBCAP_CLOSE();
  unsetenv("LRBCAP_EVENTS");
  std::filesystem::remove(file());
}

BENCHMARK(nothing);
BENCHMARK(dormant);
BENCHMARK(queries_only);
BENCHMARK(recording)->Iterations(50);

}  // namespace

BENCHMARK_MAIN();
