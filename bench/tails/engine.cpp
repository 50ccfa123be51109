#include "bench/tails/engine.hpp"

#include <algorithm>
#include <chrono>
#include <istream>
#include <sstream>

#include <nlohmann/json.hpp>
#include <poll.h>

#include "bench/methods/triangles.hpp"
#include "bench/workers/worker_json.hpp"
#include "bench/workers/workers.hpp"
#include "bench/xray/foreign_walk.hpp"
#include "scenarios/io/poses.hpp"
#include "scenarios/profile/check.hpp"
#include <lrbscope/core/file.hpp>
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>
#include <lrbscope/workspace.hpp>

namespace lrb::tails {

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

using Clock = std::chrono::steady_clock;

constexpr int kTests = 1, kList = 2;
constexpr std::string_view kReady = "{\"ready\":true}\n";  // the worker's first line

class WorkerEngine : public Engine {
 public:
  WorkerEngine(const workers::WorkerMethod& method, const BodyFiles& files,
               std::chrono::duration<double> limit)
      : name_(method.info.name), limit_(std::chrono::duration_cast<Clock::duration>(limit)) {
    command_ = {method.program, "--method", name_, "--bodies", files.a, files.b};
    if (files.corners == bodies::Corners::apart) command_.emplace_back("--no-join");
  }

  std::string name() const override { return name_; }

  std::vector<EngineAnswer> ask(std::span<const Pose> poses, Wanted wanted,
                                const Progress& progress) override {
    std::vector<EngineAnswer> out;
    std::size_t requested = 0;
    int late = 0;  // consecutive poses without an answer in time
    while (out.size() < poses.size()) {
      if (!child_) {
        start();
        requested = 0;
      }
      requested = std::max(requested, out.size());
      for (; requested < poses.size() && requested < out.size() + kAhead; ++requested)
        pipe_->write(request_line(poses[requested], wanted));
      std::vector<std::string> lines;
      const std::string failure = wait_for_lines(limit_, lines);
      for (const std::string& line : lines) out.push_back(reply_from(line));
      if (failure.empty()) {
        late = 0;
      } else {
        // The first pose without an answer has ended the worker.
        child_.reset();
        out.emplace_back().failure = failure;
        late = failure == kLate ? late + 1 : 0;
      }
      if (late == kMaxLate)
        while (out.size() < poses.size())
          out.emplace_back().failure = "skipped after three poses in a row without an answer in time";
      progress(out.size());
    }
    return out;
  }

 private:
  /// Requests sent ahead of their answers, so that the worker does not wait between two queries. They fit the
  /// buffer of a pipe.
  static constexpr std::size_t kAhead = 64;
  static constexpr int kMaxLate = 3;
  static constexpr std::chrono::seconds kBuild{600};  // time to read and build the bodies
  static constexpr const char* kLate = "no answer in time";

  /// Starts the worker and waits until it has built the bodies. Requests that the last one left unanswered
  /// are lost with its pipe.
  void start() {
    pipe_.emplace();
    child_.emplace(command_, pipe_->reading_end());
    std::vector<std::string> lines;
    const std::string failure = wait_for_lines(kBuild, lines);
    if (!failure.empty())
      throw InputError("method '" + name_ + "': expected trees of the two bodies, found that its worker " +
                       failure + " while it built them");
    if (lines.front() + "\n" != kReady)
      throw InputError("method '" + name_ + "': " + error_in(lines.front()));
  }

  static std::string error_in(const std::string& line) {
    const auto value = nlohmann::json::parse(line, nullptr, false);
    return value.is_object() ? value.value("error", "") : "";
  }

  /// Waits for lines. Returns what happened instead, or an empty text.
  std::string wait_for_lines(Clock::duration limit, std::vector<std::string>& lines) {
    const Clock::time_point deadline = Clock::now() + limit;
    while (lines.empty()) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
      if (left.count() <= 0) return kLate;
      pollfd waiting{child_->output(), POLLIN, 0};
      if (poll(&waiting, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 1000))) <= 0) continue;
      if (child_->read(lines) || !lines.empty()) continue;
      const int status = child_->wait();
      if (status == workers::kNoSuchProgram)
        throw EnvironmentError(command_.front() + ": cannot be started; rebuild it");
      return status < 0 ? "was killed by signal " + std::to_string(-status)
                        : "exited with code " + std::to_string(status);
    }
    return "";
  }

  std::string name_;
  Clock::duration limit_;
  std::vector<std::string> command_;
  std::optional<workers::Pipe> pipe_;
  std::optional<workers::Child> child_;
};

}  // namespace

std::unique_ptr<Engine> worker_engine(const workers::WorkerMethod& method, const BodyFiles& files,
                                      std::chrono::duration<double> limit) {
  return std::make_unique<WorkerEngine>(method, files, limit);
}

std::string request_line(const Pose& pose, Wanted wanted) {
  std::string out = std::to_string((wanted.tests ? kTests : 0) + (wanted.list ? kList : 0));
  for (const double x : io::rows_of(pose)) out.append(" ").append(io::exact_text(x));
  return out + "\n";
}

std::string reply_line(const EngineAnswer& answer) {
  nlohmann::ordered_json out;
  if (!answer.failure.empty()) {
    out["failure"] = answer.failure;
  } else {
    out["us"] = answer.us;
    out["pairs"] = answer.pairs;
    if (answer.kinds) {
      out["boxes"] = answer.kinds->boxes;
      out["faces"] = answer.kinds->faces;
    }
    if (!answer.list.empty()) out["list"] = workers::PairsJson::write(answer.list);
  }
  return out.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

EngineAnswer reply_from(const std::string& line) {
  EngineAnswer out;
  try {
    const auto value = nlohmann::json::parse(line);
    if (const auto failure = value.find("failure"); failure != value.end()) {
      out.failure = failure->get<std::string>();
      return out;
    }
    out.us = value.at("us");
    out.pairs = value.at("pairs");
    if (value.contains("boxes")) {
      out.kinds = methods::TestCounts{value.at("boxes"), value.at("faces")};
      out.tests = out.kinds->boxes + out.kinds->faces;
    }
    if (value.contains("list")) out.list = workers::PairsJson::read(value.at("list"));
  } catch (const nlohmann::json::exception& e) {
    throw InputError(std::string("a worker's reply: ") + e.what());
  }
  return out;
}

void serve(const methods::MethodEntry& entry, const BodyFiles& files, std::istream& requests,
           const std::function<void(const std::string& line)>& say) {
  const auto loaded = bodies::load_faces_of_two(files.a, files.b, files.corners);
  const std::unique_ptr<methods::Method> method = entry.make();
  const auto a = method->build(loaded[0].rep), b = method->build(loaded[1].rep);
  say(std::string(kReady));
  for (std::string line; std::getline(requests, line);) {
    std::istringstream in(line);
    int bits = 0;
    std::array<double, 12> rows{};
    in >> bits;
    for (double& x : rows) in >> x;
    if (!in) throw InputError("expected a request, found '" + line + "'");
    const Pose pose = io::pose_of(rows);
    EngineAnswer answer;
    try {
      methods::MethodAnswer found = method->query(*a, Pose{}, *b, pose, Mode::all_pairs);
      answer.us = found.microseconds;
      answer.pairs = found.pairs.size();
      if ((bits & kTests) != 0) answer.kinds = method->count_tests(*a, Pose{}, *b, pose);
      if ((bits & kList) != 0) answer.list = std::move(found.pairs);
    } catch (const std::exception& e) {
      answer.failure = e.what();
    }
    say(reply_line(answer));
  }
}

// Programs that record captures.

namespace {

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
