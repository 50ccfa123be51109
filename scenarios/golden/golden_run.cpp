#include "scenarios/golden/golden_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <type_traits>
#include <utility>

#include "render/gl.hpp"
#include "scenarios/profile/captured_run.hpp"
#include "scenarios/run/run_scenario.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/render/overlay.hpp>
#include <lrbscope/trace/capture.hpp>
#include <lrbscope/trace/divergence.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/record_fields.hpp>
#include <lrbscope/trace/trace_json.hpp>

namespace lrb::golden {

std::vector<double> contact_lengths(const record::Recording& recording) {
  std::vector<double> out;
  if (!recording.trace.header.request.contacts) return out;
  for (const CollideResult& r : recording.results) {
    double length = 0;
    for (const ContactRegion& region : r.regions) length += region.length;
    out.push_back(length);
  }
  return out;
}

std::vector<Effect> find_effects(const Golden& golden, const GoldenRun& run) {
  const std::vector<trace::Step>&expected = golden.trace.steps, &found = run.recording.trace.steps;
  const std::vector<double>& lengths = golden.facts.contact_lengths;
  const std::vector<double> lengths_now = contact_lengths(run.recording);
  std::vector<Effect> out;
  for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i) {
    Effect like;
    like.step = found[i].index;
    std::vector<Effect> of_step;
    if (expected[i].finished && found[i].finished)
      for (const trace::FieldDifference& d : trace::differing_fields(expected[i].result, found[i].result))
        of_step.push_back({like.step, io::in_words(d.name), d.expected, d.actual,
                           d.is_counter ? Effect::Kind::work : Effect::Kind::answer});
    if (i < lengths.size() && i < lengths_now.size() && lengths[i] != lengths_now[i]) {
      like.what = "length of contact";
      // As many digits as differ.
      for (int digits = 7; like.expected == like.found && digits <= 17; ++digits) {
        like.expected = io::number_text(lengths[i], digits);
        like.found = io::number_text(lengths_now[i], digits);
      }
      like.kind = Effect::Kind::measure;
      of_step.push_back(like);
    }
    out.insert(out.end(), of_step.begin(), of_step.end());
  }
  if (const std::size_t both = std::min(expected.size(), found.size()); expected.size() != found.size())
    out.push_back({(expected.size() > both ? expected : found)[both].index, "number of steps",
                   std::to_string(expected.size()), std::to_string(found.size()), Effect::Kind::answer});
  std::stable_sort(out.begin(), out.end(), [](const Effect& x, const Effect& y) { return x.kind < y.kind; });
  return out;
}

std::vector<Effect> find_more_work(const Golden& golden, const GoldenRun& run) {
  struct Sum {
    std::string name;
    std::uint64_t value = 0;
  };
  const auto of_steps = [](const trace::Trace& trace) {
    std::vector<Sum> sums;
    for_each_field<Counters>([&](const auto& field) {
      if constexpr (std::is_same_v<decltype(std::declval<Counters&>().*field.member), std::uint64_t&>) {
        Sum sum{io::in_words(field.name)};
        for (const trace::Step& step : trace.steps) sum.value += step.result.counters.*field.member;
        sums.push_back(std::move(sum));
      }
    });
    return sums;
  };
  const std::vector<Sum> expected = of_steps(golden.trace), found = of_steps(run.recording.trace);
  std::vector<Effect> out;
  for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i) {
    if (static_cast<double>(found[i].value) <=
        static_cast<double>(expected[i].value) * (1 + golden.spec.work))
      continue;
    Effect more;
    more.what = found[i].name;
    more.expected = std::to_string(expected[i].value);
    more.found = std::to_string(found[i].value);
    more.kind = Effect::Kind::work;
    out.push_back(more);
  }
  return out;
}

namespace {

constexpr int kDefaultWidth = 480, kMinHeight = 240, kMaxHeight = 4 * kDefaultWidth;

std::string to_text(const Eigen::Vector3d& v) {
  std::ostringstream out;
  out.precision(6);
  out << "(" << v.x() + 0.0 << ", " << v.y() + 0.0 << ", " << v.z() + 0.0 << ")";
  return out.str();
}

std::string to_text(const render::Camera& c) {
  std::ostringstream out;
  out.precision(6);
  out << "eye " << to_text(c.eye) << "; target " << to_text(c.target) << "; up " << to_text(c.up) << "; ";
  if (c.orthographic)
    out << "half height " << c.half_height;
  else
    out << c.fov_y * 180 / std::numbers::pi << " degrees high";
  return out.str();
}

}  // namespace

void set_default_size(GoldenSpec& spec, const pictures::FrameSpec& frames) {
  const double shape = double{1} * frames.height / frames.width;
  const double height = std::clamp(kDefaultWidth * shape, double{kMinHeight}, double{kMaxHeight});
  spec.height = static_cast<int>(std::lround(height));
  spec.width = static_cast<int>(std::lround(height / shape));
}

namespace {

/// Selects the pictures of a golden.
void set_pictures(pictures::FrameSpec& frames, const GoldenSpec& spec) {
  frames.width = spec.width;
  frames.height = spec.height;
  frames.dpi = 0;
  frames.most = spec.frames;
}

std::string without_folder(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

GoldenRun record_scenario(spec::Scenario scenario, const GoldenSpec& spec,
                          const record::ProgressReport& progress) {
  GoldenRun run;
  run.scenario = std::move(scenario);
  run.scenario.clock = trace::Clock::event;
  set_pictures(run.scenario.frames, spec);
  run.recording = record::record(run.scenario, progress);
  for (trace::BodyInfo& body : run.recording.trace.header.bodies)
    if (body.source.find('/') != std::string::npos) body.source = without_folder(body.source);
  return run;
}

GoldenRun record_capture(const CapturedQueries& source, const GoldenSpec& spec,
                         const record::ProgressReport& progress) {
  const std::string name = printable_name(source.file);
  capture::Capture c = capture::read_capture(source.file);
  profile::describe_probes(c);
  const profile::TreePairs found = profile::tree_pairs(c);
  if (found.pairs.size() != 1)
    throw InputError(name + ": expected queries of one pair of trees, found " +
                     std::to_string(found.pairs.size()) + "; record each pair in a file of its own");
  const profile::TreePair& pair = found.pairs.front();
  std::vector<bodies::LoadedBody> bodies = profile::captured_bodies(c, pair);
  GoldenRun run;
  run.scenario = profile::captured_scenario(c, pair, bodies, source.file);
  run.scenario.name = source.name;
  set_pictures(run.scenario.frames, spec);
  const profile::CapturedRunSettings settings =
      profile::captured_settings(run.scenario, c, pair, without_folder(source.file));
  for (std::size_t side = 0; side < 2; ++side) run.scenario.bodies[side].file = settings.sources[side];
  run.recording = profile::captured_run(c, pair, std::move(bodies), settings, progress);
  // Times and the numbers of threads differ from recording to recording.
  for (trace::Step& step : run.recording.trace.steps)
    if (std::optional<trace::EngineReport>& report = step.result.engine)
      report->begin_ns = report->duration_ns = report->thread = 0;
  return run;
}

}  // namespace

GoldenRun record_golden(const Source& source, const GoldenSpec& spec,
                        const record::ProgressReport& progress) {
  if (const auto* captured = std::get_if<CapturedQueries>(&source))
    return record_capture(*captured, spec, progress);
  return record_scenario(std::get<spec::Scenario>(source), spec, progress);
}

void paint_golden(GoldenRun& run, const GoldenSpec& spec, const record::ProgressReport& progress) {
  if (spec.compares(Level::pictures))
    run.frames = frames::paint_frames(recorded_run_of(run), run.scenario.frames, progress);
}

GoldenRun play_golden(const Source& source, const GoldenSpec& spec, const record::ProgressReport& progress) {
  GoldenRun run = record_golden(source, spec, progress);
  paint_golden(run, spec, progress);
  return run;
}

GoldenFacts facts_of(const GoldenRun& run) {
  GoldenFacts facts;
  for (const bodies::LoadedBody& body : run.recording.bodies)
    facts.meshes.push_back(mesh_hash(body.rep.real_mesh()));
  facts.contact_lengths = contact_lengths(run.recording);
  if (!run.text.empty()) facts.scenario = compact_json(run.text);
  if (!run.frames.empty()) facts.renderer = render::gl_version();
  return facts;
}

frames::RecordedRun recorded_run_of(const GoldenRun& run) {
  frames::RecordedRun p = run::recorded_run_of(run.scenario, run.recording);
  p.purpose.clear();  // approved pictures omit the purpose
  return p;
}

std::string camera_text(const std::vector<render::Camera>& cameras) {
  std::string out;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (i > 0) out += "; ";
    if (cameras.size() > 1) out += "view " + std::to_string(i + 1) + ": ";
    out += to_text(cameras[i]);
  }
  return out;
}

std::vector<render::PngText> golden_text(const GoldenRun& run, std::size_t frame) {
  return {{"lrbscope:scenario", run.scenario.name},
          {"lrbscope:scenario_hash", trace::to_hex(run.scenario.hash)},
          {"lrbscope:event", std::to_string(run.frames[frame].event)},
          {kCameraText, camera_text(run.frames[frame].cameras)}};
}

}  // namespace lrb::golden
