#pragma once
/// Orderly termination of the program, its progress, and the pipes that it reads.

#include <chrono>
#include <cstdint>
#include <string>

#include "scenarios/record/recorded_run.hpp"
#include <lrbscope/build.hpp>

namespace lrb::tools {

/// A progress bar on stderr, removed when the work is done. If stderr is not a terminal, a line every ten
/// seconds instead.
class Progress {
 public:
  /// `total` 0: not known; a counter is drawn instead of a bar.
  Progress(std::string label, std::uint64_t total, bool quiet);
  ~Progress() { finish(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void set(std::uint64_t done, const std::string& detail = {});
  void set_total(std::uint64_t total) { total_ = total; }
  /// Returns a function that sets all of it.
  auto setter() {
    return [this](std::uint64_t done, std::uint64_t total, const std::string& detail) {
      set_total(total);
      set(done, detail);
    };
  }
  /// Shows a share of the work, from 0 to 1, as a percentage instead of a number out of the total.
  void set_share(double share, const std::string& detail = {});
  void finish();

 private:
  std::string label_;
  std::uint64_t total_;
  bool enabled_, terminal_, colour_, drawn_ = false, shares_ = false;
  std::chrono::steady_clock::time_point begin_, last_;
};

/// Returns a function that draws the progress of a job of several parts, one bar per part.
record::ProgressReport progress_report(bool quiet);

/// Returns the options with a progress bar for the build, removed when the last copy of them is destroyed.
/// Bodies that are built at the same time share it.
BuildOptions with_progress(BuildOptions options, bool quiet);

/// Installs handlers for SIGINT, SIGTERM and SIGHUP that remove unfinished files, print a line, and then end
/// the program by the same signal, so that a shell sees the cause. Finished files stay. Signals that the
/// caller ignores stay ignored. Call it once, before any thread is started.
void end_cleanly_on_signals();

/// Replaces the end of that line, which says what an interrupted command leaves and how to continue it.
void say_when_interrupted(const std::string& what);

/// While an object of this class exists, the first of these signals is noted instead of ending the program;
/// the next one ends it. At most one object exists at a time.
class StopSignal {
 public:
  /// Throws EnvironmentError if the system has no more file descriptors.
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  /// Returns a descriptor that can be read once a signal has arrived.
  int descriptor() const { return descriptor_; }
  bool has_arrived() const;

 private:
  int descriptor_;
};

/// Installs a handler for an exception that cannot be caught: it removes unfinished files and ends the
/// program with a line and code 3. (The known case is a std::bad_alloc in a destructor of nlohmann-json;
/// these allocate.)
void end_cleanly_on_terminate();

/// Ends the program silently, as SIGPIPE does, because the reader of its stdout has closed it. Returns if the
/// caller had that signal ignored.
void end_as_by_closed_pipe();

/// Replaces an anonymous pipe that this process reads, such as /dev/stdin or that of <(...), by its contents,
/// so that it can be read repeatedly. Leaves other paths alone. Throws EnvironmentError if there is no room.
void hold_pipe(const std::string& path);

}  // namespace lrb::tools
