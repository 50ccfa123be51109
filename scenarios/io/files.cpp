#include "scenarios/io/files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>

#ifndef _WIN32
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ;
#endif

#include "engine/platform/platform.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb::io {

std::string_view embedded_file(std::string_view name) {
  for (const EmbeddedFile& file : embedded_files())
    if (file.name == name) return file.text;
  throw EnvironmentError("internal file missing from the program: " + std::string(name) +
                         "; rebuild the program");
}

namespace fs = std::filesystem;
namespace {

constexpr const char* kMadeFrom = "made_from.txt";

bool is_written(const fs::path& name) {
  if (name == "frames") return true;
  for (const char* ending : {".html", ".json", ".gz", ".lrb", ".png", ".txt"})
    if (name.extension() == ending) return true;
  return false;
}

void reject_links_in(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (fs::is_symlink(entry->symlink_status()) && is_written(entry->path().filename()))
      throw EnvironmentError(printable_name(entry->path().string()) +
                             ": expected a file of the run, found a symbolic link, which could lead out of "
                             "the folder; remove it, or choose another folder");
}

}  // namespace

std::string read_text(const std::string& path, std::uint64_t most) {
  return read_file(path, most);
}

std::string read_small_text(const std::string& path) {
  constexpr std::uint64_t kMax = std::uint64_t{8} << 20;
  return read_file(path, kMax);
}

void write_text(const std::string& path, const std::string& text) {
  make_folder_of(path);
  write_file(path, text);
}

void reject_links(const std::string& folder) {
  reject_links_in(folder);  // throws if `frames` itself is a link
  reject_links_in(fs::path(folder) / "frames");
}

void reject_run_of_another(const std::string& folder, const std::string& scenario_file) {
  std::error_code error;
  const std::string marker = folder + "/" + kMadeFrom;
  if (!fs::is_regular_file(marker, error)) return;
  std::string other = read_file(marker);
  if (!other.empty() && other.back() == '\n') other.pop_back();
  if (fs::is_regular_file(other, error) && !fs::equivalent(other, scenario_file, error))
    throw InputError(printable_name(folder) + ": contains the run of another scenario of this name, " +
                     printable_name(other) + "; rename one of them, or choose another folder with -o");
}

void mark_run(const std::string& folder, const std::string& scenario_file) {
  std::error_code error;
  if (fs::is_regular_file(scenario_file, error))
    write_text(folder + "/" + kMadeFrom, fs::canonical(scenario_file, error).string() + "\n");
}

FolderLock::FolderLock(const std::string& path) : folder_(platform::lock_folder(path)) {
  if (folder_ == platform::kOthersLock)
    throw EnvironmentError(
        printable_name(path) +
        ": another lrbscope process is writing to this folder; wait for it, or choose another folder");
}

FolderLock::~FolderLock() {
  if (folder_ >= 0) platform::close(folder_);
}

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::string start = (fs::temp_directory_path(error) / "lrbscope-").string();
  path = platform::create_folder(start);
  if (path.empty())
    throw EnvironmentError(start + "XXXXXX: cannot create a folder: " + std::strerror(errno) +
                           "; set TMPDIR");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  fs::remove_all(path, ignored);
}

#ifdef _WIN32
Finished run_program(std::vector<std::string>, const std::string&) {
  return {.not_started = "not supported on Windows"};
}
#else
namespace {

/// An unnamed temporary file: removed when it is closed, however the process ends.
class Scratch {
 public:
  Scratch() : file_(std::tmpfile()) {
    if (file_ == nullptr) throw EnvironmentError(std::string("no temporary file: ") + std::strerror(errno));
  }
  ~Scratch() { std::fclose(file_); }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  int descriptor() const { return fileno(file_); }
  void fill(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size() || std::fflush(file_) != 0)
      throw EnvironmentError(std::string("cannot write a temporary file: ") + std::strerror(errno));
    std::rewind(file_);
  }
  std::string text() {
    std::string out;
    char buffer[1 << 14];
    std::rewind(file_);
    while (const std::size_t n = std::fread(buffer, 1, sizeof buffer, file_)) out.append(buffer, n);
    return out;
  }

 private:
  std::FILE* file_;
};

}  // namespace

Finished run_program(std::vector<std::string> words, const std::string& input) {
  Scratch files[3];
  files[STDIN_FILENO].fill(input);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_adddup2(&actions, files[number].descriptor(), number);
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = -1;
  Finished out;
  const int error = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) {
    out.not_started = std::strerror(error);
    return out;
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  out.code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  out.output = files[STDOUT_FILENO].text();
  out.errors = files[STDERR_FILENO].text();
  return out;
}
#endif

namespace {

/// Returns the lines of a file that end with a line break; the last one may have been cut off.
std::vector<std::string> complete_lines(const std::string& path) {
  std::vector<std::string> out;
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return out;
  const std::string text = read_text(path);
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    out.push_back(text.substr(begin, end - begin));
  return out;
}

}  // namespace

void LineAppender::add(const std::string& line) {
  if (!(out_ << line << "\n" << std::flush))
    throw EnvironmentError(printable_name(path_) + ": cannot write the file: " + std::strerror(errno));
}

UnfinishedFile::UnfinishedFile(std::string path, const std::string& head, Other other)
    : path_(std::move(path)) {
  if (path_.empty()) return;
  lines_ = complete_lines(path_);
  if (other == Other::refused && !lines_.empty() && lines_.front() != head)
    throw InputError(
        printable_name(path_) +
        ": belongs to a run with other settings or of another version; finish that run, remove the file, or "
        "give another folder (-o)");
  if (lines_.empty() || lines_.front() != head)
    lines_.clear();
  else
    lines_.erase(lines_.begin());
  std::string text = head + "\n";
  for (const std::string& line : lines_) text += line + "\n";
  write_text(path_, text);  // without a line that was cut off
  out_.emplace(path_);
}

void UnfinishedFile::add(const std::string& line) {
  if (out_) out_->add(line);
}

void UnfinishedFile::remove() const {
  std::error_code error;
  if (!path_.empty()) std::filesystem::remove(path_, error);
}

}  // namespace lrb::io
