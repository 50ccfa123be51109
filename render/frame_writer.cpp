#include <algorithm>
#include <utility>

#include <lrbscope/render/frame_writer.hpp>

namespace lrb::render {

FrameWriter::FrameWriter(std::size_t capacity)
    : capacity_(std::max<std::size_t>(capacity, 1)), thread_([this] { run(); }) {}

FrameWriter::~FrameWriter() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FrameWriter::push(std::string path, Image image, PngOptions options) {
  std::unique_lock lock(mutex_);
  // Back pressure: wait while the queue is full, so that memory is bounded.
  changed_.wait(lock, [&] { return jobs_.size() < capacity_ || error_; });
  rethrow();
  jobs_.push_back({std::move(path), std::move(image), std::move(options)});
  changed_.notify_all();
}

void FrameWriter::finish() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return (jobs_.empty() && !busy_) || error_; });
  rethrow();
}

void FrameWriter::rethrow() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void FrameWriter::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return stop_ || !jobs_.empty(); });
    if (jobs_.empty()) return;
    const Job job = std::move(jobs_.front());
    jobs_.pop_front();
    busy_ = true;
    // Encode without the lock: rendering continues meanwhile.
    lock.unlock();
    std::exception_ptr error;
    try {
      write_png(job.image, job.path, job.options);
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    busy_ = false;
    if (error) {  // frames queued behind a failure are dropped: the run is over
      if (!error_) error_ = error;
      jobs_.clear();
    }
    changed_.notify_all();
  }
}

}  // namespace lrb::render
