#include "scenarios/cli/signals.hpp"

#include <csignal>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>

#include <unistd.h>

#include "engine/core/atomic_file.hpp"
#include "scenarios/cli/command.hpp"

namespace lrb::cli {
namespace {

constexpr std::string_view kOutOfMemoryLine =
    "lrbscope: out of memory: try a smaller input or a larger machine\n";

bool pipes_end_us = false;

bool is_ignored(int signal) {
  struct sigaction now {};
  return sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// Ends the process by the signal itself.
void die_of(int signal) {
  sigset_t only;
  sigemptyset(&only);
  sigaddset(&only, signal);
  std::signal(signal, SIG_DFL);
  pthread_sigmask(SIG_UNBLOCK, &only, nullptr);
  std::raise(signal);
}

std::string farewell(int signal) {
  const char* name = signal == SIGINT ? "SIGINT" : signal == SIGTERM ? "SIGTERM" : "SIGHUP";
  const char* clear = isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";  // there may be a progress bar
  return std::string(clear) + "lrbscope: interrupted by " + name +
         ": files written so far are whole, the others are missing; run it again\n";
}

/// Runs on a thread, which may take locks and allocate, as a signal handler may not.
void wait_for(const sigset_t& signals) {
  int signal = 0;
  if (sigwait(&signals, &signal) != 0) return;
  abandon_atomic_files();
  const std::string line = farewell(signal);
  if (write(STDERR_FILENO, line.data(), line.size()) < 0) {
    // There is nobody left to tell.
  }
  die_of(signal);
}

/// There may be no memory left, so nothing here takes any.
[[noreturn]] void say_why_and_end() {
  std::string_view line = "lrbscope: internal error, please report it: std::terminate was called\n";
  try {
    if (std::current_exception()) throw;
  } catch (const std::bad_alloc&) {
    line = kOutOfMemoryLine;
  } catch (...) {
    // The line above says all we know.
  }
  abandon_atomic_files();
  if (write(STDERR_FILENO, line.data(), line.size()) < 0) {
    // There is nobody left to tell.
  }
  _exit(kEnvironment);
}

}  // namespace

void end_cleanly_on_terminate() {
  std::set_terminate(say_why_and_end);
}

void end_cleanly_on_signals() {
  pipes_end_us = !is_ignored(SIGPIPE);
  std::signal(SIGPIPE, SIG_IGN);  // writing fails with EPIPE instead, where we can act on it
  sigset_t signals, before;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (!is_ignored(signal)) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, &before);
  try {
    std::thread(wait_for, signals).detach();
  } catch (const std::system_error&) {  // no thread can be started: the signals then end us at once, as
                                        // without us
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
}

void end_as_by_closed_pipe() {
  if (!pipes_end_us) return;
  abandon_atomic_files();
  die_of(SIGPIPE);
}

}  // namespace lrb::cli
