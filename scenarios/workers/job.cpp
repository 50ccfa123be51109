#include "scenarios/workers/job.hpp"

#include <algorithm>
#include <cstring>

#include <nlohmann/json.hpp>
#include <poll.h>

#include "engine/core/error.hpp"

namespace lrb::workers {
namespace {

constexpr int kPatience = 3;  // number of cases in a row on which a method may hang
constexpr int kBadInput = 2;  // an exit code that does not count as a crash

std::string how_it_ended(int status) {
  if (status >= 0) return "ended with exit code " + std::to_string(status);
  const char* name = strsignal(-status);
  return "died of signal " + std::to_string(-status) +
         (name != nullptr ? std::string(" (") + name + ")" : "");
}

/// Returns a worker's complaint about what we asked, or nothing.
std::string complaint(const std::string& line) {
  if (line.compare(0, std::strlen("{\"error\""), "{\"error\"") != 0) return "";
  const auto value = nlohmann::json::parse(line, nullptr, false);
  return value.is_object() ? value.value("error", "") : "";
}

}  // namespace

void Job::start() {
  std::vector<std::string> command = task_.command;
  command.insert(command.end(), {"--begin", std::to_string(next_), "--end", std::to_string(task_.end)});
  child_.reset();
  if (next_ == task_.end) return;
  child_.emplace(command, task_.given);
  deadline_ = Clock::now() + task_.limit;
}

void Job::receive() {
  std::vector<std::string> lines;
  const bool more = child_->read(lines);
  for (const std::string& line : lines) {
    const std::string error = complaint(line);
    if (!error.empty()) throw EnvironmentError(task_.command.front() + ": " + error);
    if (next_ == task_.end) break;
    task_.on_line(next_++, line);
    hung_ = 0;
  }
  if (!lines.empty()) deadline_ = Clock::now() + task_.limit;
  if (more) return;
  const int status = child_->wait();
  if (status == kBadInput || status == kNoSuchProgram)
    throw EnvironmentError(task_.command.front() + ": " + how_it_ended(status) + "; build it again");
  if (next_ == task_.end)
    child_.reset();  // whatever became of it after its last line does not matter
  else
    go_on({false, how_it_ended(status)});
}

void Job::expire() {
  child_->kill();
  const double seconds = std::chrono::duration<double>(task_.limit).count();
  char text[64];
  std::snprintf(text, sizeof text, "no answer in %g s", seconds);
  go_on({true, text});
}

void Job::go_on(const Mishap& mishap) {
  task_.on_mishap(next_++, mishap);
  hung_ = mishap.timed_out ? hung_ + 1 : 0;
  if (hung_ == kPatience)
    while (next_ < task_.end)
      task_.on_mishap(next_++, {true, "not asked: " + mishap.message + " for " + std::to_string(kPatience) +
                                          " cases in a row"});
  start();
}

void run_to_end(Job job) {
  while (!job.done()) {
    pollfd waiting{job.output(), POLLIN, 0};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(job.deadline() - Job::Clock::now());
    if (poll(&waiting, 1, static_cast<int>(std::max<std::int64_t>(0, left.count()))) > 0)
      job.receive();
    else if (Job::Clock::now() > job.deadline())
      job.expire();
  }
}

}  // namespace lrb::workers
