/// What `render` can be asked for: regions alone, ghosts, SVG.

#include <doctest/doctest.h>

#include "tests/support/program.hpp"
#include <lrbscope/render/image.hpp>
#include <lrbscope/render/style.hpp>

namespace lrb::test {
namespace {

std::string scenario(const std::string& generator) {
  return R"({"name": "x", "purpose": "y", "show": "refinement", "bodies": {"a": {"generator": ")" +
         generator + R"("}}, "frames": {"at": "none"}})";
}

/// Pixels of the picture that are not white, without the texts above and below it.
std::size_t painted(const Folder& folder, const std::string& out) {
  const render::Image image = render::read_png(folder / (out + "/frames/frame_0000.png")).image;
  const auto height = static_cast<std::size_t>(image.height()),
             width = static_cast<std::size_t>(image.width());
  std::size_t count = 0;
  for (std::size_t i = height / 6 * width; i < height * 4 / 5 * width; ++i)
    count += image.pixels()[i] != render::kWhite;
  return count;
}

}  // namespace

TEST_CASE("render --region: alone, with a ghost of the rest or without") {
  const Folder folder;
  for (const char* generator : {"knot", "island"}) {
    CAPTURE(std::string(generator));
    folder.write("s.json", scenario(generator));
    REQUIRE(run(folder, {"run", "s.json", "-o", "run"}).code == 0);
    const auto render = [&](std::vector<std::string> more) {
      std::vector<std::string> all = {"render", "run/trace.json", "--most", "1", "--size", "480x360"};
      all.insert(all.end(), more.begin(), more.end());
      const Outcome o = run(folder, all);
      CAPTURE(o.err);
      REQUIRE(o.code == 0);
    };
    render({"-o", "all"});
    render({"-o", "ghost", "--region", "0,a1"});
    render({"-o", "alone", "--region", "0", "--no-ghost"});
    const std::string all = slurp(folder / "all/frames/frame_0000.png"),
                      ghost = slurp(folder / "ghost/frames/frame_0000.png");
    CHECK(all != ghost);
    CHECK(ghost != slurp(folder / "alone/frames/frame_0000.png"));
    for (const char* out : {"all", "ghost", "alone"}) {
      CAPTURE(std::string(out));
      CHECK(painted(folder, out) > 500);
    }
  }
}

TEST_CASE("render --format svg: each frame, of 2D bodies") {
  const Folder folder;
  folder.write("s.json", scenario("island"));
  REQUIRE(run(folder, {"run", "s.json", "-o", "run"}).code == 0);
  REQUIRE(run(folder, {"render", "run/trace.json", "-o", "svg", "--format", "svg", "--most", "2"}).code == 0);
  for (const char* frame : {"svg/frames/frame_0000.svg", "svg/frames/frame_0001.svg"}) {
    const std::string text = slurp(folder / frame);
    CHECK(text.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
    CHECK(text.ends_with("</svg>\n"));
    CHECK(text.find("<path") != std::string::npos);
  }
  REQUIRE(run(folder, {"render", "run/trace.json", "-o", "svg", "--most", "2"}).code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "svg/frames/frame_0000.svg"));  // of the former run
}

TEST_CASE("--dpi: the same size on paper in more pixels, said in the file; lines and texts grow with them") {
  const Folder folder;
  folder.write("s.json", scenario("island"));
  REQUIRE(run(folder, {"run", "s.json", "-o", "run"}).code == 0);
  const auto frame = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> all = {"render", "run/trace.json", "-o",      out,        "--most",
                                    "1",      "--size",         "480x360", "--format", "svg"};
    all.insert(all.end(), more.begin(), more.end());
    REQUIRE(run(folder, all).code == 0);
    return render::read_png(folder / (out + "/frames/frame_0000.png"));
  };
  const render::DecodedPng screen = frame("screen", {}), print = frame("print", {"--dpi", "288"});
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
  const std::string text = slurp(folder / "print/frames/frame_0000.svg");
  CHECK(text.find("width=\"480\"") != std::string::npos);
  CHECK(text.find("viewBox=\"0 0 1440 ") != std::string::npos);
}

TEST_CASE("--style: background and lines of frames, montages, figures and sheets; a trace keeps it") {
  const Folder folder;
  folder.write("s.json", scenario("island"));
  const auto corner = [&](const std::string& file) { return render::read_png(folder / file).image.at(0, 0); };
  const render::Rgba dark = render::style_of(render::StyleName::dark).paper;
  REQUIRE(
      run(folder, {"run", "s.json", "-o", "run", "--style", "dark", "--frames", "refinement", "--most", "1"})
          .code == 0);
  CHECK(corner("run/frames/frame_0000.png") == dark);
  const std::vector<std::string> again = {"render",  "run/trace.json", "--most", "1",        "--size",
                                          "480x360", "--montage",      "1",      "--format", "svg",
                                          "-o"};
  const auto render_as = [&](const std::string& out, const std::string& style) {
    std::vector<std::string> all = again;
    all.push_back(out);
    if (!style.empty()) all.insert(all.end(), {"--style", style});
    REQUIRE(run(folder, all).code == 0);
    return slurp(folder / (out + "/frames/frame_0000.png"));
  };
  const std::string kept = render_as("kept", ""), print = render_as("print", "print"),
                    screen = render_as("screen", "screen");
  CHECK(corner("kept/montage.png") == dark);
  CHECK(slurp(folder / "kept/montage.svg").find("fill=\"#14161b\"") != std::string::npos);
  CHECK(corner("screen/montage.png") == render::kWhite);
  CHECK(kept != screen);
  CHECK(print != screen);
  for (const char* style : {"print", "dark"})
    REQUIRE(run(folder, {"figure", "run", "-o", std::string(style) + ".svg", "--style", style}).code == 0);
  REQUIRE(run(folder, {"figure", "run", "-o", "usual.svg"}).code == 0);
  CHECK(slurp(folder / "usual.svg") == slurp(folder / "print.svg"));
  CHECK(slurp(folder / "dark.svg").find("fill=\"#14161b\"") != std::string::npos);
  REQUIRE(run(folder, {"inspect", "run/a.lrb", "--render", "-o", "sheet.png", "--style", "dark"}).code == 0);
  CHECK(corner("sheet.png") == dark);
}

TEST_CASE("--no-title, --no-legend: what is left out needs no room, so that small frames can be drawn") {
  const Folder folder;
  folder.write("s.json", scenario("island"));
  const std::vector<std::string> small = {"run",    "s.json", "--frames", "refinement", "--size",
                                          "120x90", "--most", "1",        "-o"};
  const auto run_small = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> all = small;
    all.push_back(out);
    all.insert(all.end(), more.begin(), more.end());
    return run(folder, all);
  };
  const Outcome refused = run_small("a", {});
  CHECK(refused.code == 2);
  CHECK(refused.err.find("too small for its title") != std::string::npos);
  CHECK(refused.err.find("--no-title, --no-legend") != std::string::npos);
  REQUIRE(run_small("b", {"--no-title", "--no-legend"}).code == 0);
  const render::Image image = render::read_png(folder / "b/frames/frame_0000.png").image;
  REQUIRE(image.width() == 120);
  // The body reaches nearly from the top to the bottom.
  const auto drawn = [&](int y) {
    for (int x = 0; x < image.width(); ++x)
      if (image.at(x, y) != render::kWhite) return true;
    return false;
  };
  int top = 0, bottom = image.height() - 1;
  while (top < bottom && !drawn(top)) ++top;
  while (top < bottom && !drawn(bottom)) --bottom;
  CHECK(bottom - top > 0.8 * image.height());
}

TEST_CASE("--transparent: no background in PNG and SVG; laid on white, the usual frame") {
  const Folder folder;
  folder.write("s.json", scenario("island"));
  REQUIRE(run(folder, {"run", "s.json", "-o", "run"}).code == 0);
  REQUIRE(run(folder, {"render", "run/trace.json", "-o", "clear", "--most", "1", "--size", "480x360",
                       "--format", "svg", "--montage", "1", "--transparent"})
              .code == 0);
  REQUIRE(run(folder, {"render", "run/trace.json", "-o", "white", "--most", "1", "--size", "480x360"}).code ==
          0);
  const render::Image white = render::read_png(folder / "white/frames/frame_0000.png").image,
                      clear = render::read_png(folder / "clear/frames/frame_0000.png").image;
  CHECK(white.opaque());
  CHECK(clear.at(0, 0) == render::kTransparent);
  int worst = 0;
  for (std::size_t i = 0; i < white.pixels().size(); ++i) {
    const render::Rgba got = render::over(clear.pixels()[i], render::kWhite), want = white.pixels()[i];
    worst = std::max({worst, std::abs(got.r - want.r), std::abs(got.g - want.g), std::abs(got.b - want.b)});
  }
  CHECK(worst <= 3);
  CHECK(slurp(folder / "clear/montage.svg").find("<rect") == std::string::npos);
  CHECK(render::read_png(folder / "clear/montage.png").image.at(0, 0) == render::kTransparent);
}

TEST_CASE("run --format svg: frames, montage and caption; the former run's are gone") {
  const Folder folder;
  REQUIRE(run(folder, {"run", "figure2", "-o", "two", "--most", "4"}).code == 0);
  const std::string montage = slurp(folder / "two/montage.svg"), caption = slurp(folder / "two/caption.txt");
  CHECK(caption.find("(a) outermost wrapper, 8 faces; (b) ") != std::string::npos);
  CHECK(caption.find("(d) the body, 144 faces.") != std::string::npos);
  CHECK(montage.find(">(a) outermost wrapper, 8 faces</text>") != std::string::npos);
  CHECK(std::filesystem::exists(folder / "two/frames/frame_0003.svg"));
  REQUIRE(run(folder, {"run", "figure2", "-o", "two", "--most", "2", "--format", "png"}).code == 0);
  for (const char* gone : {"two/montage.svg", "two/frames/frame_0000.svg"})
    CHECK_FALSE(std::filesystem::exists(folder / gone));
}

TEST_CASE("render: of a crowd's trace, with the flags that fit") {
  const Folder folder;
  folder.write("c.json", R"({"name": "few", "purpose": "p", "room": [2, 2, 2],
    "bodies": [{"name": "bead", "body": {"generator": "ball", "parameters": {"frequency": 2, "radius": 0.5}}, "count": 4},
               {"name": "bowl", "body": {"generator": "bowl", "parameters": {"segments": 10, "rows": 4}}}],
    "motion": {"steps": 3, "speed": 0.1, "spin": 5}, "frames": {"size": [320, 240]}})");
  REQUIRE(run(folder, {"crowd", "c.json", "-o", "run"}).code == 0);
  const Outcome same = run(folder, {"render", "run/trace.json", "-o", "again", "--size", "320x240"});
  CAPTURE(same.err);
  REQUIRE(same.code == 0);
  CHECK(same.out == "again/index.html\n");
  for (int i = 0; i < 3; ++i) {
    const std::string frame = "/frames/frame_000" + std::to_string(i) + ".png";
    CHECK(render::read_png(folder / ("again" + frame)).image ==
          render::read_png(folder / ("run" + frame)).image);
  }
  REQUIRE(
      run(folder, {"render", "run/trace.json", "-o", "close", "--size", "640x240", "--close-up", "--every",
                   "2", "--transparent", "--up", "y", "--bodies", "run/bead.lrb", "run/bowl.lrb"})
          .code == 0);
  CHECK(std::filesystem::exists(folder / "close/frames/frame_0001.png"));
  CHECK(!std::filesystem::exists(folder / "close/frames/frame_0002.png"));
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--montage", "2"},
                                                {"--events", "3"},
                                                {"--region", "1"},
                                                {"--no-ghost"},
                                                {"--format", "svg"},
                                                {"--colour-by", "layer"},
                                                {"--frames", "refinement"},
                                                {"--frames", "event"},
                                                {"--size", "8000x8000", "--dpi", "2400"},
                                                {"--bodies", "run/bead.lrb"},
                                                {"--bodies", "run/bowl.lrb", "run/bead.lrb"}}) {
    std::vector<std::string> all = {"--quiet", "render", "run/trace.json", "-o", "out"};
    all.insert(all.end(), flags.begin(), flags.end());
    check_refused(folder, all);
  }
}

TEST_CASE(
    "run: colours and boxes of a walk are refused where no trees are walked, before anything is written") {
  const Folder folder;
  folder.write("one.json", scenario("knot"));
  for (const char* by : {"box_tests", "plane_tests", "expansions"}) {
    const std::string what = std::string("colours by ") + by + " need ";
    const Outcome one = check_refused(folder, {"--quiet", "run", "one.json", "-o", "out", "--colour-by", by});
    CHECK(one.err.find(what + "the trees of two bodies") != std::string::npos);
  }
  const Outcome boxes =
      check_refused(folder, {"--quiet", "run", "one.json", "-o", "out", "--node-boxes", "1"});
  CHECK(boxes.err.find("boxes of tree nodes need the trees of two bodies") != std::string::npos);
  const Outcome paper = check_refused(
      folder, {"--quiet", "run", "islands", "-o", "out", "--recursion", "paper", "--colour-by", "box_tests"});
  CHECK(paper.err.find("--recursion paper does not use trees") != std::string::npos);
}

TEST_CASE("render: flags that do not fit are refused before anything is written") {
  const Folder folder;
  folder.write("s.json", scenario("ball"));
  REQUIRE(run(folder, {"run", "s.json", "-o", "run"}).code == 0);
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
                                                {"--region", "0x"}}) {
    std::vector<std::string> all = {"render", "run/trace.json", "-o", "out"};
    all.insert(all.end(), flags.begin(), flags.end());
    check_refused(folder, all);
  }
}

}  // namespace lrb::test
