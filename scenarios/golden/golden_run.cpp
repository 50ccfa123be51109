#include "scenarios/golden/golden_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>

#include "scenarios/golden/effects.hpp"
#include "scenarios/golden/kept_body.hpp"
#include "scenarios/run/run_scenario.hpp"
#include "trace/hex.hpp"

namespace lrb::golden {
namespace {

constexpr int kDefaultWidth = 480, kLeastHeight = 320;

std::string words(const Eigen::Vector3d& v) {
  std::ostringstream out;
  out.precision(6);
  out << "(" << v.x() + 0.0 << ", " << v.y() + 0.0 << ", " << v.z() + 0.0 << ")";
  return out.str();
}

std::string words(const render::Camera& c) {
  std::ostringstream out;
  out.precision(6);
  out << "eye " << words(c.eye) << "; target " << words(c.target) << "; up " << words(c.up) << "; ";
  if (c.orthographic)
    out << "half height " << c.half_height;
  else
    out << c.fov_y * 180 / std::numbers::pi << " degrees high";
  return out.str();
}

}  // namespace

void set_default_size(GoldenSpec& spec, const render::FrameSpec& frames) {
  spec.width = kDefaultWidth;
  spec.height =
      std::clamp(static_cast<int>(std::lround(double{kDefaultWidth} * frames.height / frames.width)),
                 kLeastHeight, 4 * kDefaultWidth);
}

GoldenRun record_golden(spec::Scenario scenario, const GoldenSpec& spec,
                        const run::ProgressReport& progress) {
  GoldenRun run;
  run.scenario = std::move(scenario);
  run.scenario.clock = trace::Clock::event;
  render::FrameSpec& frames = run.scenario.frames;
  frames.width = spec.width;
  frames.height = spec.height;
  frames.dpi = 0;
  frames.most = spec.frames;
  run.recording = run::record(run.scenario, progress);
  for (trace::BodyInfo& body : run.recording.trace.header.bodies)  // names no folder of this machine
    if (body.source.find('/') != std::string::npos)
      body.source = std::filesystem::path(body.source).filename().string();
  return run;
}

void paint_golden(GoldenRun& run, const GoldenSpec& spec, const run::ProgressReport& progress) {
  if (spec.compares(Level::pictures))
    run.frames = run::paint_frames(recorded_run_of(run), run.scenario.frames, progress);
}

GoldenRun play_golden(spec::Scenario scenario, const GoldenSpec& spec, const run::ProgressReport& progress) {
  GoldenRun run = record_golden(std::move(scenario), spec, progress);
  paint_golden(run, spec, progress);
  return run;
}

GoldenFacts facts_of(const GoldenRun& run) {
  GoldenFacts facts;
  for (const bodies::LoadedBody& body : run.recording.bodies)
    facts.meshes.push_back(mesh_hash(kept_mesh(body.rep)));
  facts.contact_lengths = contact_lengths(run.recording);
  return facts;
}

run::RecordedRun recorded_run_of(const GoldenRun& run) {
  run::RecordedRun p = run::recorded_run_of(run.scenario, run.recording);
  p.purpose.clear();  // approved pictures say what they show without it
  return p;
}

std::string camera_words(const std::vector<render::Camera>& cameras) {
  std::string out;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (i > 0) out += "; ";
    if (cameras.size() > 1) out += "view " + std::to_string(i + 1) + ": ";
    out += words(cameras[i]);
  }
  return out;
}

std::vector<render::PngText> golden_text(const GoldenRun& run, std::size_t frame) {
  return {{"lrbscope:scenario", run.scenario.name},
          {"lrbscope:scenario_hash", trace::to_hex(run.scenario.hash)},
          {"lrbscope:event", std::to_string(run.frames[frame].event)},
          {kCameraText, camera_words(run.frames[frame].cameras)}};
}

}  // namespace lrb::golden
