#include "tools/terminal.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <mutex>
#include <new>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/platform/platform.hpp"
#include "tools/commands.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::tools {
namespace {

/// Returns true unless NO_COLOR is set and not empty (https://no-color.org), or the terminal is dumb.
bool colour_wanted() {
  const char* no_colour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return (no_colour == nullptr || *no_colour == '\0') && terminal != nullptr &&
         std::string(terminal) != "dumb";
}

}  // namespace

Progress::Progress(std::string label, std::uint64_t total, bool quiet)
    : label_(std::move(label)),
      total_(total),
      enabled_(!quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      colour_(colour_wanted()),
      begin_(std::chrono::steady_clock::now()),
      last_(begin_) {}

void Progress::set(std::uint64_t done, const std::string& detail) {
  if (!enabled_) return;
  constexpr std::chrono::milliseconds kBetweenDrawings(80), kBetweenLines(10'000);
  const auto now = std::chrono::steady_clock::now();
  if (!terminal_ && now - last_ < kBetweenLines) return;  // a file or a pipe: few whole lines
  if (now - last_ < kBetweenDrawings && done != total_) return;
  last_ = now;
  drawn_ = terminal_;
  std::string line = label_ + " ";
  if (total_ > 0) {
    constexpr std::uint64_t kWidth = 28;
    const std::uint64_t full = std::min(kWidth, kWidth * done / total_);
    std::string bar;
    for (std::uint64_t i = 0; i < kWidth; ++i) bar += i < full ? "#" : ".";
    if (terminal_) line += (colour_ ? "\033[36m" + bar + "\033[0m" : bar) + " ";
    line += shares_ ? std::to_string(100 * done / total_) + " %"
                    : std::to_string(done) + "/" + std::to_string(total_);
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    if (done > 0 && elapsed > 1) {
      const double left =
          elapsed * static_cast<double>(total_ - std::min(done, total_)) / static_cast<double>(done);
      line += ", " + std::to_string(static_cast<int>(left + 0.5)) + " s left";
    }
  } else {
    line += std::to_string(done);
  }
  if (!detail.empty()) line += ", " + detail;
  if (terminal_)
    std::cerr << "\r\033[K" << line << std::flush;
  else
    std::cerr << "progress: " << line << std::endl;
}

void Progress::set_share(double share, const std::string& detail) {
  constexpr double kWhole = 100'000;
  shares_ = true;
  total_ = static_cast<std::uint64_t>(kWhole);
  set(static_cast<std::uint64_t>(kWhole * std::clamp(share, 0.0, 1.0)), detail);
}

void Progress::finish() {
  if (drawn_) std::cerr << "\r\033[K" << std::flush;
  drawn_ = false;
}

record::ProgressReport progress_report(bool quiet) {
  struct Parts {
    std::string what;
    std::unique_ptr<Progress> bar;
  };
  return [quiet, parts = std::make_shared<Parts>()](const std::string& what, std::uint64_t done,
                                                    std::uint64_t total) {
    if (what != parts->what) {
      parts->bar = std::make_unique<Progress>(what, total, quiet);
      parts->what = what;
    }
    parts->bar->set(done);
  };
}

BuildOptions with_progress(BuildOptions options, bool quiet) {
  struct Shared {
    explicit Shared(bool q) : bar("build", 0, q) {}
    std::mutex mutex;
    Progress bar;
  };
  options.progress = [shared = std::make_shared<Shared>(quiet)](std::uint32_t pass,
                                                                std::uint32_t front_faces) {
    const std::lock_guard lock(shared->mutex);
    shared->bar.set(pass, "front of " + std::to_string(front_faces) + " faces");
  };
  return options;
}

namespace {

constexpr std::string_view kOutOfMemoryLine =
    "lrbscope: out of memory: try a smaller input or a larger machine\n";

bool pipes_end_us = false;

bool is_ignored(int signal) {
  struct sigaction now {};
  return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// Ends the process by the same signal.
void die_of(int signal) {
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal);
  std::signal(signal, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  std::raise(signal);
}

struct Farewell {
  std::mutex lock;
  std::string end = "files written so far are complete, the others are missing; run it again";
};
/// Never destroyed, because a signal may arrive at the end of the program.
Farewell& farewell_words() {
  static auto* words = new Farewell;
  return *words;
}

std::string farewell(int signal) {
  const char* name = signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
  const char* clear = isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";  // there may be a progress bar
  const std::lock_guard lock(farewell_words().lock);
  return std::string(clear) + "lrbscope: interrupted by " + name + ": " + farewell_words().end + "\n";
}

/// The descriptor of a StopSignal; -1: none.
std::atomic<int> noted_by{-1};

/// Runs on a thread, which may lock and allocate, unlike a signal handler.
void wait_for(const sigset_t& signals) {
  int signal = 0;
  while (true) {
    if (sigwait(&signals, &signal) != 0) return;
    const int descriptor = noted_by.exchange(-1);
    if (descriptor < 0 || eventfd_write(descriptor, 1) != 0) break;
  }
  abandon_atomic_files();
  const std::string line = farewell(signal);
  if (write(STDERR_FILENO, line.data(), line.size()) < 0) {
    // Nowhere left to report an error.
  }
  die_of(signal);
}

/// Memory may be exhausted, so nothing here allocates.
[[noreturn]] void say_why_and_end() {
  std::string_view line = "lrbscope: internal error, please report it: std::terminate was called\n";
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    line = kOutOfMemoryLine;
  } catch (...) {
    // The line above is all the information available.
  }
  abandon_atomic_files();
  if (write(STDERR_FILENO, line.data(), line.size()) < 0) {
    // Nowhere left to report an error.
  }
  _exit(kEnvironment);
}

}  // namespace

void end_cleanly_on_terminate() {
  std::set_terminate(say_why_and_end);
}

void end_cleanly_on_signals() {
  pipes_end_us = !is_ignored(SIGPIPE);
  std::signal(SIGPIPE, SIG_IGN);  // writing fails with EPIPE instead, which can be handled
  std::signal(SIGXFSZ, SIG_IGN);  // writing fails with EFBIG beyond the limit of `ulimit -f`
  sigset_t signals, before;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (!is_ignored(signal)) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, &before);
  try {
    std::thread(wait_for, signals).detach();
  } catch (const std::system_error&) {  // no thread: the signals then end the process immediately
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
}

void say_when_interrupted(const std::string& what) {
  const std::lock_guard lock(farewell_words().lock);
  farewell_words().end = what;
}

StopSignal::StopSignal() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) throw EnvironmentError("too many open files; raise the limit (ulimit -n)");
  noted_by = descriptor_;
}

StopSignal::~StopSignal() {
  noted_by = -1;
  close(descriptor_);
}

bool StopSignal::has_arrived() const {
  pollfd waiting{descriptor_, POLLIN, 0};
  return poll(&waiting, 1, 0) == 1;
}

void end_as_by_closed_pipe() {
  if (!pipes_end_us) return;
  abandon_atomic_files();
  die_of(SIGPIPE);
}

void hold_pipe(const std::string& path) {
  struct stat of_path {};
  struct stat of_own {};
  if (stat(path.c_str(), &of_path) != 0 || !S_ISFIFO(of_path.st_mode) || platform::has_name(path.c_str()))
    return;
  constexpr int kDescriptors = 1024;
  int pipe = 0;
  const auto is_pipe = [&] { return of_own.st_dev == of_path.st_dev && of_own.st_ino == of_path.st_ino; };
  while (pipe < kDescriptors && !(fstat(pipe, &of_own) == 0 && is_pipe())) ++pipe;
  if ((fcntl(pipe, F_GETFL) & O_ACCMODE) != O_RDONLY) return;  // none of this process, or to be written to
  // Copy what it holds to a file without a name, at whose start the descriptor is afterwards.
  constexpr std::uint64_t kMax = std::uint64_t{4} << 30;  // endless ones must not fill the disk
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> kept(std::tmpfile(), &std::fclose);
  std::vector<char> buffer(std::size_t{1} << 18);
  std::uint64_t total = 0;
  bool is_kept = kept != nullptr;
  for (ssize_t n; is_kept && (n = read(pipe, buffer.data(), buffer.size())) > 0;) {
    const auto size = static_cast<std::size_t>(n);
    errno = EFBIG;
    is_kept = (total += size) <= kMax && std::fwrite(buffer.data(), 1, size, kept.get()) == size;
  }
  if (!is_kept || std::fflush(kept.get()) != 0 || lseek(fileno(kept.get()), 0, SEEK_SET) != 0 ||
      dup2(fileno(kept.get()), pipe) < 0)
    throw EnvironmentError(printable_name(path) + ": cannot keep the contents of the pipe (" +
                           std::strerror(errno) + "); write them to a file, and name it instead");
}

}  // namespace lrb::tools
