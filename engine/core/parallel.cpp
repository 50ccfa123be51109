#include <atomic>
#include <exception>
#include <mutex>
#include <optional>

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <lrbscope/core/float_mode.hpp>
#include <lrbscope/parallel.hpp>

namespace lrb {

struct Workers::Pool {
  explicit Pool(int threads) : arena(threads) {
    // By default oneTBB starts at most as many threads as there are processors.
    if (threads > tbb::info::default_concurrency())
      more.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
  }
  std::optional<tbb::global_control> more;
  tbb::task_arena arena;
};

Workers::Workers(unsigned threads)
    : count_(threads > 0 ? threads : static_cast<unsigned>(tbb::info::default_concurrency())) {
  if (count_ > 1) pool_ = std::make_unique<Pool>(static_cast<int>(count_));
}

Workers::~Workers() = default;

void Workers::for_each(std::size_t n, const std::function<void(std::size_t, unsigned)>& work) {
  // Single thread: a plain loop, which ends at the first exception, that is, at the lowest failing index.
  if (!pool_ || n < 2) {
    for (std::size_t i = 0; i < n; ++i) work(i, 0);
    return;
  }
  // Calls above the lowest failed index are skipped; those below it still run. Hence the exception of the
  // lowest index is found regardless of the schedule.
  std::atomic<std::size_t> failed = n;
  std::exception_ptr failure;
  std::mutex one_at_a_time;
  pool_->arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, n, [&](std::size_t i) {
      // Relaxed is enough: a stale value only runs a call that could have been skipped.
      if (i > failed.load(std::memory_order_relaxed)) return;
      try {
        const FloatMode float_mode;
        work(i, static_cast<unsigned>(tbb::this_task_arena::current_thread_index()));
      } catch (...) {
        const std::lock_guard lock(one_at_a_time);
        // Another call with a lower index failed meanwhile.
        if (i > failed) return;
        failed = i;
        failure = std::current_exception();
      }
    });
  });
  if (failure) std::rethrow_exception(failure);
}

void Workers::both(const std::function<void()>& one, const std::function<void()>& other) {
  if (!pool_) {
    one();
    other();
    return;
  }
  // parallel_invoke may run nested calls on the same threads, so recursion cannot run out of them.
  const auto in_mode = [](const std::function<void()>& work) {
    const FloatMode float_mode;
    work();
  };
  pool_->arena.execute([&] { tbb::parallel_invoke([&] { in_mode(one); }, [&] { in_mode(other); }); });
}

}  // namespace lrb
