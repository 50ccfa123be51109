#if !defined(_WIN32)

#include <cerrno>
#include <cstdlib>
#include <string_view>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>
#if defined(__linux__)
#include <sys/vfs.h>
#endif

#include "engine/platform/platform.hpp"

namespace lrb::platform {

int create_file(const std::string& path) {
  static constexpr mode_t kAll = 0666;  // minus the umask
  return open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kAll);
}
int open_to_write(const std::string& path) {
  return open(path.c_str(), O_WRONLY | O_CLOEXEC);
}
std::ptrdiff_t write(int file, const char* bytes, std::size_t size) {
  return ::write(file, bytes, size);
}
int close(int file) {
  return ::close(file);
}
void remove(const char* path) {
  unlink(path);
}

std::uint64_t process() {
  return static_cast<std::uint64_t>(getpid());
}

bool has_name(const char* fifo) {
#if defined(__linux__)
  constexpr long kPipeFileSystem = 0x50495045;  // PIPEFS_MAGIC
  struct statfs where {};
  return statfs(fifo, &where) != 0 || static_cast<long>(where.f_type) != kPipeFileSystem;
#else
  return !std::string_view(fifo).starts_with("/dev/fd/");
#endif
}

std::string create_folder(const std::string& start) {
  std::string name = start + "XXXXXX";
  return mkdtemp(name.data()) != nullptr ? name : std::string();
}

int lock_folder(const std::string& folder) {
  const int file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return kNotLockable;  // the folder may be writable but not readable
  if (flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return file;
  ::close(file);
  return kOthersLock;
}

}  // namespace lrb::platform

#endif
