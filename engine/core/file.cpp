// Atomic replacement of a file, by renaming.
// 1. Create a temporary file beside the target, on the same file system, and register it.
// 2. Write to it through a buffer.
// 3. commit(): close it and rename it over the target, which is atomic for readers.
// Without commit(), the destructor removes it. There is no fsync: a crash of the machine may lose the data.

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>
#include <vector>

#include "engine/platform/platform.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>

namespace lrb {
namespace {

std::string escaped(std::string_view text, bool keep_high) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    // Printable ASCII as it is. Bytes from 0x80 may be UTF-8, and are kept on request, but for control
    // characters (C2 80 to C2 9F). Others as \xhh.
    const auto is_c1 = [&](std::size_t at) {
      return at + 1 < text.size() && text[at] == '\xc2' && (text[at + 1] & 0xe0) == 0x80;
    };
    const bool keeps = keep_high && byte >= 0x80 && !is_c1(i) && !(i > 0 && is_c1(i - 1));
    if ((byte >= 0x20 && byte < 0x7f) || keeps) {
      out += text[i];
    } else {
      out += {'\\', 'x', kHex[byte >> 4], kHex[byte & 15]};
    }
  }
  return out;
}

[[noreturn]] void cannot_read(const std::string& path, const std::string& why) {
  throw InputError(printable_name(path) + ": " + why);
}

[[noreturn]] void too_large(const std::string& path, std::uint64_t most) {
  cannot_read(path, "expected at most " + std::to_string(most) +
                        " bytes for a file of this kind, found more; check that it is the right file");
}

}  // namespace

std::string_view what_is_no_file(const std::string& path) {
  using Kind = std::filesystem::file_type;
  std::error_code ignored;
  switch (std::filesystem::status(path, ignored).type()) {
    case Kind::directory:
      return "a directory";
    case Kind::character:  // /dev/zero has no end
    case Kind::block:
      return "a device";
    case Kind::fifo:
      return platform::has_name(path.c_str()) ? "a named pipe" : "";
    case Kind::socket:
      return "a socket";
    default:
      return "";
  }
}

InputFile::InputFile(const std::string& path) : path_(path), file_(nullptr, &std::fclose) {
  const std::string_view kind = what_is_no_file(path);
  if (!kind.empty())
    cannot_read(
        path, "found " + std::string(kind) + ", expected a file" +
                  (kind == "a directory" ? "; name a file in it" : "; copy its contents to a regular file"));
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (!file_) {
    const int reason = errno;
    if (reason == ENOENT) cannot_read(path, "no such file; check the path");
    cannot_read(path,
                std::string("cannot open the file (") + std::strerror(reason) + "); check its permissions");
  }
  std::error_code no_size;  // of a pipe
  const std::uint64_t size = std::filesystem::file_size(path, no_size);
  if (!no_size) size_ = size;
}

std::string_view InputFile::start() {
  static constexpr std::size_t kEnough = 64;  // bytes: more than any magic
  if (start_.empty()) {
    std::string first(kEnough, '\0');
    first.resize(read(first.data(), kEnough));
    start_ = std::move(first);
  }
  return start_;
}

std::size_t InputFile::read(char* to, std::size_t most) {
  // Bytes that start() has read, then those of the file.
  const std::size_t before = start_.copy(to, most);
  start_.erase(0, before);
  const std::size_t got = before + std::fread(to + before, 1, most - before, file_.get());
  // A short read is the end of the file or an error.
  if (got < most && std::ferror(file_.get()))
    cannot_read(path_, "cannot read the file; check the disk or copy the file again");
  return got;
}

std::string read_file(const std::string& path, std::uint64_t most) {
  InputFile file(path);
  return read_file(file, most);
}

std::string read_file(InputFile& file, std::uint64_t most) {
  const std::string& path = file.path();
  // Reject large files before reading. Pipes have no size, so the limit is checked again after each chunk.
  if (file.size() > most) too_large(path, most);
  static constexpr std::size_t kChunk = std::size_t{1} << 18;
  std::string bytes;
  // Room for one chunk beyond the size, so that the buffer of a file does not grow.
  if (file.size()) bytes.reserve(*file.size() + kChunk);
  for (;;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kChunk);
    const std::size_t got = file.read(bytes.data() + before, kChunk);
    bytes.resize(before + got);
    if (bytes.size() > most) too_large(path, most);
    if (got < kChunk) return bytes;
  }
}

std::string in_quotes(std::string_view text, std::size_t limit) {
  const bool cut = text.size() > limit;
  return std::string(1, '\'').append(escaped(text.substr(0, limit), false)).append(cut ? "...'" : "'");
}

std::string printable_name(std::string_view name) {
  return escaped(name, true);
}

namespace {

constexpr std::size_t kBuffer = std::size_t{1} << 16;

bool is_machines_fault(int reason) {
#if defined(EDQUOT)
  if (reason == EDQUOT) return true;
#endif
  return reason == ENOSPC || reason == EIO || reason == EROFS || reason == EFBIG || reason == EMFILE ||
         reason == ENFILE;
}

/// Resolves symbolic links, so that the file is replaced and not the link.
std::string behind_links(const std::string& path) {
  std::error_code error;
  const auto real = std::filesystem::weakly_canonical(path, error);
  return error ? path : real.string();
}

/// Returns an unused name beside the target, on the same file system, unique among processes and threads.
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> counter{0};
  return target + ".tmp-" + std::to_string(platform::process()) + "-" + std::to_string(counter++);
}

/// The existing temporary files. Never destroyed, because threads may outlive main().
struct Unfinished {
  std::mutex mutex;
  std::set<std::string> files;
};

Unfinished& unfinished() {
  static auto* const all = new Unfinished;
  return *all;
}

int create_temporary(const std::string& name) {
  Unfinished& all = unfinished();
  // Register before creating: abandon_atomic_files() must not miss a file. Once it has the lock, none is
  // created.
  const std::lock_guard lock(all.mutex);
  const auto entry = all.files.insert(name).first;
  const int file = platform::create_file(name);
  // erase() may change errno, which the caller reports.
  const int reason = errno;
  if (file < 0) all.files.erase(entry);
  errno = reason;
  return file;
}

std::vector<std::filesystem::path>& inputs() {
  static auto* const all = new std::vector<std::filesystem::path>;
  return *all;
}

}  // namespace

void protect_input(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) inputs().push_back(std::filesystem::absolute(path));
}

void reject_input_as_output(const std::string& path) {
  std::error_code ignored;  // also that one of the files does not exist: then they differ
  for (const std::filesystem::path& input : inputs())
    if (std::filesystem::equivalent(path, input, ignored))
      throw InputError(printable_name(path) +
                       ": expected another file than an input, which the output would replace");
}

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(behind_links(path)) {
  namespace fs = std::filesystem;
  reject_input_as_output(path);
  std::error_code ignored;
  const fs::file_status status = fs::status(target_, ignored);
  const bool exists = fs::exists(status);
  if (fs::is_directory(status)) fail("write", EISDIR);
  // Pipes and devices cannot be replaced: write to them directly.
  if (exists && !fs::is_regular_file(status)) {
    file_ = platform::open_to_write(path_);
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
    fs::permissions(temporary_, status.permissions(), ignored);  // if permitted
}

AtomicFile::~AtomicFile() {
  if (file_ >= 0) platform::close(file_);
  if (temporary_.empty()) return;
  // Not committed: the target is unchanged.
  const std::lock_guard lock(unfinished().mutex);
  platform::remove(temporary_.c_str());
  unfinished().files.erase(temporary_);
}

void AtomicFile::write(std::string_view bytes) {
  buffer_.append(bytes);
  if (buffer_.size() >= kBuffer) flush();
}

void AtomicFile::flush() {
  const char* at = buffer_.data();
  for (std::size_t left = buffer_.size(); left > 0;) {
    const std::ptrdiff_t written = platform::write(file_, at, left);
    // Interrupted by a signal, or a partial write: continue with the rest.
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
  if (platform::close(file) != 0) fail("write", errno);
  if (temporary_.empty()) return;
  {
    // Rename under the lock, so that abandon_atomic_files() sees the file either unfinished or in place.
    const std::lock_guard lock(unfinished().mutex);
    std::error_code error;
    std::filesystem::rename(temporary_, target_, error);
    if (error) fail("replace", error.default_error_condition().value());
    unfinished().files.erase(temporary_);
  }
  temporary_.clear();
}

void AtomicFile::fail(const char* doing, int reason) const {
  const std::string message = printable_name(path_) + ": cannot " + doing + " the file (" +
                              std::strerror(reason) + "); check the path, its permissions and the free space";
  if (is_machines_fault(reason)) throw EnvironmentError(message);
  throw InputError(message);
}

void abandon_atomic_files() {
  Unfinished& all = unfinished();
  // Never unlocked: no thread can create or commit a file from here on.
  all.mutex.lock();
  for (const std::string& file : all.files) platform::remove(file.c_str());
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
    throw EnvironmentError(path + ": cannot create the folder (" +
                           (error ? error.message() : "a file of this name exists") + ")");
}

void make_folder_of(const std::string& file) {
  make_folder(std::filesystem::path(file).parent_path().string());
}

}  // namespace lrb
