#pragma once
/// Counts what `new` hands out: memory to the byte, whatever else the machine does.

#include <cstddef>

namespace lrb::scaling {

/// The most that has been held since it was made, beyond what was held then. One at a time.
class PeakMemory {
 public:
  PeakMemory();
  std::size_t bytes() const;

 private:
  std::size_t before_;
};

}  // namespace lrb::scaling
