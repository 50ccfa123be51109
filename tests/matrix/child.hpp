#pragma once
/// Work in a process of its own, so that a crash or a hang is a finding like others.

#include <csignal>
#include <exception>
#include <functional>
#include <string>

#include <sys/wait.h>
#include <unistd.h>

namespace lrb::matrix {

inline constexpr unsigned kChildSeconds = 600;

/// Reports progress and faults to the parent.
class Report {
 public:
  explicit Report(int out) : out_(out) {}
  void through(const std::string& door) { door_ = door; }
  void doing(const std::string& what) { line('@', what_ = what); }
  void wrong(const std::string& what) { line('!', what_ + ": " + what); }

 private:
  void line(char kind, const std::string& text) const {
    const std::string all = kind + (door_.empty() ? "" : door_ + ", ") + text + "\n";
    static_cast<void>(!write(out_, all.data(), all.size()));
  }
  int out_;
  std::string door_, what_;
};

/// Does `work` and returns what was wrong, a line each; also if the process ended otherwise, and in what.
inline std::string in_child(const std::function<void(Report&)>& work) {
  int ends[2];
  if (pipe(ends) != 0) return "no pipe";
  const pid_t child = fork();
  if (child == 0) {
    for (const int number : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL})
      std::signal(number, SIG_DFL);  // not doctest's
    alarm(kChildSeconds);
    Report report(ends[1]);
    try {
      work(report);
    } catch (const std::exception& e) {
      report.wrong(std::string("exception: ") + e.what());
    }
    _exit(0);
  }
  close(ends[1]);
  std::string all, wrong, last;
  char bytes[4096];
  for (ssize_t n = 0; (n = read(ends[0], bytes, sizeof bytes)) > 0;)
    all.append(bytes, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  for (std::size_t at = 0, end = 0; (end = all.find('\n', at)) != std::string::npos; at = end + 1)
    (all[at] == '!' ? wrong : (last.clear(), last)) += all.substr(at + 1, end - at);
  if (status != 0) wrong += "crash or hang (status " + std::to_string(status) + ") in " + last;
  return wrong;
}

}  // namespace lrb::matrix
