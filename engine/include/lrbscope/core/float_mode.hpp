#pragma once

#include <cfenv>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace lrb {

/// Sets the default floating-point mode of this thread, on which all bounds and exact predicates rely, and
/// restores the previous one at its end: rounding to nearest and, on x86, subnormal numbers kept. Every
/// query, build and check has one, so that callers may use any mode, such as the directed rounding of an
/// interval arithmetic. Takes a few nanoseconds if the mode is the default.
class FloatMode {
 public:
  FloatMode() : before_(now()) {
    if (!is_default()) set(FE_TONEAREST, kDefault);
  }
  ~FloatMode() {
    if (!is_default()) set(rounding_, before_);
  }
  FloatMode(const FloatMode&) = delete;
  FloatMode& operator=(const FloatMode&) = delete;

 private:
#if defined(__SSE2__)
  // The control word of SSE, without the sticky flags of exceptions.
  static constexpr unsigned kControl = 0xffc0, kDefault = 0x1f80;
  static unsigned now() {
    return _mm_getcsr();
  }
  bool is_default() const {
    return (before_ & kControl) == kDefault;
  }
#else
  static constexpr unsigned kDefault = 0;
  static unsigned now() {
    return std::fegetround() == FE_TONEAREST ? kDefault : 1;
  }
  bool is_default() const {
    return before_ == kDefault;
  }
#endif
  void set(int rounding, [[maybe_unused]] unsigned control) {
    // Also of the x87 unit, which Extended uses.
    rounding_ = std::fegetround();
    std::fesetround(rounding);
#if defined(__SSE2__)
    _mm_setcsr(control);
#endif
  }

  unsigned before_;
  int rounding_ = FE_TONEAREST;
};

}  // namespace lrb
