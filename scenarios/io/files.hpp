#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace lrb::io {

// Text files that are compiled into the program (cmake/embed.cmake): the page's template, the charting
// library, the schemas and the shipped scenarios. One binary then does everything wherever it is copied to.

struct EmbeddedFile {
  std::string_view name;  ///< without its folder
  std::string_view text;
};

std::span<const EmbeddedFile> embedded_files();
/// Returns the text of a file. Throws EnvironmentError if the program was built without it.
std::string_view embedded_file(std::string_view name);

/// Returns the contents of a file. Throws InputError that names the file if it cannot be read, is not a
/// file, or has more than `most` bytes, which are then not read.
std::string read_text(const std::string& path,
                      std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

/// Returns the contents of a file that people write: a scenario, a crowd, an experiment. More than 8 MiB (a
/// scenario of 35,000 poses) are refused before they are read, because parsing takes 50 times as much memory.
std::string read_small_text(const std::string& path);

/// Writes a file whole or not at all: beside its place, then renamed. Makes its folder if that is missing.
/// Throws EnvironmentError.
void write_text(const std::string& path, const std::string& text);

/// Makes sure that what is written into an output folder stays in it: throws EnvironmentError that names a
/// symbolic link in the folder, or in its frames folder, under a name that a run writes (a page, numbers, a
/// trace, an LRB-rep, a picture, or frames itself). The folder's own path may lead through links, because
/// that is what the user asked for.
void refuse_links(const std::string& folder);

/// Keep two scenarios of one name from replacing each other's runs in the folder of that name. `refuse`
/// throws InputError if the folder holds the run of another file that still exists; `mark` notes, in a file
/// of its own, whose run the folder holds from now on. Shipped scenarios, which are not files, mark nothing.
void refuse_run_of_another(const std::string& folder, const std::string& scenario_file);
void mark_run(const std::string& folder, const std::string& scenario_file);

/// Keeps other processes that ask for the same folder's lock out of it as long as this object lives. Ends
/// with the process, however that ends, and leaves no file behind. Throws EnvironmentError if another process
/// has it.
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
