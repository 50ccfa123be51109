#pragma once

#include <cstdio>
#include <string>
#include <string_view>

namespace lrb {

/// A file that appears whole or not at all: written under another name in the same folder and renamed by
/// commit(). Without commit() nothing is left and whatever was there before stays.
class AtomicFile {
 public:
  /// Throws EnvironmentError if it cannot be created, or if `path` is there and not a regular file.
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Throws EnvironmentError (disk full, and so on).
  void write(std::string_view bytes);
  /// Nothing can be written afterwards. Throws EnvironmentError.
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;
  void close_and_remove();

  std::string path_;
  std::string beside_;
  std::FILE* file_ = nullptr;
};

}  // namespace lrb
