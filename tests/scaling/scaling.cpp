// Measures how CPU time and memory grow with the size of the input (and of the answer), family by family, as
// fitted powers, and exits with 1 if one grows faster than it may:
//   scaling [--share] [--only TEXT]...
// --share: the small sizes alone, and 0.35 more allowed for a busy machine, as the test suite runs it.
// --only: families whose line has this text.

#include "tests/scaling/scaling.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

#include "scenarios/paper/series.hpp"
#include "tests/support/counted_new.hpp"

namespace lrb::scaling {
namespace {

std::vector<Family>& families() {
  static std::vector<Family> all;
  return all;
}

double cpu_seconds() {
  std::timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Cost {
  double size, seconds, bytes;
};

/// The least of some repeats: what other processes do only ever adds to it.
Cost measure(const Task& task) {
  constexpr double kEnough = 0.1;  // seconds
  constexpr int kLeast = 2, kMax = 20;
  Cost cost{task.size, 0, 0};
  double total = 0;
  for (int i = 0; i < kLeast || (i < kMax && total < kEnough); ++i) {
    const test::PeakMemory memory;
    const double begin = cpu_seconds();
    task.work();
    const double seconds = cpu_seconds() - begin;
    total += seconds;
    cost.bytes = static_cast<double>(memory.bytes());
    cost.seconds = i == 0 ? seconds : std::min(cost.seconds, seconds);
    if (seconds > 10 * kEnough) break;
  }
  return cost;
}

/// Powers of time and of memory. Too little to be measured does not grow.
struct Growth {
  double time, memory;
};

Growth fit(const std::vector<Cost>& costs) {
  constexpr double kMinSeconds = 20e-6, kMinBytes = 4096;
  std::vector<double> size, seconds, bytes;
  for (const Cost& c : costs) {
    size.push_back(c.size);
    seconds.push_back(std::max(c.seconds, kMinSeconds));
    bytes.push_back(std::max(c.bytes, kMinBytes));
  }
  return {resolutions::fit_power(size, seconds).exponent, resolutions::fit_power(size, bytes).exponent};
}

/// True if nothing grows faster than it may.
bool run(const Family& family, bool share) {
  std::vector<std::uint32_t> sizes = family.share;
  // Small sizes on a busy machine: quadratic growth is detected, growth slightly above n log n only in the
  // full run.
  constexpr double kShareSlack = 0.35;
  const double max_time = family.max_time + (share ? kShareSlack : 0);
  if (!share) sizes.insert(sizes.end(), family.more.begin(), family.more.end());
  Growth growth{};
  std::vector<Cost> costs;
  for (int attempt = 0; attempt < 2; ++attempt) {  // a slow moment of the machine is no cliff
    std::vector<Cost> now;
    for (const std::uint32_t size : sizes) now.push_back(measure(family.make(size)));
    for (std::size_t i = 0; i < costs.size(); ++i)
      now[i].seconds = std::min(now[i].seconds, costs[i].seconds);
    costs = std::move(now);
    growth = fit(costs);
    if (growth.time <= max_time && growth.memory <= family.max_memory) break;
  }
  const bool ok = growth.time <= max_time && growth.memory <= family.max_memory;
  std::printf(
      "| %-24s | %-14s | %-8s | %10.0f | %10.0f | %10.3f | %9.2f | %5.2f | %5.2f | %5.2f | %5.2f | %s |\n",
      family.input.c_str(), family.work.c_str(), family.unit.c_str(), costs.front().size, costs.back().size,
      1e3 * costs.back().seconds, costs.back().bytes / 1e6, growth.time, max_time, growth.memory,
      family.max_memory, ok ? "ok" : "CLIFF");
  if (!ok)
    for (const Cost& c : costs)
      std::printf("|   size %.0f: %.3f ms, %.2f MB\n", c.size, 1e3 * c.seconds, c.bytes / 1e6);
  std::fflush(stdout);
  return ok;
}

int run_all(int argc, char** argv) {
  bool share = false;
  std::vector<std::string> only;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--share") == 0) {
      share = true;
    } else if (std::strcmp(argv[i], "--only") == 0 && i + 1 < argc) {
      only.emplace_back(argv[++i]);
    } else {
      std::fprintf(stderr, "usage: scaling [--share] [--only TEXT]...\n");
      return 2;
    }
  }
  std::sort(families().begin(), families().end(), [](const Family& a, const Family& b) {
    return a.input != b.input ? a.input < b.input : a.work < b.work;
  });
  std::printf(
      "| input                    | work           | size in  | from       | to         | ms there   | MB there  "
      "| time  | most  | mem.  | most  |    |\n");
  bool ok = true;
  std::size_t measured = 0;
  for (const Family& family : families()) {
    const std::string line = family.input + " " + family.work + " " + family.unit;
    const auto wanted = [&](const std::string& text) { return line.find(text) != std::string::npos; };
    if (!only.empty() && std::none_of(only.begin(), only.end(), wanted)) continue;
    ok = run(family, share) && ok;
    ++measured;
  }
  if (measured == 0) {
    std::fprintf(stderr, "scaling: no family has this text in its name\n");
    return 2;
  }
  return ok ? 0 : 1;
}

}  // namespace

bool add(Family family) {
  families().push_back(std::move(family));
  return true;
}

}  // namespace lrb::scaling

int main(int argc, char** argv) {
  try {
    return lrb::scaling::run_all(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "scaling: %s\n", error.what());
    return 2;
  }
}
