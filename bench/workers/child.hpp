#pragma once
/// Runs another program as a child process, reads its lines, and exchanges files with it.

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

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
  void kill();
  /// Waits for the end. Returns an exit code, or -signal.
  int wait();

 private:
  pid_t pid_ = -1;
  int output_ = -1;
  std::string unfinished_;
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
  int descriptor() const { return file_; }
  void write(std::string_view text) const;
  /// Returns the whole content, and sets the position to the end.
  std::vector<std::byte> bytes() const;

 private:
  int file_;
};

}  // namespace lrb::workers
