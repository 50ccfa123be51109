#include "bench/engines/engine.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/profile/check.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::engines {

// lrbscope itself.

namespace {

class OurEngine : public Engine {
 public:
  OurEngine(const LrbRep& a, const LrbRep& b) : a_(a), b_(b) {}

  std::string name() const override { return "ours"; }

  std::vector<EngineAnswer> ask(std::span<const Pose> poses, Wanted wanted,
                                const Progress& progress) override {
    std::vector<EngineAnswer> out;
    for (const Pose& pose : poses) {
      const methods::Stopwatch watch;
      CollideResult result = std::move(collide(a_, Pose{}, b_, pose, CollideRequest{}, workspace_).value());
      EngineAnswer& answer = out.emplace_back();
      answer.us = watch.microseconds();
      answer.pairs = result.pairs.size();
      // All pairs of faces that a pair of leaves compares count, as in other engines.
      answer.kinds = {result.counters.box_tests,
                      std::max(result.counters.prefilter_tests, result.counters.face_tests)};
      answer.tests = answer.kinds->boxes + answer.kinds->faces;
      if (wanted.list) answer.list = std::move(result.pairs);
      progress(out.size());
    }
    return out;
  }

 private:
  const LrbRep &a_, &b_;
  Workspace workspace_;
};

}  // namespace

std::unique_ptr<Engine> our_engine(const LrbRep& a, const LrbRep& b) {
  return std::make_unique<OurEngine>(a, b);
}

// Methods in worker programs.

namespace {

using Clock = workers::Worker::Clock;

class WorkerEngine : public Engine {
 public:
  WorkerEngine(const workers::WorkerMethod& method, const std::string& a, const std::string& b,
               std::chrono::duration<double> limit)
      : program_(method.program), name_(method.info.name), bodies_{{"bodies", {a, b}}}, limit_(limit) {}

  std::string name() const override { return name_; }

  std::vector<EngineAnswer> ask(std::span<const Pose> poses, Wanted wanted,
                                const Progress& progress) override {
    std::vector<EngineAnswer> out;
    std::size_t requested = 0;
    int late = 0;  // consecutive poses without an answer in time
    while (out.size() < poses.size()) {
      if (!worker_) {
        start();
        requested = out.size();
      }
      for (; requested < poses.size() && requested < out.size() + kAhead; ++requested)
        worker_->ask(question(poses[requested], wanted));
      workers::WorkerFailure failure;
      if (const auto line = worker_->answer(limit_, failure)) {
        out.push_back(answer_from(*line));
        late = 0;
      } else {
        worker_.reset();  // with its unanswered questions
        out.emplace_back().failure = failure.message;
        late = failure.timed_out ? late + 1 : 0;
      }
      if (late == kMaxLate)
        while (out.size() < poses.size())
          out.emplace_back().failure = "skipped after three poses in a row without an answer in time";
      progress(out.size());
    }
    return out;
  }

 private:
  /// Questions sent ahead of their answers, so that the worker does not wait between two queries. They fit
  /// the buffer of a pipe.
  static constexpr std::size_t kAhead = 16;
  static constexpr int kMaxLate = 3;
  static constexpr std::chrono::seconds kBuild{600};  // time to read and build the bodies

  void start() {
    worker_.emplace(std::vector<std::string>{program_, "--method", name_});
    worker_->ask(bodies_.dump());
    workers::WorkerFailure failure;
    const auto line = worker_->answer(kBuild, failure);
    const std::string why = line ? workers::error_in(*line) : failure.message;
    if (!why.empty()) throw InputError("method '" + name_ + "': cannot build the two bodies: " + why);
  }

  std::string question(const Pose& pose, Wanted wanted) const {
    nlohmann::json out = bodies_;
    out["b"] = io::rows_of(pose);
    out["tests"] = wanted.tests;
    out["list"] = wanted.list;
    return out.dump();
  }

  static EngineAnswer answer_from(const std::string& line) {
    EngineAnswer out;
    const auto value = nlohmann::json::parse(line);
    out.failure = value.value("failure", workers::error_in(line));
    if (!out.answered()) return out;
    out.us = value.at("us");
    out.pairs = value.at("pairs");
    if (value.contains("boxes")) {
      out.kinds = methods::TestCounts{value.at("boxes"), value.at("faces")};
      out.tests = out.kinds->boxes + out.kinds->faces;
    }
    if (value.contains("list")) out.list = workers::PairsJson::read(value.at("list"));
    return out;
  }

  std::string program_, name_;
  nlohmann::json bodies_;
  std::chrono::duration<double> limit_;
  std::optional<workers::Worker> worker_;
};

}  // namespace

std::unique_ptr<Engine> worker_engine(const workers::WorkerMethod& method, const std::string& a,
                                      const std::string& b, std::chrono::duration<double> limit) {
  return std::make_unique<WorkerEngine>(method, a, b, limit);
}

// Programs that record captures.

namespace {

class CommandEngine : public Engine {
 public:
  CommandEngine(std::string command, std::string a, std::string b, std::chrono::duration<double> limit)
      : command_(std::move(command)), a_(std::move(a)), b_(std::move(b)), limit_(limit) {}

  std::string name() const override { return "command:" + command_; }

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

 private:
  [[noreturn]] void complain(const std::string& what) const {
    throw InputError(printable_name(name()) + ": " + what);
  }

  /// Runs the program once for these poses.
  std::vector<EngineAnswer> answers(std::span<const Pose> poses, Wanted wanted) const {
    const workers::MemoryFile requested("poses"), capture("capture");
    std::string text;
    for (const Pose& pose : poses) {
      for (const double x : io::rows_of(pose)) text.append(io::exact_text(x)).append(" ");
      text.back() = '\n';
    }
    requested.write(text);
    run(requested.path(), capture.path(), wanted.tests || wanted.list || wanted.waste);
    return read(read_file(capture.path()), poses, wanted);
  }

  std::vector<EngineAnswer> read(const std::string& bytes, std::span<const Pose> poses, Wanted wanted) const {
    if (bytes.empty())
      complain("expected a capture in $LRBCAP_OUT, found nothing; was it compiled with -DLRBCAP_ENABLE?");
    const capture::Capture c = [&] {
      try {
        return capture::parse_capture(std::as_bytes(std::span(bytes)), "its capture");
      } catch (const InputError& e) {
        complain(e.what());
      }
    }();
    if (c.queries.size() != poses.size())
      complain("expected " + std::to_string(poses.size()) + " queries, one for each pose, found " +
               std::to_string(c.queries.size()));
    for (std::size_t i = 0; i < poses.size(); ++i) check(c.queries[i], poses[i]);
    std::vector<EngineAnswer> out;
    for (const capture::Query& q : c.queries) out.push_back(answer_of(q, c.names, wanted.list));
    if (!wanted.waste) return out;
    const profile::Check checked = profile::check(c, {.precision = {}, .split = false});
    for (std::size_t i = 0; i < out.size(); ++i) {
      const profile::Prices& prices = checked.queries[i].prices;
      out[i].wasted = prices.wasted() + prices.triangle_tests_for_nothing;
    }
    return out;
  }

  /// Runs the program to its end.
  void run(const std::string& poses, const std::string& capture, bool events) const {
    // Its messages are read, for ours; its output is not.
    const std::string script = "export LRBCAP_OUT=\"$1\" LRBCAP_EVENTS=\"$2\"; shift 2; exec " + command_ +
                               " \"$@\" 2>&1 >/dev/null";
    workers::Child child({"/bin/sh", "-c", script, "sh", capture, events ? "1" : "0", a_, b_, poses}, -1);
    const Clock::time_point deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(limit_);
    std::string last;
    auto next = workers::Child::Next::line;
    while (next == workers::Child::Next::line) next = child.next_line(deadline, last);
    if (next == workers::Child::Next::late)
      complain("expected its end within " + io::number_text(limit_.count()) +
               " s, found it still running; try a longer --timeout");
    const int status = child.wait();
    if (status != 0)
      complain("expected exit code 0, found: " + workers::text_of_end(status) +
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

  std::string command_, a_, b_;
  std::chrono::duration<double> limit_;
};

}  // namespace

std::unique_ptr<Engine> command_engine(const std::string& command, const std::string& a, const std::string& b,
                                       std::chrono::duration<double> limit) {
  return std::make_unique<CommandEngine>(command, a, b, limit);
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

}  // namespace lrb::engines
