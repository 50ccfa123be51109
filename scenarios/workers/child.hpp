#pragma once
/// A program of ours that runs beside us and says lines.

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace lrb::workers {

/// The exit code of a child whose program is not there, as shells have it.
inline constexpr int kNoSuchProgram = 127;

/// Killed when it goes out of scope, and when this process ends, however that ends (Linux). Its stderr leads
/// nowhere.
class Child {
 public:
  /// `given`: a file descriptor that becomes the child's number 3, or -1. Throws EnvironmentError if the
  /// machine has no room for another process; a program that is not there ends with kNoSuchProgram.
  Child(const std::vector<std::string>& command, int given);
  ~Child();
  Child(Child&& other) noexcept;
  Child& operator=(Child&&) = delete;

  /// Where to wait for lines.
  int output() const { return output_; }
  /// Reads what there is, and appends the lines that are whole. False at the end.
  bool read(std::vector<std::string>& lines);
  void kill();
  /// Waits for the end: an exit code, or -signal.
  int wait();

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  std::string unfinished_;
};

/// All lines of a child that is expected to end soon; empty if it did not end with code 0 in time.
std::vector<std::string> lines_of(const std::vector<std::string>& command, std::chrono::seconds limit);

}  // namespace lrb::workers
