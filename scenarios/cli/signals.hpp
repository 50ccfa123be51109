#pragma once
/// Ends the program in order when it is told to end.

namespace lrb::cli {

/// Installs handlers so that SIGINT, SIGTERM and SIGHUP remove the files that were begun, say so in a line,
/// and then end the program as they would have done by themselves: a shell sees what happened. Finished files
/// stay. Signals that the caller ignores stay ignored. Call it once, before any thread is started.
void end_cleanly_on_signals();

/// Installs a handler so that an exception that nobody can catch removes the files that were begun and ends
/// the program with a line and code 3. (It is a std::bad_alloc in a destructor of nlohmann-json; these
/// allocate.)
void end_cleanly_on_terminate();

/// Ends the program silently, as SIGPIPE does, because nobody reads its stdout any more; returns if the
/// caller had that signal ignored.
void end_as_by_closed_pipe();

}  // namespace lrb::cli
