/// Options of `render`: isolated regions, ghosts, SVG.

#include <doctest/doctest.h>

#include "tests/support/pixels.hpp"

namespace lrb::test {
namespace {

std::string scenario(const std::string& generator) {
  return R"({"name": "x", "purpose": "y", "show": "refinement", "bodies": {"a": {"generator": ")" +
         generator + R"("}}, "frames": {"at": "none"}})";
}

/// A recorded run of a generated body.
struct Recorded {
  Folder folder;
  explicit Recorded(const std::string& generator) {
    folder.write("s.json", scenario(generator));
    succeed(folder, {"run", "s.json", "-o", "run"});
  }
  /// Draws its first frame into a folder `out`.
  render::DecodedPng frame(const std::string& out, const std::vector<std::string>& more = {}) const {
    return drawn(folder, out + "/frames/frame_0000.png",
                 {"render", "run/trace.json", "--most", "1", "--size", "480x360", "-o", out}, more);
  }
};

}  // namespace

TEST_CASE("render --region: with or without a ghost of the rest") {
  constexpr Part kWithoutTexts{0, 1.0 / 6, 1, 4.0 / 5};
  for (const char* generator : {"knot", "island"}) {
    CAPTURE(std::string(generator));
    const Recorded r(generator);
    const render::Image all = r.frame("all").image, ghost = r.frame("ghost", {"--region", "0,a1"}).image,
                        alone = r.frame("alone", {"--region", "0", "--no-ghost"}).image;
    CHECK(all != ghost);
    CHECK(ghost != alone);
    for (const render::Image* image : {&all, &ghost, &alone})
      CHECK(count_pixels(*image, kWithoutTexts, is_painted) > 500);
  }
}

TEST_CASE("render --format svg: each frame, of 2D bodies") {
  const Recorded r("island");
  const Folder& folder = r.folder;
  succeed(folder, {"render", "run/trace.json", "-o", "svg", "--format", "svg", "--most", "2"});
  for (const char* frame : {"svg/frames/frame_0000.svg", "svg/frames/frame_0001.svg"}) {
    const std::string text = slurp(folder / frame);
    CHECK(text.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
    CHECK(text.ends_with("</svg>\n"));
    CHECK(text.find("<path") != std::string::npos);
  }
  succeed(folder, {"render", "run/trace.json", "-o", "svg", "--most", "2"});
  CHECK_FALSE(std::filesystem::exists(folder / "svg/frames/frame_0000.svg"));  // of the former run
}

TEST_CASE("--dpi: the same size on paper in more pixels, recorded in the file; lines and texts scale") {
  const Recorded r("island");
  const render::DecodedPng screen = r.frame("screen"),
                           print = r.frame("print", {"--dpi", "288", "--format", "svg"});
  CHECK(screen.dpi == 0);
  CHECK(print.dpi == doctest::Approx(288).epsilon(0.001));
  REQUIRE(print.image.width() == 3 * screen.image.width());
  REQUIRE(print.image.height() == 3 * screen.image.height());
  // Ink per area is the same only if everything has grown alike.
  const auto ink = [](const render::Image& image) {
    double sum = 0;
    for (const render::Rgba p : image.pixels()) sum += 255 - render::luma(p);
    return sum / (255.0 * image.width() * image.height());
  };
  CHECK(ink(print.image) == doctest::Approx(ink(screen.image)).epsilon(0.03));
  const std::string text = slurp(r.folder / "print/frames/frame_0000.svg");
  CHECK(text.find("width=\"480\"") != std::string::npos);
  CHECK(text.find("viewBox=\"0 0 1440 ") != std::string::npos);
}

TEST_CASE("--style: background and lines of frames, montages, figures and sheets; a trace keeps it") {
  const Folder folder;
  folder.write("s.json", scenario("island"));
  const auto corner = [&](const std::string& file) { return render::read_png(folder / file).image.at(0, 0); };
  const render::Rgba dark = render::style_of(render::StyleName::dark).paper;
  succeed(folder, {"run", "s.json", "-o", "run", "--style", "dark", "--frames", "refinement", "--most", "1"});
  CHECK(corner("run/frames/frame_0000.png") == dark);
  const auto render_as = [&](const std::string& out, const std::vector<std::string>& style) {
    return drawn(folder, out + "/frames/frame_0000.png",
                 {"render", "run/trace.json", "--most", "1", "--size", "480x360", "--montage", "1",
                  "--format", "svg", "-o", out},
                 style)
        .image;
  };
  const render::Image kept = render_as("kept", {}), print = render_as("print", {"--style", "print"}),
                      screen = render_as("screen", {"--style", "screen"});
  CHECK(corner("kept/montage.png") == dark);
  CHECK(slurp(folder / "kept/montage.svg").find("fill=\"#14161b\"") != std::string::npos);
  CHECK(corner("screen/montage.png") == render::kWhite);
  CHECK(kept != screen);
  CHECK(print != screen);
  for (const char* style : {"print", "dark"})
    succeed(folder, {"figure", "run", "-o", std::string(style) + ".svg", "--style", style});
  succeed(folder, {"figure", "run", "-o", "usual.svg"});
  CHECK(slurp(folder / "usual.svg") == slurp(folder / "print.svg"));
  CHECK(slurp(folder / "dark.svg").find("fill=\"#14161b\"") != std::string::npos);
  succeed(folder, {"inspect", "run/a.lrb", "--render", "-o", "sheet.png", "--style", "dark"});
  CHECK(corner("sheet.png") == dark);
}

TEST_CASE("--no-title, --no-legend: omitted parts take no space, so small frames can be drawn") {
  const Folder folder;
  folder.write("s.json", scenario("island"));
  const std::vector<std::string> small = {"run",    "s.json", "--frames", "refinement", "--size",
                                          "120x90", "--most", "1",        "-o"};
  const Outcome rejected = run(folder, joined(small, {"a"}));
  CHECK(rejected.code == 2);
  CHECK(rejected.err.find("too small for its title") != std::string::npos);
  CHECK(rejected.err.find("--no-title, --no-legend") != std::string::npos);
  const render::Image image =
      drawn(folder, "b/frames/frame_0000.png", small, {"b", "--no-title", "--no-legend"}).image;
  REQUIRE(image.width() == 120);
  // The body reaches nearly from the top to the bottom.
  const auto is_blank = [&](int y) {
    const auto row = image.pixels().begin() + y * image.width();
    return std::none_of(row, row + image.width(), is_painted);
  };
  int top = 0, bottom = image.height() - 1;
  while (top < bottom && is_blank(top)) ++top;
  while (top < bottom && is_blank(bottom)) --bottom;
  CHECK(bottom - top > 0.8 * image.height());
}

TEST_CASE("--transparent: no background in PNG and SVG; on white, the usual frame") {
  const Recorded r("island");
  const Folder& folder = r.folder;
  const render::Image white = r.frame("white").image,
                      clear = r.frame("clear", {"--format", "svg", "--montage", "1", "--transparent"}).image;
  CHECK(white.opaque());
  CHECK(clear.at(0, 0) == render::kTransparent);
  CHECK(largest_difference(clear, white) <= 3);
  CHECK(slurp(folder / "clear/montage.svg").find("<rect") == std::string::npos);
  CHECK(render::read_png(folder / "clear/montage.png").image.at(0, 0) == render::kTransparent);
}

TEST_CASE("run --format svg: frames, montage and caption; files of the previous run are removed") {
  const Folder folder;
  succeed(folder, {"run", "figure2", "-o", "two", "--most", "4"});
  const std::string montage = slurp(folder / "two/montage.svg"), caption = slurp(folder / "two/caption.txt");
  CHECK(caption.find("(a) outermost wrapper, 8 faces; (b) ") != std::string::npos);
  CHECK(caption.find("(d) the body, 144 faces.") != std::string::npos);
  CHECK(montage.find(">(a) outermost wrapper, 8 faces</text>") != std::string::npos);
  CHECK(std::filesystem::exists(folder / "two/frames/frame_0003.svg"));
  succeed(folder, {"run", "figure2", "-o", "two", "--most", "2", "--format", "png"});
  for (const char* gone : {"two/montage.svg", "two/frames/frame_0000.svg"})
    CHECK_FALSE(std::filesystem::exists(folder / gone));
}

TEST_CASE(
    "run: colours and boxes of a traversal are rejected if no trees are traversed, before anything is written") {
  const Folder folder;
  folder.write("one.json", scenario("knot"));
  for (const char* by : {"box_tests", "plane_tests", "expansions"}) {
    const std::string what = std::string("colours by ") + by + " need ";
    const Outcome one =
        check_rejected(folder, {"--quiet", "run", "one.json", "-o", "out", "--colour-by", by});
    CHECK(one.err.find(what + "the trees of two bodies") != std::string::npos);
  }
  const Outcome boxes =
      check_rejected(folder, {"--quiet", "run", "one.json", "-o", "out", "--node-boxes", "1"});
  CHECK(boxes.err.find("boxes of tree nodes need the trees of two bodies") != std::string::npos);
  const Outcome paper = check_rejected(
      folder, {"--quiet", "run", "islands", "-o", "out", "--recursion", "paper", "--colour-by", "box_tests"});
  CHECK(paper.err.find("--recursion paper does not use trees") != std::string::npos);
}

TEST_CASE("render: inapplicable flags are rejected before anything is written") {
  const Recorded r("ball");
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--format", "svg"},
                                                {"--format", "gif"},
                                                {"--dpi", "2400"},
                                                {"--dpi", "0"},
                                                {"--dpi", "x"},
                                                {"--region", "99999"},
                                                {"--region", "b0"},
                                                {"--region", "c0"},
                                                {"--region", "-1"},
                                                {"--region", "4294967296"},
                                                {"--region", "0x"}})
    check_rejected(r.folder, joined({"render", "run/trace.json", "-o", "out"}, flags));
}

}  // namespace lrb::test
