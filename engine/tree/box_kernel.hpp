#pragma once
/// The box kernel: boxes of simplices on turned axes, for the construction of trees.
///
/// Contains only plain structures: this header is compiled once per instruction set (cmake/kernels.cmake).

#include <cstddef>
#include <cstdint>

namespace lrb {

/// A simplex in float, for estimates of boxes.
struct alignas(32) LocalSimplex {
  float corner[4][4];  ///< x, y, z, 0; the third corner is repeated
  float box[2][4];     ///< of the corners: the lower end and the upper end, negated
};

struct BoxKernel {
  const std::uint32_t* which;  ///< (count) indices of simplices, at least one
  std::size_t count;

  /// Estimates, or null: the sides of the boxes on the coordinate axes and on turned axes, on which x is the
  /// sum of x[k] axes[k].
  const LocalSimplex* local;
  float axes[3][4];
  float straight[4], turned[4];

  /// If there are no estimates: the ends of the box of `corners`, nine numbers a simplex, in a frame in which
  /// x is the sum of (x[k] - origin[k]) columns[k].
  const double* corners;
  double columns[3][4], origin[3];
  double low[4], high[4];
};

/// Runs the kernel. The result does not depend on the instruction set.
void run_box_kernel(BoxKernel& k);

}  // namespace lrb
