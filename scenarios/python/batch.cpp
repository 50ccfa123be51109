#include "scenarios/python/batch.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include <pybind11/pybind11.h>
#include <unistd.h>

#include "engine/core/parallel.hpp"

namespace lrb::python {
namespace py = pybind11;
namespace {

const pid_t loaded_by = getpid();

/// Work on a thread of its own, so that the one that Python's signals come to can wait for either.
class Batch {
 public:
  Batch(std::size_t n, unsigned threads, const std::function<void(std::size_t, unsigned)>& work)
      : thread_([this, n, threads, &work] { run(n, threads, work); }) {}
  ~Batch() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }

  /// Waits, but no longer than a moment. Returns true if all is done.
  bool wait() {
    constexpr std::chrono::milliseconds kMoment{50};
    std::unique_lock lock(mutex_);
    return ready_.wait_for(lock, kMoment, [this] { return done_; });
  }
  void finish() {
    thread_.join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void run(std::size_t n, unsigned threads, const std::function<void(std::size_t, unsigned)>& work) {
    try {
      Workers workers(threads);
      workers.for_each(n, [&](std::size_t i, unsigned worker) {
        if (!stop_.load(std::memory_order_relaxed)) work(i, worker);
      });
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::lock_guard lock(mutex_);
    done_ = true;
    ready_.notify_all();
  }

  std::atomic<bool> stop_ = false;
  bool done_ = false;
  std::exception_ptr failure_;
  std::mutex mutex_;
  std::condition_variable ready_;
  std::thread thread_;  ///< last: it uses all others
};

}  // namespace

unsigned threads_of(std::size_t asked) {
  if (getpid() != loaded_by) return 1;
  if (asked > 0) return static_cast<unsigned>(asked);
  const unsigned all = std::thread::hardware_concurrency();
  return all > 0 ? all : 1;
}

void check_signals() {
  const py::gil_scoped_acquire lock;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

void run_batch(std::size_t n, unsigned threads, const std::function<void(std::size_t, unsigned)>& work) {
  const py::gil_scoped_release unlocked;
  Batch batch(n, threads, work);
  while (!batch.wait()) check_signals();
  batch.finish();
}

}  // namespace lrb::python
