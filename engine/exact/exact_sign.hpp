#pragma once
/// The exact signs behind the predicates, computed when a floating-point filter cannot decide. Private to the
/// engine.

#include <array>

namespace lrb::exact {

/// Return what orient2d, on the coordinates `x` and `y` of the points, and orient3d return; without a filter.
int orient2d_exact(const double* a, const double* b, const double* c, int x, int y);
int orient3d_exact(const double* a, const double* b, const double* c, const double* d);

/// The coordinates of the points a, b, c, d along x, along y and along z.
using Coordinates4 = std::array<std::array<double, 4>, 3>;

/// The two ways to compute orient3d, separately: with long integers (for all finite doubles), and with
/// expansions where they apply.
int orient3d_integer(const Coordinates4& p);
int orient3d_expansion(const Coordinates4& p);
bool expansions_apply(const Coordinates4& p);

inline bool same_point(const double* a, const double* b) {
  return a == b || (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]);
}

}  // namespace lrb::exact
