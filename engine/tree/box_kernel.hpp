#pragma once
/// The box kernel: boxes of simplices on turned axes, for the construction of trees.
///
/// Contains only plain structures: this header is compiled once per instruction set (cmake/kernels.cmake).

#include <cstddef>
#include <cstdint>
#include <limits>

#include <lrbscope/ids.hpp>

namespace lrb {

/// A simplex in float, for estimates of boxes.
struct alignas(32) LocalSimplex {
  float corner[4][4];  ///< x, y, z, 0; the third corner is repeated
  float box[2][4];     ///< of the corners: the lower end and the upper end, negated
};

/// Number of bins of an axis in which simplices are counted.
inline constexpr int kBins = 32;

/// The simplices whose centre is in a bin: their number and the ends of their box, x, y, z. Each end has a
/// number without meaning beside it, as vectors have four.
struct Bin {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  double low_and[4] = {kFar, kFar, kFar, kFar}, and_high[4] = {-kFar, -kFar, -kFar, -kFar};
  std::uint32_t count = 0;
};

/// Bins of equal width from `from` on, `per_unit` in a unit of length, on each axis.
struct BoxBins {
  double from[4] = {}, per_unit[4] = {};  ///< the fourth is 0
  Bin bin[3][kBins];
};

struct BoxKernel {
  const std::uint32_t* which;  ///< (count) indices of simplices, at least one
  std::size_t count;

  /// If not null, the simplices are added to the bins: `boxes` has six numbers for each, the lower and the
  /// upper end.
  BoxBins* bins;
  const double* boxes;

  /// Otherwise estimates, if not null: the sides of the boxes on the coordinate axes and on turned axes, on
  /// which x is the sum of x[k] axes[k].
  const LocalSimplex* local;
  float axes[3][4];
  float straight[4], turned[4];

  /// Otherwise the ends of the box of the `vertices` with the numbers `corners`, three a simplex, scaled,
  /// in a frame in which x is the sum of (x[k] - origin[k]) columns[k].
  const double* vertices;
  const VertexId* corners;
  double scale;
  double columns[3][4], origin[3];
  double low[4], high[4];
};

/// Runs the kernel. The result does not depend on the instruction set.
void run_box_kernel(BoxKernel& k);

}  // namespace lrb
