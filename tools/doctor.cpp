#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#ifdef LRB_BUILD_BENCH
#include "bench/workers/workers.hpp"
#endif
#include "render/gl.hpp"
#include "scenarios/bodies/generators.hpp"
#include "scenarios/bodies/loaded_body.hpp"
#include "scenarios/frames/animation.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/chart.hpp"
#include "tools/commands.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/rasterize.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::tools {
namespace {

using Level = render::Finding::Level;

/// Runs a check that returns a short result or throws.
template <class Check>
render::Finding finding_of(const std::string& what, const Check& check) {
  try {
    return {Level::ok, what, check()};
  } catch (const std::exception& e) {
    return {Level::error, what, e.what()};
  }
}

std::string check_drawing() {
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

std::string check_query() {
  const bodies::LoadedBody ball = bodies::body_of_mesh(generators::generate("ball", {{"frequency", 3}}));
  const CollideResult apart = collide(ball.rep, Pose{}, ball.rep, Pose::translation({3, 0, 0}));
  const CollideResult meet = collide(ball.rep, Pose{}, ball.rep, Pose::translation({1.5, 0.1, 0.2}));
  if (apart.relation != Relation::separate || meet.relation != Relation::crossing)
    throw EnvironmentError(
        "query test failed: two balls gave a wrong answer, so the compiler or its flags break floating-point "
        "arithmetic");
  return "two balls: separate, then crossing in " + std::to_string(meet.pairs.size()) + " pairs";
}

std::string check_output() {
  const std::filesystem::path folder = std::filesystem::exists("out") ? "out" : ".";
  const std::string path = (folder / ".doctor").string();
  io::write_text(path, "written by lrbscope doctor\n");
  std::filesystem::remove(path);
  return "writable: " + std::filesystem::absolute(folder).lexically_normal().string();
}

render::Finding optional(const std::string& what, bool is_found, const std::string& use) {
  return is_found ? render::Finding{Level::ok, what, "found"}
                  : render::Finding{Level::warning, what, "not found; " + use};
}

#ifdef LRB_BUILD_BENCH
/// Returns a finding for each worker program and each method of other engines.
std::vector<render::Finding> check_engines() {
  std::vector<render::Finding> out;
  bool is_found = false;
  try {
    workers::main_worker();
    is_found = true;
    for (const workers::WorkerMethod& m : workers::find_methods()) {
      const bool is_own = m.info.name.starts_with("ours");
      if (!is_own)
        out.push_back({m.info.present ? Level::ok : Level::warning, "method " + m.info.name,
                       m.info.present ? m.info.title : m.info.title + ": " + m.info.remark});
    }
  } catch (const EnvironmentError& e) {
    if (is_found) out.push_back({Level::warning, "methods", e.what()});
  }
  out.insert(out.begin(),
             optional("lrbscope-methods", is_found,
                      "needed by bench, chart and stability; build it: cmake --build --preset release "
                      "--target lrbscope-workers"));
  return out;
}
#endif

int run_doctor(bool json) {
  std::vector<render::Finding> findings = {{Level::ok, "lrbscope", trace::lrbscope_version()}};
  findings.push_back(finding_of("query", check_query));
  for (render::Finding& f : render::check_rendering()) findings.push_back(std::move(f));
  findings.push_back(finding_of("drawing", check_drawing));
  findings.push_back(finding_of("output", check_output));
  findings.push_back(finding_of("page", [] {
    return std::to_string(io::embedded_file("chart.min.js").size() / 1000) +
           " kB of charting library compiled in";
  }));
  findings.push_back(optional("gnuplot", report::has_gnuplot(),
                              "needed by charts in print (--chart, chart, paper); install gnuplot-nox"));
  findings.push_back(
      optional("ffmpeg", frames::has_ffmpeg(), "needed by --animate; install ffmpeg or set LRB_FFMPEG"));
#ifdef LRB_BUILD_BENCH
  for (render::Finding& f : check_engines()) findings.push_back(std::move(f));
#endif
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

Command add_doctor(App& root, const Globals&) {
  App* app = root.add_subcommand(
      "doctor",
      "Check this machine for everything lrbscope needs, and list the optional programs and engines; exit code "
      "3 if something required is missing");
  const auto json = std::make_shared<bool>(false);
  app->add_flag("--json", *json, "Print one JSON object");
  return {app, [json] { return run_doctor(*json); }};
}

}  // namespace lrb::tools
