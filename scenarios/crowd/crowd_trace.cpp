#include "scenarios/crowd/crowd_trace.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include "trace/trace_json_parts.hpp"
#include <lrbscope/trace/json_write.hpp>
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

}  // namespace lrb::crowd
