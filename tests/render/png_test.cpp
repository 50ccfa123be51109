#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include <doctest/doctest.h>

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

struct Folder {
  fs::path path =
      fs::temp_directory_path() / std::string("lrb_png_test_").append(std::to_string(std::random_device()()));
  Folder() { fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  std::string operator/(const char* name) const { return (path / name).string(); }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path), fs::directory_iterator()));
  }
};

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

TEST_CASE("damaged PNGs are rejected") {
  const auto good = render::encode_png(noise(16, 16, true), {{{"key", "value"}}, 72});
  for (std::size_t cut = 0; cut < good.size(); cut += 7) {
    const std::vector<std::uint8_t> part(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(cut));
    try {
      render::decode_png(part, "part.png");
    } catch (const InputError& e) {
      CHECK(std::string(e.what()).find("part.png") == 0);
    }
  }
  CHECK_THROWS_AS(render::decode_png(std::vector<std::uint8_t>{1, 2, 3}), InputError);
  std::mt19937 random(11);
  for (int i = 0; i < 300; ++i) {
    auto bad = good;
    for (int j = 0; j < 3; ++j) bad[random() % bad.size()] = static_cast<std::uint8_t>(random());
    try {
      render::decode_png(bad);
    } catch (const InputError&) {
    }
  }
}

TEST_CASE("files appear complete or not at all") {
  const Folder folder;
  const render::Image image = noise(30, 20, true);
  render::write_png(image, folder / "a.png", {{{"k", "v"}}, 0});
  CHECK(render::read_png(folder / "a.png").image == image);
  CHECK(folder.files() == 1);
  CHECK_THROWS_AS(render::write_png(image, folder / "missing/a.png"), InputError);
  fs::create_directories(folder / "taken.png");
  CHECK_THROWS_AS(render::write_png(image, folder / "taken.png"), InputError);
  CHECK(folder.files() == 2);
  CHECK_THROWS_AS(render::read_png(folder / "absent.png"), InputError);
}

TEST_CASE("the frame writer writes all frames and reports its errors") {
  const Folder folder;
  const render::Image image = noise(60, 40, true);
  {
    render::FrameWriter writer(2);
    for (int i = 0; i < 9; ++i) writer.push(folder / std::to_string(i).append(".png").c_str(), image);
    writer.finish();
    CHECK(folder.files() == 9);
    writer.push(folder / "last.png", image);
  }
  CHECK(folder.files() == 10);
  CHECK(render::read_png(folder / "last.png").image == image);
  render::FrameWriter writer;
  writer.push(folder / "missing/f.png", image);
  CHECK_THROWS_AS(writer.finish(), InputError);
  writer.push(folder / "after.png", image);
  writer.finish();
  CHECK(fs::exists(folder / "after.png"));
}
