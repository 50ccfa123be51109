#pragma once
/// The results of a long computation while it runs, so that an interrupted one can be continued.

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

namespace lrb::io {

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
