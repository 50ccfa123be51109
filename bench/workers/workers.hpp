#pragma once
/// Finds the worker programs beside lrbscope, and their methods.

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/methods/method.hpp"
#include "bench/workers/child.hpp"

namespace lrb::workers {

// Runs the cases of one family with one method, or with exact brute force, in a sequence of worker processes.
// If one crashes or hangs, the next continues after its current case. If several consecutive cases hang, the
// remaining ones are skipped and count as time-outs, so that the running time is bounded.

/// The reason why a worker ended before its work was complete.
struct WorkerFailure {
  bool timed_out = false;
  std::string message;
};

/// Messages of failures: of the end of a child, as Child::wait() returns it, and of an answer that is late.
std::string text_of_end(int status);
std::string text_of_timeout(double seconds);

class Job {
 public:
  using Clock = std::chrono::steady_clock;

  struct Task {
    std::vector<std::string> command;  ///< without --begin and --end
    std::uint64_t begin = 0, end = 0;  ///< cases
    int given = -1;                    ///< file descriptor passed to the worker, see Child
    Clock::duration limit{};           ///< per case
    /// Called in order for each case, with its line or the failure in its place.
    std::function<void(std::uint64_t k, const std::string& line)> on_line;
    std::function<void(std::uint64_t k, const WorkerFailure& failure)> on_failure;
  };

  explicit Job(Task task) : task_(std::move(task)), next_(task_.begin) { start(); }

  bool done() const { return !child_; }
  int output() const { return child_->output(); }
  Clock::time_point deadline() const { return deadline_; }
  /// Reads lines. Call it when there is output to read.
  void receive();
  /// Ends the current case. Call it when the deadline has passed.
  void expire();

 private:
  void start();
  void go_on(const WorkerFailure& failure);

  Task task_;
  std::uint64_t next_;  ///< case of the next line
  int hung_ = 0;        ///< consecutive cases that hung
  std::optional<Child> child_;
  Clock::time_point deadline_;
};

/// Runs a job to its end, with all its lines and failures.
void run_to_end(Job job);

struct MethodColumn {
  std::string name;     ///< for the command line: "ours", "fcl"
  std::string title;    ///< display name: "FCL 0.7.0, OBBRSS, double"
  std::string remark;   ///< meaning of the answer, and the options of the query
  bool present = true;  ///< false: not available when this was built
};

struct WorkerMethod {
  MethodColumn column;
  std::string program;       ///< path of the worker with this method
  methods::MethodInfo info;  ///< the worker's description of it, including the entries of the table column
};

/// Queries the workers in the folder of the running program, or in the folder named by the environment
/// variable LRBSCOPE_METHODS. Throws EnvironmentError if there is no worker or one does not answer.
std::vector<WorkerMethod> find_all_methods();
/// Returns the methods of the stability experiment.
std::vector<WorkerMethod> find_methods();

/// Returns the methods that return a number. Throws EnvironmentError if their worker is missing.
std::vector<WorkerMethod> find_number_methods(methods::Quantity quantity);
/// Returns the path of that worker. Throws EnvironmentError if it is missing.
std::string number_worker();

/// Returns the methods of one program, in its order; options may select some of them. Throws EnvironmentError
/// if it does not answer.
std::vector<WorkerMethod> methods_of(const std::string& program,
                                     const std::vector<std::string>& options = {});

/// Returns the path of another program in that folder, or an empty string if it is missing.
std::string program_beside(const std::string& name);

}  // namespace lrb::workers
