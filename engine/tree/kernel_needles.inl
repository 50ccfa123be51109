#pragma once
// Part of tree_kernel.inl: two nodes full of needles.

#include "engine/tree/kernel_boxes.inl"

namespace lrb {
namespace {

/// Returns true if the two nodes' boxes are apart along a direction across an axis of each. On the boxes' own
/// axes, which are tried everywhere, skew needles nearly always overlap; along these directions nearly all
/// are parted.
///
/// Let L = e_i x r_m, with e_i an axis of A's node and r_m the m-th axis of B's seen from A's. A point in
/// common is in A's box at x_a and in B's at x_b, and on each axis of A's node x_a and r x_b + t differ by at
/// most w.error. So L.x_a and L.(r x_b + t) differ by at most |L|_1 w.error. L's coordinates are entries of
/// r, without another rounding; what is computed with them is off by less than 16 u |L|_1 times the sizes of
/// the coordinates, u = 2^-24, and w.error is at least 2^-18 times those: twice w.error covers both. This
/// holds for any r, a rotation or not. NaN (an overflow) counts as "not apart".
inline bool needles_apart(const TreeKernel& k, const TreeNode& na, const TreeNode& nb) {
  const Between w = between<false>(k, na, nb);
  const Whole a = whole_of(na, k.ratio_a), b = whole_of(nb, k.ratio_b);
  float c[3];  // from A's centre to B's
  for (int i = 0; i < 3; ++i)
    c[i] = w.t[i] + w.r[i][0] * b.centre[0] + w.r[i][1] * b.centre[1] + w.r[i][2] * b.centre[2] - a.centre[i];
  for (int i = 0; i < 3; ++i) {
    const int p = (i + 1) % 3, q = (i + 2) % 3;
    for (int m = 0; m < 3; ++m) {
      const float lp = w.r[q][m], lq = w.r[p][m];  // L is -lp on axis p and lq on axis q
      float reach = a.half[p] * w.abs_r[q][m] + a.half[q] * w.abs_r[p][m];
      for (int n = 0; n < 3; ++n) reach += b.half[n] * __builtin_fabsf(lq * w.r[q][n] - lp * w.r[p][n]);
      reach += 2 * w.error * (w.abs_r[p][m] + w.abs_r[q][m]);
      if (__builtin_fabsf(lq * c[q] - lp * c[p]) > reach) return true;
    }
  }
  return false;
}

}  // namespace
}  // namespace lrb
