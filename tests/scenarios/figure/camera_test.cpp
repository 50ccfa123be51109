/// Cameras: chosen, given, and kept in traces.

#include <cmath>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "render/pictures/panel.hpp"
#include "scenarios/bodies/shapes.hpp"
#include "scenarios/frames/animation.hpp"
#include "scenarios/frames/framing.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/spec/scenario.hpp"
#include "tests/support/pixels.hpp"
#include <lrbscope/error.hpp>

using namespace lrb;
using Eigen::Vector3d;

TEST_CASE("picture settings in a trace are read back unchanged") {
  render::FrameSpec frames;
  frames.width = 300, frames.height = 200, frames.dpi = 150;
  frames.montage = 6, frames.montage_columns = 3;
  render::FrameSpec::View view;
  view.camera = render::FrameSpec::Camera::fixed;
  view.eye = {1, 2, 3}, view.target = {0.1, 0.2, 1.0 / 3};
  view.orthographic = true, view.zoom = 1.5, view.wrapper = false;
  view.title = "a \"title\"";
  view.look_at = Vector3d(0, 0.5, 0);
  frames.views = {view, {}};
  const render::FrameSpec read = spec::read_pictures(spec::pictures_text(frames), "x");
  CHECK(spec::pictures_text(read) == spec::pictures_text(frames));
  REQUIRE(read.views.size() == 2);
  CHECK(read.views[0].target == view.target);
  CHECK(read.views[0].look_at == view.look_at);
  CHECK(read.views[0].orthographic);
  CHECK(read.montage_columns == 3);
  CHECK(spec::read_pictures("", "x", frames).width == 300);
  CHECK_THROWS_AS(spec::read_pictures(R"({"size":[1,2]})", "x"), InputError);
  CHECK_THROWS_AS(spec::read_pictures(R"({"view":[]})", "x"), InputError);
}

TEST_CASE("a long body is viewed from its long side, whatever the up direction") {
  const Eigen::AlignedBox3d along_x(Vector3d(0, 0, 0), Vector3d(4, 1, 1));
  const Vector3d z_up = run::broadside(along_x, {0, 0, 1});
  CHECK(std::abs(z_up.y()) > 2 * std::abs(z_up.x()));
  CHECK(z_up.z() > 0);
  const Vector3d y_up = run::broadside(along_x, {0, 1, 0});
  CHECK(std::abs(y_up.z()) > 2 * std::abs(y_up.x()));
  CHECK(y_up.y() > 0);
}

TEST_CASE("a thin upright body is drawn from its broad side, unless a view is given") {
  const auto view = [](const Vector3d& size, const render::Look& look = {}) {
    Mesh mesh = shapes::box();
    for (Vector3d& v : mesh.vertices) v = v.cwiseProduct(size);
    const LrbRep rep = LrbRep::without_regions(mesh, true, false);
    trace::Trace trace;
    trace.steps.emplace_back();
    run::RecordedRun recorded;
    recorded.reps = {&rep};
    recorded.trace = &trace;
    return run::view_of_thin_body(recorded, look);
  };
  const auto plate = view({0.1, 2, 2}), rod = view({0.1, 2, 0.1});
  REQUIRE((plate && rod));
  for (const auto& from : {*plate, *rod}) CHECK(std::abs(from.x()) > 2 * std::abs(from.y()));
  CHECK_FALSE(view({1, 2, 2}));
  CHECK_FALSE(view({2, 2, 0.1}));  // lies flat: seen from above by default
  render::Look given;
  given.views.emplace_back();
  CHECK_FALSE(view({0.1, 2, 2}, given));
}

TEST_CASE("render draws a trace as run does: view, projection, size") {
  const test::Folder folder;
  folder.write("s.json",
               R"({"name": "x", "purpose": "y", "show": "refinement", "bodies": {"a": {"generator": "gear"}},
    "frames": {"at": "refinement", "most": 2, "size": [320, 300], "montage": {"panels": 2, "columns": 1},
               "views": [{"from": [1, 0.2, 0.3], "projection": "orthographic", "zoom": 1.3, "look_at": [0.1, 0, 0]}]}})");
  test::succeed(folder, {"run", "s.json", "-o", "run"});
  test::succeed(folder, {"render", "run/trace.json", "--most", "2", "-o", "again"});
  for (const char* frame : {"frames/frame_0000.png", "frames/frame_0001.png", "montage.png"}) {
    CAPTURE(std::string(frame));
    const render::Image first = render::read_png(folder / (std::string("run/") + frame)).image;
    CHECK(first == render::read_png(folder / (std::string("again/") + frame)).image);
  }
  test::succeed(folder, {"render", "run/trace.json", "--most", "2", "--from", "0,-1,0.2", "-o", "turned"});
  CHECK(render::read_png(folder / "run/frames/frame_0000.png").image !=
        render::read_png(folder / "turned/frames/frame_0000.png").image);
}

TEST_CASE("--up rotates a scenario's view; --from is in the axes of the files") {
  const test::Folder folder;
  folder.write("cube.obj", test::kCube);
  const auto picture = [&](const std::vector<std::string>& more, const std::string& name) {
    return test::drawn(folder, name, {"inspect", "cube.obj", "--render", "--size", "200x160", "-o", name},
                       more)
        .image;
  };
  const render::Image above = picture({"--from", "0.01,0,1", "--projection", "orthographic"}, "a.png");
  CHECK(above != picture({"--from", "1,0.01,0", "--projection", "orthographic", "--up", "z"}, "b.png"));
  CHECK(above != picture({"--from", "0.01,0,1", "--zoom", "0.5", "--projection", "orthographic"}, "c.png"));
  CHECK(above.width() < 500);  // panels have the requested size
  for (const char* bad : {"0,0,1", "0,0,0", "1,2"})
    test::check_rejected(folder, {"inspect", "cube.obj", "--render", "--from", bad, "-o", "no.png"});
  test::check_rejected(folder, {"inspect", "cube.obj", "--up", "y"});
  test::check_rejected(folder, {"inspect", "cube.obj", "--render", "--size", "5x5", "-o", "no.png"});
}

TEST_CASE("--animate: by ffmpeg; rejected before drawing if it is missing") {
  const test::Folder folder;
  folder.write("s.json",
               R"({"name": "x", "purpose": "y", "show": "refinement", "bodies": {"a": {"generator": "gear"}},
    "frames": {"at": "refinement", "most": 3, "size": [321, 300]}})");
  // A program that takes ffmpeg's place: it makes the last word's file of the names of the frames.
  folder.write("ffmpeg", "#!/bin/sh\nfor last; do :; done\nls run/frames >\"$last\"\n");
  std::filesystem::permissions(folder / "ffmpeg", std::filesystem::perms::owner_all);
  ::setenv("LRB_FFMPEG", (folder / "ffmpeg").c_str(), 1);
  test::Outcome o = test::run(folder, {"run", "s.json", "-o", "run", "--orbit", "40", "--animate", "x.gif"});
  CAPTURE(o.err);
  CHECK(o.code == 0);
  CHECK(test::slurp(folder / "x.gif") == "frame_0000.png\nframe_0001.png\nframe_0002.png\n");
  folder.write("cube.obj", test::kCube);
  ::setenv("LRB_FFMPEG", "/no such program", 1);
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"run", "s.json"}, {"render", "run"}, {"collide", "cube.obj", "cube.obj"}}) {
    o = test::run(folder, test::joined(command, {"-o", "other", "--animate", "y.mp4"}));
    CAPTURE(o.err);
    CHECK(o.code == 3);
    CHECK(o.error_lines() == 1);
    CHECK(o.err.find("--animate: cannot find the program /no such program") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder / "other"));
  }
  ::unsetenv("LRB_FFMPEG");
  const std::string path = ::getenv("PATH");
  ::setenv("PATH", "/nowhere", 1);  // of the shell, too, which knows how to find /bin/sh
  CHECK(test::run(folder, {"run", "s.json", "-o", "other", "--animate", "y.mp4"}).code == 3);
  ::setenv("PATH", path.c_str(), 1);
  ::setenv("LRB_FFMPEG", "/bin/false", 1);
  CHECK(test::run(folder, {"run", "s.json", "-o", "run", "--animate", "z.webp"}).code == 3);
  ::unsetenv("LRB_FFMPEG");
  for (const char* none : {"y.mp4", "z.webp"}) CHECK(!std::filesystem::exists(folder / none));
  test::check_rejected(folder, {"run", "s.json", "-o", "other", "--animate", "x.avi"});
}

TEST_CASE("--animate to a PNG: all frames in one file, without ffmpeg") {
  const test::Folder folder;
  folder.write("s.json",
               R"({"name": "x", "purpose": "y", "show": "refinement", "bodies": {"a": {"generator": "gear"}},
    "frames": {"at": "refinement", "most": 3, "size": [321, 300]}})");
  ::setenv("LRB_FFMPEG", "/no such program", 1);
  test::succeed(folder, {"run", "s.json", "-o", "run", "--orbit", "40", "--animate", "x.png"});
  ::unsetenv("LRB_FFMPEG");
  // Programs without animation show the first frame.
  const std::string png = test::slurp(folder / "x.png");
  CHECK(render::read_png(folder / "x.png").image ==
        render::read_png(folder / "run/frames/frame_0000.png").image);
  CHECK(png.find(std::string("\0\0\0\x08"
                             "acTL\0\0\0\3",
                             12)) != std::string::npos);
  // The chunks of a frame, as a PNG of their own, are the frame.
  std::vector<std::string> frames;
  for (const char* name : {"0", "1", "2"})
    frames.push_back(test::slurp(folder / (std::string("run/frames/frame_000") + name + ".png")));
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
  const std::string twice = run::animated_png({frames[0], frames[0], frames[1]});
  const std::string control = data_of(twice, "fcTL", 0);
  CHECK(control.substr(20, 4) == std::string("\0\2\0\14", 4));  // 2 of 12 seconds
  CHECK(twice.size() < png.size());
  render::write_png(render::Image(5, 5), folder / "small.png");
  CHECK_THROWS_AS(run::animated_png({frames[0], test::slurp(folder / "small.png")}), InputError);
  CHECK_THROWS_AS(run::animated_png({}), InputError);
}

TEST_CASE("collide looks across the approach, with the axis up on which A is most stable") {
  const test::Folder folder;
  // A plate that lies across y, and a box.
  const auto box = [](double x, double y, double z) {
    std::string obj;
    for (int i = 0; i < 8; ++i)
      obj += "v " + std::to_string(i & 1 ? x : 0) + " " + std::to_string(i & 2 ? y : 0) + " " +
             std::to_string(i & 4 ? z : 0) + "\n";
    return obj + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
  };
  // Wide at y = 0, narrow at the other ends.
  folder.write("wedge.obj",
               "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0.05 1 0.02\nf 1 2 3 4\nf 5 2 1\nf 5 3 2\nf 5 4 3\n"
               "f 5 1 4\n");
  folder.write("box.obj", box(0.5, 0.6, 0.7));
  for (const std::string approach : {"1,0.3,0.2", "0,1,0", "0.2,-1,0.6"}) {
    CAPTURE(approach);
    const test::Outcome o = test::run(folder, {"collide", "wedge.obj", "box.obj", "--approach", approach,
                                               "--frames", "step", "--most", "1", "-o", "run"});
    CAPTURE(o.err);
    REQUIRE(o.code == 0);
    CHECK(o.err.find("up is y, on which wedge.obj is most stable") != std::string::npos);
    const auto trace = nlohmann::json::parse(test::slurp(folder / "run/trace.json"));
    const auto view = spec::read_pictures(trace["metadata"]["pictures"].dump(), "x").views.at(0);
    CHECK(view.up == Vector3d(0, 1, 0));
    const Vector3d from = view.from.normalized(), along = io::parse_vector(approach, "").normalized();
    CHECK(std::abs(from.dot(along)) < (std::abs(along.y()) > 0.97 ? 0.25 : 0.02));
    CHECK(from.y() > 0.1);
  }
  test::succeed(folder,
                {"collide", "wedge.obj", "box.obj", "--frames", "none", "--from", "0,1,0", "-o", "run"});
}

TEST_CASE("collide stores its chosen view in the trace") {
  const test::Folder folder;
  folder.write("cube.obj", test::kCube);
  test::succeed(folder, {"collide", "cube.obj", "cube.obj", "--frames", "none", "-o", "run"});
  const std::string chosen = test::slurp(folder / "run/trace.json");
  test::succeed(
      folder, {"collide", "cube.obj", "cube.obj", "--frames", "none", "--from", "0.25,-1,0.5", "-o", "run"});
  const std::string given = test::slurp(folder / "run/trace.json");
  CHECK(given.find("\"from\":[0.25,-1.0,0.5]") != std::string::npos);
  CHECK(chosen.find("\"from\":[0.25,-1.0,0.5]") == std::string::npos);
  CHECK(chosen.find("\"pictures\"") != std::string::npos);
}
