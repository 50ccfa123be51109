#include "scenarios/crowd/task_pool.hpp"

namespace lrb::crowd {

TaskPool::TaskPool(std::uint32_t threads) {
  for (std::uint32_t t = 1; t < threads; ++t) workers_.emplace_back([this, t] { wait_for_work(t); });
}

TaskPool::~TaskPool() {
  const std::lock_guard lock(mutex_);
  stop_ = true;
  begun_.notify_all();
}

void TaskPool::run(std::size_t count, const std::function<void(std::uint32_t, std::size_t)>& task) {
  {
    const std::lock_guard lock(mutex_);
    task_ = &task;
    count_ = count;
    next_ = 0;
    failure_ = nullptr;
    busy_ = threads();
    ++round_;
  }
  begun_.notify_all();
  work(0);
  std::unique_lock lock(mutex_);
  ended_.wait(lock, [this] { return busy_ == 0; });
  if (failure_) std::rethrow_exception(failure_);
}

void TaskPool::wait_for_work(std::uint32_t thread) {
  std::uint64_t done = 0;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      begun_.wait(lock, [&] { return stop_ || round_ != done; });
      if (stop_) return;
      done = round_;
    }
    work(thread);
  }
}

void TaskPool::work(std::uint32_t thread) {
  std::unique_lock lock(mutex_);
  while (next_ < count_) {
    const std::size_t i = next_++;
    lock.unlock();
    std::exception_ptr failure;
    try {
      (*task_)(thread, i);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    if (!failure || (failure_ && failed_ < i)) continue;
    failure_ = failure;
    failed_ = i;
  }
  if (--busy_ == 0) ended_.notify_one();
}

}  // namespace lrb::crowd
