#pragma once
/// Files that are there whole or not at all.

#include <string>
#include <string_view>

namespace lrb {

/// Writes beside the target and moves the result there at the end: a reader never sees half a file, and a
/// failure (disk full, no permission, an exception on the way) leaves what was there before. Text and binary
/// alike. Something that is not a regular file, such as a pipe or /dev/null, is written to directly.
///
/// Failures throw naming path and reason: EnvironmentError if the machine cannot (disk full, read-only, I/O
/// error), InputError if the path is at fault.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();  ///< removes the temporary file unless commit() was reached
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// May be called many times; small pieces are gathered.
  void write(std::string_view bytes);
  /// Must be called once, at the end.
  void commit();

 private:
  void flush();
  [[noreturn]] void fail(const char* doing, int reason) const;

  std::string path_;       ///< as given, for messages
  std::string target_;     ///< behind symbolic links
  std::string temporary_;  ///< empty: written to directly, or committed
  std::string buffer_;
  int file_ = -1;
};

/// Removes the temporary files of all AtomicFiles, and lets none begin or end any more: for a process that is
/// about to end without running destructors. Takes a lock for good; not for use in a signal handler.
void abandon_atomic_files();

/// The whole file in one go.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace lrb
