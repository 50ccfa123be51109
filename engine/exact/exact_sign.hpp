#pragma once
/// The exact signs behind the predicates: what is called when a floating-point filter cannot decide.
/// Private to engine/exact.

#include <cstdint>

namespace lrb::exact {

/// As orient2d on the coordinates `x` and `y` of the points, and orient3d; without a filter.
int orient2d_exact(const double* a, const double* b, const double* c, int x, int y);
int orient3d_exact(const double* a, const double* b, const double* c, const double* d);

inline bool same_point(const double* a, const double* b) {
  return a == b || (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]);
}

}  // namespace lrb::exact
