#include <algorithm>
#include <array>
#include <cmath>
#include <csetjmp>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include <png.h>
#include <zlib.h>

#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/frame_writer.hpp>
#include <lrbscope/render/image.hpp>

namespace {

/// Compresses for stb_image_write by zlib, which is faster. Level 1: rendered frames have large flat areas,
/// where more effort gains almost nothing.
unsigned char* deflated(unsigned char* data, int size, int* out_size, int /*level*/) {
  uLongf length = compressBound(static_cast<uLong>(size));
  auto* const out = static_cast<unsigned char*>(std::malloc(length));
  if (out != nullptr && compress2(out, &length, data, static_cast<uLong>(size), 1) == Z_OK) {
    *out_size = static_cast<int>(length);
    return out;
  }
  std::free(out);
  return nullptr;
}

}  // namespace

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STBIW_ZLIB_COMPRESS deflated
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>
#pragma GCC diagnostic pop

namespace lrb::render {
namespace {

using Bytes = std::vector<std::uint8_t>;

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

void put_u32(Bytes& out, std::size_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(number >> shift));
}

void put_chunk(Bytes& out, const std::string& type, const Bytes& data) {
  put_u32(out, data.size());
  const std::size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  put_u32(out, crc32(0, &out[start], static_cast<uInt>(out.size() - start)));
}

/// Appends a text chunk: plain ASCII becomes tEXt, other text (UTF-8) iTXt.
void put_text(Bytes& out, const PngText& text) {
  const auto& [key, value] = text;
  // Limits of the PNG specification.
  if (key.empty() || key.size() > 79)
    throw InputError("PNG text keyword '" + key + "': expected 1 to 79 characters");
  const bool ascii =
      std::all_of(value.begin(), value.end(), [](char c) { return static_cast<signed char>(c) > 0; });
  Bytes data(key.begin(), key.end());
  data.resize(key.size() + (ascii ? 1 : 5), 0);  // iTXt: not compressed, no language, no translated keyword
  data.insert(data.end(), value.begin(), value.end());
  put_chunk(out, ascii ? "tEXt" : "iTXt", data);
}

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
  Bytes extra;
  if (const std::size_t per_metre = std::lround(std::max(0.0, options.dpi) * kInchesPerMetre);
      per_metre > 0) {
    Bytes density;
    put_u32(density, per_metre), put_u32(density, per_metre);
    density.push_back(PNG_RESOLUTION_METER);
    put_chunk(extra, "pHYs", density);
  }
  for (const PngText& t : options.text) put_text(extra, t);
  // Without transparency three channels suffice.
  const int channels = image.opaque() ? 3 : 4;
  const std::string size = std::to_string(image.width()) + "x" + std::to_string(image.height()) + " pixels";
  if ((std::int64_t{image.width()} * channels + 1) * image.height() > std::numeric_limits<int>::max())
    throw InputError("a picture of " + size + " is too large for a PNG; choose a smaller size");
  Bytes rgb;
  if (channels == 3) {
    rgb.resize(image.pixels().size() * 3);
    std::uint8_t* to = rgb.data();
    for (const Rgba& p : image.pixels()) *to++ = p.r, *to++ = p.g, *to++ = p.b;
  }
  const std::uint8_t* const pixels =
      channels == 3 ? rgb.data() : reinterpret_cast<const std::uint8_t*>(image.pixels().data());
  stbi_write_force_png_filter = 0;
  int length = 0;
  const std::unique_ptr<unsigned char, decltype(&std::free)> png(
      stbi_write_png_to_mem(pixels, image.width() * channels, image.width(), image.height(), channels,
                            &length),
      &std::free);
  if (!png) throw EnvironmentError("cannot encode a PNG of " + size + ": out of memory");
  // The other chunks follow the signature and the header.
  constexpr std::ptrdiff_t kHeaderEnd = 8 + 12 + 13;
  Bytes out(png.get(), png.get() + length);
  out.insert(out.begin() + kHeaderEnd, extra.begin(), extra.end());
  return out;
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
