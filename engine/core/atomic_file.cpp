// Atomic replacement of a file, by the rename idiom of POSIX.
// 1. Create a temporary file beside the target, on the same file system, and register it.
// 2. Write to it through a buffer.
// 3. commit(): close it and rename it over the target, which is atomic for readers.
// Without commit(), the destructor removes it. There is no fsync: a crash of the machine may lose the data.

#include "engine/core/atomic_file.hpp"

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"

namespace lrb {
namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 16;

bool is_machines_fault(int reason) {
  return reason == ENOSPC || reason == EDQUOT || reason == EIO || reason == EROFS || reason == EFBIG ||
         reason == EMFILE || reason == ENFILE;
}

/// Resolves symbolic links, so that the file is replaced and not the link.
std::string behind_links(const std::string& path) {
  std::error_code error;
  const auto real = std::filesystem::weakly_canonical(path, error);
  return error ? path : real.string();
}

/// Returns a name beside the target, on the same file system, that no other process or thread uses.
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return target + ".tmp-" + std::to_string(getpid()) + "-" + std::to_string(counter++);
}

/// The temporary files that exist. Never destroyed, because threads may outlive main().
struct Unfinished {
  std::mutex mutex;
  std::set<std::string> files;
};

Unfinished& unfinished() {
  static auto* const all = new Unfinished;
  return *all;
}

int create_temporary(const std::string& name) {
  static constexpr mode_t kAll = 0666;  // less the umask
  Unfinished& all = unfinished();
  // Register before creating: abandon_atomic_files() must not miss a file. Once it has the lock, none is
  // created.
  const std::lock_guard lock(all.mutex);
  const auto entry = all.files.insert(name).first;
  const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kAll);
  // erase() may change errno, which the caller reports.
  const int reason = errno;
  if (file < 0) all.files.erase(entry);
  errno = reason;
  return file;
}

}  // namespace

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(behind_links(path)) {
  struct stat status {};
  const bool exists = stat(target_.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) fail("write", EISDIR);
  // Pipes and devices cannot be replaced: write to them directly.
  if (exists && !S_ISREG(status.st_mode)) {
    file_ = open(path_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    temporary_ = temporary_name(target_);
    file_ = create_temporary(temporary_);
  }
  if (file_ < 0) {
    const int reason = errno;
    temporary_.clear();
    fail("create", reason);
  }
  if (exists && !temporary_.empty())
    static_cast<void>(fchmod(file_, status.st_mode & 07777));  // keep the mode if we are allowed to
}

AtomicFile::~AtomicFile() {
  if (file_ >= 0) close(file_);
  if (temporary_.empty()) return;
  // Not committed: the target stays as it was.
  const std::lock_guard lock(unfinished().mutex);
  unlink(temporary_.c_str());
  unfinished().files.erase(temporary_);
}

void AtomicFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBuffer) flush();
}

void AtomicFile::flush() {
  const char* at = buffer_.data();
  for (std::size_t left = buffer_.size(); left > 0;) {
    const ssize_t written = ::write(file_, at, left);
    // A signal interrupted the call, or it wrote only a part: go on with the rest.
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("write", errno);
    at += written;
    left -= static_cast<std::size_t>(written);
  }
  buffer_.clear();
}

void AtomicFile::commit() {
  flush();
  // close() must not be repeated after an error, so forget the descriptor first. It reports delayed write
  // errors.
  const int file = file_;
  file_ = -1;
  if (close(file) != 0) fail("write", errno);
  if (temporary_.empty()) return;
  {
    // Rename under the lock, so that abandon_atomic_files() sees the file either unfinished or in place.
    const std::lock_guard lock(unfinished().mutex);
    if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail("replace", errno);
    unfinished().files.erase(temporary_);
  }
  temporary_.clear();
}

void AtomicFile::fail(const char* doing, int reason) const {
  const std::string message = printable_name(path_) + ": cannot " + doing + " the file (" +
                              std::strerror(reason) + "); check the path, its permissions and the space left";
  if (is_machines_fault(reason)) throw EnvironmentError(message);
  throw InputError(message);
}

void abandon_atomic_files() {
  Unfinished& all = unfinished();
  // Never unlocked: no thread can create or commit a file from here on.
  all.mutex.lock();
  for (const std::string& file : all.files) unlink(file.c_str());
}

void write_file(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

void make_folder(const std::string& path) {
  if (path.empty()) return;
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error || !std::filesystem::is_directory(path, error))
    throw EnvironmentError(path + ": cannot be made a folder (" +
                           (error ? error.message() : "a file is in the way") + ")");
}

void make_folder_of(const std::string& file) {
  make_folder(std::filesystem::path(file).parent_path().string());
}

}  // namespace lrb
