#pragma once
/// Puts the cases of one family to one method, or to exact brute force, in a chain of worker processes: where
/// one dies or hangs, the next begins after the case it was at. If several cases in a row hang, the remaining
/// ones are not asked and count as time-outs, so that a run ends in time whatever a method does.

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/workers/child.hpp"

namespace lrb::workers {

/// What ended a worker before its work was done.
struct Mishap {
  bool timed_out = false;
  std::string message;
};

class Job {
 public:
  using Clock = std::chrono::steady_clock;

  struct Task {
    std::vector<std::string> command;  ///< without --begin and --end
    std::uint64_t begin = 0, end = 0;  ///< cases
    int given = -1;                    ///< file descriptor that the worker gets, see Child
    Clock::duration limit{};           ///< for one case
    /// Called in order for each case, with its line or the mishap that took its place.
    std::function<void(std::uint64_t k, const std::string& line)> on_line;
    std::function<void(std::uint64_t k, const Mishap& mishap)> on_mishap;
  };

  explicit Job(Task task) : task_(std::move(task)), next_(task_.begin) { start(); }

  bool done() const { return !child_; }
  int output() const { return child_->output(); }
  Clock::time_point deadline() const { return deadline_; }
  /// Reads lines; call it when there is something to read.
  void receive();
  /// Ends the case at hand; call it when the deadline has passed.
  void expire();

 private:
  void start();
  void go_on(const Mishap& mishap);

  Task task_;
  std::uint64_t next_;  ///< the case whose line comes next
  int hung_ = 0;        ///< number of cases in a row that hung
  std::optional<Child> child_;
  Clock::time_point deadline_;
};

/// Runs a job to its end, with all its lines and mishaps.
void run_to_end(Job job);

}  // namespace lrb::workers
