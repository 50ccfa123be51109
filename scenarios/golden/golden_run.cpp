#include "scenarios/golden/golden_run.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <type_traits>
#include <utility>

#include "render/gl.hpp"
#include "scenarios/crowd/crowd_frames.hpp"
#include "scenarios/golden/golden.hpp"
#include "scenarios/io/files.hpp"
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
namespace {

using Answer = crowd::CrowdTrace::Answer;
using Interval = std::optional<std::array<double, 2>>;

std::string words_of(std::uint64_t value) {
  return std::to_string(value);
}
std::string words_of(Relation relation) {
  return std::string(to_string(relation));
}
std::string words_of(const Interval& bounds) {
  return bounds ? "[" + io::number_text((*bounds)[0]) + ", " + io::number_text((*bounds)[1]) + "]" : "none";
}
std::string words_of(const std::optional<ClashKind>& kind) {
  return kind ? std::string(lrb::name_of(*kind)) : "none";
}
std::string words_of(const std::optional<std::uint64_t>& value) {
  return value ? std::to_string(*value) : "none";
}

/// Returns "8 knot, 6 gear".
std::string kinds_text(const spec::Crowd& crowd) {
  std::string out;
  for (const spec::CrowdKind& kind : crowd.kinds)
    out += (out.empty() ? "" : ", ") + std::to_string(kind.count) + " " + kind.name;
  return out;
}

/// Returns the requested measures: "distance, near 0.1".
std::string measures_text(const spec::StepQuestions& more) {
  std::string out;
  const auto add = [&](const std::string& word) { out.append(out.empty() ? "" : ", ").append(word); };
  if (more.distance) add("distance");
  if (more.clash) add("clash");
  if (more.near) add("near " + io::number_text(*more.near));
  return out.empty() ? "none" : out;
}

/// Collects the differences of the queries of two runs.
class Queries {
 public:
  Queries(const crowd::CrowdTrace& expected, const crowd::CrowdTrace& found)
      : expected_(expected), found_(found), names_(crowd::body_names(found.crowd)) {}

  /// Appends the differences at a step, in ascending order of bodies.
  void of_step(std::size_t step, std::vector<Effect>& out) {
    out_ = &out;
    step_ = static_cast<std::uint32_t>(step);
    const std::vector<Answer>&x = expected_.answers[step], &y = found_.answers[step];
    for (auto p = x.begin(), q = y.begin(); p != x.end() || q != y.end();) {
      const bool only_x = q == y.end() || (p != x.end() && p->bodies < q->bodies),
                 only_y = p == x.end() || (q != y.end() && q->bodies < p->bodies);
      if (only_x) {
        one_sided(*p, true);
        ++p;
      } else if (only_y) {
        one_sided(*q, false);
        ++q;
      } else {
        both(*p++, *q++);
      }
    }
  }

 private:
  /// Adds a query that only one run has. Bodies that are not queried are separate.
  void one_sided(const Answer& a, bool is_expected) {
    const std::string relation = words_of(a.relation), none = "none: the boxes are disjoint";
    add(a.bodies, "query", is_expected ? relation : none, is_expected ? none : relation,
        a.relation == Relation::separate ? Effect::Kind::work : Effect::Kind::answer);
  }

  void both(const Answer& x, const Answer& y) {
    const auto compare = [&](const char* what, const auto& p, const auto& q, Effect::Kind kind) {
      if (p != q) add(x.bodies, what, words_of(p), words_of(q), kind);
    };
    using Kind = Effect::Kind;
    compare("relation", x.relation, y.relation, Kind::answer);
    compare("pairs", x.pairs, y.pairs, Kind::answer);
    if (x.fingerprint != y.fingerprint)
      add(x.bodies, "fingerprint", trace::to_hex(x.fingerprint), trace::to_hex(y.fingerprint), Kind::answer);
    compare("distance", x.distance, y.distance, Kind::answer);
    compare("contact kind", x.kind, y.kind, Kind::answer);
    compare("depth", x.depth, y.depth, Kind::answer);
    compare("near pairs", x.near_pairs, y.near_pairs, Kind::answer);
    compare("contact regions", x.contact_regions, y.contact_regions, Kind::measure);
    for (std::size_t i = 0; i < crowd::kQueryCounters.size(); ++i)
      compare(crowd::kQueryCounters[i].name, x.work[i], y.work[i], Kind::work);
  }

  void add(const BodyPair& bodies, const std::string& what, const std::string& expected,
           const std::string& found, Effect::Kind kind) {
    out_->push_back(
        {step_, names_[bodies.i] + " and " + names_[bodies.j] + ": " + what, expected, found, kind});
  }

  const crowd::CrowdTrace &expected_, &found_;
  std::vector<std::string> names_;
  std::vector<Effect>* out_ = nullptr;
  std::uint32_t step_ = 0;
};

std::size_t common_steps(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  return std::min(x.answers.size(), y.answers.size());
}

/// Returns the first body that has another pose at a step; nullopt: none.
std::optional<std::size_t> moved_body(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y,
                                      std::size_t step) {
  for (std::size_t i = 0; i < y.poses[step].size(); ++i)
    if (!trace::equal(x.poses[step][i], y.poses[step][i])) return i;
  return std::nullopt;
}

/// Returns all differences of the queries, as find_effects(). If the crowds have different bodies, this is
/// the only difference.
std::vector<Effect> crowd_effects(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  const std::string kinds_x = kinds_text(x.crowd), kinds_y = kinds_text(y.crowd);
  if (kinds_x != kinds_y) return {{0, "bodies", kinds_x, kinds_y, Effect::Kind::answer}};
  std::vector<Effect> out;
  Queries queries(x, y);
  for (std::size_t step = 0; step < common_steps(x, y); ++step) queries.of_step(step, out);
  if (x.answers.size() != y.answers.size())
    out.push_back({static_cast<std::uint32_t>(common_steps(x, y)), "number of steps",
                   std::to_string(x.answers.size()), std::to_string(y.answers.size()), Effect::Kind::answer});
  std::stable_sort(out.begin(), out.end(), [](const Effect& a, const Effect& b) { return a.kind < b.kind; });
  return out;
}

}  // namespace

std::size_t query_count(const crowd::CrowdTrace& trace) {
  std::size_t n = 0;
  for (const std::vector<Answer>& step : trace.answers) n += step.size();
  return n;
}

std::optional<trace::Divergence> first_divergence(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  const auto differ = [](const std::string& what, const std::string& expected, const std::string& found,
                         std::optional<std::size_t> step = {}) {
    return trace::Divergence{{}, step, what, expected, found};
  };
  if (const std::string p = kinds_text(x.crowd), q = kinds_text(y.crowd); p != q)
    return differ("bodies", p, q);
  for (std::size_t k = 0; k < y.bodies.size(); ++k)
    if (x.bodies[k].hash != y.bodies[k].hash)
      return differ(y.crowd.kinds[k].name + ": hash", trace::to_hex(x.bodies[k].hash),
                    trace::to_hex(y.bodies[k].hash));
  std::optional<trace::Divergence> request;
  for_each_field<CollideRequest>([&](const auto& field) {
    if (!request && x.crowd.request.*field.member != y.crowd.request.*field.member)
      request = differ("request: " + std::string(field.name), "as approved", "another value");
  });
  if (request) return request;
  if (const std::string p = measures_text(x.crowd.more), q = measures_text(y.crowd.more); p != q)
    return differ("request: measures", p, q);
  const std::vector<std::string> names = crowd::body_names(y.crowd);
  Queries queries(x, y);
  for (std::size_t step = 0; step < common_steps(x, y); ++step) {
    if (const auto body = moved_body(x, y, step))
      return differ(names[*body] + ": pose", "as approved", "another one", step);
    std::vector<Effect> effects;
    queries.of_step(step, effects);
    if (!effects.empty()) return differ(effects[0].what, effects[0].expected, effects[0].found, step);
  }
  if (x.answers.size() != y.answers.size())
    return differ("number of steps", std::to_string(x.answers.size()), std::to_string(y.answers.size()));
  return std::nullopt;
}

std::string kinds_cause(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  const std::string p = kinds_text(x.crowd), q = kinds_text(y.crowd);
  if (p != q) return "the bodies changed: " + p + " -> " + q;
  const std::string m = measures_text(x.crowd.more), n = measures_text(y.crowd.more);
  return m != n ? "the requested measures changed: " + m + " -> " + n : std::string();
}

std::string crowd_pose_cause(const crowd::CrowdTrace& x, const crowd::CrowdTrace& y) {
  if (kinds_text(x.crowd) != kinds_text(y.crowd)) return {};
  const std::vector<std::string> names = crowd::body_names(y.crowd);
  for (std::size_t step = 0; step < common_steps(x, y); ++step)
    if (const auto body = moved_body(x, y, step))
      return "step " + std::to_string(step) + ": " + names[*body] + " moved: its origin is displaced by " +
             render::short_number((y.poses[step][*body].t - x.poses[step][*body].t).norm());
  return {};
}

namespace {

std::string to_text(std::uint64_t value) {
  return std::to_string(value);
}
std::string to_text(double value) {
  return io::number_text(value);
}
std::string to_text(bool value) {
  return value ? "yes" : "no";
}
std::string to_text(const std::optional<Separation>& s) {
  return s ? "proven by wrappers of " + std::to_string(s->face_count[0]) + " and " +
                 std::to_string(s->face_count[1]) + " faces"
           : "none";
}
template <class Measured>
std::string to_text(const std::optional<Measured>& m) {
  return m ? trace::to_text(*m) : "none";
}
std::string to_text(const std::vector<std::uint32_t>& values) {
  std::string out;
  for (const std::uint32_t value : values) out.append(out.empty() ? "" : ", ").append(std::to_string(value));
  return out;
}
template <class Enum>
requires std::is_enum_v<Enum> std::string to_text(Enum value) {
  return std::string(name_of(value));
}

/// Compares the fields of two records and the fields of their counters.
template <class Record>
void compare(const Record& x, const Record& y, Effect like, std::vector<Effect>& out) {
  std::vector<Effect> counters;
  for_each_field<Record>([&](const auto& field) {
    const auto &expected = x.*field.member, &found = y.*field.member;
    if (expected == found) return;
    if constexpr (std::is_same_v<decltype(expected), const Counters&>) {
      Effect work = like;
      work.kind = Effect::Kind::work;
      compare(expected, found, work, counters);
    } else {
      like.what = io::in_words(field.name);
      like.expected = to_text(expected);
      like.found = to_text(found);
      if constexpr (std::is_same_v<decltype(expected), const std::uint64_t&>)
        if (field.form == Form::hash) {
          like.expected = trace::to_hex(expected);
          like.found = trace::to_hex(found);
        }
      out.push_back(like);
    }
  });
  out.insert(out.end(), counters.begin(), counters.end());
}

}  // namespace

std::vector<double> contact_lengths(const run::Recording& recording) {
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
  if (run.crowd) return crowd_effects(*golden.crowd, run.crowd->trace);
  const std::vector<trace::Step>&expected = golden.trace.steps, &found = run.recording.trace.steps;
  const std::vector<double>& lengths = golden.facts.contact_lengths;
  const std::vector<double> lengths_now = contact_lengths(run.recording);
  std::vector<Effect> out;
  for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i) {
    Effect like;
    like.step = found[i].index;
    std::vector<Effect> of_step;
    if (expected[i].finished && found[i].finished)
      compare(expected[i].result, found[i].result, like, of_step);
    if (i < lengths.size() && i < lengths_now.size() && lengths[i] != lengths_now[i]) {
      like.what = "length of contact";
      like.expected = to_text(lengths[i]);
      like.found = to_text(lengths_now[i]);
      like.kind = Effect::Kind::measure;
      of_step.push_back(like);
    }
    out.insert(out.end(), of_step.begin(), of_step.end());
  }
  if (expected.size() != found.size())
    out.push_back({static_cast<std::uint32_t>(std::min(expected.size(), found.size())), "number of steps",
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
  const auto of_queries = [](const crowd::CrowdTrace& trace) {
    std::vector<Sum> sums;
    for (std::size_t i = 0; i < crowd::kQueryCounters.size(); ++i) {
      Sum sum{crowd::kQueryCounters[i].name};
      for (const auto& step : trace.answers)
        for (const crowd::CrowdTrace::Answer& answer : step) sum.value += answer.work[i];
      sums.push_back(std::move(sum));
    }
    return sums;
  };
  const std::vector<Sum> expected = golden.crowd ? of_queries(*golden.crowd) : of_steps(golden.trace),
                         found = run.crowd ? of_queries(run.crowd->trace) : of_steps(run.recording.trace);
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

void set_default_size(GoldenSpec& spec, const render::FrameSpec& frames) {
  const double shape = double{1} * frames.height / frames.width;
  const double height = std::clamp(kDefaultWidth * shape, double{kMinHeight}, double{kMaxHeight});
  spec.height = static_cast<int>(std::lround(height));
  spec.width = static_cast<int>(std::lround(height / shape));
}

namespace {

/// Selects the pictures of a golden.
void set_pictures(render::FrameSpec& frames, const GoldenSpec& spec) {
  frames.width = spec.width;
  frames.height = spec.height;
  frames.dpi = 0;
  frames.most = spec.frames;
}

std::string without_folder(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

GoldenRun record_scenario(spec::Scenario scenario, const GoldenSpec& spec,
                          const run::ProgressReport& progress) {
  GoldenRun run;
  run.scenario = std::move(scenario);
  run.scenario.clock = trace::Clock::event;
  set_pictures(run.scenario.frames, spec);
  run.recording = run::record(run.scenario, progress);
  for (trace::BodyInfo& body : run.recording.trace.header.bodies)
    if (body.source.find('/') != std::string::npos) body.source = without_folder(body.source);
  return run;
}

GoldenRun record_capture(const CapturedQueries& source, const GoldenSpec& spec,
                         const run::ProgressReport& progress) {
  const std::string name = printable_name(source.file);
  const capture::Capture c = capture::read_capture(source.file);
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
  run.recording = profile::captured_run(c, pair, std::move(bodies), settings, {}, progress);
  // Times and the numbers of threads differ from recording to recording.
  for (trace::Step& step : run.recording.trace.steps)
    if (std::optional<trace::EngineReport>& report = step.result.engine)
      report->begin_ns = report->duration_ns = report->thread = 0;
  return run;
}

GoldenRun record_crowd(spec::Crowd crowd, const GoldenSpec& spec, const run::ProgressReport& progress,
                       std::uint32_t threads) {
  constexpr std::uint32_t kAllSlices = 50'000'000;  // of any crowd that fits in memory
  GoldenRun run;
  crowd.clock = trace::Clock::event;
  crowd.max_events = kAllSlices;
  set_pictures(crowd.frames, spec);
  if (!spec.compares(Level::pictures)) crowd.frames.at = render::FrameSpec::At::none;
  run.scenario.name = crowd.name;
  run.scenario.purpose = crowd.purpose;
  run.scenario.hash = crowd.hash;
  run.scenario.frames = crowd.frames;
  crowd::CrowdRun played = crowd::run_crowd(crowd, threads, progress);
  for (spec::CrowdKind& kind : crowd.kinds) {
    kind.body.file = without_folder(kind.body.file);
    run.scenario.bodies.push_back(kind.body);
  }
  trace::StringSink sink;
  crowd::write_crowd_trace(crowd, played, sink);
  crowd::CrowdTrace trace = crowd::read_crowd_trace(sink.text, crowd.name);
  run.crowd = CrowdRecord{std::move(crowd), std::move(played), std::move(trace)};
  return run;
}

}  // namespace

GoldenRun record_golden(Source source, const GoldenSpec& spec, const run::ProgressReport& progress,
                        std::uint32_t threads) {
  if (auto* crowd = std::get_if<spec::Crowd>(&source))
    return record_crowd(std::move(*crowd), spec, progress, threads);
  if (const auto* captured = std::get_if<CapturedQueries>(&source))
    return record_capture(*captured, spec, progress);
  return record_scenario(std::get<spec::Scenario>(std::move(source)), spec, progress);
}

void paint_golden(GoldenRun& run, const GoldenSpec& spec, const run::ProgressReport& progress) {
  if (!spec.compares(Level::pictures)) return;
  run.frames = run.crowd ? crowd::paint_crowd(run.crowd->crowd, run.crowd->run, progress)
                         : run::paint_frames(recorded_run_of(run), run.scenario.frames, progress);
}

GoldenRun play_golden(Source source, const GoldenSpec& spec, const run::ProgressReport& progress,
                      std::uint32_t threads) {
  GoldenRun run = record_golden(std::move(source), spec, progress, threads);
  paint_golden(run, spec, progress);
  return run;
}

void save_run_trace(const GoldenRun& run, const std::string& path) {
  if (!run.crowd) return trace::save_trace(run.recording.trace, path);
  trace::save_trace(
      [&](trace::ByteSink& sink) { crowd::write_crowd_trace(run.crowd->crowd, run.crowd->run, sink); }, path);
}

GoldenFacts facts_of(const GoldenRun& run) {
  GoldenFacts facts;
  for (const bodies::LoadedBody& body : run.bodies()) facts.meshes.push_back(mesh_hash(body.rep.real_mesh()));
  facts.contact_lengths = contact_lengths(run.recording);
  if (!run.text.empty()) facts.scenario = compact_json(run.text);
  if (!run.frames.empty()) facts.renderer = render::gl_version();
  return facts;
}

run::RecordedRun recorded_run_of(const GoldenRun& run) {
  run::RecordedRun p = run::recorded_run_of(run.scenario, run.recording);
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
          {run.crowd ? "lrbscope:step" : "lrbscope:event", std::to_string(run.frames[frame].event)},
          {kCameraText, camera_text(run.frames[frame].cameras)}};
}

}  // namespace lrb::golden
