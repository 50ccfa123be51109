#include <algorithm>
#include <chrono>

#include <poll.h>

#include "bench/tails/engine.hpp"
#include "bench/workers/child.hpp"
#include "bench/xray/foreign_walk.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/profile/check.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::tails {
namespace {

using Clock = std::chrono::steady_clock;

std::string how_it_ended(int status) {
  return status < 0 ? "was killed by signal " + std::to_string(-status)
                    : "exited with code " + std::to_string(status);
}

class CommandEngine : public Engine {
 public:
  CommandEngine(std::string command, BodyFiles files, std::chrono::duration<double> limit)
      : command_(std::move(command)), files_(std::move(files)), limit_(limit) {}

  std::string name() const override { return command_; }

  std::vector<EngineAnswer> ask(std::span<const Pose> poses, Wanted wanted,
                                const Progress& progress) override {
    std::vector<EngineAnswer> out;
    while (out.size() < poses.size()) {
      const auto some = poses.subspan(out.size(), std::min(kPosesAtOnce, poses.size() - out.size()));
      for (EngineAnswer& answer : answers(some, wanted)) out.push_back(std::move(answer));
      progress(out.size());
    }
    return out;
  }

  /// Runs the program once for these poses and returns its capture.
  std::vector<std::byte> recorded(std::span<const Pose> poses, bool events) const {
    const workers::MemoryFile requested("poses"), capture("capture");
    std::string text;
    for (const Pose& pose : poses) {
      for (const double x : io::rows_of(pose)) text.append(io::exact_text(x)).append(" ");
      text.back() = '\n';
    }
    requested.write(text);
    run(requested.path(), capture.path(), events);
    return capture.bytes();
  }

  std::vector<EngineAnswer> read(const std::vector<std::byte>& bytes, std::span<const Pose> poses,
                                 Wanted wanted) const;

 private:
  [[noreturn]] void complain(const std::string& what) const {
    throw InputError("--command " + printable_name(command_) + ": " + what);
  }

  std::vector<EngineAnswer> answers(std::span<const Pose> poses, Wanted wanted) const {
    return read(recorded(poses, wanted.tests || wanted.list || wanted.waste), poses, wanted);
  }

  /// Runs the program to its end.
  void run(const std::string& poses, const std::string& capture, bool events) const {
    // Its messages are read, for ours; its output is not.
    const std::string script = "export LRBCAP_OUT=\"$1\" LRBCAP_EVENTS=\"$2\"; shift 2; exec " + command_ +
                               " \"$@\" 2>&1 >/dev/null";
    workers::Child child(
        {"/bin/sh", "-c", script, "sh", capture, events ? "1" : "0", files_.a, files_.b, poses}, -1);
    const Clock::time_point deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(limit_);
    std::vector<std::string> lines;
    std::string last;
    while (true) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
      if (left.count() <= 0)
        complain("expected its end within " + io::number_text(limit_.count()) +
                 " s, found it still running; try a longer --timeout");
      pollfd waiting{child.output(), POLLIN, 0};
      if (poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 1000))) <= 0) continue;
      const bool more = child.read(lines);
      if (!lines.empty()) last = lines.back();
      lines.clear();
      if (!more) break;
    }
    const int status = child.wait();
    if (status != 0)
      complain("expected exit code 0, found that it " + how_it_ended(status) +
               (last.empty() ? "" : " after " + in_quotes(last, 200)));
  }

  /// Throws InputError unless the query was answered, for all pairs, at the pose.
  void check(const capture::Query& q, const Pose& pose) const {
    constexpr double kAlike = 1e-5;  // engines may keep poses in single precision
    const std::string query = "query " + std::to_string(q.number) + ": ";
    if (!q.ended) complain(query + "expected LRBCAP_END, found the end of the capture");
    if (q.kind != capture::QueryKind::all_pairs && q.kind != capture::QueryKind::any)
      complain(query + "expected a query for all pairs, found another kind");
    const Eigen::Matrix3d back = q.poses[0].r.transpose();
    const Eigen::Vector3d t = back * (q.poses[1].t - q.poses[0].t);
    if ((back * q.poses[1].r - pose.r).norm() > kAlike || (t - pose.t).norm() > kAlike * (1 + pose.t.norm()))
      complain(query + "expected the pose of line " + std::to_string(q.number) +
               ", found another; are matrices given row by row, and queries in the order of the poses?");
  }

  std::string command_;
  BodyFiles files_;
  std::chrono::duration<double> limit_;
};

std::vector<EngineAnswer> CommandEngine::read(const std::vector<std::byte>& bytes,
                                              std::span<const Pose> poses, Wanted wanted) const {
  if (bytes.empty())
    complain("expected a capture in $LRBCAP_OUT, found nothing; was it compiled with -DLRBCAP_ENABLE?");
  const capture::Capture c = [&] {
    try {
      return capture::parse_capture(bytes, "its capture");
    } catch (const InputError& e) {
      complain(e.what());
    }
  }();
  if (c.queries.size() != poses.size())
    complain("expected " + std::to_string(poses.size()) + " queries, one for each pose, found " +
             std::to_string(c.queries.size()));
  for (std::size_t i = 0; i < poses.size(); ++i) check(c.queries[i], poses[i]);
  return answers_of(c, wanted);
}

}  // namespace

std::string record_capture(const std::string& command, const BodyFiles& files,
                           std::chrono::duration<double> limit, const Pose& pose) {
  const CommandEngine engine(command, files, limit);
  const std::vector<std::byte> bytes = engine.recorded({&pose, 1}, true);
  engine.read(bytes, {&pose, 1}, {});  // refuses what is no capture of this pose
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

std::unique_ptr<Engine> command_engine(const std::string& command, const BodyFiles& files,
                                       std::chrono::duration<double> limit) {
  return std::make_unique<CommandEngine>(command, files, limit);
}

namespace {

class RecordedEngine : public Engine {
 public:
  RecordedEngine(std::string method, const LrbRep& a, const LrbRep& b)
      : method_(std::move(method)), a_(a), b_(b) {}

  std::string name() const override { return method_; }

  std::vector<EngineAnswer> ask(std::span<const Pose> poses, Wanted wanted,
                                const Progress& progress) override {
    std::vector<xray::PosePair> pairs;
    for (const Pose& pose : poses) pairs.push_back({{}, pose});
    std::vector<EngineAnswer> out = answers_of(xray::walk_of(method_, a_, b_, pairs), wanted);
    progress(out.size());
    return out;
  }

 private:
  std::string method_;
  const LrbRep &a_, &b_;
};

}  // namespace

std::unique_ptr<Engine> recorded_engine(const std::string& method, const LrbRep& a, const LrbRep& b) {
  return std::make_unique<RecordedEngine>(method, a, b);
}

std::vector<EngineAnswer> answers_of(const capture::Capture& capture, Wanted wanted) {
  std::vector<EngineAnswer> out;
  for (const capture::Query& q : capture.queries) out.push_back(answer_of(q, capture.names, wanted.list));
  if (!wanted.waste) return out;
  const profile::Check checked = profile::check(capture, {.precision = {}, .split = false});
  for (std::size_t i = 0; i < out.size(); ++i) {
    const profile::Prices& prices = checked.queries[i].prices;
    out[i].wasted = prices.wasted() + prices.triangle_tests_for_nothing;
  }
  return out;
}

EngineAnswer answer_of(const capture::Query& query, const std::vector<std::string>& names, bool list) {
  using capture::EventKind;
  EngineAnswer out;
  out.us = query.duration_ns / 1e3;
  out.pairs = query.pairs;
  if (query.complete()) {
    methods::TestCounts counts;
    std::uint64_t* phase = nullptr;
    for (const capture::Event& e : query.events) {
      std::uint64_t tests = 0;
      if (e.kind == EventKind::nodes) counts.boxes += tests = e.tests;
      if (e.kind == EventKind::triangles) counts.faces += tests = 1;
      if (e.kind == EventKind::phase)
        phase = &out.phases[e.a < names.size() ? names[e.a] : "phase " + std::to_string(e.a)];
      if (phase != nullptr) *phase += tests;
      if (list && e.kind == EventKind::triangles && e.met != 0)
        out.list.push_back({SimplexId(e.a), SimplexId(e.b)});
    }
    // Every query tests something: without tests, they were not recorded.
    if (counts.boxes + counts.faces > 0) {
      out.kinds = counts;
      out.tests = counts.boxes + counts.faces;
    } else {
      out.phases.clear();
    }
    std::sort(out.list.begin(), out.list.end());
  } else if (query.events_seen > 0) {
    out.tests = query.events_seen;
  }
  return out;
}

}  // namespace lrb::tails
