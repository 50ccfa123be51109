/// Trace files: reads and writes bytes, compressed or not. trace_json_*.cpp interprets the bytes.

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include <zlib.h>

#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::trace {

namespace {

class FileSink final : public ByteSink {
 public:
  explicit FileSink(AtomicFile& file) : file_(&file) {}
  void write(std::string_view bytes) override { file_->write(bytes); }

 private:
  AtomicFile* file_;
};

/// Compresses with gzip at level 1: traces are so repetitive that higher levels cost time and gain little.
/// The header contains no name or time, so that equal traces give equal files.
class GzipSink final : public ByteSink {
 public:
  explicit GzipSink(ByteSink& next) : next_(&next), out_(kChunk) {
    constexpr int kGzipHeader = 16;  // added to the window bits: gzip instead of zlib
    constexpr int kMemLevel = 8;
    if (deflateInit2(&stream_, 1, Z_DEFLATED, MAX_WBITS + kGzipHeader, kMemLevel, Z_DEFAULT_STRATEGY) != Z_OK)
      throw EnvironmentError("zlib cannot be initialised (out of memory)");
  }
  ~GzipSink() override { deflateEnd(&stream_); }
  GzipSink(const GzipSink&) = delete;
  GzipSink& operator=(const GzipSink&) = delete;

  void write(std::string_view bytes) override { deflate_all(bytes, Z_NO_FLUSH); }
  void finish() { deflate_all({}, Z_FINISH); }

 private:
  static constexpr std::size_t kChunk = 1 << 16;

  void deflate_all(std::string_view bytes, int flush) {
    // zlib's interface predates const; deflate does not write to its input.
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream_.avail_in = static_cast<uInt>(bytes.size());  // JsonOut passes 64 kB at a time, or one string
    // A full output buffer means that more may follow.
    do {
      stream_.next_out = reinterpret_cast<Bytef*>(out_.data());
      stream_.avail_out = static_cast<uInt>(out_.size());
      deflate(&stream_, flush);
      next_->write({out_.data(), out_.size() - stream_.avail_out});
    } while (stream_.avail_out == 0);
  }

  ByteSink* next_;
  std::vector<char> out_;
  z_stream stream_{};
};

struct GzClose {
  void operator()(gzFile file) const { gzclose_r(file); }
};

[[noreturn]] void fail_to_read(const std::string& path, const std::string& why) {
  throw InputError(printable_name(path) + ": cannot read the trace: " + why +
                   "; pass a trace.json or trace.json.gz");
}

/// Maximum decompressed size of a compressed file. Traces compressed at gzip's highest level expand 15 times;
/// a file of zeros expands 1000 times.
std::uint64_t max_unpacked(std::uint64_t packed) {
  constexpr std::uint64_t kFree = std::uint64_t{8} << 20, kRatio = 60;
  return kFree + kRatio * packed;
}

/// Reads all bytes of a file and decompresses them if they are gzip.
std::string read_all(const std::string& path, std::uint64_t max_bytes) {
  // Directories and devices are rejected before zlib opens them.
  const std::string_view kind = what_is_no_file(path);
  if (!kind.empty()) fail_to_read(path, "it is " + std::string(kind));
  const std::unique_ptr<gzFile_s, GzClose> file(gzopen(path.c_str(), "rb"));
  if (!file) fail_to_read(path, std::strerror(errno));
  constexpr unsigned kChunk = 1 << 18;
  gzbuffer(file.get(), kChunk);
  std::string text;
  std::vector<char> chunk(kChunk);
  for (;;) {
    const int got = gzread(file.get(), chunk.data(), kChunk);
    int code = Z_OK;
    const char* why = gzerror(file.get(), &code);
    if (code == Z_MEM_ERROR) throw std::bad_alloc();
    // A truncated gzip stream is an error, not an early end.
    if (got < 0 || (code != Z_OK && code != Z_STREAM_END))
      fail_to_read(path, code == Z_ERRNO       ? std::strerror(errno)
                         : code == Z_BUF_ERROR ? "the compressed file is truncated"
                                               : why);
    if (got == 0) return text;
    if (text.size() + static_cast<std::size_t>(got) > max_bytes)
      fail_to_read(path, "it has more than " + std::to_string(max_bytes) + " bytes of uncompressed text");
    // Protection from decompression bombs: limit the ratio as well as the total.
    const auto packed = static_cast<std::uint64_t>(std::max<z_off_t>(gzoffset(file.get()), 0));
    if (gzdirect(file.get()) == 0 && text.size() + static_cast<std::size_t>(got) > max_unpacked(packed))
      fail_to_read(path, "its first " + std::to_string(packed) + " bytes unpack to more than " +
                             std::to_string(max_unpacked(packed)) + ", which is not plausible for a trace");
    text.append(chunk.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

void save_trace(const Trace& trace, const std::string& path) {
  save_trace([&](ByteSink& sink) { write_trace(trace, sink); }, path);
}

void save_trace(const std::function<void(ByteSink&)>& write, const std::string& path) {
  AtomicFile file(path);
  FileSink sink(file);
  if (path.ends_with(".gz")) {
    GzipSink gzip(sink);
    write(gzip);
    gzip.finish();
  } else {
    write(sink);
  }
  file.commit();
}

Trace load_trace(const std::string& path, const ReadLimits& limits) {
  return trace_from_json(load_trace_text(path, limits), printable_name(path));
}

std::string load_trace_text(const std::string& path, const ReadLimits& limits) {
  return read_all(path, limits.max_bytes);
}

}  // namespace lrb::trace
