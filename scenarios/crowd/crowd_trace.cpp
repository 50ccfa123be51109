#include "scenarios/crowd/crowd_trace.hpp"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "trace/json_read.hpp"
#include "trace/trace_json_parts.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/trace/json_write.hpp>
#include <lrbscope/trace/replay.hpp>
#include <lrbscope/trace/trace.hpp>

namespace lrb::crowd {
namespace {

using trace::JsonWriter;

/// A time interval: in microseconds, or in event numbers, which viewers read as microseconds.
struct Span {
  double begin = 0, length = 1;
};

class Writer {
 public:
  Writer(const spec::Crowd& crowd, const CrowdRun& run, trace::ByteSink& sink)
      : crowd_(crowd), run_(run), out_(sink), w_(out_, 2), wall_(crowd.clock == trace::Clock::wall) {}

  void run() {
    w_.begin_object().key("traceEvents").begin_array();
    name_tracks();
    for (std::uint32_t i = 0; i < run_.steps.size(); ++i) step(i);
    w_.end_array().key("metadata");
    metadata();
    w_.end_object();
    out_.raw('\n');
    out_.flush();
  }

 private:
  static constexpr std::uint32_t kSteps = 1, kBroadPhase = 2, kFirst = 3;  ///< tracks

  void name_tracks() {
    name_of_track("process_name", 0, "lrbscope crowd: " + crowd_.name);
    name_of_track("thread_name", kSteps, "time steps");
    name_of_track("thread_name", kBroadPhase, "broad phase");
    const auto n = wall_ ? run_.threads : run_.motion.body_count();
    for (std::uint32_t i = 0; i < n; ++i)
      name_of_track("thread_name", kFirst + i, wall_ ? "thread " + std::to_string(i) : run_.names[i]);
    for (std::uint32_t track = kSteps; track < kFirst + n; ++track) {
      begin("thread_sort_index", "__metadata", "M", track, {0, 0});
      w_.member("sort_index", track);
      end();
    }
  }

  void name_of_track(std::string_view what, std::uint32_t track, const std::string& name) {
    begin(what, "__metadata", "M", track, {0, 0});
    w_.member("name", name);
    end();
  }

  /// Writes the beginning of a line, up to the arguments.
  void begin(std::string_view name, std::string_view category, std::string_view phase, std::uint32_t track,
             const Span& span) {
    w_.begin_object().member("name", name).member("cat", category).member("ph", phase).key("ts");
    time(span.begin);
    if (phase == "X") {
      w_.key("dur");
      time(span.length);
    }
    w_.member("pid", 1U).member("tid", track).key("args").begin_object();
  }
  void end() { w_.end_object().end_object(); }
  void time(double t) {
    if (wall_)
      w_.value(t);
    else
      w_.value(static_cast<std::uint64_t>(t));
  }

  void step(std::uint32_t index) {
    const CrowdStep& s = run_.steps[index];
    index_ = index;
    if (wall_) clock_ = static_cast<double>(s.begin_ns) / 1000;
    const Span broad{clock_, wall_ ? static_cast<double>(s.broad_phase_ns) / 1000
                                   : static_cast<double>(s.broad_phase.box_tests) + 1};
    double at = broad.begin + broad.length;
    double length = broad.length;
    if (wall_) {
      length += static_cast<double>(s.queries_ns) / 1000;
    } else {
      for (const CrowdQuery& q : s.queries) length += static_cast<double>(q.events());
    }
    step_slice(s, index, {clock_, length});
    broad_phase(s, broad);
    counters(s);
    std::vector<CrowdQuery> queries = s.queries;
    if (wall_)
      std::sort(queries.begin(), queries.end(),
                [](const CrowdQuery& x, const CrowdQuery& y) { return x.begin_ns < y.begin_ns; });
    for (const CrowdQuery& q : queries) {
      const std::uint32_t slices = wall_ ? 1 : 2;
      seen_ += slices;
      const Span span = wall_ ? Span{static_cast<double>(q.begin_ns) / 1000,
                                     static_cast<double>(q.end_ns - q.begin_ns) / 1000}
                              : Span{at, static_cast<double>(q.events())};
      at += span.length;
      if (stored_ + slices > crowd_.max_events) continue;
      stored_ += slices;
      query(q, span);
    }
    clock_ += length;
  }

  void step_slice(const CrowdStep& s, std::uint32_t index, const Span& span) {
    begin("step", "step", "X", kSteps, span);
    w_.member("time step", index).member("bodies", run_.motion.body_count());
    w_.member("bodies in contact", std::uint64_t{bodies_in_contact(s, run_.motion.body_count())});
    w_.member("queries", std::uint64_t{s.queries.size()});
    end();
  }

  void broad_phase(const CrowdStep& s, const Span& span) {
    begin("boxes, sort and sweep", "broad phase", "X", kBroadPhase, span);
    w_.member("box tests", s.broad_phase.box_tests).member("swaps", s.broad_phase.swaps);
    w_.member("sorted afresh", s.broad_phase.sorted_afresh);
    w_.member("pairs of boxes that meet", std::uint64_t{s.queries.size()});
    end();
  }

  void counters(const CrowdStep& s) {
    const Counters c = sum(s);
    begin("bodies", "counter", "C", 0, {clock_, 0});
    w_.member("in contact", std::uint64_t{bodies_in_contact(s, run_.motion.body_count())});
    end();
    begin("pairs of bodies", "counter", "C", 0, {clock_, 0});
    w_.member("boxes meet", std::uint64_t{s.queries.size()});
    w_.member("crossing", std::uint64_t{count(s, Relation::crossing)});
    end();
    begin("work", "counter", "C", 0, {clock_, 0});
    w_.member("face tests", c.face_tests).member("refinements", c.refinements);
    end();
  }

  /// Writes a query on the tracks of both bodies, or on the thread's.
  void query(const CrowdQuery& q, const Span& span) {
    if (wall_) {
      slice(q, span, kFirst + q.thread, run_.names[q.bodies.i] + " - " + run_.names[q.bodies.j]);
      return;
    }
    slice(q, span, kFirst + q.bodies.i, run_.names[q.bodies.j]);
    slice(q, span, kFirst + q.bodies.j, run_.names[q.bodies.i]);
  }

  void slice(const CrowdQuery& q, const Span& span, std::uint32_t track, const std::string& name) {
    const trace::StepResult& r = q.result;
    const Counters& c = r.counters;
    begin(name, trace::name_of(r.relation), "X", track, span);
    w_.member("time step", index_).member("A", run_.names[q.bodies.i]).member("B", run_.names[q.bodies.j]);
    w_.member("relation", trace::name_of(r.relation)).member("pairs", r.pair_count);
    w_.member("fingerprint", trace::to_hex(r.fingerprint));
    if (crowd_.request.contacts) w_.member("contact regions", q.contact_regions);
    for (const QueryCounter& counter : kQueryCounters) w_.member(counter.name, c.*counter.member);
    measures(r);
    end();
  }

  void measures(const trace::StepResult& r) {
    const auto interval = [&](std::string_view key, double lower, double upper) {
      w_.key(key).begin_array().value(lower).value(upper).end_array();
    };
    if (r.distance) interval("distance", r.distance->lower, r.distance->upper);
    if (r.clash) w_.member("contact kind", trace::name_of(r.clash->kind));
    if (r.clash && r.clash->depth) interval("depth", (*r.clash->depth)[0], (*r.clash->depth)[1]);
    if (r.near) w_.member("near pairs", r.near->pairs);
  }

  void metadata() {
    w_.begin_object().member("lrbscope", trace::lrbscope_version()).member("format", kCrowdFormat);
    w_.member("version", kCrowdVersion).member("clock", trace::name_of(crowd_.clock));
    w_.key("crowd").begin_object().member("name", crowd_.name).member("hash", trace::to_hex(crowd_.hash));
    w_.end_object().key("request");
    trace::write_json(w_, crowd_.request);
    const spec::StepQuestions& more = crowd_.more;
    if (more.distance || more.clash || more.near) {
      w_.key("measures").begin_object();
      w_.member("distance", more.distance).member("clash", more.clash);
      if (more.near) w_.member("near", *more.near);
      w_.end_object();
    }
    w_.key("room").begin_array();
    for (int axis = 0; axis < 3; ++axis) w_.value(crowd_.room[axis]);
    w_.end_array();
    write_kinds(w_, crowd_, run_);
    w_.member("steps", std::uint64_t{run_.steps.size()});
    poses();
    w_.key("query_slices").begin_object().member("stored", stored_).member("seen", seen_);
    w_.member("truncated", stored_ < seen_).end_object().end_object();
  }

  void poses() {
    w_.key("poses").begin_array();
    const std::uint64_t bodies = run_.motion.body_count();
    for (std::uint32_t i = 0; i < run_.steps.size() && (i + 1) * bodies <= crowd_.max_events; ++i) {
      w_.begin_array();
      for (std::uint32_t body = 0; body < bodies; ++body) trace::write_json(w_, run_.motion.pose(body, i));
      w_.end_array();
    }
    w_.end_array();
  }

  const spec::Crowd& crowd_;
  const CrowdRun& run_;
  trace::JsonOut out_;
  JsonWriter w_;
  bool wall_;
  double clock_ = 0;
  std::uint32_t index_ = 0;  ///< of the step
  std::uint64_t stored_ = 0, seen_ = 0;
};

}  // namespace

void write_crowd_trace(const spec::Crowd& crowd, const CrowdRun& run, trace::ByteSink& sink) {
  Writer(crowd, run, sink).run();
}

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

namespace {

std::uint32_t find_body(const std::vector<std::string>& names, const std::string& name,
                        const std::string& file) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end())
    throw InputError("--pair: " + file + " has no body " + printable_name(name) +
                     "; its bodies are named by kind and number, from " + names.front() + " to " +
                     names.back());
  return static_cast<std::uint32_t>(at - names.begin());
}

const spec::CrowdKind& kind_of(const spec::Crowd& crowd, std::uint32_t body) {
  std::size_t kind = 0;
  for (; body >= crowd.kinds[kind].count; ++kind) body -= crowd.kinds[kind].count;
  return crowd.kinds[kind];
}

}  // namespace

BodyPair find_pair(const CrowdTrace& trace, const std::string& names) {
  const std::size_t comma = names.find(',');
  if (comma == std::string::npos || names.find(',', comma + 1) != std::string::npos)
    throw InputError("--pair: expected the names of two bodies, such as \"gear 3,rock 5\", found " +
                     printable_name(names));
  const std::vector<std::string> all = body_names(trace.crowd);
  const std::uint32_t i = find_body(all, names.substr(0, comma), trace.file);
  const std::uint32_t j = find_body(all, names.substr(comma + 1), trace.file);
  if (i == j) throw InputError("--pair: expected two bodies, found " + all[i] + " twice");
  return {std::min(i, j), std::max(i, j)};
}

spec::Scenario scenario_of_pair(const CrowdTrace& trace, const BodyPair& pair, const std::string& path) {
  spec::Scenario s;
  const std::vector<std::string> names = body_names(trace.crowd);
  s.name = trace.crowd.name + "-" + names[pair.i] + "-" + names[pair.j];
  std::replace(s.name.begin(), s.name.end(), ' ', '_');
  s.purpose = names[pair.i] + " (A) and " + names[pair.j] + " (B) of the crowd " + trace.crowd.name + ".";
  Fnv64 hash;
  hash.add_value(trace.crowd.hash);
  for (const std::uint32_t body : {pair.i, pair.j}) {
    hash.add_value(body);
    s.bodies.emplace_back();
    s.bodies.back().file =
        (std::filesystem::path(path).parent_path() / (kind_of(trace.crowd, body).name + ".lrb")).string();
    std::vector<Pose>& poses = body == pair.i ? s.motion.of_a : s.motion.poses;
    for (const std::vector<Pose>& step : trace.poses) poses.push_back(step[body]);
  }
  s.hash = hash.value();
  s.motion.kind = spec::Motion::Kind::poses;
  s.request = trace.crowd.request;
  s.more = trace.crowd.more;
  s.request.contacts = s.request.mode == Mode::all_pairs;
  return s;
}

void check_answers(const CrowdTrace& trace, const BodyPair& pair, const run::Recording& recording) {
  for (std::size_t step = 0; step < trace.answers.size(); ++step) {
    const std::vector<CrowdTrace::Answer>& answers = trace.answers[step];
    const auto recorded = std::find_if(answers.begin(), answers.end(),
                                       [&](const CrowdTrace::Answer& a) { return a.bodies == pair; });
    const CollideResult& found = recording.results[step];
    // A pair that was not queried has disjoint boxes.
    const CrowdTrace::Answer answer{.bodies = pair,
                                    .relation = found.relation,
                                    .pairs = found.pairs.size(),
                                    .fingerprint = fingerprint(found.pairs)};
    if (recorded == answers.end() ? !found.pairs.empty() : *recorded != answer)
      throw InputError(trace.file + ": step " + std::to_string(step) +
                       ": the two bodies have another answer than the recorded one; the trace is damaged; "
                       "record it again");
  }
}

}  // namespace lrb::crowd
