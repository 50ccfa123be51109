#pragma once
/// Worker programs: runs one as a child process, reads its lines and exchanges files with it; finds those
/// beside lrbscope, and their methods.

#include <chrono>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "bench/methods/method.hpp"

namespace lrb::workers {

/// Exit code of a child whose program does not exist, as in shells.
inline constexpr int kNoSuchProgram = 127;

/// A process that is killed when this object is destroyed, and when this process ends in any way (Linux). Its
/// stderr is discarded.
class Child {
 public:
  /// Starts a program. `given` is a file descriptor that becomes the child's number 3, or -1. Throws
  /// EnvironmentError if the system cannot start another process. A program that does not exist ends with
  /// kNoSuchProgram.
  Child(const std::vector<std::string>& command, int given);
  ~Child();
  Child(Child&& other) noexcept;
  Child& operator=(Child&&) = delete;

  /// Returns the file descriptor to wait on for lines.
  int output() const { return output_; }
  /// Reads the available output, and appends complete lines. Returns false at the end.
  bool read(std::vector<std::string>& lines);
  enum class Next { line, late, end };
  /// Waits for the next line until a point in time, and stores it.
  Next next_line(std::chrono::steady_clock::time_point deadline, std::string& line);
  void kill();
  /// Waits for the end. Returns an exit code, or -signal.
  int wait();

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  std::string unfinished_;
  std::deque<std::string> unread_;  ///< lines for next_line()
};

/// Returns all lines of a child that is expected to end soon, or an empty list if it did not end with code 0
/// within `limit`. `given` as for Child.
std::vector<std::string> lines_of(const std::vector<std::string>& command, std::chrono::seconds limit,
                                  int given = -1);

/// Both ends of a pipe to a child, whose `given` is the reading end. That end stays open here, so that
/// writing to a child that has died does not end this process.
class Pipe {
 public:
  Pipe();
  ~Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int reading_end() const { return ends_[0]; }
  /// Waits if the child is more than a buffer (64 KiB) behind.
  void write(std::string_view text) const;

 private:
  int ends_[2] = {};
};

/// A file in memory that children of this process can open by its path. Nothing is left of it when this
/// process ends, however that happens (Linux). Throws EnvironmentError if there is no memory for it.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  std::string path() const;
  void write(std::string_view text) const;

 private:
  int file_;
};

// Questions to a worker: lines of JSON on its file descriptor 3, each of which it answers with a line, in
// order (bench/programs/serve.hpp).

/// The reason why a worker ended before its work was complete.
struct WorkerFailure {
  bool timed_out = false;
  std::string message;
};

/// Messages of failures: of the end of a child, as Child::wait() returns it, and of an answer that is late.
std::string text_of_end(int status);
std::string text_of_timeout(double seconds);

/// Returns the message of an answer {"error": "..."}, or an empty text.
std::string error_in(const std::string& answer);

/// A worker process.
class Worker {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Worker(std::vector<std::string> command)
      : command_(std::move(command)), child_(command_, pipe_.reading_end()) {}

  /// Waits if questions of more than a pipe's buffer (64 KiB) are unanswered.
  void ask(const std::string& question) const { pipe_.write(question + "\n"); }
  /// Returns the next answer, or nullopt and the reason why there is none; the process is then of no more
  /// use. Throws EnvironmentError if the program cannot be started.
  std::optional<std::string> answer(std::chrono::duration<double> limit, WorkerFailure& failure);
  /// Asks and waits for the answer. Throws EnvironmentError as well if the answer is an error.
  std::optional<std::string> ask(const std::string& question, std::chrono::duration<double> limit,
                                 WorkerFailure& failure);

 private:
  std::vector<std::string> command_;
  Pipe pipe_;
  Child child_;
};

/// Asks questions in a sequence of worker processes. If one crashes or hangs, the next continues after its
/// current question. If several consecutive questions hang, the remaining ones are skipped and count as
/// time-outs, so that the running time is bounded.
class Job {
 public:
  using Clock = Worker::Clock;

  struct Task {
    std::vector<std::string> command;
    std::uint64_t begin = 0, end = 0;  ///< numbers of the questions
    std::function<std::string(std::uint64_t k)> question;
    std::chrono::duration<double> limit{};  ///< per question
    /// Called in order for each question, with its answer or the failure in its place.
    std::function<void(std::uint64_t k, const std::string& line)> on_line;
    std::function<void(std::uint64_t k, const WorkerFailure& failure)> on_failure;
  };

  explicit Job(Task task) : task_(std::move(task)), next_(task_.begin) { start(); }

  bool done() const { return !child_; }
  int output() const { return child_->output(); }
  Clock::time_point deadline() const { return deadline_; }
  /// Reads lines. Call it when there is output to read.
  void receive();
  /// Ends the current question. Call it when the deadline has passed.
  void expire();

 private:
  void start();
  void ask_ahead();
  void go_on(const WorkerFailure& failure);

  Task task_;
  std::uint64_t next_;      ///< question of the next answer
  std::uint64_t sent_ = 0;  ///< questions before this one have been sent
  int hung_ = 0;            ///< consecutive questions that hung
  std::optional<Pipe> pipe_;
  std::optional<Child> child_;
  Clock::time_point deadline_;
};

/// Waits for the next output or deadline of jobs that are not done, and passes it to them.
void wait_for_news(std::span<Job* const> jobs);
/// Runs a job to its end, with all its lines and failures.
void run_to_end(Job job);

struct WorkerMethod {
  std::string program;       ///< path of the worker with this method
  methods::MethodInfo info;  ///< the worker's description of it
};

/// Queries the workers in the folder of the running program, or in the folder named by the environment
/// variable LRBSCOPE_METHODS, for their methods for a quantity. Throws EnvironmentError if there is no worker
/// or one does not answer.
std::vector<WorkerMethod> find_methods(methods::Quantity quantity = methods::Quantity::pairs);
/// Returns their descriptions.
std::vector<methods::MethodInfo> infos_of(const std::vector<WorkerMethod>& methods);

/// Returns the path of the worker with methods that return a number. Throws EnvironmentError if it is
/// missing.
std::string number_worker();

/// Returns the methods of one program, in its order; options may select some of them. Throws EnvironmentError
/// if it does not answer.
std::vector<WorkerMethod> methods_of(const std::string& program,
                                     const std::vector<std::string>& options = {});

/// Returns the path of another program in that folder, or an empty string if it is missing.
std::string program_beside(const std::string& name);

}  // namespace lrb::workers
