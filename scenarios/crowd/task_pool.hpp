#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace lrb::crowd {

/// Threads that wait for the next round of small jobs: a round starts in microseconds, which starting threads
/// would not. The thread that asks works too.
class TaskPool {
 public:
  /// In all, the asking thread included; at least 1.
  explicit TaskPool(std::uint32_t threads);
  ~TaskPool();
  TaskPool(const TaskPool&) = delete;
  TaskPool& operator=(const TaskPool&) = delete;

  std::uint32_t threads() const { return static_cast<std::uint32_t>(workers_.size()) + 1; }
  /// task(thread, i) for each i below `count`, each once, in any order; waits for all. `thread` is below
  /// threads(), and tasks with the same one never overlap. Of exceptions, that of the lowest i is thrown,
  /// once the others are done.
  void run(std::size_t count, const std::function<void(std::uint32_t, std::size_t)>& task);

 private:
  void wait_for_work(std::uint32_t thread);
  void work(std::uint32_t thread);

  std::mutex mutex_;
  std::condition_variable begun_, ended_;
  std::uint64_t round_ = 0;
  std::uint32_t busy_ = 0;
  bool stop_ = false;
  const std::function<void(std::uint32_t, std::size_t)>* task_ = nullptr;
  std::size_t count_ = 0, next_ = 0;
  std::size_t failed_ = 0;
  std::exception_ptr failure_;
  std::vector<std::jthread> workers_;  ///< last: they see the rest
};

}  // namespace lrb::crowd
