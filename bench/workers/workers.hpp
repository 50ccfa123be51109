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
#include <utility>
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
  enum class Next { line, late, end };
  /// Waits for the next line until a point in time, and stores it. If that has passed, it takes only a line
  /// that is already there.
  Next next_line(std::chrono::steady_clock::time_point deadline, std::string& line);
  void kill();
  /// Waits for the end. Returns an exit code, or -signal; the same again if it is called again.
  int wait();

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  std::string unfinished_;
  std::deque<std::string> unread_;
  int status_ = 0;  ///< of waitpid()

  /// Reads the available output. Returns false at the end.
  bool read();
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
// order (bench/programs/methods.cpp).

/// The reason why a worker ended before its work was complete.
struct WorkerFailure {
  bool timed_out = false;
  std::string message;
};

/// Returns the message on the end of a child, as Child::wait() returns it.
std::string text_of_end(int status);

/// Returns the message of an answer {"error": "..."}, or an empty text.
std::string error_in(const std::string& answer);

/// The first line to every process of a worker, which it must answer; otherwise InputError is thrown.
struct Greeting {
  std::string question;
  std::chrono::duration<double> limit{};
  std::string complaint;  ///< begins the message of the error
};

/// A worker program that answers sequences of numbered questions. The process goes on from one sequence to
/// the next. If it crashes, hangs or answers with an error, a new one continues after the current question.
/// If several consecutive questions hang, the remaining ones are skipped and count as time-outs, so that the
/// running time is bounded.
class Worker {
 public:
  using Clock = std::chrono::steady_clock;

  struct Task {
    std::uint64_t begin = 0, end = 0;  ///< numbers of the questions
    std::function<std::string(std::uint64_t k)> question;
    std::chrono::duration<double> limit{};  ///< per question
    /// Called in order for each question, with its answer or the failure in its place.
    std::function<void(std::uint64_t k, const std::string& line)> on_line;
    std::function<void(std::uint64_t k, const WorkerFailure& failure)> on_failure;
  };

  explicit Worker(std::vector<std::string> command, Greeting greeting = {})
      : command_(std::move(command)), greeting_(std::move(greeting)) {}

  /// Begins a sequence; the one before must be done. Throws EnvironmentError, as do the following functions,
  /// if the program cannot be started or several consecutive answers are errors.
  void begin(Task task);
  bool done() const { return next_ == task_.end; }
  int output() const { return child_->output(); }
  Clock::time_point deadline() const { return deadline_; }
  /// Reads lines. Call it when there is output to read.
  void receive();
  /// Ends the current question. Call it when the deadline has passed.
  void expire();

  /// Runs a sequence to its end, with all its lines and failures.
  void run(Task task);
  /// Asks one question. Returns nullopt and the reason if there is no answer.
  std::optional<std::string> ask(const std::string& question, std::chrono::duration<double> limit,
                                 WorkerFailure& failure);

 private:
  void start();
  void ask_ahead();
  void go_on(const WorkerFailure& failure);

  std::vector<std::string> command_;
  Greeting greeting_;
  Task task_;
  std::uint64_t next_ = 0;  ///< question of the next answer
  std::uint64_t sent_ = 0;  ///< questions before this one have been sent
  int hung_ = 0;            ///< consecutive questions that hung
  int errors_ = 0;          ///< consecutive answers that are errors
  std::optional<Pipe> pipe_;
  std::optional<Child> child_;
  Clock::time_point deadline_;
};

/// Waits for the next output or deadline of workers that are not done, and passes it to them.
void wait_for_news(std::span<Worker* const> workers);

struct WorkerMethod {
  WorkerMethod(const std::string& path, methods::MethodInfo of)
      : program(path), info(std::move(of)), command{path, "--method", info.name} {}

  std::string program;               ///< path of the worker with this method
  methods::MethodInfo info;          ///< the worker's description of it
  std::vector<std::string> command;  ///< starts the worker with it
};

/// Queries the workers in the folder of the running program, or in the folder named by the environment
/// variable LRBSCOPE_METHODS, for their methods for a quantity; the first program has all that are not for
/// pairs. Throws EnvironmentError if there is no worker
/// or one does not answer.
std::vector<WorkerMethod> find_methods(methods::Quantity quantity = methods::Quantity::pairs);
/// Returns their descriptions.
std::vector<methods::MethodInfo> infos_of(const std::vector<WorkerMethod>& methods);

/// Returns the path of the worker with lrbscope's own methods. Throws EnvironmentError if it is missing.
std::string main_worker();

}  // namespace lrb::workers
