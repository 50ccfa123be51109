#include "render/png.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>

#include <unistd.h>
#include <zlib.h>

#include "engine/core/atomic_file.hpp"
#include "engine/core/error.hpp"
#include "engine/core/file_bytes.hpp"

namespace {

/// stb's writer leaves compression and checksum to zlib, which is five times as fast and makes smaller files.
/// Level 1 without row filters: rendered frames have large flat areas, where more effort gains next to
/// nothing.
constexpr int kZlibLevel = 1;

unsigned char* zlib_deflate(unsigned char* data, int size, int* out_size, int /*quality*/) {
  uLongf length = compressBound(static_cast<uLong>(size));
  if (length > static_cast<uLongf>(std::numeric_limits<int>::max())) return nullptr;
  auto* out = static_cast<unsigned char*>(std::malloc(length));
  if (out == nullptr) return nullptr;
  if (compress2(out, &length, data, static_cast<uLong>(size), kZlibLevel) != Z_OK) {
    std::free(out);
    return nullptr;
  }
  *out_size = static_cast<int>(length);
  return out;
}

unsigned int zlib_crc(const unsigned char* data, int size) {
  return static_cast<unsigned int>(crc32(0, data, static_cast<uInt>(size)));
}

}  // namespace

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#define STBIW_ZLIB_COMPRESS zlib_deflate
#define STBIW_CRC32 zlib_crc
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb_image_write.h>
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STB_IMAGE_IMPLEMENTATION
#include <stb_image.h>
#pragma GCC diagnostic pop

namespace lrb::render {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kSignature = 8;
constexpr std::size_t kHeaderEnd = kSignature + 4 + 4 + 13 + 4;  ///< the signature and the IHDR chunk
constexpr double kInchesPerMetre = 1 / 0.0254;

void put_u32(Bytes& out, std::uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(v >> shift));
}

std::uint32_t get_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) << 24 | static_cast<std::uint32_t>(bytes[at + 1]) << 16 |
         static_cast<std::uint32_t>(bytes[at + 2]) << 8 | bytes[at + 3];
}

void put_chunk(Bytes& out, const char type[5], const Bytes& data) {
  put_u32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type, type + 4);
  out.insert(out.end(), data.begin(), data.end());
  put_u32(out, zlib_crc(out.data() + start, static_cast<int>(out.size() - start)));
}

/// Adds a text chunk: plain ASCII as tEXt, anything else (as UTF-8) as iTXt.
void put_text(Bytes& out, const PngText& text) {
  const auto& [key, value] = text;
  if (key.empty() || key.size() > 79)
    throw InputError("PNG text keyword '" + key + "': 1 to 79 characters needed");
  const bool ascii =
      std::all_of(value.begin(), value.end(), [](char c) { return static_cast<signed char>(c) > 0; });
  Bytes data(key.begin(), key.end());
  data.push_back(0);
  if (!ascii)
    data.insert(data.end(), {0, 0, 0, 0});  // not compressed, method, no language, no translated keyword
  data.insert(data.end(), value.begin(), value.end());
  put_chunk(out, ascii ? "tEXt" : "iTXt", data);
}

Bytes encode_pixels(const Image& image) {
  stbi_write_force_png_filter = 0;
  const bool rgb = image.opaque();
  const int channels = rgb ? 3 : 4;
  const void* pixels = image.pixels().data();
  Bytes packed;
  if (rgb) {
    packed.resize(image.pixels().size() * 3);
    std::uint8_t* to = packed.data();
    for (const Rgba p : image.pixels()) {
      to[0] = p.r, to[1] = p.g, to[2] = p.b;
      to += 3;
    }
    pixels = packed.data();
  }
  int length = 0;
  const std::unique_ptr<unsigned char, decltype(&std::free)> png(
      stbi_write_png_to_mem(static_cast<const unsigned char*>(pixels), image.width() * channels,
                            image.width(), image.height(), channels, &length),
      &std::free);
  if (!png)
    throw EnvironmentError("cannot encode a PNG of " + std::to_string(image.width()) + "x" +
                           std::to_string(image.height()) + " pixels: out of memory");
  return {png.get(), png.get() + length};
}

/// Reads the chunks that stb ignores. The pixels have been decoded already, so the file is whole.
void decode_extras(std::span<const std::uint8_t> bytes, DecodedPng& out) {
  for (std::size_t at = kSignature; at + 12 <= bytes.size();) {
    const std::size_t length = get_u32(bytes, at);
    if (length > bytes.size() - at - 12) return;
    const std::string type(reinterpret_cast<const char*>(bytes.data()) + at + 4, 4);
    const std::string data(reinterpret_cast<const char*>(bytes.data()) + at + 8, length);
    if (type == "pHYs" && length == 9 && data[8] == 1) out.dpi = get_u32(bytes, at + 8) / kInchesPerMetre;
    if (type == "tEXt" || type == "iTXt") {
      const std::size_t key_end = data.find('\0');
      const std::size_t skip = type == "tEXt" ? 1 : 5;
      if (key_end != std::string::npos && key_end + skip <= data.size()) {
        out.text.emplace_back(data.substr(0, key_end), data.substr(key_end + skip));
      }
    }
    at += 12 + length;
  }
}

/// What the header says about the pixels.
struct Header {
  std::uint64_t width, height;
  std::uint64_t raw_bytes;  ///< length of the rows before compression; a little more if interlaced
};

/// Reads the header; nothing if it is damaged.
std::optional<Header> header_of(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < kHeaderEnd || std::memcmp(bytes.data() + 12, "IHDR", 4) != 0) return std::nullopt;
  constexpr std::uint64_t kChannels[] = {1, 0, 3, 1, 2, 0, 4};
  const std::uint64_t width = get_u32(bytes, 16), height = get_u32(bytes, 20);
  const unsigned depth = bytes[24], colour = bytes[25];
  constexpr std::uint64_t kLongest = 1 << 24;
  if (colour >= std::size(kChannels) || depth > 16 || width > kLongest || height > kLongest)
    return std::nullopt;
  return Header{width, height, height * (1 + (width * kChannels[colour] * depth + 7) / 8)};
}

/// Returns the parts of the compressed pixels, in order.
std::vector<std::span<const std::uint8_t>> data_chunks(std::span<const std::uint8_t> bytes) {
  std::vector<std::span<const std::uint8_t>> out;
  for (std::size_t at = kSignature; at + 12 <= bytes.size();) {
    const std::size_t length = get_u32(bytes, at);
    if (length > bytes.size() - at - 12) break;
    if (std::memcmp(bytes.data() + at + 4, "IDAT", 4) == 0) out.push_back(bytes.subspan(at + 8, length));
    at += 12 + length;
  }
  return out;
}

/// Returns true if the compressed pixels unpack to more than `most` bytes; does not keep them.
bool unpacks_beyond(const std::vector<std::span<const std::uint8_t>>& chunks, std::uint64_t most) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw EnvironmentError("zlib cannot begin to unpack: out of memory?");
  const std::unique_ptr<z_stream, decltype(&inflateEnd)> end(&stream, &inflateEnd);
  Bytes unpacked(std::size_t{1} << 16);
  std::uint64_t total = 0;
  for (const std::span<const std::uint8_t> chunk : chunks) {
    stream.next_in = const_cast<Bytef*>(chunk.data());
    stream.avail_in = static_cast<uInt>(chunk.size());
    do {
      stream.next_out = unpacked.data();
      stream.avail_out = static_cast<uInt>(unpacked.size());
      const int result = inflate(&stream, Z_NO_FLUSH);
      total += unpacked.size() - stream.avail_out;
      if (total > most) return true;
      if (result != Z_OK) return false;  // the end, or damage, which the decoder will find
    } while (stream.avail_out == 0 || stream.avail_in > 0);
  }
  return false;
}

/// Refuses, before any memory is taken, a file that would take far more than its bytes and its pixels call
/// for.
void check_size(std::span<const std::uint8_t> bytes, const std::string& name, std::uint64_t most_pixels) {
  const std::optional<Header> header = header_of(bytes);
  if (!header) return;  // the decoder says what is wrong
  const std::string size = std::to_string(header->width) + "x" + std::to_string(header->height) + " pixels";
  if (header->width * header->height > most_pixels)
    throw InputError(name + ": has " + size + ", more than the " + std::to_string(most_pixels) +
                     " that are expected at most");
  constexpr std::uint64_t kDeflateMost = 1032;  // the most bytes that one byte can unpack to, by the format
  const auto chunks = data_chunks(bytes);
  std::uint64_t packed = 0;
  for (const auto chunk : chunks) packed += chunk.size();
  if (header->raw_bytes > kDeflateMost * packed)
    throw InputError(name + ": not a readable PNG (" + size + " cannot be in " + std::to_string(packed) +
                     " bytes)");
  const std::uint64_t enough = 2 * header->raw_bytes + (std::uint64_t{1} << 20);
  if (kDeflateMost * packed > enough && unpacks_beyond(chunks, enough))
    throw InputError(name + ": not a readable PNG (its data unpack to more than its " + size + ")");
}

}  // namespace

Bytes encode_png(const Image& image, const PngOptions& options) {
  if (image.empty()) throw InputError("an empty image cannot be encoded: it has no pixels");
  const Bytes pixels = encode_pixels(image);
  Bytes out(pixels.begin(), pixels.begin() + kHeaderEnd);
  if (options.dpi > 0) {
    Bytes phys;
    const auto per_metre = static_cast<std::uint32_t>(std::lround(options.dpi * kInchesPerMetre));
    put_u32(phys, per_metre);
    put_u32(phys, per_metre);
    phys.push_back(1);  // the unit is the metre
    put_chunk(out, "pHYs", phys);
  }
  for (const PngText& text : options.text) put_text(out, text);
  out.insert(out.end(), pixels.begin() + kHeaderEnd, pixels.end());
  return out;
}

DecodedPng decode_png(std::span<const std::uint8_t> bytes, const std::string& name,
                      std::uint64_t most_pixels) {
  check_size(bytes, name, most_pixels);
  int width = 0, height = 0, channels = 0;
  const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
      stbi_load_from_memory(bytes.data(), static_cast<int>(bytes.size()), &width, &height, &channels, 4),
      &stbi_image_free);
  if (!pixels) throw InputError(name + ": not a readable PNG (" + stbi_failure_reason() + ")");
  DecodedPng out;
  out.image = Image(width, height);
  static_assert(sizeof(Rgba) == 4);
  std::memcpy(out.image.pixels().data(), pixels.get(), out.image.pixels().size() * sizeof(Rgba));
  decode_extras(bytes, out);
  return out;
}

void write_png(const Image& image, const std::string& path, const PngOptions& options) {
  const Bytes bytes = encode_png(image, options);
  write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

DecodedPng read_png(const std::string& path, std::uint64_t most_pixels) {
  const std::string bytes = read_file(path);
  return decode_png({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}, printable_name(path),
                    most_pixels);
}

}  // namespace lrb::render
