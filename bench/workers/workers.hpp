#pragma once
/// Finds the worker programs beside lrbscope, and the methods that they have.

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/rivals/method.hpp"
#include "bench/workers/child.hpp"

namespace lrb::workers {

// Puts the cases of one family to one method, or to exact brute force, in a chain of worker processes: where
// one dies or hangs, the next begins after the case it was at. If several cases in a row hang, the remaining
// ones are not asked and count as time-outs, so that a run ends in time whatever a method does.

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

struct MethodColumn {
  std::string name;     ///< for the command line: "ours", "fcl"
  std::string title;    ///< for people: "FCL 0.7.0, OBBRSS, double"
  std::string remark;   ///< what it answers, and how it was asked
  bool present = true;  ///< false: not installed when this was built
};

struct WorkerMethod {
  MethodColumn column;
  std::string program;       ///< path of the worker that has it
  methods::MethodInfo info;  ///< what the worker says about it, including what the column shows
};

/// Asks the workers in the folder of this very program, or in the one that the environment's LRBSCOPE_METHODS
/// names. Throws EnvironmentError if there is none, or if one does not answer.
std::vector<WorkerMethod> find_all_methods();
/// Returns those that take part in the stability experiment.
std::vector<WorkerMethod> find_methods();

/// Returns those that answer with a number. Throws EnvironmentError if their worker is not there.
std::vector<WorkerMethod> find_number_methods(methods::Quantity quantity);
/// Returns the path of that worker. Throws EnvironmentError if it is not there.
std::string number_worker();

/// Returns the methods of one program, in its order, which may be asked for some of them with options. Throws
/// EnvironmentError if it does not answer.
std::vector<WorkerMethod> methods_of(const std::string& program,
                                     const std::vector<std::string>& options = {});

/// Returns the path of another program in that folder; empty if it is not there.
std::string program_beside(const std::string& name);

}  // namespace lrb::workers
