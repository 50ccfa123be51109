#pragma once
// Part of tree_kernel.inl and pair_kernel.inl: two nodes, their relative position, and tests of their boxes.

#include "engine/core/tolerances.hpp"
#include "engine/tree/kernel_lanes.inl"
#include "engine/tree/tree_kernel.hpp"

namespace lrb {
namespace {

/// The box of a node in its own frame, query units.
struct Whole {
  float centre[3], half[3];
};

inline Whole whole_of(const TreeNode& n, float ratio) {
  Whole w;
  // The node box spans the codes 0 to 255 on each axis.
  for (int i = 0; i < 3; ++i) {
    w.half[i] = n.scale[i] * ratio * (0.5f * kQuantizedMost);
    w.centre[i] = n.base[i] * ratio + w.half[i];
  }
  return w;
}

/// The boxes of a node's children or simplices, in its own frame, query units.
struct Boxes {
  Float8 centre[3], half[3];
};

inline Boxes decode(const TreeNode& n, float ratio) {
  Boxes b;
  for (int i = 0; i < 3; ++i) {
    // Centre and half extent from the sum and difference of the codes, which are exact integers in float.
    const float base = n.base[i] * ratio, half_scale = n.scale[i] * ratio * 0.5f;
    const Int8 lo = bytes_to_int(n.lo[i]), hi = bytes_to_int(n.hi[i]);
    b.centre[i] = splat(base) + splat(half_scale) * __builtin_convertvector(lo + hi, Float8);
    b.half[i] = splat(half_scale) * __builtin_convertvector(hi - lo, Float8);
  }
  return b;
}

/// The relative position of two nodes: coordinates in A's node = r * (coordinates in B's node) + t;
/// coordinates in B's node = r^T * (coordinates in A's node) + back. The fourth entry of each row is unused.
struct Between {
  alignas(16) float r[3][4], abs_r[3][4], t[4], back[4];
  float reach;  ///< bound on every coordinate difference that occurs
  float error;  ///< error bound of every transformed coordinate
  /// For A and for B: error bound of every coordinate of the difference of two corners of that body.
  float edge_error[2];
  // Only with a margin:
  /// Enlargement of boxes on A's and on B's axes: the error, the margin, and the swept displacement.
  alignas(16) float grow[2][4];
  float direction[4];  ///< displacement by which B's node is swept, on A's axes
  float margin;        ///< maximum additional displacement of any of its points
};

/// Sets the error bounds. radius_a, radius_b: radius of a ball that contains the transformed points of each
/// body, or the length of its edges. reach: bound on the differences of a corner of A and a corner of B.
/// whole: bound on the coordinates from which corners of B are transformed.
inline void set_errors(Between& w, float slack, float m_size, float radius_a, float radius_b, float reach,
                       float whole) {
  w.reach = reach;
  w.error = slack + kKernelRounding * whole;
  w.edge_error[0] = 2 * slack + kOwnEdgeRounding * radius_a;
  w.edge_error[1] = 2 * slack + kTurnedEdgeRounding * (m_size * radius_b) + kFarEdgeRounding * reach;
}

/// Returns row i of a node's frame; the fourth entry is the number that follows it in the node.
inline Float4 frame_row(const TreeNode& n, int i) {
  static_assert(__builtin_offsetof(TreeNode, base) == sizeof(n.frame));
  Float4 row;
  __builtin_memcpy(&row, reinterpret_cast<const char*>(&n) + static_cast<unsigned>(i) * 3 * sizeof(float),
                   sizeof row);
  return row;
}

struct Columns {
  Float4 c[3];
};

inline Columns columns_of(Float4 row0, Float4 row1, Float4 row2) {
  const Float4 low = __builtin_shufflevector(row0, row1, 0, 4, 1, 5);
  const Float4 high = __builtin_shufflevector(row0, row1, 2, 6, 2, 6);
  return {{__builtin_shufflevector(low, row2, 0, 1, 4, 4), __builtin_shufflevector(low, row2, 2, 3, 5, 5),
           __builtin_shufflevector(high, row2, 0, 1, 6, 6)}};
}

/// Returns x[0] column[0] + x[1] column[1] + x[2] column[2].
inline Float4 combine(const float* x, const Float4* column) {
  return splat4(x[0]) * column[0] + splat4(x[1]) * column[1] + splat4(x[2]) * column[2];
}

/// Computes the displacement by which a node of B is swept, on A's axes. Returns the sum of the magnitudes of
/// its coordinates.
inline float sweep(const TreeKernel& k, const TreeNode& b, const Columns& a_columns, Between& w) {
  // In double first, because the node's origin may be far from the body's; then rounded to float and rotated.
  const Double4* m = reinterpret_cast<const Double4*>(k.sweep);
  const Double4 swept =
      ((m[0] * splat4d(b.origin[0]) + m[1] * splat4d(b.origin[1])) + m[2] * splat4d(b.origin[2])) *
          splat4d(k.ratio_b) +
      *reinterpret_cast<const Double4*>(k.sweep_t);
  const Float4 direction = __builtin_convertvector(swept, Float4);
  const float parts[3] = {direction[0], direction[1], direction[2]};
  const Float4 on_a = combine(parts, a_columns.c);
  __builtin_memcpy(w.direction, &on_a, sizeof on_a);
  return __builtin_fabsf(parts[0]) + __builtin_fabsf(parts[1]) + __builtin_fabsf(parts[2]);
}

/// Returns the offset from the origin of A's node to the origin of B's, on A's axes.
inline Float4 offset_between(const TreeKernel& k, const TreeNode& a, const TreeNode& b) {
  // Double precision: the origins may be large and nearly equal, so their difference would cancel in float.
  const Double4* m = reinterpret_cast<const Double4*>(k.m);
  const Double4 origin_a{a.origin[0], a.origin[1], a.origin[2], 0};
  const Double4 d =
      (((m[0] * splat4d(b.origin[0]) + m[1] * splat4d(b.origin[1])) + m[2] * splat4d(b.origin[2])) *
           splat4d(k.ratio_b) +
       *reinterpret_cast<const Double4*>(k.t)) -
      origin_a * splat4d(k.ratio_a);
  return __builtin_convertvector(d, Float4);
}

/// Computes the relative position of two nodes. kMargin: accounts for k.margin. If simplices share a point
/// after a motion, then before it they have two points that the motion brings together. A slab between the
/// simplices that is wider than the motion's extent across it therefore proves that they do not intersect.
template <bool kMargin = false>
inline Between between(const TreeKernel& k, const TreeNode& a, const TreeNode& b) {
  Between w;
  const Float4 offset = offset_between(k, a, b);
  const float df[3] = {offset[0], offset[1], offset[2]};
  const Columns b_columns = columns_of(frame_row(b, 0), frame_row(b, 1), frame_row(b, 2));
  const Columns a_columns = columns_of(frame_row(a, 0), frame_row(a, 1), frame_row(a, 2));
  // r = frame_a m frame_b^T, in two products of 3 x 3 matrices.
  Float4 mb[3], r[3];  // rows of m * (axes of B), and of r
  for (int i = 0; i < 3; ++i) mb[i] = combine(k.m_rows[i], b_columns.c);
  for (int i = 0; i < 3; ++i) {
    r[i] = combine(a.frame[i], mb);
    __builtin_memcpy(w.r[i], &r[i], sizeof r[i]);
    const Float4 size = abs4(r[i]);
    __builtin_memcpy(w.abs_r[i], &size, sizeof size);
  }
  // The offset on A's axes, and minus the offset on B's axes. r is inverted by transposition.
  const Float4 t = combine(df, a_columns.c);
  __builtin_memcpy(w.t, &t, sizeof t);
  const float t_parts[3] = {t[0], t[1], t[2]};
  const Float4 back = -combine(t_parts, r);
  __builtin_memcpy(w.back, &back, sizeof back);
  // `whole` bounds every intermediate number, and the error bounds are relative to it.
  const float radius_a = a.radius * k.ratio_a, radius_b = b.radius * k.ratio_b;
  const float whole = k.m_size * (radius_a + radius_b + __builtin_fabsf(df[0]) + __builtin_fabsf(df[1]) +
                                  __builtin_fabsf(df[2]));
  float reach = whole;
  // The sweep of B's origin is in w.direction. The margin bounds by how much other points of the node differ
  // from it.
  if constexpr (kMargin) {
    const float size = sweep(k, b, a_columns, w);
    w.margin = k.margin + k.sweep_turn * radius_b + kSweepRounding * size;
    reach += size + w.margin;  // also covers differences of corners at the end of the sweep
  }
  set_errors(w, k.slack, k.m_size, radius_a, radius_b, reach, whole);
  if constexpr (kMargin) {
    // The sweep widens boxes by its extent on each axis, in both directions.
    const Float4 on_a{w.direction[0], w.direction[1], w.direction[2], 0}, on_b = combine(w.direction, r);
    const Float4 grow[2] = {splat4(w.error + w.margin) + abs4(on_a), splat4(w.error + w.margin) + abs4(on_b)};
    __builtin_memcpy(w.grow, grow, sizeof grow);
  }
  return w;
}

template <bool kMargin>
inline float grow_of(const Between& w, int side, int axis) {
  return kMargin ? w.grow[side][axis] : w.error;
}

/// Returns the boxes unchanged: under a rotation the axes of a node are its own. See affine_kernel.inl for
/// other maps.
inline const Boxes& boxes_on_own(const Boxes& boxes, Side, const Between&) {
  return boxes;
}
inline const Whole& whole_on_own(const Whole& whole, Side, const Between&) {
  return whole;
}

/// Returns the node box of B on A's axes, enlarged by the error bound.
template <bool kMargin>
inline Whole turn_whole_b(const Whole& b, const Between& w) {
  Whole o;
  // On other axes a box has the half extents |r| half (Arvo 1990).
  for (int i = 0; i < 3; ++i) {
    o.centre[i] = w.t[i] + w.r[i][0] * b.centre[0] + w.r[i][1] * b.centre[1] + w.r[i][2] * b.centre[2];
    o.half[i] = grow_of<kMargin>(w, 0, i) + w.abs_r[i][0] * b.half[0] + w.abs_r[i][1] * b.half[1] +
                w.abs_r[i][2] * b.half[2];
  }
  return o;
}

/// Returns the node box of A on B's axes, enlarged by the error bound.
template <bool kMargin>
inline Whole turn_whole_a(const Whole& a, const Between& w) {
  Whole o;
  // Columns of r instead of rows: the inverse of a rotation is its transpose.
  for (int j = 0; j < 3; ++j) {
    o.centre[j] = w.back[j] + w.r[0][j] * a.centre[0] + w.r[1][j] * a.centre[1] + w.r[2][j] * a.centre[2];
    o.half[j] = grow_of<kMargin>(w, 1, j) + w.abs_r[0][j] * a.half[0] + w.abs_r[1][j] * a.half[1] +
                w.abs_r[2][j] * a.half[2];
  }
  return o;
}

/// Boxes of one node on the axes of the other: axis-aligned there, and enlarged by the error bound.
struct Turned {
  Float8 centre[3], half[3];
};

template <bool kMargin>
inline Turned turn_b(const Boxes& b, const Between& w) {
  Turned o;
  // As turn_whole_b(), for eight boxes at once.
  for (int i = 0; i < 3; ++i) {
    o.centre[i] = splat(w.t[i]) + splat(w.r[i][0]) * b.centre[0] + splat(w.r[i][1]) * b.centre[1] +
                  splat(w.r[i][2]) * b.centre[2];
    o.half[i] = splat(grow_of<kMargin>(w, 0, i)) + splat(w.abs_r[i][0]) * b.half[0] +
                splat(w.abs_r[i][1]) * b.half[1] + splat(w.abs_r[i][2]) * b.half[2];
  }
  return o;
}

template <bool kMargin>
inline Turned turn_a(const Boxes& a, const Between& w) {
  Turned o;
  for (int j = 0; j < 3; ++j) {
    o.centre[j] = splat(w.back[j]) + splat(w.r[0][j]) * a.centre[0] + splat(w.r[1][j]) * a.centre[1] +
                  splat(w.r[2][j]) * a.centre[2];
    o.half[j] = splat(grow_of<kMargin>(w, 1, j)) + splat(w.abs_r[0][j]) * a.half[0] +
                splat(w.abs_r[1][j]) * a.half[1] + splat(w.abs_r[2][j]) * a.half[2];
  }
  return o;
}

/// Returns the lanes whose boxes are separated on some axis. A comparison with NaN (an overflow) is false and
/// counts as "not separated".
inline Lanes apart(const Float8* centre, const Float8* half, const float* other_centre,
                   const float* other_half) {
  Lanes result = kNoLanes;
  // No early exit: the other seven boxes of the vector may not be separated by that axis.
  for (int i = 0; i < 3; ++i)
    result |= greater(abs8(centre[i] - splat(other_centre[i])), half[i] + splat(other_half[i]));
  return result;
}

inline std::uint32_t present(const TreeNode& n) {
  return (1u << n.count) - 1;
}

}  // namespace
}  // namespace lrb
