#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstring>
#include <new>
#include <utility>

#include <png.h>
#include <zlib.h>

#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/frame_writer.hpp>
#include <lrbscope/render/image.hpp>

namespace lrb::render {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Level 1 without row filters: rendered frames have large flat areas, where more effort gains almost
/// nothing.
constexpr int kZlibLevel = 1;
constexpr double kInchesPerMetre = 1 / 0.0254;
/// Limits of chunks other than pixels: lrbscope's texts are far below; a file with millions of chunks is
/// rejected.
constexpr png_alloc_size_t kLongestChunk = png_alloc_size_t{1} << 20;
constexpr png_uint_32 kMaxChunks = 100;

static_assert(sizeof(Rgba) == 4);

/// The last error message of libpng.
struct Complaint {
  std::array<char, 200> text{};
};

[[noreturn]] void complain(png_structp png, png_const_charp text) {
  // Never returns: control goes back to setjmp in succeeds().
  auto& out = static_cast<Complaint*>(png_get_error_ptr(png))->text;
  std::strncpy(out.data(), text, out.size() - 1);
  png_longjmp(png, 1);
}

void keep_silent(png_structp /*png*/, png_const_charp /*text*/) {}

/// Calls `body`, which calls libpng. Returns false if it was aborted: libpng reports errors by longjmp, so
/// `body` must not need a destructor.
template <class Body>
bool succeeds(png_structp png, const Body& body) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp): required by libpng
  body();
  return true;
}

/// Makes a text chunk: plain ASCII becomes tEXt, other text (UTF-8) iTXt.
png_text as_chunk(const PngText& text) {
  const auto& [key, value] = text;
  // Limits of the PNG specification.
  if (key.empty() || key.size() > 79)
    throw InputError("PNG text keyword '" + key + "': expected 1 to 79 characters");
  const bool ascii =
      std::all_of(value.begin(), value.end(), [](char c) { return static_cast<signed char>(c) > 0; });
  png_text out{};
  out.compression = ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
  out.key = const_cast<png_charp>(key.c_str());
  out.text = const_cast<png_charp>(value.c_str());
  return out;
}

class PngWriter {
 public:
  PngWriter() : png_(png_create_write_struct(PNG_LIBPNG_VER_STRING, &complaint_, complain, keep_silent)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ != nullptr) png_set_write_fn(png_, this, append, [](png_structp) {});
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  bool write(const Image& image, const std::vector<png_text>& text, png_uint_32 per_metre) {
    return info_ != nullptr && succeeds(png_, [&] {
             write_header(image, text, per_metre);
             for (int y = 0; y < image.height(); ++y)
               png_write_row(png_, reinterpret_cast<png_const_bytep>(&image.at(0, y)));
             png_write_end(png_, nullptr);
           });
  }

  Bytes bytes;
  const char* complaint() const { return info_ != nullptr ? complaint_.text.data() : "out of memory"; }

 private:
  void write_header(const Image& image, const std::vector<png_text>& text, png_uint_32 per_metre) {
    // Without transparency three channels suffice.
    const bool rgb = image.opaque();
    const auto width = static_cast<png_uint_32>(image.width()),
               height = static_cast<png_uint_32>(image.height());
    png_set_IHDR(png_, info_, width, height, 8, rgb ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGBA,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_filter(png_, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_compression_level(png_, kZlibLevel);
    // A buffer for the whole compressed stream gives a single IDAT chunk.
    const std::size_t raw = std::size_t{height} * (1 + std::size_t{width} * (rgb ? 3 : 4));
    png_set_compression_buffer_size(png_, compressBound(raw));  // pixels in one chunk
    if (per_metre > 0) png_set_pHYs(png_, info_, per_metre, per_metre, PNG_RESOLUTION_METER);
    png_set_text(png_, info_, text.data(), static_cast<int>(text.size()));
    png_write_info(png_, info_);
    if (rgb) png_set_filler(png_, 0, PNG_FILLER_AFTER);  // skips each fourth byte
  }

  static void append(png_structp png, png_bytep data, std::size_t size) {
    // Exceptions must not cross libpng's C frames.
    bool room = true;
    try {
      Bytes& bytes = static_cast<PngWriter*>(png_get_io_ptr(png))->bytes;
      bytes.insert(bytes.end(), data, data + size);
    } catch (const std::bad_alloc&) {
      room = false;
    }
    if (!room) png_error(png, "out of memory");
  }

  Complaint complaint_;
  png_structp png_;
  png_infop info_ = nullptr;
};

class PngReader {
 public:
  explicit PngReader(std::span<const std::uint8_t> bytes)
      : rest_(bytes),
        png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &complaint_, complain, keep_silent)) {
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw EnvironmentError("cannot read a PNG: out of memory");
    }
    png_set_read_fn(png_, this, take);
    png_set_benign_errors(png_, 0);  // surplus pixel data are an error
    png_set_chunk_malloc_max(png_, kLongestChunk);
    png_set_chunk_cache_max(png_, kMaxChunks);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  bool read_header() {
    return succeeds(png_, [&] { png_read_info(png_, info_); });
  }
  std::uint64_t width() const { return png_get_image_width(png_, info_); }
  std::uint64_t height() const { return png_get_image_height(png_, info_); }
  /// Returns a lower bound on the length of the rows before compression, in bytes.
  std::uint64_t raw_bytes() const { return height() * (1 + std::uint64_t{png_get_rowbytes(png_, info_)}); }

  /// Reads a PNG of any kind to the end of the file: `rows` of RGBA, 8 bits each.
  bool read_pixels(std::vector<png_bytep>& rows) {
    return succeeds(png_, [&] {
      // Convert every colour type and depth to 8-bit RGBA.
      png_set_expand(png_);
      png_set_strip_16(png_);
      png_set_gray_to_rgb(png_);
      png_set_add_alpha(png_, 255, PNG_FILLER_AFTER);
      png_set_interlace_handling(png_);
      png_read_update_info(png_, info_);
      png_read_image(png_, rows.data());
      png_read_end(png_, info_);
    });
  }

  std::vector<PngText> text() const {
    png_textp texts = nullptr;
    int count = 0;
    png_get_text(png_, info_, &texts, &count);
    std::vector<PngText> out;
    out.reserve(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) out.emplace_back(texts[i].key, texts[i].text);
    return out;
  }
  double dpi() const { return png_get_pixels_per_meter(png_, info_) / kInchesPerMetre; }

  const char* complaint() const { return complaint_.text.data(); }

 private:
  static void take(png_structp png, png_bytep to, std::size_t size) {
    auto& rest = static_cast<PngReader*>(png_get_io_ptr(png))->rest_;
    // Truncated file: the error unwinds to succeeds().
    if (size > rest.size()) png_error(png, "the file is truncated");
    std::memcpy(to, rest.data(), size);
    rest = rest.subspan(size);
  }

  Complaint complaint_;
  std::span<const std::uint8_t> rest_;
  png_structp png_;
  png_infop info_ = nullptr;
};

/// Rejects, before allocating, a picture with far more pixels than its file can contain.
void check_size(const PngReader& reader, std::size_t file_bytes, const std::string& name,
                std::uint64_t max_pixels) {
  const std::string size = std::to_string(reader.width()) + "x" + std::to_string(reader.height()) + " pixels";
  // No allocation before these checks: the header may be forged.
  if (reader.width() * reader.height() > max_pixels)
    throw InputError(name + ": has " + size + ", expected at most " + std::to_string(max_pixels));
  if (std::max(reader.width(), reader.height()) > Image::kMaxSide)
    throw InputError(name + ": has " + size + ", a side of more than " + std::to_string(Image::kMaxSide));
  // Deflate cannot expand by more than this, so larger pictures cannot be in the file.
  constexpr std::uint64_t kDeflateMost = 1032;  // maximum expansion per byte, by the format
  if (reader.raw_bytes() > kDeflateMost * file_bytes)
    throw InputError(name + ": not a readable PNG (" + size + " cannot be in " + std::to_string(file_bytes) +
                     " bytes)");
}

}  // namespace

Bytes encode_png(const Image& image, const PngOptions& options) {
  if (image.empty()) throw InputError("an empty image cannot be encoded: it has no pixels");
  std::vector<png_text> text;
  for (const PngText& t : options.text) text.push_back(as_chunk(t));
  const double per_metre = std::max(0.0, options.dpi) * kInchesPerMetre;
  PngWriter writer;
  if (!writer.write(image, text, static_cast<png_uint_32>(std::lround(per_metre))))
    throw EnvironmentError("cannot encode a PNG of " + std::to_string(image.width()) + "x" +
                           std::to_string(image.height()) + " pixels: " + writer.complaint());
  return std::move(writer.bytes);
}

DecodedPng decode_png(std::span<const std::uint8_t> bytes, const std::string& name,
                      std::uint64_t max_pixels) {
  PngReader reader(bytes);
  const auto reject_unless = [&](bool readable) {
    if (!readable) throw InputError(name + ": not a readable PNG (" + reader.complaint() + ")");
  };
  reject_unless(reader.read_header());
  check_size(reader, bytes.size(), name, max_pixels);
  DecodedPng out;
  out.image = Image(static_cast<int>(reader.width()), static_cast<int>(reader.height()));
  // libpng decodes directly into the image.
  std::vector<png_bytep> rows;
  rows.reserve(reader.height());
  for (int y = 0; y < out.image.height(); ++y)
    rows.push_back(reinterpret_cast<png_bytep>(&out.image.at(0, y)));
  reject_unless(reader.read_pixels(rows));
  out.text = reader.text();
  out.dpi = reader.dpi();
  return out;
}

void write_png(const Image& image, const std::string& path, const PngOptions& options) {
  const Bytes bytes = encode_png(image, options);
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

DecodedPng read_png(const std::string& path, std::uint64_t max_pixels) {
  const std::string bytes = read_file(path);
  return decode_png({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, printable_name(path),
                    max_pixels);
}

// Writing on a second thread.

FrameWriter::FrameWriter(std::size_t capacity)
    : capacity_(std::max<std::size_t>(capacity, 1)), thread_([this] { run(); }) {}

FrameWriter::~FrameWriter() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FrameWriter::push(std::string path, Image image, PngOptions options) {
  std::unique_lock lock(mutex_);
  // Back pressure: wait while the queue is full, so that memory is bounded.
  changed_.wait(lock, [&] { return jobs_.size() < capacity_ || error_; });
  rethrow();
  jobs_.push_back({std::move(path), std::move(image), std::move(options)});
  changed_.notify_all();
}

void FrameWriter::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return (jobs_.empty() && !busy_) || error_; });
  rethrow();
}

void FrameWriter::rethrow() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void FrameWriter::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    busy_ = true;
    // Encode without the lock: rendering continues meanwhile.
    lock.unlock();
    std::exception_ptr error;
    try {
      write_png(job.image, job.path, job.options);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    if (error) {  // frames queued behind a failure are dropped: the run is over
      if (!error_) error_ = error;
      jobs_.clear();
    }
    changed_.notify_all();
  }
}

}  // namespace lrb::render
