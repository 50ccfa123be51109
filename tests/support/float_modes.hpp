#pragma once

#include <array>
#include <cfenv>

#include <doctest/doctest.h>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace lrb::test {

/// Sets a floating-point mode: directed rounding (i % 5 = 0, 1, 2), subnormal numbers flushed to zero (3), or
/// both (4). Checks at its end that the mode was kept, and restores the default.
class InMode {
 public:
  explicit InMode(int i)
      : rounding_(std::array{FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO, FE_TONEAREST}[i % 5 % 4]) {
    std::fesetround(rounding_);
#if defined(__SSE2__)
    if (i % 5 >= 3) _mm_setcsr(_mm_getcsr() | kFlush);
    flush_ = _mm_getcsr() & kFlush;
#endif
  }
  ~InMode() {
    CHECK(std::fegetround() == rounding_);
#if defined(__SSE2__)
    CHECK((_mm_getcsr() & kFlush) == flush_);
#endif
    std::fesetenv(FE_DFL_ENV);
  }

 private:
  static constexpr unsigned kFlush = 0x8040;
  int rounding_;
  unsigned flush_ = 0;
};

template <class Ask>
auto in_mode(int i, const Ask& ask) {
  const InMode mode(i);
  return ask();
}

}  // namespace lrb::test
