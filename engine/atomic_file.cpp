#include "engine/atomic_file.hpp"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include <unistd.h>

#include "engine/error.hpp"

namespace lrb {

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)) {
  std::error_code ignored;
  const std::filesystem::file_status status = std::filesystem::status(path_, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw EnvironmentError(path_ + ": cannot be written: it is not a regular file; give another name");
  // The process and a count make the name unique among all that may be writing here now.
  static std::atomic<unsigned> count{0};
  beside_ = path_ + "." + std::to_string(::getpid()) + "-" + std::to_string(count++) + ".tmp";
  file_ = std::fopen(beside_.c_str(), "wbx");
  if (!file_) fail("created");
}

AtomicFile::~AtomicFile() {
  close_and_remove();
}

void AtomicFile::fail(const char* what) const {
  throw EnvironmentError(path_ + ": cannot be " + what + ": " + std::strerror(errno) +
                         "; check the folder, its permissions and the free space");
}

void AtomicFile::close_and_remove() {
  if (!file_) return;
  std::fclose(std::exchange(file_, nullptr));
  std::remove(beside_.c_str());
}

void AtomicFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail("written");
}

void AtomicFile::commit() {
  // Buffered bytes may meet a full disk as late as here.
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (closed && std::rename(beside_.c_str(), path_.c_str()) == 0) return;
  const int why = errno;
  std::remove(beside_.c_str());
  errno = why;
  fail(closed ? "given its name" : "written");
}

}  // namespace lrb
