#include <cmath>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "render/gl.hpp"
#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/gnuplot.hpp"
#include "tools/commands.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::cli {
namespace {

using Level = render::Finding::Level;

/// Runs a check that returns a short result or throws.
template <class Check>
render::Finding look(const std::string& what, const Check& check) {
  try {
    return {Level::ok, what, check()};
  } catch (const std::exception& e) {
    return {Level::error, what, e.what()};
  }
}

std::string draw_something() {
  render::DrawList list;
  render::DrawTriangle triangle;
  triangle.x = {Eigen::Vector3d(-9, -9, 0), Eigen::Vector3d(9, -9, 0), Eigen::Vector3d(0, 9, 0)};
  triangle.colour = {200, 40, 40};
  triangle.lit = false;
  list.triangles = {triangle};
  render::RasterOptions options;
  options.width = options.height = 64;
  const render::Image image =
      render::Rasterizer().draw(list, render::Camera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}}, options);
  const render::Rgba centre = image.at(32, 32);
  if (centre != render::Rgba{200, 40, 40})
    throw EnvironmentError(
        "rendering test failed: a red triangle was drawn in another colour, so this Mesa build is broken");
  return "a test triangle was drawn correctly";
}

std::string ask_something() {
  const bodies::LoadedBody ball = bodies::body_of_mesh(generators::generate("ball", {{"frequency", 3}}));
  const CollideResult apart = collide(ball.rep, Pose{}, ball.rep, Pose::translation({3, 0, 0}));
  const CollideResult meet = collide(ball.rep, Pose{}, ball.rep, Pose::translation({1.5, 0.1, 0.2}));
  if (apart.relation != Relation::separate || meet.relation != Relation::crossing)
    throw EnvironmentError(
        "query test failed: two balls gave a wrong answer, so the compiler or its flags break floating-point "
        "arithmetic");
  return "two balls: separate, then crossing in " + std::to_string(meet.pairs.size()) + " pairs";
}

std::string write_something() {
  const std::filesystem::path folder = std::filesystem::exists("out") ? "out" : ".";
  const std::string path = (folder / ".doctor").string();
  io::write_text(path, "written by lrbscope doctor\n");
  std::filesystem::remove(path);
  return "writable: " + std::filesystem::absolute(folder).lexically_normal().string();
}

int run_doctor(bool json) {
  std::vector<render::Finding> findings = {{Level::ok, "lrbscope", trace::lrbscope_version()}};
  findings.push_back(look("query", ask_something));
  for (render::Finding& f : render::check_rendering()) findings.push_back(std::move(f));
  findings.push_back(look("drawing", draw_something));
  findings.push_back(look("output", write_something));
  findings.push_back(look("page", [] {
    return std::to_string(io::embedded_file("chart.min.js").size() / 1000) +
           " kB of charting library compiled in";
  }));
  findings.push_back(report::has_gnuplot()
                         ? render::Finding{Level::ok, "gnuplot", "found"}
                         : render::Finding{Level::warning, "gnuplot",
                                           "not found, so print charts are disabled; install gnuplot-nox"});
  bool well = true;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  std::string text;
  for (const render::Finding& f : findings) {
    const char* level = f.level == Level::ok ? "ok" : f.level == Level::warning ? "warning" : "error";
    well = well && f.level != Level::error;
    list.push_back({{"level", level}, {"what", f.what}, {"detail", f.detail}});
    text += std::string(level) + std::string(9 - std::string(level).size(), ' ') + f.what + ": " + f.detail +
            "\n";
  }
  print(json ? nlohmann::ordered_json{{"well", well}, {"findings", list}}.dump() + "\n" : text);
  return well ? kOk : kEnvironment;
}

}  // namespace

Command add_doctor(CLI::App& root, const Globals&) {
  CLI::App* app = root.add_subcommand(
      "doctor", "Check this machine for everything lrbscope needs; exit code 3 if something is missing");
  const auto json = std::make_shared<bool>(false);
  app->add_flag("--json", *json, "Print one JSON object");
  return {app, [json] { return run_doctor(*json); }};
}

}  // namespace lrb::cli
