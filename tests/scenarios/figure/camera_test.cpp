/// Cameras: chosen, given, and kept in traces.

#include <cmath>

#include <doctest/doctest.h>

#include "render/pictures/panel.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/frames/animation.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/spec/scenario.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/render/image.hpp>

using namespace lrb;
using Eigen::Vector3d;

TEST_CASE("a long body is viewed from its long side, whatever the up direction") {
  const Eigen::AlignedBox3d along_x(Vector3d(0, 0, 0), Vector3d(4, 1, 1));
  const Vector3d z_up = pictures::broadside(along_x, {0, 0, 1});
  CHECK(std::abs(z_up.y()) > 2 * std::abs(z_up.x()));
  CHECK(z_up.z() > 0);
  const Vector3d y_up = pictures::broadside(along_x, {0, 1, 0});
  CHECK(std::abs(y_up.z()) > 2 * std::abs(y_up.x()));
  CHECK(y_up.y() > 0);
}

TEST_CASE("a thin upright body is drawn from its broad side, unless a view is given") {
  const auto view = [](const Vector3d& size, const pictures::Look& look = {}) {
    Mesh mesh = shapes::box();
    for (Vector3d& v : mesh.vertices) v = v.cwiseProduct(size);
    const LrbRep rep = LrbRep::without_regions(mesh, true, false);
    trace::Trace trace;
    trace.steps.emplace_back();
    frames::RecordedRun recorded;
    recorded.reps = {&rep};
    recorded.trace = &trace;
    return frames::view_of_thin_body(recorded, look);
  };
  const auto plate = view({0.1, 2, 2}), rod = view({0.1, 2, 0.1});
  REQUIRE((plate && rod));
  for (const auto& from : {*plate, *rod}) CHECK(std::abs(from.x()) > 2 * std::abs(from.y()));
  CHECK_FALSE(view({1, 2, 2}));
  CHECK_FALSE(view({2, 2, 0.1}));  // lies flat: seen from above by default
  pictures::Look given;
  given.views.emplace_back();
  CHECK_FALSE(view({0.1, 2, 2}, given));
}

TEST_CASE("an animated PNG has all frames in one file") {
  std::vector<std::string> frames;
  for (const int grey : {10, 20, 30}) {
    const auto g = static_cast<std::uint8_t>(grey);
    const std::vector<std::uint8_t> png = render::encode_png(render::Image(5, 4, {g, g, g, 255}));
    frames.emplace_back(png.begin(), png.end());
  }
  const std::string png = frames::animated_png(frames);
  // Programs without animation show the first frame.
  const std::vector<std::uint8_t> bytes(png.begin(), png.end());
  CHECK(render::decode_png(bytes).image.at(0, 0) == render::Rgba{10, 10, 10, 255});
  CHECK(png.find(std::string("\0\0\0\x08"
                             "acTL\0\0\0\3",
                             12)) != std::string::npos);
  // The chunks of a frame, as a PNG of their own, are the frame.
  const auto data_of = [](const std::string& text, const std::string& type, std::size_t from) {
    const std::size_t at = text.find(type, from);
    REQUIRE(at != std::string::npos);
    std::size_t length = 0;
    for (std::size_t i = at - 4; i < at; ++i) length = length << 8 | static_cast<unsigned char>(text[i]);
    return text.substr(at + 4, length);
  };
  std::size_t at = 0;
  for (std::size_t i = 1; i < 3; ++i) {
    at = png.find("fdAT", at + 1);
    CHECK(data_of(png, "fdAT", at).substr(4) == data_of(frames[i], "IDAT", 0));
  }
  // Equal frames extend the one before; frames of another size are rejected.
  const std::string twice = frames::animated_png({frames[0], frames[0], frames[1]});
  CHECK(data_of(twice, "fcTL", 0).substr(20, 4) ==
        std::string("\0\10\0\14", 4));  // 2 and 6 twelfths of a second
  CHECK(twice.size() < png.size());
  const std::vector<std::uint8_t> small = render::encode_png(render::Image(5, 5));
  CHECK_THROWS_AS(frames::animated_png({frames[0], {small.begin(), small.end()}}), InputError);
  CHECK_THROWS_AS(frames::animated_png({}), InputError);
}
