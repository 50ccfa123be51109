#pragma once
/// Files of the program and of its results: embedded, written as a whole, in folders, and line by line.

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lrb::io {

// Text files compiled into the program (cmake/embed.cmake): the page template, the charting library, the
// schemas and the shipped scenarios. The binary is therefore self-contained.

struct EmbeddedFile {
  std::string_view name;  ///< without its folder
  std::string_view text;
};

std::span<const EmbeddedFile> embedded_files();
/// Returns the text of a file. Throws EnvironmentError if the program was built without it.
std::string_view embedded_file(std::string_view name);

/// Returns the contents of a file. Throws InputError that names the file if it cannot be read, is not a file,
/// or is longer than `most` bytes (it is not read then).
std::string read_text(const std::string& path,
                      std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// Returns the contents of a hand-written file: a scenario, a crowd, an experiment. Files of more than 8 MiB
/// (a scenario of 35,000 poses) are rejected before they are read, because parsing takes 50 times as much
/// memory.
std::string read_small_text(const std::string& path);

/// Writes a file completely or not at all: to a temporary name in the same folder, then renamed. Makes the
/// folder if it is missing. Throws EnvironmentError.
void write_text(const std::string& path, const std::string& text);

/// Ensures that output written to a folder stays in it. Throws EnvironmentError that names a symbolic link in
/// the folder, or in its frames folder, under a name that a run writes (a page, numbers, a trace, an LRB-rep,
/// a picture, or frames itself). The folder's own path may contain links, because the user chose it.
void reject_links(const std::string& folder);

/// Prevent two scenarios of one name from replacing each other's runs in the folder of that name.
/// reject_run_of_another() throws InputError if the folder contains the run of another file that still
/// exists; mark_run() records, in a separate file, the scenario file of the folder's run. Shipped scenarios,
/// which are not files, mark nothing.
void reject_run_of_another(const std::string& folder, const std::string& scenario_file);
void mark_run(const std::string& folder, const std::string& scenario_file);

/// Locks a folder against other processes that request its lock, while this object lives. The lock ends with
/// the process in any case, and leaves no file behind. Throws EnvironmentError if another process has it.
class FolderLock {
 public:
  explicit FolderLock(const std::string& path);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_;
};

/// A new folder for temporary files, which is removed with this object. Throws EnvironmentError if it cannot
/// be created.
struct TemporaryFolder {
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path path;
};

/// How a program ended.
struct Finished {
  std::string not_started;  ///< why it could not be started; empty if it was
  int code = 1;             ///< exit code; 1 also after a signal
  std::string output, errors;
};
/// Runs a program, found in PATH unless its name is a path, with `input` as its standard input.
Finished run_program(std::vector<std::string> words, const std::string& input = {});

// The results of a long computation while it runs, so that an interrupted one can be continued.

/// A file to which lines are appended; each is flushed at once.
class LineAppender {
 public:
  explicit LineAppender(const std::string& path) : path_(path), out_(path, std::ios::app) {}
  /// Throws EnvironmentError if the line cannot be written.
  void add(const std::string& line);

 private:
  std::string path_;
  std::ofstream out_;
};

/// A file to which lines are appended as results come. Its first line, the head, describes the computation.
class UnfinishedFile {
 public:
  /// What happens to a file with another head.
  enum class Other : std::uint8_t { dropped, refused };

  /// Reads the complete lines of an earlier computation with the same head. `head` and lines have no line
  /// breaks. An empty path: nothing is kept. Throws EnvironmentError if the file cannot be written, and
  /// InputError if it is refused.
  UnfinishedFile(std::string path, const std::string& head, Other other = Other::dropped);

  /// Returns the lines of the earlier computation.
  const std::vector<std::string>& lines() const { return lines_; }
  /// Appends a line, at once. Throws EnvironmentError if it cannot be written.
  void add(const std::string& line);
  /// Removes the file, because the computation is finished.
  void remove() const;

 private:
  std::string path_;
  std::vector<std::string> lines_;
  std::optional<LineAppender> out_;
};

}  // namespace lrb::io
