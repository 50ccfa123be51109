#include "bench/engines/engine.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "bench/methods/triangles.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/profile/check.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::engines {

using methods::Answer;

// Methods in worker programs.

namespace {

class WorkerEngine : public Engine {
 public:
  WorkerEngine(const workers::WorkerMethod& method, const std::string& a, const std::string& b,
               std::chrono::duration<double> limit)
      : name_(method.info.name),
        bodies_{{"bodies", {a, b}}},
        limit_(limit),
        worker_(method.command,
                {bodies_.dump(), kBuild, "method '" + name_ + "': cannot build the two bodies: "}) {}

  std::string name() const override { return name_; }

  std::vector<Answer> ask(std::span<const Pose> poses, Wanted wanted, const Progress& progress) override {
    std::vector<Answer> out;
    worker_.run({0, poses.size(), [&](std::uint64_t k) { return question(poses[k], wanted); }, limit_,
                 [&](std::uint64_t, const std::string& line) {
                   out.push_back(workers::answer_from(nlohmann::json::parse(line)));
                   progress(out.size());
                 },
                 [&](std::uint64_t, const workers::WorkerFailure& failure) {
                   workers::note_failure(out.emplace_back(), failure);
                   progress(out.size());
                 }});
    return out;
  }

 private:
  static constexpr std::chrono::seconds kBuild{600};  // time to read and build the bodies

  std::string question(const Pose& pose, Wanted wanted) const {
    nlohmann::json out = bodies_;
    out["b"] = io::rows_of(pose);
    out["tests"] = wanted.tests;
    out["list"] = wanted.list;
    return out.dump();
  }

  std::string name_;
  nlohmann::json bodies_;
  std::chrono::duration<double> limit_;
  workers::Worker worker_;
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

  std::vector<Answer> ask(std::span<const Pose> poses, Wanted wanted, const Progress& progress) override {
    std::vector<Answer> out;
    while (out.size() < poses.size()) {
      const auto some = poses.subspan(out.size(), std::min(kPosesAtOnce, poses.size() - out.size()));
      for (Answer& answer : answers(some, wanted)) out.push_back(std::move(answer));
      progress(out.size());
    }
    return out;
  }

 private:
  [[noreturn]] void complain(const std::string& what) const {
    throw InputError(printable_name(name()) + ": " + what);
  }

  /// Runs the program once for these poses.
  std::vector<Answer> answers(std::span<const Pose> poses, Wanted wanted) const {
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

  std::vector<Answer> read(const std::string& bytes, std::span<const Pose> poses, Wanted wanted) const {
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
    std::vector<Answer> out;
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
    using Clock = workers::Worker::Clock;
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
    const Pose found = methods::relative(q.poses[0], q.poses[1]);
    if ((found.r - pose.r).norm() > kAlike || (found.t - pose.t).norm() > kAlike * (1 + pose.t.norm()))
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

Answer answer_of(const capture::Query& query, const std::vector<std::string>& names, bool list) {
  using capture::EventKind;
  Answer out;
  out.microseconds = query.duration_ns / 1e3;
  out.count = query.pairs;
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
        out.pairs.push_back({SimplexId(e.a), SimplexId(e.b)});
    }
    // Every query tests something: without tests, they were not recorded.
    if (counts.boxes + counts.faces > 0) {
      out.kinds = counts;
      out.tests = counts.boxes + counts.faces;
    } else {
      out.phases.clear();
    }
    std::sort(out.pairs.begin(), out.pairs.end());
  } else if (query.events_seen > 0) {
    out.tests = query.events_seen;
  }
  return out;
}

}  // namespace lrb::engines
