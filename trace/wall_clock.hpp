#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace lrb::trace {

/// Times the events of a recording.
class WallClock {
 public:
  /// Returns the nanoseconds since this began, and never the same number twice, so that no two events of a
  /// timeline coincide.
  std::uint64_t now_ns() {
    const auto elapsed = std::chrono::steady_clock::now() - began_;
    const auto ns = std::chrono::duration_cast<std::chrono::nanoseconds>(elapsed).count();
    return last_ns_ = std::max(last_ns_ + 1, static_cast<std::uint64_t>(ns));
  }

 private:
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::uint64_t last_ns_ = 0;
};

}  // namespace lrb::trace
