#pragma once
/// Atomic file output, and file input.

#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace lrb {

/// Writes to a temporary file beside the target and renames it at the end. Readers never see an incomplete
/// file, and after a failure (disk full, no permission, an exception) the previous content is unchanged. For
/// text and binary data. Targets that are not regular files, such as a pipe or /dev/null, are written
/// directly.
///
/// Every failure throws and names the path and the reason: EnvironmentError if the machine is the cause (disk
/// full, read-only, I/O error), InputError if the path is.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();  ///< removes the temporary file unless commit() succeeded
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes; small pieces are buffered. Can be called any number of times.
  void write(std::string_view bytes);
  /// Flushes the buffer and moves the file to its target. Must be called once, at the end.
  void commit();

 private:
  void flush();
  [[noreturn]] void fail(const char* doing, int reason) const;

  std::string path_;       ///< as given, for messages
  std::string target_;     ///< path_ with symbolic links resolved
  std::string temporary_;  ///< empty if the target is written directly, or after commit()
  std::string buffer_;
  int file_ = -1;
};

/// Makes AtomicFile refuse to replace a file that exists, under any of its names: a program's outputs must
/// not replace its inputs. Call it before any thread.
void protect_input(const std::string& path);
/// Throws InputError if a path is a protected file.
void reject_input_as_output(const std::string& path);

/// Removes the temporary files of all AtomicFiles and blocks creation and commit of others. For a process
/// that is about to exit without running destructors. Acquires a lock and never releases it; must not be
/// called from a signal handler.
void abandon_atomic_files();

/// Writes an entire file atomically, as AtomicFile does.
void write_file(const std::string& path, std::string_view bytes);

/// Creates a folder and its parents. Throws EnvironmentError if that fails or a file is in the way.
void make_folder(const std::string& path);

/// Creates the folder of a file that is to be written, as make_folder() does. (`build` and `close` do not
/// call it: they reject files in folders that do not exist.)
void make_folder_of(const std::string& file);

/// A file that is read from its start to its end. Errors throw InputError and name the path.
class InputFile {
 public:
  /// Throws if the file is missing or unreadable, or is not a regular file or pipe (what_is_no_file()).
  explicit InputFile(const std::string& path);

  const std::string& path() const { return path_; }
  /// Returns the number of bytes; nullopt for a pipe.
  std::optional<std::uint64_t> size() const { return size_; }
  /// Reads the next bytes, at most `most`. Returns their number; fewer: the end of the file.
  std::size_t read(char* to, std::size_t most);
  /// Returns the first bytes, at most 64, which tell the format. read() returns them again. Must be called
  /// before any read().
  std::string_view start();

 private:
  std::string path_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::optional<std::uint64_t> size_;
  std::string start_;  ///< bytes of start() that read() has not returned yet
};

/// Returns the content of a file. Throws InputError as InputFile does, or if there are more than `most`
/// bytes.
std::string read_file(const std::string& path,
                      std::uint64_t most = std::numeric_limits<std::uint64_t>::max());
/// Returns the rest of a file.
std::string read_file(InputFile& file, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// Returns the type of a path that cannot be read to its end like a file: "a directory", "a device", "a named
/// pipe" (might block forever) or "a socket". Returns an empty string for files, for anonymous pipes as
/// created by shells, and if the path does not exist. Does not open it.
std::string_view what_is_no_file(const std::string& path);

/// Returns `text` in single quotes for use in a one-line message. Control characters and bytes outside
/// printable ASCII appear as \\xNN. Text after the first `limit` characters is cut off.
std::string in_quotes(std::string_view text, std::size_t limit = 40);

/// Returns a file name as the prefix of a message: unchanged, except that it is kept on one line.
std::string printable_name(std::string_view name);

}  // namespace lrb
