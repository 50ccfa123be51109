#pragma once
/// Runs a program of ours beside this one and reads its lines.

#include <chrono>
#include <string>
#include <vector>

#include <sys/types.h>

namespace lrb::workers {

/// The exit code of a child whose program does not exist, as in shells.
inline constexpr int kNoSuchProgram = 127;

/// A process that is killed when this object goes, and when this process ends, however that ends (Linux). Its
/// stderr is discarded.
class Child {
 public:
  /// Starts a program. `given` is a file descriptor that becomes the child's number 3, or -1. Throws
  /// EnvironmentError if the machine has no room for another process; a program that does not exist ends with
  /// kNoSuchProgram.
  Child(const std::vector<std::string>& command, int given);
  ~Child();
  Child(Child&& other) noexcept;
  Child& operator=(Child&&) = delete;

  /// Returns the file descriptor to wait on for lines.
  int output() const { return output_; }
  /// Reads what there is, and appends the lines that are whole. Returns false at the end.
  bool read(std::vector<std::string>& lines);
  void kill();
  /// Waits for the end; returns an exit code, or -signal.
  int wait();

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  std::string unfinished_;
};

/// Returns all lines of a child that should end soon; empty if it did not end with code 0 in time. `given` as
/// for Child.
std::vector<std::string> lines_of(const std::vector<std::string>& command, std::chrono::seconds limit,
                                  int given = -1);

}  // namespace lrb::workers
