#include "bench/workers/workers.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <nlohmann/json.hpp>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "bench/workers/worker_json.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::workers {

namespace {

constexpr int kGiven = 3;  // the child's file descriptor for `given`

/// Returns the time left for poll(), in milliseconds; of a far deadline the first minute.
int time_left(std::chrono::steady_clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
  constexpr std::int64_t kLeast = 0, kMax = 60'000;  // fits an int
  return static_cast<int>(std::clamp<std::int64_t>(left.count(), kLeast, kMax));
}

/// Runs in the child, between fork and exec: must not allocate or take locks.
[[noreturn]] void become(char* const* arguments, int output, int given, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kNoSuchProgram);  // the parent died before prctl()
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  const int nowhere = open("/dev/null", O_RDWR);
  dup2(nowhere, STDIN_FILENO);
  dup2(output, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  if (given == kGiven)
    fcntl(kGiven, F_SETFD, 0);
  else if (given >= 0)
    dup2(given, kGiven);
  execv(arguments[0], arguments);
  _exit(kNoSuchProgram);
}

}  // namespace

Child::Child(const std::vector<std::string>& command, int given) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0)
    throw EnvironmentError(std::string("cannot create a pipe (") + std::strerror(errno) +
                           "); try fewer --jobs");
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ == 0) become(arguments.data(), ends[1], given, parent);
  const int reason = errno;
  close(ends[1]);
  output_ = ends[0];
  if (pid_ < 0) {
    close(output_);
    throw EnvironmentError(std::string("cannot start a process (") + std::strerror(reason) +
                           "); try fewer --jobs");
  }
}

Child::~Child() {
  if (output_ >= 0) close(output_);
  if (pid_ < 0) return;
  kill();
  wait();
}

Child::Child(Child&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      output_(std::exchange(other.output_, -1)),
      unfinished_(std::move(other.unfinished_)),
      unread_(std::move(other.unread_)),
      status_(other.status_) {}

bool Child::read() {
  static constexpr std::size_t kPiece = 1 << 16;
  char buffer[kPiece];
  const ssize_t n = ::read(output_, buffer, sizeof buffer);
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  if (n == 0) return false;
  unfinished_.append(buffer, static_cast<std::size_t>(n));
  std::size_t begin = 0;
  for (std::size_t end; (end = unfinished_.find('\n', begin)) != std::string::npos; begin = end + 1)
    unread_.push_back(unfinished_.substr(begin, end - begin));
  unfinished_.erase(0, begin);
  return true;
}

Child::Next Child::next_line(std::chrono::steady_clock::time_point deadline, std::string& line) {
  while (unread_.empty()) {
    const int left = time_left(deadline);
    pollfd waiting{output_, POLLIN, 0};
    if (poll(&waiting, 1, left) > 0) {
      if (!read()) return Next::end;
    } else if (left == 0) {
      return Next::late;
    }
  }
  line = std::move(unread_.front());
  unread_.pop_front();
  return Next::line;
}

void Child::kill() {
  if (pid_ > 0) ::kill(pid_, SIGKILL);
}

int Child::wait() {
  // Only once: -1 would stand for any child.
  while (pid_ > 0 && waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return WIFSIGNALED(status_) ? -WTERMSIG(status_) : WEXITSTATUS(status_);
}

std::vector<std::string> lines_of(const std::vector<std::string>& command, std::chrono::seconds limit,
                                  int given) {
  Child child(command, given);
  std::vector<std::string> lines;
  const auto deadline = std::chrono::steady_clock::now() + limit;
  std::string line;
  auto next = Child::Next::line;
  while ((next = child.next_line(deadline, line)) == Child::Next::line) lines.push_back(line);
  if (next == Child::Next::late || child.wait() != 0) lines.clear();
  return lines;
}

Pipe::Pipe() {
  if (pipe2(ends_, O_CLOEXEC) != 0)
    throw EnvironmentError(std::string("cannot create a pipe: ") + std::strerror(errno));
}

Pipe::~Pipe() {
  close(ends_[0]);
  close(ends_[1]);
}

namespace {

void write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(file, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw EnvironmentError(std::string("cannot write to a worker, or to its file in memory: ") +
                             std::strerror(errno));
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

}  // namespace

void Pipe::write(std::string_view text) const {
  write_all(ends_[1], text);
}

MemoryFile::MemoryFile(const char* name) : file_(memfd_create(name, MFD_CLOEXEC)) {
  if (file_ < 0)
    throw EnvironmentError(std::string("cannot create a file in memory: ") + std::strerror(errno));
}

MemoryFile::~MemoryFile() {
  close(file_);
}

std::string MemoryFile::path() const {
  return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(file_);
}

void MemoryFile::write(std::string_view text) const {
  write_all(file_, text);
}

namespace {

// Number of consecutive time-outs after which a method is abandoned, and of errors after which a run ends.
constexpr int kMaxTimeouts = 3, kMaxErrors = 3;
constexpr int kBadInput = 2;         // an exit code that does not count as a crash
constexpr std::uint64_t kAhead = 8;  // questions sent ahead of their answers; they fit the buffer of a pipe

}  // namespace

std::string error_in(const std::string& answer) {
  if (!answer.starts_with("{\"error\"")) return "";
  const auto value = nlohmann::json::parse(answer, nullptr, false);
  return value.is_object() ? value.value("error", "") : "";
}

std::string text_of_end(int status) {
  if (status >= 0) return "exited with code " + std::to_string(status);
  const char* name = strsignal(-status);
  return "killed by signal " + std::to_string(-status) +
         (name != nullptr ? std::string(" (") + name + ")" : "");
}

namespace {

std::string text_of_timeout(std::chrono::duration<double> limit) {
  char text[64];
  std::snprintf(text, sizeof text, "no answer in %g s", limit.count());
  return text;
}

Worker::Clock::time_point after(std::chrono::duration<double> limit) {
  return Worker::Clock::now() + std::chrono::duration_cast<Worker::Clock::duration>(limit);
}

}  // namespace

void Worker::begin(Task task) {
  task_ = std::move(task);
  next_ = sent_ = task_.begin;
  hung_ = 0;
  if (!done()) start();
}

void Worker::start() {
  if (!child_) {
    pipe_.emplace();
    child_.emplace(command_, pipe_->reading_end());
    sent_ = next_;
    if (!greeting_.question.empty()) {
      pipe_->write(greeting_.question + "\n");
      std::string line;
      const Child::Next next = child_->next_line(after(greeting_.limit), line);
      const std::string why = next == Child::Next::line   ? error_in(line)
                              : next == Child::Next::late ? text_of_timeout(greeting_.limit)
                                                          : text_of_end(child_->wait());
      if (!why.empty()) {
        child_.reset();  // so that the next question starts another one, and greets it
        throw InputError(greeting_.complaint + why);
      }
    }
  }
  ask_ahead();
  deadline_ = after(task_.limit);
}

void Worker::ask_ahead() {
  for (; sent_ < std::min(task_.end, next_ + kAhead); ++sent_) pipe_->write(task_.question(sent_) + "\n");
}

void Worker::receive() {
  std::string line;
  auto next = Child::Next::line;
  while (!done() && (next = child_->next_line(Clock::now(), line)) == Child::Next::line) {
    if (const std::string error = error_in(line); !error.empty()) {
      if (++errors_ == kMaxErrors) throw EnvironmentError(command_.front() + ": " + error);
      return go_on({false, error});
    }
    task_.on_line(next_++, line);
    hung_ = errors_ = 0;
    ask_ahead();
    deadline_ = after(task_.limit);
  }
  if (done() || next == Child::Next::late) return;
  const int status = child_->wait();
  if (status == kBadInput || status == kNoSuchProgram)
    throw EnvironmentError(command_.front() + ": " + text_of_end(status) + "; rebuild it");
  go_on({false, text_of_end(status)});
}

void Worker::expire() {
  go_on({true, text_of_timeout(task_.limit)});
}

void Worker::go_on(const WorkerFailure& failure) {
  child_.reset();  // kills it
  task_.on_failure(next_++, failure);
  hung_ = failure.timed_out ? hung_ + 1 : 0;
  if (hung_ == kMaxTimeouts)
    while (!done())
      task_.on_failure(next_++, {true, "skipped: " + failure.message + " for " +
                                           std::to_string(kMaxTimeouts) + " cases in a row"});
  if (!done()) start();
}

void wait_for_news(std::span<Worker* const> workers) {
  std::vector<pollfd> waiting;
  auto deadline = Worker::Clock::time_point::max();
  for (const Worker* worker : workers) {
    waiting.push_back({worker->output(), POLLIN, 0});
    deadline = std::min(deadline, worker->deadline());
  }
  poll(waiting.data(), waiting.size(), time_left(deadline));
  for (std::size_t i = 0; i < workers.size(); ++i) {
    if (waiting[i].revents != 0)
      workers[i]->receive();
    else if (Worker::Clock::now() > workers[i]->deadline())
      workers[i]->expire();
  }
}

void Worker::run(Task task) {
  begin(std::move(task));
  Worker* const workers[] = {this};
  while (!done()) wait_for_news(workers);
}

std::optional<std::string> Worker::ask(const std::string& question, std::chrono::duration<double> limit,
                                       WorkerFailure& failure) {
  std::optional<std::string> out;
  run({0, 1, [&](std::uint64_t) { return question; }, limit,
       [&](std::uint64_t, const std::string& line) { out = line; },
       [&](std::uint64_t, const WorkerFailure& why) { failure = why; }});
  return out;
}

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kProgram = "lrbscope-methods";  // and programs whose names begin with it
constexpr std::chrono::seconds kListLimit(20);

fs::path folder_of_workers() {
  if (const char* given = std::getenv("LRBSCOPE_METHODS")) return given;
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path(".") : self.parent_path();
}

/// Returns the worker programs, sorted by name.
std::vector<fs::path> programs_in(const fs::path& folder) {
  std::vector<fs::path> programs;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    const bool is_ours = name.starts_with(kProgram) &&
                         name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
    if (is_ours && entry.is_regular_file(error) && access(entry.path().c_str(), X_OK) == 0)
      programs.push_back(entry.path());
  }
  std::sort(programs.begin(), programs.end());
  return programs;
}

[[noreturn]] void throw_not_found(const std::string& program) {
  throw EnvironmentError(
      printable_name(program) +
      ": not found. Build it with cmake --build --preset release --target "
      "lrbscope-workers, and run lrbscope from the build folder or set LRBSCOPE_METHODS to "
      "that folder");
}

/// Returns the methods of one program, in its order. Throws EnvironmentError if it does not answer.
std::vector<WorkerMethod> methods_of(const std::string& program, const std::vector<std::string>& options) {
  std::vector<std::string> command = {program, "--list"};
  command.insert(command.end(), options.begin(), options.end());
  const std::vector<std::string> lines = lines_of(command, kListLimit);
  std::vector<WorkerMethod> methods;
  for (const std::string& line : lines) {
    const auto value = nlohmann::json::parse(line, nullptr, false);
    if (!value.is_object()) break;
    methods.emplace_back(program, method_info_from(value));
  }
  if (lines.empty())
    throw EnvironmentError(printable_name(program) + ": does not list its methods; rebuild it");
  return methods;
}

}  // namespace

std::vector<WorkerMethod> find_methods(methods::Quantity quantity) {
  if (quantity != methods::Quantity::pairs)
    return methods_of(main_worker(), {"--quantity", std::string(name_of(quantity))});
  const fs::path folder = folder_of_workers();
  std::vector<WorkerMethod> methods;
  for (const fs::path& program : programs_in(folder))
    for (WorkerMethod& m : methods_of(program.string(), {})) methods.push_back(std::move(m));
  if (methods.empty()) throw_not_found((folder / kProgram).string());
  return methods;
}

std::vector<methods::MethodInfo> infos_of(const std::vector<WorkerMethod>& methods) {
  std::vector<methods::MethodInfo> out;
  for (const WorkerMethod& m : methods) out.push_back(m.info);
  return out;
}

std::string main_worker() {
  const std::string path = (folder_of_workers() / kProgram).string();
  if (access(path.c_str(), X_OK) != 0) throw_not_found(path);
  return path;
}

}  // namespace lrb::workers
