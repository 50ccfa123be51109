#include "scenarios/run/live_page.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <nlohmann/json.hpp>
#include <zlib.h>

#include "render/page_palette.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/scene_json.hpp"
#include <lrbscope/error.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::run {
namespace {

constexpr const char* kEngine = "lrbscope_engine.js";

bool has_engine() {
  const auto files = io::embedded_files();
  return std::any_of(files.begin(), files.end(), [](const io::EmbeddedFile& f) { return f.name == kEngine; });
}

/// Returns bytes compressed in zlib's format, which browsers decompress ("deflate"), in base64.
std::string compressed(const std::string& bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> out(size);
  constexpr int kLevel = 9;
  if (compress2(out.data(), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), kLevel) != Z_OK)
    throw EnvironmentError("zlib cannot compress a body (out of memory)");
  return report::base64(out.data(), size);
}

}  // namespace

void check_live_page() {
  if (!has_engine())
    throw EnvironmentError(
        "--live: this program was built without the engine for pages; configure it with -DLRB_WASM=ON, which needs "
        "Debian's emscripten");
}

void check_live_page(const spec::Scenario& scenario) {
  check_live_page();
  if (scenario.bodies.size() != 2)
    throw InputError("--live: expected a scenario with two bodies, found " + scenario.name + " with " +
                     std::to_string(scenario.bodies.size()));
}

std::string live_page(const RecordedRun& recorded, const std::string& folder, const std::string& command) {
  nlohmann::json data = posed_bodies_json(recorded);
  data["command"] = command;
  // Equal bodies are stored once.
  const std::string a = io::read_text(folder + "/a.lrb"), b = io::read_text(folder + "/b.lrb");
  data["files"] = {compressed(a), a == b ? std::string() : compressed(b)};
  std::string library, json = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  for (const char* name : {"three.min.js", "OrbitControls.js"})
    library += "\n" + std::string(io::embedded_file(name));
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return report::filled(
      io::embedded_file("drag.html"),
      {{"title", render::escape_markup(recorded.title)},
       {"purpose", render::escape_markup(recorded.purpose)},
       {"style",
        render::page_root_css() + render::scene_root_css() + std::string(io::embedded_file("page.css")) +
            std::string(io::embedded_file("scene.css")) + std::string(io::embedded_file("drag.css"))},
       {"version", trace::lrbscope_version()},
       {"data", json},
       {"library", library},
       {"engine", io::embedded_file(kEngine)},
       {"script", report::script_of(std::array<std::string, 1>{"drag"})}});
}

}  // namespace lrb::run
