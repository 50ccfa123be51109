#pragma once

#include <cstddef>
#include <iterator>

namespace lrb {

/// Clips a convex polygon to value(x) >= 0, where `value` is linear (Sutherland and Hodgman 1974). `corners`:
/// an array or vector of points of any dimension, in order. Calls add(x, i, is_new, along_cut) for each
/// corner of the result, in the same order, and not at all if nothing is left; a polygon that only touches
/// the half-space gives the one or two corners there. is_new: x is a point of the edge from corner i to the
/// next, rounded, else it is corner i. x may be an expression of Eigen, valid only during the call. Values
/// must be finite, and so must their differences. along_cut: the edge that begins at x is the cut, else a
/// part of the edge from corner i.
template <class Points, class Value, class Add>
void clip_polygon(const Points& corners, const Value& value, const Add& add) {
  const std::size_t n = std::size(corners);
  for (std::size_t i = 0; i < n; ++i) {
    const auto &p = corners[i], &q = corners[(i + 1) % n];
    const double d = value(p), e = value(q);
    if (d >= 0) add(p, i, false, d == 0 && e < 0);
    // A change of sign: the zero of the linear interpolation. A corner with value 0 was added itself.
    if ((d >= 0) != (e >= 0) && d != 0 && e != 0) add(p + d / (d - e) * (q - p), i, true, d > 0);
  }
}

}  // namespace lrb
