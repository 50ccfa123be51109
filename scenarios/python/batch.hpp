#pragma once

#include <cstddef>
#include <functional>

namespace lrb::python {

/// Returns the number of threads that an argument stands for: 0 as many as the machine runs at once, but one
/// in a process that was forked from the one that loaded the module. Threads do not survive a fork, and who
/// forks has processes for all cores.
unsigned threads_of(std::size_t asked);

/// Calls work(i, worker) for i = 0 .. n - 1 on threads_of(asked) threads without the lock of Python, which
/// must be held when this is called. Looks for signals meanwhile: after Ctrl-C calls that have not begun are
/// left out, and KeyboardInterrupt comes out.
void run_batch(std::size_t n, unsigned threads,
               const std::function<void(std::size_t i, unsigned worker)>& work);

/// Throws what signal handlers raised, such as KeyboardInterrupt. Takes the lock of Python.
void check_signals();

}  // namespace lrb::python
