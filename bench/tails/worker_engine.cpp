#include <algorithm>
#include <chrono>
#include <istream>
#include <sstream>

#include <nlohmann/json.hpp>
#include <poll.h>

#include "bench/tails/engine.hpp"
#include "bench/workers/child.hpp"
#include "bench/workers/worker_json.hpp"
#include "scenarios/io/poses.hpp"
#include <lrbscope/core/strings.hpp>
#include <lrbscope/error.hpp>

namespace lrb::tails {
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

}  // namespace lrb::tails
