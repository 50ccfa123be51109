#include "scenarios/cli/progress.hpp"

#include <cstdlib>
#include <iostream>
#include <memory>

#include <unistd.h>

namespace lrb::cli {
namespace {

/// Returns true if colours are not wanted (https://no-color.org): the variable is set and not empty.
bool colour_wanted() {
  const char* no_colour = std::getenv("NO_COLOR");
  const char* terminal = std::getenv("TERM");
  return (no_colour == nullptr || *no_colour == '\0') && terminal != nullptr &&
         std::string(terminal) != "dumb";
}

}  // namespace

Progress::Progress(std::string label, std::uint64_t total, bool quiet)
    : label_(std::move(label)),
      total_(total),
      enabled_(!quiet && ::isatty(STDERR_FILENO) == 1),
      colour_(colour_wanted()),
      begin_(std::chrono::steady_clock::now()),
      last_(begin_) {}

void Progress::set(std::uint64_t done, const std::string& detail) {
  if (!enabled_) return;
  constexpr std::chrono::milliseconds kBetweenDrawings(80);
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < kBetweenDrawings && done != total_) return;
  last_ = now;
  drawn_ = true;
  std::string line = label_ + " ";
  if (total_ > 0) {
    constexpr std::uint64_t kWidth = 28;
    const std::uint64_t full = std::min(kWidth, kWidth * done / total_);
    std::string bar;
    for (std::uint64_t i = 0; i < kWidth; ++i) bar += i < full ? "#" : ".";
    line += (colour_ ? "\033[36m" + bar + "\033[0m" : bar) + " " + std::to_string(done) + "/" +
            std::to_string(total_);
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    if (done > 0 && elapsed > 1) {
      const double left =
          elapsed * static_cast<double>(total_ - std::min(done, total_)) / static_cast<double>(done);
      line += ", " + std::to_string(static_cast<int>(left + 0.5)) + " s left";
    }
  } else {
    line += std::to_string(done);
  }
  if (!detail.empty()) line += ", " + detail;
  std::cerr << "\r\033[K" << line << std::flush;
}

void Progress::finish() {
  if (drawn_) std::cerr << "\r\033[K" << std::flush;
  drawn_ = false;
}

run::ProgressReport progress_report(bool quiet) {
  struct Parts {
    std::string what;
    std::unique_ptr<Progress> bar;
  };
  return [quiet, parts = std::make_shared<Parts>()](const std::string& what, std::uint64_t done,
                                                    std::uint64_t total) {
    if (what != parts->what) {
      parts->bar = std::make_unique<Progress>(what, total, quiet);
      parts->what = what;
    }
    parts->bar->set(done);
  };
}

}  // namespace lrb::cli
