#pragma once

#include <string>

namespace lrb::io {

/// The whole of a file. Throws InputError naming the file if it cannot be read or is a folder.
std::string read_text(const std::string& path);

/// Writes beside the file and renames, so that no half-written file is ever seen under its name. Makes the
/// folder if it is missing. Throws EnvironmentError.
void write_text(const std::string& path, const std::string& text);

/// Makes a folder and those above it. Throws EnvironmentError if that fails or a file is in the way.
void make_folder(const std::string& path);

/// What is written into an output folder stays in it: throws EnvironmentError, naming it, if a symbolic link
/// stands in the folder, or in its frames folder, under a name that a run writes (a page, numbers, a trace,
/// an LRB-rep, a picture, or frames itself). The folder's own path may lead through links: it was asked for.
void refuse_links(const std::string& folder);

/// Keeps other processes that ask for the same folder's lock out of it, until it goes. Ends with the process,
/// however that ends, and leaves no file. Throws EnvironmentError if another one has it.
class FolderLock {
 public:
  explicit FolderLock(const std::string& path);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int folder_;
};

}  // namespace lrb::io
