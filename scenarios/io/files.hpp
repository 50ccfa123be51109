#pragma once

#include <string>

namespace lrb::io {

/// Returns all of a file. Throws InputError naming the file if it cannot be read or is no file.
std::string read_text(const std::string& path);

/// The same of a file that people write: a scenario, a crowd, an experiment. More than 8 MiB (a scenario of
/// 35,000 poses) are refused before they are read: to parse them takes 50 times as much memory.
std::string read_small_text(const std::string& path);

/// Writes beside the file and renames, so that no half-written file is ever seen under its name. Makes the
/// folder if it is missing. Throws EnvironmentError.
void write_text(const std::string& path, const std::string& text);

/// Makes a folder and those above it. Throws EnvironmentError if that fails or a file is in the way.
void make_folder(const std::string& path);

/// What is written into an output folder stays in it: throws EnvironmentError, naming it, if a symbolic link
/// stands in the folder, or in its frames folder, under a name that a run writes (a page, numbers, a trace,
/// an LRB-rep, a picture, or frames itself). The folder's own path may lead through links: it was asked for.
void refuse_links(const std::string& folder);

/// Keeps two scenarios of one name from replacing each other's runs in the folder of that name. `refuse`
/// throws InputError if it holds the run of another file, which is still there; `mark` notes in a file of its
/// own whose run it holds from now on. Shipped scenarios, which are no files, mark nothing.
void refuse_run_of_another(const std::string& folder, const std::string& scenario_file);
void mark_run(const std::string& folder, const std::string& scenario_file);

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
