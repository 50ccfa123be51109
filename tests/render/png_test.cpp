#include <filesystem>
#include <random>

#include <doctest/doctest.h>
#include <zlib.h>

#include "tests/support/folder.hpp"
#include "tests/support/text.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/frame_writer.hpp>
#include <lrbscope/render/image.hpp>

using namespace lrb;
namespace fs = std::filesystem;

namespace {

render::Image noise(int width, int height, bool opaque) {
  std::mt19937 random(3);
  render::Image image(width, height);
  for (render::Rgba& p : image.pixels()) {
    p = {static_cast<std::uint8_t>(random()), static_cast<std::uint8_t>(random()),
         static_cast<std::uint8_t>(random()),
         opaque ? std::uint8_t{255} : static_cast<std::uint8_t>(random())};
  }
  return image;
}

void put_number(std::string& to, std::size_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) to += static_cast<char>(v >> shift);
}

void put_chunk(std::string& png, const std::string& type, const std::string& data) {
  put_number(png, data.size());
  const std::string body = type + data;
  png += body;
  put_number(png, crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size())));
}

/// An RGB picture of a size, whose data unpack to `zeros` bytes of 0.
std::string png_of(std::size_t width, std::size_t height, std::size_t zeros) {
  std::string header;
  put_number(header, width);
  put_number(header, height);
  const std::string raw(zeros, '\0');
  uLongf length = compressBound(raw.size());
  std::string packed(length, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &length, reinterpret_cast<const Bytef*>(raw.data()),
           raw.size());
  packed.resize(length);
  std::string png = "\x89PNG\r\n\x1a\n";
  put_chunk(png, "IHDR", header + std::string("\x08\x02\0\0\0", 5));
  put_chunk(png, "IDAT", packed);
  put_chunk(png, "IEND", "");
  return png;
}

/// Returns the message with which a picture is rejected; empty if it is read.
std::string rejection(const std::string& bytes, std::uint64_t max_pixels = render::kMaxPixels) {
  const auto* const data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return test::error_of([&] { render::decode_png({data, bytes.size()}, "p.png", max_pixels); });
}

}  // namespace

TEST_CASE("PNG round trip, opaque and not") {
  for (const bool opaque : {true, false}) {
    for (const auto& [w, h] : {std::pair{1, 1}, {7, 5}, {64, 48}, {1, 300}}) {
      const render::Image image = noise(w, h, opaque);
      const auto bytes = render::encode_png(image);
      CHECK(bytes[25] == (opaque ? 2 : 6));  // colour type in IHDR: RGB, RGBA
      CHECK(render::decode_png(bytes).image == image);
    }
  }
}

TEST_CASE("PNG carries text and resolution") {
  const render::PngOptions options{
      {{"lrbscope:scene", "fnv1a 0123456789abcdef"}, {"Title", "90° round — twice"}, {"Empty", ""}}, 300};
  const render::Image image = noise(20, 10, true);
  const render::DecodedPng png = render::decode_png(render::encode_png(image, options));
  CHECK(png.image == image);
  CHECK(png.text == options.text);
  CHECK(png.dpi == doctest::Approx(300).epsilon(1e-4));
  CHECK(render::decode_png(render::encode_png(image)).dpi == 0);
  CHECK_THROWS_AS(render::encode_png(image, {{{"", "no key"}}, 0}), InputError);
  CHECK_THROWS_AS(render::encode_png(image, {{{std::string(80, 'k'), "long key"}}, 0}), InputError);
  CHECK_THROWS_AS(render::encode_png(render::Image()), InputError);
}

TEST_CASE("decompression bombs and damaged pictures are rejected with a reason") {
  constexpr std::size_t kRow = 193, kMega = 1'000'000;  // bytes of a row of 64 pixels
  const std::string good = png_of(64, 64, 64 * kRow), bad = "p.png: not a readable PNG (";
  CHECK(rejection(good).empty());
  const std::pair<std::string, std::string> table[] = {
      {rejection(good, 4095), "has 64x64 pixels, expected at most 4095"},
      {rejection(png_of(20'000, 20'000, 1000)), "has 20000x20000 pixels, expected at most"},
      {rejection(png_of(8000, 8000, 1000)), "8000x8000 pixels cannot be in "},
      {rejection(png_of(40'000, 2, 2UL * 120'001)), "has 40000x2 pixels, a side of more than"},
      {rejection("GIF89a, or so"), bad + "Not a PNG file)"},
      {rejection(png_of(64, 64, 20 * kMega)), bad + "IDAT: Too much image data)"},
      {rejection(png_of(64, 64, 64 * kRow - 1)), bad + "Not enough image data)"},
      {rejection(good.substr(0, good.size() - 13)), bad + "the file is truncated)"},
      {rejection(good.substr(0, 40)), bad + "the file is truncated)"}};
  for (const auto& row : table) CHECK_MESSAGE(row.first.find(row.second) != std::string::npos, row.first);
  // Texts have a size limit.
  const auto with_text = [&](const std::string& value, int times) {
    std::string png = png_of(1, 1, 4);
    png.resize(png.size() - 12);
    for (int i = 0; i < times; ++i) put_chunk(png, "tEXt", "key" + std::string(1, '\0') + value);
    put_chunk(png, "IEND", "");
    return png;
  };
  CHECK(rejection(with_text("value", 50)).empty());
  CHECK(rejection(with_text("value", 1000)) == bad + "tEXt: no space in chunk cache)");
  CHECK(rejection(with_text(std::string(2 * kMega, 'v'), 1)).find(bad + "tEXt: ") == 0);
}

TEST_CASE("the frame writer writes all frames and reports its errors") {
  const test::Folder folder;
  const render::Image image = noise(60, 40, true);
  {
    render::FrameWriter writer(2);
    for (int i = 0; i < 9; ++i) writer.push(folder / (std::to_string(i) + ".png"), image);
    writer.finish();
    CHECK(folder.tree().size() == 9);
    writer.push(folder / "last.png", image);
  }
  CHECK(folder.tree().size() == 10);
  CHECK(render::read_png(folder / "last.png").image == image);
  render::FrameWriter writer;
  writer.push(folder / "missing/f.png", image);
  CHECK_THROWS_AS(writer.finish(), InputError);
  writer.push(folder / "after.png", image);
  writer.finish();
  CHECK(fs::exists(folder / "after.png"));
}
