#pragma once
/// Tables of counts. Work is done in batches, each in a process of its own: a crash or a hang costs its batch
/// and is counted, and the rest goes on.

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "scenarios/bodies/shapes.hpp"

namespace lrb::torture {

/// A batch takes seconds: one that takes longer than this hangs.
inline constexpr unsigned kBatchSeconds = 600;

struct Batch {
  std::uint64_t begin = 0, end = 0;
};

template <class Counts>
struct Column {
  const char* head;
  std::uint64_t Counts::*count;
  bool is_difference = false;  ///< should be 0
};
/// The columns of a struct of counts, one for each: the first is the number of cases, the last of crashes.
template <class Counts>
inline constexpr std::array<Column<Counts>, 0> kColumns = {};

template <class Counts>
requires(!kColumns<Counts>.empty()) Counts& operator+=(Counts& sum, const Counts& part) {
  for (const auto& c : kColumns<Counts>) sum.*c.count += part.*c.count;
  return sum;
}

template <class Counts>
void print_row(const char* name, const Counts& counts, double seconds) {
  std::printf("%-14s", name);
  for (const auto& c : kColumns<Counts>)
    std::printf(" %10llu", static_cast<unsigned long long>(counts.*c.count));
  std::printf(" %7.1f\n", seconds);
  std::fflush(stdout);
}

/// Counts a difference of case number `number` of a batch, and prints the first ones.
inline void complain(std::uint64_t& counter, const char* bodies, std::uint64_t number, const char* what) {
  if (counter++ < 3)
    std::fprintf(stderr, "%s, case %llu of its batch: %s\n", bodies, static_cast<unsigned long long>(number),
                 what);
}

/// Adds up work(batch) over [0, count), `jobs` processes at a time. Counts come through a pipe. Those of a
/// batch whose process dies are a crash.
template <class Counts>
Counts sum_in_children(const char* name, std::uint64_t count, std::uint64_t batch_size, unsigned jobs,
                       const std::function<Counts(Batch)>& work) {
  static_assert(sizeof(Counts) <= 4096, "must fit into a pipe, which is read when its writer has gone");
  struct Child {
    pid_t pid;
    int result;
    Batch batch;
  };
  std::vector<Child> running;
  Counts sum{};
  const auto collect = [&] {
    int status = 0;
    const pid_t pid = wait(&status);
    const auto it =
        std::find_if(running.begin(), running.end(), [&](const Child& c) { return c.pid == pid; });
    if (it == running.end()) return;
    Counts part{};
    const bool whole = read(it->result, &part, sizeof part) == static_cast<ssize_t>(sizeof part);
    close(it->result);
    if (!whole || !WIFEXITED(status) || WEXITSTATUS(status) != 0) {
      const auto [begin, end] = it->batch;
      std::fprintf(stderr, "%s: the process died (status %d) between cases %llu and %llu\n", name, status,
                   static_cast<unsigned long long>(begin), static_cast<unsigned long long>(end));
      part = {};
      part.*kColumns<Counts>.front().count = end - begin;
      part.*kColumns<Counts>.back().count = 1;
    }
    sum += part;
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
      const Counts part = work(batch);
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

/// A row: its name, the number of cases, and the work for some of them.
template <class Counts>
struct Row {
  std::string name;
  std::uint64_t count = 0;
  std::function<Counts(Batch)> work;
};

/// Does the work of all rows, with `jobs` children, or without any if that is 0, and prints the table.
/// Returns the number of differences.
template <class Counts>
std::uint64_t print_table(const std::vector<Row<Counts>>& rows, std::uint64_t batch_size, unsigned jobs) {
  using Clock = std::chrono::steady_clock;
  const auto since = [](Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
  };
  std::printf("%-14s", "bodies");
  for (const auto& c : kColumns<Counts>) std::printf(" %10s", c.head);
  std::printf(" %7s\n", "s");
  Counts total{};
  const Clock::time_point begun = Clock::now();
  for (const Row<Counts>& row : rows) {
    const Clock::time_point start = Clock::now();
    const Counts sum = jobs == 0 ? row.work({0, row.count})
                                 : sum_in_children(row.name.c_str(), row.count, batch_size, jobs, row.work);
    print_row(row.name.c_str(), sum, since(start));
    total += sum;
  }
  print_row("total", total, since(begun));
  std::uint64_t differences = 0;
  for (const auto& c : kColumns<Counts>) differences += c.is_difference ? total.*c.count : 0;
  return differences;
}

/// Returns a row for each of the bodies, with an equal share of `count` cases: Checker(bodies,
/// random).run(n).
template <class Counts, class Checker, class Bodies>
std::vector<Row<Counts>> rows_of(const std::vector<Bodies>& list, std::uint64_t count, std::uint64_t seed) {
  std::vector<Row<Counts>> rows;
  for (std::size_t i = 0; i < list.size(); ++i)
    rows.push_back({list[i].name, (count + list.size() - 1) / list.size(), [&list, seed, i](Batch b) {
                      shapes::RandomEngine random(seed * 1'000'003 + i * 10'007 + b.begin);
                      return Checker(list[i], random).run(b.end - b.begin);
                    }});
  return rows;
}

}  // namespace lrb::torture
