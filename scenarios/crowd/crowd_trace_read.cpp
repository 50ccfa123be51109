#include <algorithm>
#include <limits>
#include <map>

#include "scenarios/crowd/crowd_trace.hpp"
#include "trace/json_read.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/replay.hpp>

namespace lrb::crowd {
namespace {

std::string to_text(const CrowdTrace::Answer* a) {
  return a == nullptr ? "no query"
                      : std::string(to_string(a->relation)) + " in " + std::to_string(a->pairs) +
                            " pairs, fingerprint " + trace::to_hex(a->fingerprint);
}

/// Throws at the first answer that differs.
void compare(const CrowdTrace& trace, const CrowdRun& run, std::size_t step) {
  std::vector<CrowdTrace::Answer> found;
  for (const CrowdQuery& q : run.steps[step].queries)
    found.push_back({.bodies = q.bodies,
                     .relation = q.result.relation,
                     .pairs = q.result.pair_count,
                     .fingerprint = q.result.fingerprint});
  const std::vector<CrowdTrace::Answer>& recorded = trace.answers[step];
  for (std::size_t i = 0; i < std::max(found.size(), recorded.size()); ++i) {
    const CrowdTrace::Answer *x = i < recorded.size() ? &recorded[i] : nullptr,
                             *y = i < found.size() ? &found[i] : nullptr;
    if (x != nullptr && y != nullptr && *x == *y) continue;
    if (x != nullptr && y != nullptr && x->bodies != y->bodies) (x->bodies < y->bodies ? y : x) = nullptr;
    const BodyPair bodies = x != nullptr ? x->bodies : y->bodies;
    throw InputError(trace.file + ": step " + std::to_string(step) + ", " + run.names[bodies.i] + " and " +
                     run.names[bodies.j] + ": expected " + to_text(x) + " as recorded, found " + to_text(y) +
                     "; the trace is damaged; record it again");
  }
}

}  // namespace

CrowdRun replay_crowd(const CrowdTrace& trace, std::vector<bodies::LoadedBody> kinds, std::uint32_t threads,
                      const run::ProgressReport& progress) {
  if (kinds.size() != trace.bodies.size())
    throw InputError(trace.file + ": has " + std::to_string(trace.bodies.size()) +
                     " kinds of bodies, found " + std::to_string(kinds.size()));
  for (std::size_t k = 0; k < kinds.size(); ++k)
    trace::require_same_body(trace.bodies[k], kinds[k].rep, trace.crowd.kinds[k].name);
  CrowdRun run =
      play_crowd(trace.crowd, std::move(kinds), CrowdMotion(trace.crowd, trace.poses), threads, progress);
  for (std::size_t step = 0; step < run.steps.size(); ++step) compare(trace, run, step);
  if (trace.crowd.steps < trace.steps)
    run.notes.push_back("the trace contains only the first " + std::to_string(trace.crowd.steps) + " of " +
                        std::to_string(trace.steps) + " steps (trace.max_events); only these are drawn");
  return run;
}

namespace {

using trace::TraceNode;

class Reader {
 public:
  Reader(std::string_view text, const std::string& file) : text_(text) { t_.file = printable_name(file); }

  CrowdTrace run() {
    const nlohmann::json document =
        trace::parse_events(text_, t_.file, [this](const TraceNode& event) { take(event); });
    const TraceNode root(document, t_.file);
    const TraceNode metadata = root.at("metadata");
    trace::check_format(metadata, t_.file, kCrowdFormat, kCrowdVersion);
    if (metadata.at("version").integer<std::uint32_t>() < kCrowdVersion)
      throw InputError(
          t_.file + ": recorded by a version of lrbscope that did not store the poses; run the crowd again");
    read_header(metadata);
    read_kinds(metadata.at("kinds"));
    read_answers();
    read_poses(metadata.at("poses"));
    t_.steps = metadata.at("steps").integer<std::uint32_t>();
    keep_whole_steps();
    return std::move(t_);
  }

 private:
  /// Reads a query's slice in the trace, on one track or two.
  struct Slice {
    std::uint32_t step;
    std::string a, b;
    CrowdTrace::Answer answer;
  };

  void take(const TraceNode& event) {
    if (event.at("ph").string() != "X") return;
    const TraceNode args = event.at("args");
    if (args.has("queries")) {
      if (args.at("time step").integer<std::uint32_t>() != queries_.size())
        args.at("time step").fail(std::to_string(queries_.size()) + ", the next step");
      queries_.push_back(args.at("queries").integer<std::uint32_t>());
    }
    if (!args.has("relation")) return;
    // Version 1, which is rejected once it is known, did not name the step.
    const auto step = args.has("time step") ? args.at("time step").integer<std::uint32_t>() : 0U;
    slices_.push_back({step, args.at("A").string(), args.at("B").string(), read_answer(args)});
  }

  /// Reads the arguments of a slice, all but the bodies. Traces of 1.x lack some.
  static CrowdTrace::Answer read_answer(const TraceNode& args) {
    CrowdTrace::Answer a;
    a.relation = args.at("relation").named<Relation>();
    a.pairs = args.at("pairs").integer<std::uint64_t>();
    a.fingerprint = args.at("fingerprint").hash();
    const auto interval = [&](const char* key) -> std::optional<std::array<double, 2>> {
      if (!args.has(key)) return std::nullopt;
      const TraceNode bounds = args.at(key);
      if (bounds.array_size() != 2) bounds.fail("two bounds");
      return std::array{bounds.at(std::size_t{0}).number(), bounds.at(std::size_t{1}).number()};
    };
    const auto count = [&](const char* key) {
      return args.has(key) ? args.at(key).integer<std::uint64_t>() : std::uint64_t{0};
    };
    a.distance = interval("distance");
    a.depth = interval("depth");
    if (args.has("contact kind")) a.kind = args.at("contact kind").named<ClashKind>();
    if (args.has("near pairs")) a.near_pairs = count("near pairs");
    a.contact_regions = count("contact regions");
    for (std::size_t i = 0; i < kQueryCounters.size(); ++i) a.work[i] = count(kQueryCounters[i].name);
    return a;
  }

  void read_header(const TraceNode& metadata) {
    spec::Crowd& c = t_.crowd;
    t_.lrbscope = metadata.at("lrbscope").string();
    c.name = metadata.at("crowd").at("name").string();
    c.hash = metadata.at("crowd").at("hash").hash();
    c.clock = metadata.at("clock").named<trace::Clock>();
    c.request = trace::read_request(metadata.at("request"));
    if (metadata.has("measures")) {
      const TraceNode measures = metadata.at("measures");
      c.more.distance = measures.at("distance").boolean();
      c.more.clash = measures.at("clash").boolean();
      if (measures.has("near")) c.more.near = measures.at("near").least(0);
    }
    const TraceNode room = metadata.at("room");
    if (room.array_size() != 3) room.fail("three sizes");
    for (int axis = 0; axis < 3; ++axis) {
      const TraceNode size = room.at(static_cast<std::size_t>(axis));
      c.room[axis] = size.least(0);
      if (c.room[axis] > spec::kFar) size.fail("a room of finite size");
    }
  }

  void read_kinds(const TraceNode& kinds) {
    const std::size_t count = kinds.array_size();
    if (count == 0) kinds.fail("at least one kind of bodies");
    for (std::size_t k = 0; k < count; ++k) {
      const TraceNode node = kinds.at(k);
      spec::CrowdKind kind;
      kind.name = node.at("name").string();
      // The name becomes a file name beside the trace.
      if (kind.name.empty() || kind.name.find_first_of("/.\\") != std::string::npos)
        node.at("name").fail("the name of a kind of bodies");
      kind.count = node.at("count").integer<std::uint32_t>(spec::kMaxCrowdBodies);
      if (kind.count == 0 || names_.size() + kind.count > spec::kMaxCrowdBodies)
        node.at("count").fail("at least 1 body per kind and at most 10000 in total");
      for (std::uint32_t i = 1; i <= kind.count; ++i)
        if (!names_.emplace(kind.name + " " + std::to_string(i), names_.size()).second)
          node.at("name").fail("a different name for each kind");
      t_.bodies.push_back(trace::read_body(node.at("body")));
      if (t_.bodies.back().dim != t_.bodies.front().dim)
        node.at("body").at("dim").fail("bodies of the same dimension");
      t_.crowd.kinds.push_back(std::move(kind));
    }
  }

  std::uint32_t body_called(const std::string& name) const {
    const auto body = names_.find(name);
    if (body == names_.end())
      throw InputError(t_.file + ": a query refers to " + printable_name(name) +
                       ", which does not exist; the trace is damaged; record it again");
    return static_cast<std::uint32_t>(body->second);
  }

  void read_answers() {
    t_.answers.resize(queries_.size());
    for (const Slice& s : slices_) {
      if (s.step >= queries_.size())
        throw InputError(t_.file + ": a query refers to step " + std::to_string(s.step) +
                         ", which does not exist; the trace is damaged; record it again");
      CrowdTrace::Answer& answer = t_.answers[s.step].emplace_back(s.answer);
      answer.bodies = {body_called(s.a), body_called(s.b)};
    }
    for (std::vector<CrowdTrace::Answer>& step : t_.answers) {
      std::sort(step.begin(), step.end());
      step.erase(std::unique(step.begin(), step.end()), step.end());  // a query may be on two tracks
    }
  }

  void read_poses(const TraceNode& steps) {
    const std::size_t count = steps.array_size();
    for (std::size_t i = 0; i < count; ++i) {
      const TraceNode bodies = steps.at(i);
      if (bodies.array_size() != names_.size())
        bodies.fail(std::to_string(names_.size()) + " poses, one per body");
      std::vector<Pose>& poses = t_.poses.emplace_back();
      for (std::size_t body = 0; body < names_.size(); ++body) {
        const Pose pose = trace::read_pose(bodies.at(body));
        if (!(pose.r.cwiseAbs().maxCoeff() <= spec::kFar && pose.t.cwiseAbs().maxCoeff() <= spec::kFar))
          bodies.at(body).fail("a pose near the room");
        poses.push_back(pose);
      }
    }
  }

  void keep_whole_steps() {
    std::size_t whole = 0;
    while (whole < std::min(t_.poses.size(), queries_.size()) && t_.answers[whole].size() == queries_[whole])
      ++whole;
    if (whole == 0)
      throw InputError(t_.file +
                       ": contains no complete step; run the crowd again with a larger trace.max_events");
    t_.crowd.steps = static_cast<std::uint32_t>(whole);
    t_.poses.resize(whole);
    t_.answers.resize(whole);
  }

  std::string_view text_;
  CrowdTrace t_;
  std::vector<std::uint32_t> queries_;  ///< of each step
  std::vector<Slice> slices_;
  std::map<std::string, std::size_t> names_;  ///< of bodies: their indices
};

}  // namespace

bool is_crowd_trace(std::string_view text) {
  // The metadata come last. Inside a string the quotes would be escaped.
  const std::size_t at = text.rfind("\"metadata\"");
  constexpr std::size_t kNear = 256;
  if (at == std::string_view::npos) return false;
  const std::string_view begin = text.substr(at, kNear);
  return begin.find("\"" + std::string(kCrowdFormat) + "\"") != std::string_view::npos;
}

CrowdTrace read_crowd_trace(std::string_view text, const std::string& file) {
  return Reader(text, file).run();
}

}  // namespace lrb::crowd
