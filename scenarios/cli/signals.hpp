#pragma once
/// How the program ends when it is told to.

namespace lrb::cli {

/// From now on SIGINT, SIGTERM and SIGHUP remove the files that were begun, say so in a line, and then end
/// the program as they would have without us, so that a shell sees what happened. Files that were finished
/// stay. Signals that the caller ignores stay ignored. Call it once, before any thread is started.
void end_cleanly_on_signals();

/// From now on an exception that nobody can catch, which is a std::bad_alloc in a destructor of nlohmann-json
/// (they allocate), removes the files that were begun and ends the program with a line and code 3.
void end_cleanly_on_terminate();

/// Nobody reads our stdout any more: ends the program silently as SIGPIPE does, or returns if the caller had
/// that signal ignored.
void end_as_by_closed_pipe();

}  // namespace lrb::cli
