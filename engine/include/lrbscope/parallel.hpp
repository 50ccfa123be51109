#pragma once
/// Parallel loops. Results do not depend on the number of threads: the schedule decides which thread
/// processes an item, never how it is processed.

#include <cstddef>
#include <functional>
#include <memory>

namespace lrb {

/// A set of threads, taken from the process-wide pool of oneTBB.
class Workers {
 public:
  /// `threads`: number of threads including the caller; 0: number of hardware threads.
  explicit Workers(unsigned threads = 1);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  unsigned count() const { return count_; }

  /// Calls work(i, worker) for i = 0 .. n - 1 in unspecified order, with worker < count(). Calls with the
  /// same worker do not overlap unless they are nested. If calls throw, rethrows the exception of the lowest
  /// i, as a sequential loop would; calls with larger i may have been skipped.
  void for_each(std::size_t n, const std::function<void(std::size_t i, unsigned worker)>& work);

  /// Calls both functions, possibly concurrently. Can be nested.
  void both(const std::function<void()>& one, const std::function<void()>& other);

 private:
  struct Pool;
  unsigned count_;
  std::unique_ptr<Pool> pool_;  ///< null for a single thread
};

}  // namespace lrb
