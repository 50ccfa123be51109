#if defined(_WIN32)

#include <cerrno>

#include <direct.h>
#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>
#define WIN32_LEAN_AND_MEAN
#if !defined(NOMINMAX)  // MinGW's standard library defines it
#define NOMINMAX
#endif
#include <windows.h>

#include "engine/platform/platform.hpp"

namespace lrb::platform {

int create_file(const std::string& path) {
  return _open(path.c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT, _S_IREAD | _S_IWRITE);
}
int open_to_write(const std::string& path) {
  return _open(path.c_str(), _O_WRONLY | _O_BINARY | _O_NOINHERIT);
}
std::ptrdiff_t write(int file, const char* bytes, std::size_t size) {
  constexpr std::size_t kMax = std::size_t{1} << 30;  // the function takes an unsigned int
  return _write(file, bytes, static_cast<unsigned>(size < kMax ? size : kMax));
}
int close(int file) {
  return _close(file);
}
void remove(const char* path) {
  DeleteFileA(path);
}

std::uint64_t process() {
  return GetCurrentProcessId();
}

bool has_name(const char*) {
  return true;
}

std::string create_folder(const std::string& start) {
  for (unsigned i = 0;; ++i) {
    const std::string name = start + std::to_string(process()) + "-" + std::to_string(i);
    if (_mkdir(name.c_str()) == 0) return name;
    if (errno != EEXIST) return {};
  }
}

int lock_folder(const std::string& folder) {
  // A file that no other process can open, and that is removed when it is closed.
  const HANDLE file = CreateFileA((folder + "/.lrbscope-lock").c_str(), GENERIC_WRITE, 0, nullptr,
                                  OPEN_ALWAYS, FILE_ATTRIBUTE_HIDDEN | FILE_FLAG_DELETE_ON_CLOSE, nullptr);
  if (file == INVALID_HANDLE_VALUE)
    return GetLastError() == ERROR_SHARING_VIOLATION ? kOthersLock : kNotLockable;
  return _open_osfhandle(reinterpret_cast<std::intptr_t>(file), 0);
}

}  // namespace lrb::platform

#endif
