#pragma once
/// Clips a segment by linear conditions, exactly. Private to engine/exact, because it includes Boost.

#include "engine/exact/rational.hpp"

namespace lrb::exact {

/// A part of a segment, as an interval of its parameter, which runs from 0 to 1.
struct RationalInterval {
  Rational low = 0, high = 1;
  bool empty = false;

  /// Keeps the part where f >= 0, for a function f that is linear along the segment, given its values at both
  /// ends.
  void keep_positive(const Rational& at_start, const Rational& at_end) {
    if (at_start < 0 && at_end < 0) empty = true;
    if (empty || (at_start >= 0 && at_end >= 0)) return;
    const Rational t = at_start / (at_start - at_end);
    if (at_start < 0 && t > low) low = t;
    if (at_end < 0 && t < high) high = t;
    empty = low > high;
  }
  void keep_zero(const Rational& at_start, const Rational& at_end) {
    keep_positive(at_start, at_end);
    keep_positive(-at_start, -at_end);
  }
};

}  // namespace lrb::exact
