// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_BOX_KERNEL_NAME.

#include "engine/tree/box_kernel.hpp"

namespace lrb {
namespace {

using Float8 = float __attribute__((vector_size(32)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Double4 = double __attribute__((vector_size(32)));

/// Half as wide.
template <class Vector>
struct HalfOf;
template <>
struct HalfOf<Float8> {
  using Type = float __attribute__((vector_size(16)));
};
template <>
struct HalfOf<Double4> {
  using Type = double __attribute__((vector_size(16)));
};

template <class Vector, class Operation>
Vector by_registers(Vector x, Vector y, Operation operation) {
#if defined(__AVX__)
  return operation(x, y);
#else
  // GCC compares vectors that are wider than the registers number by number.
  typename HalfOf<Vector>::Type a[2], b[2];
  __builtin_memcpy(a, &x, sizeof x);
  __builtin_memcpy(b, &y, sizeof y);
  for (int i = 0; i < 2; ++i) a[i] = operation(a[i], b[i]);
  __builtin_memcpy(&x, a, sizeof x);
  return x;
#endif
}

template <class Vector>
Vector min_of(Vector x, Vector y) {
  return by_registers(x, y, [](auto a, auto b) { return a < b ? a : b; });
}
template <class Vector>
Vector max_of(Vector x, Vector y) {
  return by_registers(x, y, [](auto a, auto b) { return a > b ? a : b; });
}

template <class Vector, class Scalar>
Vector loaded(const Scalar* from) {
  Vector x;
  __builtin_memcpy(&x, from, sizeof x);
  return x;
}

/// Two corners at a time, one in each half of a vector.
void estimate(BoxKernel& k) {
  Float8 axes[3];
  for (int i = 0; i < 3; ++i)
    for (int lane = 0; lane < 8; ++lane) axes[i][lane] = k.axes[i][lane % 4];
  const LocalSimplex& first = k.local[k.which[0]];
  const auto turn = [&](const float(&two)[4]) {
    const Float8 x = loaded<Float8>(two);
    return __builtin_shufflevector(x, x, 0, 0, 0, 0, 4, 4, 4, 4) * axes[0] +
           __builtin_shufflevector(x, x, 1, 1, 1, 1, 5, 5, 5, 5) * axes[1] +
           __builtin_shufflevector(x, x, 2, 2, 2, 2, 6, 6, 6, 6) * axes[2];
  };
  Float8 straight = loaded<Float8>(first.box[0]), low = turn(first.corner[0]), high = low;
  for (std::size_t i = 0; i < k.count; ++i) {
    const LocalSimplex& s = k.local[k.which[i]];
    straight = min_of(straight, loaded<Float8>(s.box[0]));
    const Float8 x = turn(s.corner[0]), y = turn(s.corner[2]);
    low = min_of(low, min_of(x, y));
    high = max_of(high, max_of(x, y));
  }
  for (int lane = 0; lane < 4; ++lane) {
    k.straight[lane] = -straight[lane + 4] - straight[lane];
    k.turned[lane] = (high[lane] > high[lane + 4] ? high[lane] : high[lane + 4]) -
                     (low[lane] < low[lane + 4] ? low[lane] : low[lane + 4]);
  }
}

void add_to_bins(const BoxKernel& k) {
  const Double4 from = loaded<Double4>(k.bins->from), per_unit = loaded<Double4>(k.bins->per_unit);
  for (std::size_t i = 0; i < k.count; ++i) {
    const double* const box = k.boxes + std::size_t{6} * k.which[i];
    const Double4 low = loaded<Double4>(box), high = loaded<Double4>(box + 2);
    const Double4 centre = 0.5 * (low + __builtin_shufflevector(high, high, 1, 2, 3, 3));
    const Int4 bins = __builtin_convertvector((centre - from) * per_unit, Int4);
    for (int axis = 0; axis < 3; ++axis) {
      Bin& bin = k.bins->bin[axis][bins[axis] < kBins ? bins[axis] : kBins - 1];
      const Double4 lowest = min_of(loaded<Double4>(bin.low_and), low),
                    highest = max_of(loaded<Double4>(bin.and_high), high);
      __builtin_memcpy(bin.low_and, &lowest, sizeof lowest);
      __builtin_memcpy(bin.and_high, &highest, sizeof highest);
      ++bin.count;
    }
  }
}

void measure(BoxKernel& k) {
  const Double4 column[3] = {loaded<Double4>(k.columns[0]), loaded<Double4>(k.columns[1]),
                             loaded<Double4>(k.columns[2])};
  const auto in_frame = [&](std::size_t corner) {
    const double* const v = k.vertices + std::size_t{3} * k.corners[corner];
    return (v[0] * k.scale - k.origin[0]) * column[0] + (v[1] * k.scale - k.origin[1]) * column[1] +
           (v[2] * k.scale - k.origin[2]) * column[2];
  };
  Double4 low = in_frame(std::size_t{3} * k.which[0]), high = low;
  for (std::size_t i = 0; i < k.count; ++i)
    for (int corner = 0; corner < 3; ++corner) {
      const Double4 x = in_frame(std::size_t{3} * k.which[i] + static_cast<std::size_t>(corner));
      low = min_of(low, x);
      high = max_of(high, x);
    }
  __builtin_memcpy(k.low, &low, sizeof low);
  __builtin_memcpy(k.high, &high, sizeof high);
}

}  // namespace

void LRB_BOX_KERNEL_NAME(BoxKernel& k) {
  if (k.bins != nullptr)
    add_to_bins(k);
  else
    k.local != nullptr ? estimate(k) : measure(k);
}

}  // namespace lrb
