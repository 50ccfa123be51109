#pragma once
/// Work in batches, each in a process of its own: a crash or a hang costs its batch and is counted, and the
/// rest goes on.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "scenarios/bodies/shapes.hpp"
#include "tests/torture/tally.hpp"

namespace lrb::torture {

/// A batch takes seconds: one that takes longer than this hangs.
inline constexpr unsigned kBatchSeconds = 600;

struct Batch {
  std::uint64_t begin = 0, end = 0;
};

/// Adds up work(batch) over [0, count), `jobs` processes at a time. `Sum` is plain and small, as it comes
/// through a pipe. A batch whose process dies becomes lost(batch, status) instead.
template <class Sum>
Sum sum_in_children(std::uint64_t count, std::uint64_t batch_size, unsigned jobs,
                    const std::function<Sum(Batch)>& work, const std::function<Sum(Batch, int)>& lost) {
  static_assert(sizeof(Sum) <= 4096, "must fit into a pipe, which is read when its writer has gone");
  struct Child {
    pid_t pid;
    int result;
    Batch batch;
  };
  std::vector<Child> running;
  Sum sum{};
  const auto collect = [&] {
    int status = 0;
    const pid_t pid = wait(&status);
    const auto it =
        std::find_if(running.begin(), running.end(), [&](const Child& c) { return c.pid == pid; });
    if (it == running.end()) return;
    Sum part{};
    const bool whole = read(it->result, &part, sizeof part) == static_cast<ssize_t>(sizeof part);
    close(it->result);
    sum += whole && WIFEXITED(status) && WEXITSTATUS(status) == 0 ? part : lost(it->batch, status);
    running.erase(it);
  };
  for (std::uint64_t begin = 0; begin < count; begin += batch_size) {
    const Batch batch{begin, std::min(count, begin + batch_size)};
    while (running.size() >= jobs) collect();
    int ends[2];
    std::fflush(stdout);
    const bool piped = pipe(ends) == 0;
    const pid_t child = piped ? fork() : -1;
    if (child == 0) {
      close(ends[0]);
      alarm(kBatchSeconds);
      const Sum part = work(batch);
      const bool sent = write(ends[1], &part, sizeof part) == static_cast<ssize_t>(sizeof part);
      std::fflush(stderr);
      _exit(sent ? 0 : 1);
    }
    if (piped) close(ends[1]);
    if (child > 0) {
      running.push_back({child, ends[0], batch});
    } else {  // no process to be had: unguarded
      if (piped) close(ends[0]);
      sum += work(batch);
    }
  }
  while (!running.empty()) collect();
  return sum;
}

/// Has `check(bodies, batch, random)` done for an equal share of `count` cases of each of the bodies, in
/// children, and returns the sum. Prints a row for each bodies and one for all: print_row(name, sum,
/// seconds).
template <class Sum, class Bodies, class Check, class Row>
Sum sum_over_bodies(const std::vector<Bodies>& list, std::uint64_t count, std::uint64_t batch_size,
                    std::uint64_t seed, unsigned jobs, const Check& check,
                    const std::function<Sum(Batch, int)>& lost, const Row& print_row) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  const Clock::time_point begun = Clock::now();
  Sum total;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Clock::time_point start = Clock::now();
    const Sum sum =
        sum_in_children<Sum>((count + list.size() - 1) / list.size(), batch_size, jobs,
                             [&](Batch b) {
                               shapes::RandomEngine random(seed * 1'000'003 + i * 10'007 + b.begin);
                               return check(list[i], b, random);
                             },
                             lost);
    print_row(list[i].name, sum, since(start));
    total += sum;
  }
  print_row("total", total, since(begun));
  return total;
}

}  // namespace lrb::torture
