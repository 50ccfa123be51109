#include "scenarios/run/run_scenario.hpp"

#include <algorithm>
#include <array>
#include <filesystem>

#include <nlohmann/json.hpp>
#include <zlib.h>

#include "render/page_palette.hpp"
#include "scenarios/io/files.hpp"
#include "scenarios/record/engine_run.hpp"
#include "scenarios/report/assets.hpp"
#include "scenarios/run/run_page.hpp"
#include "scenarios/run/scene_json.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::run {
namespace {

// The live page of a run: body B can be dragged and rotated, and the engine, compiled to WebAssembly (wasm/),
// answers each pose exactly in the page. The page contains the bodies and the engine and fetches nothing.

constexpr const char* kLivePage = "live.html";
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

/// Returns the page. `folder`: contains a.lrb and b.lrb of the run.
std::string live_page(const RecordedRun& recorded, const std::string& folder, const std::string& command) {
  nlohmann::json data = posed_bodies_json(recorded);
  data["command"] = command;
  // Equal bodies are stored once.
  const std::string a = io::read_text(folder + "/a.lrb"), b = io::read_text(folder + "/b.lrb");
  data["files"] = {compressed(a), a == b ? std::string() : compressed(b)};
  const std::string text = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string library;
  for (const char* name : {"three.min.js", "OrbitControls.js"})
    library += "\n" + std::string(io::embedded_file(name));
  return report::filled(
      io::embedded_file("drag.html"),
      {{"title", render::escape_markup(recorded.title)},
       {"purpose", render::escape_markup(recorded.purpose)},
       {"style",
        render::page_root_css() + render::scene_root_css() + std::string(io::embedded_file("page.css")) +
            std::string(io::embedded_file("scene.css")) + std::string(io::embedded_file("drag.css"))},
       {"version", trace::lrbscope_version()},
       {"data", report::script_safe(text)},
       {"library", library},
       {"engine", io::embedded_file(kEngine)},
       {"script", report::script_of(std::array<std::string, 1>{"drag"})}});
}

/// Throws, before any file is written, if the scenario requests a frame that cannot be drawn.
void check(const spec::Scenario& scenario, const RecordedRun& recorded) {
  try {
    check_frames(recorded, scenario.frames);
  } catch (const InputError& e) {
    throw InputError("scenario " + scenario.name + ": " + e.what());
  }
}

std::vector<trace::SummaryBody> summary_bodies(const RecordedRun& recorded) {
  std::vector<trace::SummaryBody> out;
  for (std::size_t i = 0; i < recorded.reps.size(); ++i)
    out.push_back({recorded.reps[i], i < recorded.trees->size() ? &(*recorded.trees)[i] : nullptr});
  return out;
}

}  // namespace

void check_live_page() {
  if (!has_engine())
    throw EnvironmentError(
        "--live: this program was built without the engine for pages; configure it with -DLRB_WASM=ON, which needs "
        "Debian's emscripten");
}

RecordedRun recorded_run_of(const spec::Scenario& scenario, const Recording& recording) {
  return recorded_run_of(scenario.name, scenario.purpose, recording);
}

RecordedRun recorded_run_of(const std::string& title, const std::string& purpose,
                            const Recording& recording) {
  RecordedRun p;
  p.title = title;
  p.purpose = purpose;
  p.trace = &recording.trace;
  p.results = &recording.results;
  p.trees = &recording.trees;
  p.wrong = &recording.wrong;
  for (const bodies::LoadedBody& body : recording.bodies) p.reps.push_back(&body.rep);
  return p;
}

RunOutcome write_run(const spec::Scenario& scenario, const Recording& recording, const std::string& folder,
                     const std::string& command, const ProgressReport& progress, bool live) {
  const RecordedRun recorded = recorded_run_of(scenario, recording);
  check(scenario, recorded);
  for (const char* name : {"a.lrb", "b.lrb", "trace.json", "summary.json", "index.html"})
    reject_input_as_output(folder + "/" + name);  // before anything is written
  const report::Folder locked(folder);
  const std::vector<std::pair<std::string, std::string>> text = {
      {"Software", "lrbscope " + recording.trace.header.lrbscope},
      {"lrbscope:scenario", scenario.name},
      {"lrbscope:scenario_hash", trace::to_hex(scenario.hash)},
  };
  const DrawnFrames drawn = draw_frames(recorded, scenario.frames, folder, text, progress);
  const std::string trace_file = scenario.gzip ? "trace.json.gz" : "trace.json";
  std::error_code error;
  std::filesystem::remove(folder + (scenario.gzip ? "/trace.json" : "/trace.json.gz"),
                          error);  // of an earlier run
  trace::save_trace(recording.trace, folder + "/" + trace_file);
  std::filesystem::remove(folder + "/" + kTreesFile, error);
  if (!recording.trace.header.engine.empty() && !recording.trees.empty())
    io::write_text(folder + "/" + kTreesFile, trees_text(recording.trees));
  RunOutcome out;
  out.notes = recording.notes;
  constexpr std::uintmax_t kMegabyte = 1'000'000, kLarge = 300 * kMegabyte;
  if (const auto size = std::filesystem::file_size(folder + "/" + trace_file, error); !error && size > kLarge)
    out.notes.push_back(
        folder + "/" + trace_file + " has " + std::to_string(size / kMegabyte) +
        " MB, more than most viewers load; ask for fewer poses or, by --events, fewer events");
  out.mismatches = mismatches(scenario, recording);
  out.summary = trace::summary_json(recording.trace, summary_bodies(recorded));
  io::write_text(folder + "/summary.json", out.summary);

  for (std::size_t i = 0; i < recording.bodies.size(); ++i)
    save_lrb(recording.bodies[i].rep, folder + (i == 0 ? "/a.lrb" : "/b.lrb"));
  out.frames = drawn.frames.size();
  progress("page", 0, 1);
  const report::Link summary{"summary.json", recording.trace.header.construction
                                                 ? "passes with their caps and reasons of rejection, as JSON"
                                                 : "totals, statistics and time steps, as JSON"};
  std::vector<report::Link> links = {trace_link(trace_file), summary};
  std::filesystem::remove(folder + "/" + kLivePage, error);
  if (live) {
    io::write_text(folder + "/" + kLivePage, live_page(recorded, folder, command));
    links.push_back({kLivePage, "B can be dragged; the engine answers in the page"});
  }
  run_page(recorded, drawn, folder,
           {scenario.name, scenario.purpose, command, trace_file, std::move(links), out.mismatches,
            "lrbscope why --run " + io::shell_word(folder)})
      .write(locked);
  return out;
}

RunOutcome run_scenario(const spec::Scenario& scenario, const std::string& folder, const std::string& command,
                        const ProgressReport& progress, bool live) {
  if (live) check_live_page();
  if (live && scenario.bodies.size() != 2)
    throw InputError("--live: expected a scenario with two bodies, found " + scenario.name + " with " +
                     std::to_string(scenario.bodies.size()));
  return write_run(scenario, record(scenario, progress), folder, command, progress, live);
}

}  // namespace lrb::run
