#pragma once
/// Work on several threads. Everything that runs here gives the same result on any number of threads: they
/// decide who does a piece of work, never what the work is.

#include <cstddef>
#include <functional>
#include <memory>

namespace lrb {

/// The threads that share work: those of oneTBB's pool, which the whole program has in common.
class Workers {
 public:
  /// Uses `threads` threads, the calling one included; 0: as many as the machine runs at once.
  explicit Workers(unsigned threads = 1);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  unsigned count() const { return count_; }

  /// Calls work(i, worker) for i = 0 .. n - 1, in no order to rely on; worker < count(), and no two calls
  /// with the same one run at once, unless calls are nested. If calls throw, the exception of the lowest i
  /// comes out here, as on one thread; some of the calls above it may have been left out.
  void for_each(std::size_t n, const std::function<void(std::size_t i, unsigned worker)>& work);

  /// Calls both functions, possibly at the same time. May be nested.
  void both(const std::function<void()>& one, const std::function<void()>& other);

 private:
  struct Pool;
  unsigned count_;
  std::unique_ptr<Pool> pool_;  ///< none for a single thread
};

}  // namespace lrb
