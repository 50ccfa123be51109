// Workers implemented with threads of the standard library, for builds with ThreadSanitizer, which reports
// false races in a oneTBB that was compiled without it. Each call takes idle worker numbers from the pool,
// runs a thread for each, and returns the numbers. An atomic counter distributes the work.

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include <lrbscope/parallel.hpp>

namespace lrb {

struct Workers::Pool {
  /// Creates a pool of idle worker numbers. Number 0 belongs to the thread that created the pool.
  explicit Pool(unsigned threads) {
    for (unsigned number = threads; number-- > 1;) free.push_back(number);
  }

  /// Takes up to `wanted` idle numbers; fewer if nested or concurrent calls use them.
  std::vector<unsigned> take(std::size_t wanted) {
    const std::lock_guard lock(mutex);
    std::vector<unsigned> taken;
    for (; taken.size() < wanted && !free.empty(); free.pop_back()) taken.push_back(free.back());
    return taken;
  }
  void give_back(const std::vector<unsigned>& numbers) {
    const std::lock_guard lock(mutex);
    free.insert(free.end(), numbers.begin(), numbers.end());
  }

  std::mutex mutex;
  std::vector<unsigned> free;
};

namespace {

/// The pool that this thread works for, and its number there.
thread_local std::pair<const void*, unsigned> current{nullptr, 0};

/// Runs work(number) on a new thread for each number and on this one, and rethrows the first exception.
template <class Work>
void run_on(const void* pool, const std::vector<unsigned>& numbers, const Work& work) {
  std::mutex mutex;
  std::exception_ptr failure;
  const auto run = [&](unsigned number) {
    // Saved and restored, because calls may be nested, even with different pools.
    const auto before = std::exchange(current, {pool, number});
    try {
      work(number);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    current = before;
  };
  // In a nested call the thread keeps its number; otherwise it is worker 0.
  const unsigned own = current.first == pool ? current.second : 0;
  std::vector<std::thread> threads;
  threads.reserve(numbers.size());
  for (const unsigned number : numbers) threads.emplace_back(run, number);
  run(own);
  for (std::thread& t : threads) t.join();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace

Workers::Workers(unsigned threads)
    : count_(threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency())) {
  if (count_ > 1) pool_ = std::make_unique<Pool>(count_);
}

Workers::~Workers() = default;

void Workers::for_each(std::size_t n, const std::function<void(std::size_t, unsigned)>& work) {
  const std::vector<unsigned> helpers =
      pool_ && n > 1 ? pool_->take(std::min<std::size_t>(n, count_) - 1) : std::vector<unsigned>{};
  // Each worker fetches the next index until none is left. Calls above the lowest index that has failed are
  // skipped. Those below it were fetched before, so the exception of the lowest index is always found.
  std::atomic<std::size_t> next{0}, failed{n};
  std::exception_ptr failure;
  std::mutex one_at_a_time;
  const auto take_part = [&](unsigned worker) {
    for (std::size_t i = next++; i < failed; i = next++) {
      try {
        work(i, worker);
      } catch (...) {
        const std::lock_guard lock(one_at_a_time);
        if (i > failed) continue;
        failed = i;
        failure = std::current_exception();
      }
    }
  };
  const auto give_back = [&] {
    if (pool_) pool_->give_back(helpers);
  };
  try {
    run_on(pool_.get(), helpers, take_part);
  } catch (...) {
    give_back();
    throw;
  }
  give_back();
  if (failure) std::rethrow_exception(failure);
}

void Workers::both(const std::function<void()>& one, const std::function<void()>& other) {
  const std::vector<unsigned> helper = pool_ ? pool_->take(1) : std::vector<unsigned>{};
  // No idle worker: run both on this thread. Nested calls therefore never wait for one.
  if (helper.empty()) {
    one();
    other();
    return;
  }
  const auto give_back = [&] { pool_->give_back(helper); };
  try {
    run_on(pool_.get(), helper, [&](unsigned worker) { worker == helper[0] ? other() : one(); });
  } catch (...) {
    give_back();
    throw;
  }
  give_back();
}

}  // namespace lrb
