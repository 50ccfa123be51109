#include "bench/workers/child.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <lrbscope/error.hpp>

namespace lrb::workers {
namespace {

constexpr int kGiven = 3;  // the child's file descriptor for `given`

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
      unfinished_(std::move(other.unfinished_)) {}

bool Child::read(std::vector<std::string>& lines) {
  static constexpr std::size_t kPiece = 1 << 16;
  char buffer[kPiece];
  const ssize_t n = ::read(output_, buffer, sizeof buffer);
  if (n < 0) return errno == EINTR || errno == EAGAIN;
  if (n == 0) return false;
  unfinished_.append(buffer, static_cast<std::size_t>(n));
  std::size_t begin = 0;
  for (std::size_t end; (end = unfinished_.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines.push_back(unfinished_.substr(begin, end - begin));
  unfinished_.erase(0, begin);
  return true;
}

void Child::kill() {
  if (pid_ > 0) ::kill(pid_, SIGKILL);
}

int Child::wait() {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  return WIFSIGNALED(status) ? -WTERMSIG(status) : WEXITSTATUS(status);
}

std::vector<std::string> lines_of(const std::vector<std::string>& command, std::chrono::seconds limit,
                                  int given) {
  Child child(command, given);
  std::vector<std::string> lines;
  const auto end = std::chrono::steady_clock::now() + limit;
  while (true) {
    const auto left =
        std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
    pollfd waiting{child.output(), POLLIN, 0};
    if (left.count() <= 0 || poll(&waiting, 1, static_cast<int>(left.count())) == 0) return {};
    if (!child.read(lines)) break;
  }
  if (child.wait() != 0) lines.clear();
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

void Pipe::write(std::string_view text) const {
  while (!text.empty()) {
    const ssize_t n = ::write(ends_[1], text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw EnvironmentError(std::string("cannot write to a pipe: ") + std::strerror(errno));
    text.remove_prefix(static_cast<std::size_t>(n));
  }
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
  while (!text.empty()) {
    const ssize_t n = ::write(file_, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw EnvironmentError(std::string("cannot write to memory: ") + std::strerror(errno));
    text.remove_prefix(static_cast<std::size_t>(n));
  }
}

std::vector<std::byte> MemoryFile::bytes() const {
  std::vector<std::byte> out;
  lseek(file_, 0, SEEK_SET);
  constexpr std::size_t kPiece = std::size_t{1} << 20;
  while (true) {
    const std::size_t size = out.size();
    out.resize(size + kPiece);
    const ssize_t n = ::read(file_, out.data() + size, kPiece);
    out.resize(size + static_cast<std::size_t>(std::max<ssize_t>(n, 0)));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return out;
  }
}

}  // namespace lrb::workers
