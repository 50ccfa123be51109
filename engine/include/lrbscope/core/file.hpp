#pragma once
/// Files that appear whole or not at all.

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

namespace lrb {

/// Writes to a temporary file beside the target and renames it at the end: a reader never sees half a file,
/// and a failure (disk full, no permission, an exception on the way) leaves what was there before. For text
/// and binary data. Something that is not a regular file, such as a pipe or /dev/null, is written to
/// directly.
///
/// Every failure throws and names the path and the reason: EnvironmentError if the machine is at fault (disk
/// full, read-only, I/O error), InputError if the path is.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();  ///< Removes the temporary file unless commit() was reached.
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes; small pieces are buffered. May be called any number of times.
  void write(std::string_view bytes);
  /// Writes what is buffered and puts the file in place. Must be called once, at the end.
  void commit();

 private:
  void flush();
  [[noreturn]] void fail(const char* doing, int reason) const;

  std::string path_;       ///< as given, for messages
  std::string target_;     ///< path_ with symbolic links resolved
  std::string temporary_;  ///< empty if the target is written to directly, or after commit()
  std::string buffer_;
  int file_ = -1;
};

/// Removes the temporary files of all AtomicFiles and keeps any other from being created or committed: for a
/// process that is about to end without running destructors. Takes a lock and never releases it, so it must
/// not be called from a signal handler.
void abandon_atomic_files();

/// Writes a whole file at once, as AtomicFile does.
void write_file(const std::string& path, std::string_view bytes);

/// Makes a folder and those above it. Throws EnvironmentError if that fails or a file is in the way.
void make_folder(const std::string& path);

/// Makes the folder of a file that is about to be written, as make_folder() does. (`build` and `close` do
/// not: they refuse a file in a folder that does not exist.)
void make_folder_of(const std::string& file);

/// Returns all bytes of a file. Throws InputError if it is missing or unreadable, if it is a directory or the
/// like (what_is_no_file()), or has more than `most` bytes, which are then not read.
std::string read_file(const std::string& path,
                      std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// Returns what stands at a path in place of a file that can be read to its end: "a directory", "a device",
/// "a named pipe" (which might wait for ever) or "a socket"; nothing for files, for pipes without a name, as
/// shells make them, and where nothing is. Does not open it.
std::string_view what_is_no_file(const std::string& path);

/// Returns `text` in single quotes for use in a message: control characters and bytes beyond printable ASCII
/// appear as \\xNN, and what follows the first `limit` characters is cut off. The message stays on one line
/// whatever a file contains.
std::string in_quotes(std::string_view text, std::size_t limit = 40);

/// Returns a file's name for the front of a message: as given, but on one line.
std::string printable_name(std::string_view name);

}  // namespace lrb
