#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "scenarios/run/recorded_run.hpp"

namespace lrb::cli {

/// A progress bar on stderr, drawn on a terminal only, and removed when the work is done.
class Progress {
 public:
  /// `total` 0: not known; a counter is drawn instead of a bar.
  Progress(std::string label, std::uint64_t total, bool quiet);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void set(std::uint64_t done, const std::string& detail = {});
  void set_total(std::uint64_t total) { total_ = total; }
  void finish();

 private:
  std::string label_;
  std::uint64_t total_;
  bool enabled_, colour_, drawn_ = false;
  std::chrono::steady_clock::time_point begin_, last_;
};

/// Returns a function that draws the progress of a job of several parts, a bar for each.
run::ProgressReport progress_report(bool quiet);

}  // namespace lrb::cli
