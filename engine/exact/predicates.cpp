#include "engine/exact/predicates.hpp"

#include <cmath>

#include "engine/exact/exact_sign.hpp"
#include "engine/exact/orient_axes.hpp"
#include "engine/exact/plane_side.hpp"

namespace lrb::exact {

int orient2d(const double* a, const double* b, const double* c) {
  return orient_axes(a, b, c, 0, 1);
}

int orient3d(const double* a, const double* b, const double* c, const double* d) {
  return PlaneSide(a, b, c).side(d);
}

bool collinear3d(const double* a, const double* b, const double* c) {
  return orient_axes(a, b, c, 0, 1) == 0 && orient_axes(a, b, c, 1, 2) == 0 &&
         orient_axes(a, b, c, 2, 0) == 0;
}

}  // namespace lrb::exact
