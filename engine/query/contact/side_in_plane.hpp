#pragma once

#include "engine/exact/predicates.hpp"

namespace lrb {

/// Returns the side of the line p, q on which r lies, seen along the first axis on which the triangle `face`,
/// in whose plane all of them lie, keeps its area.
inline int side_in_plane(const double* const face[3], const double* p, const double* q, const double* r) {
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const auto turn = [&](const double* a, const double* b, const double* c) {
      const double x[2] = {a[u], a[v]}, y[2] = {b[u], b[v]}, z[2] = {c[u], c[v]};
      return exact::orient2d(x, y, z);
    };
    if (turn(face[0], face[1], face[2]) != 0) return turn(p, q, r);
  }
  return 0;
}

}  // namespace lrb
