#include "scenarios/run/run_scenario.hpp"

#include <filesystem>

#include "scenarios/io/files.hpp"
#include "scenarios/record/engine_run.hpp"
#include "scenarios/run/run_page.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/trace.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::run {
namespace {

/// Throws, before any file is written, if the scenario requests a frame that cannot be drawn.
void check(const spec::Scenario& scenario, const frames::RecordedRun& recorded) {
  try {
    frames::check_frames(recorded, scenario.frames);
  } catch (const InputError& e) {
    throw InputError("scenario " + scenario.name + ": " + e.what());
  }
}

std::vector<trace::SummaryBody> summary_bodies(const frames::RecordedRun& recorded) {
  std::vector<trace::SummaryBody> out;
  for (std::size_t i = 0; i < recorded.reps.size(); ++i)
    out.push_back({recorded.reps[i], i < recorded.trees->size() ? &(*recorded.trees)[i] : nullptr});
  return out;
}

}  // namespace

frames::RecordedRun recorded_run_of(const spec::Scenario& scenario, const record::Recording& recording) {
  return recorded_run_of(scenario.name, scenario.purpose, recording);
}

frames::RecordedRun recorded_run_of(const std::string& title, const std::string& purpose,
                                    const record::Recording& recording) {
  frames::RecordedRun p;
  p.title = title;
  p.purpose = purpose;
  p.trace = &recording.trace;
  p.results = &recording.results;
  p.trees = &recording.trees;
  p.wrong = &recording.wrong;
  for (const bodies::LoadedBody& body : recording.bodies) p.reps.push_back(&body.rep);
  return p;
}

RunOutcome write_run(const spec::Scenario& scenario, const record::Recording& recording,
                     const std::string& folder, const std::string& command,
                     const record::ProgressReport& progress) {
  const frames::RecordedRun recorded = recorded_run_of(scenario, recording);
  check(scenario, recorded);
  for (const char* name : {"a.lrb", "b.lrb", "trace.json", "summary.json", "index.html"})
    reject_input_as_output(folder + "/" + name);  // before anything is written
  const report::Folder locked(folder);
  const std::vector<std::pair<std::string, std::string>> text = {
      {"Software", "lrbscope " + recording.trace.header.lrbscope},
      {"lrbscope:scenario", scenario.name},
      {"lrbscope:scenario_hash", trace::to_hex(scenario.hash)},
  };
  const frames::DrawnFrames drawn = frames::draw_frames(recorded, scenario.frames, folder, text, progress);
  const std::string trace_file = scenario.gzip ? "trace.json.gz" : "trace.json";
  std::error_code error;
  std::filesystem::remove(folder + (scenario.gzip ? "/trace.json" : "/trace.json.gz"),
                          error);  // of an earlier run
  const bool traced = scenario.keeps_trace;
  if (traced)
    trace::save_trace(recording.trace, folder + "/" + trace_file);
  else
    std::filesystem::remove(folder + "/" + trace_file, error);
  std::filesystem::remove(folder + "/" + record::kTreesFile, error);
  if (traced && !recording.trace.header.engine.empty() && !recording.trees.empty())
    io::write_text(folder + "/" + record::kTreesFile, record::trees_text(recording.trees));
  RunOutcome out;
  out.notes = recording.notes;
  constexpr std::uintmax_t kMegabyte = 1'000'000, kLarge = 300 * kMegabyte;
  if (const auto size = std::filesystem::file_size(folder + "/" + trace_file, error); !error && size > kLarge)
    out.notes.push_back(
        folder + "/" + trace_file + " has " + std::to_string(size / kMegabyte) +
        " MB, more than most viewers load; ask for fewer poses (--steps of collide) or events (--events)");
  out.mismatches = record::mismatches(scenario, recording);
  out.summary = trace::summary_json(recording.trace, summary_bodies(recorded));
  io::write_text(folder + "/summary.json", out.summary);

  for (std::size_t i = 0; i < recording.bodies.size(); ++i)
    save_lrb(recording.bodies[i].rep, folder + (i == 0 ? "/a.lrb" : "/b.lrb"));
  out.frames = drawn.frames.size();
  progress("page", 0, 1);
  const report::Link summary{"summary.json", recording.trace.header.construction
                                                 ? "passes with their caps and reasons of rejection, as JSON"
                                                 : "totals, statistics and time steps, as JSON"};
  std::vector<report::Link> links = {summary};
  if (traced) links.insert(links.begin(), trace_link(trace_file));
  run_page(recorded, drawn, folder,
           {scenario.name, scenario.purpose, command, traced ? trace_file : "", std::move(links),
            out.mismatches, traced ? "lrbscope why --run " + io::shell_word(folder) : ""})
      .write(locked);
  return out;
}

RunOutcome run_scenario(const spec::Scenario& scenario, const std::string& folder, const std::string& command,
                        const record::ProgressReport& progress) {
  return write_run(scenario, record::record(scenario, progress), folder, command, progress);
}

}  // namespace lrb::run
