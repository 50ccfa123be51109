#pragma once
/// Reports bounds to a probe when they change.

#include <algorithm>
#include <limits>

#include "engine/query/distance/distance_probe.hpp"

namespace lrb {

class BoundsTeller {
 public:
  explicit BoundsTeller(BoundsProbe& probe) : probe_(probe) {}

  /// Reports the intersection of these bounds with all that were reported before, if that is new.
  void tell(std::uint64_t work, double lower, double upper) {
    const Bounds now{std::max(work, known_.work), std::max(lower, known_.lower),
                     std::min(upper, known_.upper)};
    if (now.lower == known_.lower && now.upper == known_.upper) return;
    put(now);
  }
  /// Reports the bounds of the answer, even if some that were reported before were narrower.
  void settle(std::uint64_t work, double lower, double upper) {
    if (lower == known_.lower && upper == known_.upper) return;
    put({std::max(work, known_.work), lower, upper});
  }

  /// Returns the work count of the next report. Intervals grow geometrically, so that reports are few.
  static std::uint64_t next_look(std::uint64_t work) { return work + 1 + work / 16; }

 private:
  void put(const Bounds& now) {
    known_ = now;
    probe_.bounds(now);
  }

  BoundsProbe& probe_;
  Bounds known_{0, 0, std::numeric_limits<double>::infinity()};
};

}  // namespace lrb
