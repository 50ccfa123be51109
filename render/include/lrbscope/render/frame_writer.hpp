#pragma once
/// Encodes and writes frames on a second thread while the next ones are drawn.

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <string>
#include <thread>

#include <lrbscope/render/image.hpp>

namespace lrb::render {

class FrameWriter {
 public:
  /// At most `capacity` frames are queued; push() blocks while the queue is full.
  explicit FrameWriter(std::size_t capacity = 4);
  /// Waits for the queued frames. An error that finish() did not report is lost here: call finish().
  ~FrameWriter();
  FrameWriter(const FrameWriter&) = delete;
  FrameWriter& operator=(const FrameWriter&) = delete;

  /// Queues a frame. Throws the first error of an earlier frame, if any.
  void push(std::string path, Image image, PngOptions options = {});
  /// Waits until all frames are written. Throws the first error.
  void finish();

 private:
  struct Job {
    std::string path;
    Image image;
    PngOptions options;
  };
  void run();
  void rethrow();

  std::size_t capacity_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  bool busy_ = false, stop_ = false;
  std::exception_ptr error_;
  std::thread thread_;
};

}  // namespace lrb::render
