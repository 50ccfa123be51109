#pragma once
// Compiled once per instruction set by cmake/kernels.cmake, which defines LRB_AFFINE_KERNEL_NAME. Separate
// from the tree kernel, because the speed of that kernel depends on inlining into its one loop. See
// tree_kernel.inl.

#include "engine/tree/kernel_triangles.inl"
#include "engine/tree/kernel_walk.inl"

namespace lrb {

// The relative position of two nodes under maps that are not rotations, their boxes, and their triangles.
// kernel_setup.hpp explains the maps.

namespace {

/// Two nodes, on the axes of one of them (`self`).
struct OnAxes {
  alignas(16) float r[3][4], abs_r[3][4], t[4];  ///< coordinates on these axes = r * (coordinates in the
                                                 ///< other node) + t
  alignas(16) float own[3][4], abs_own[3][4];  ///< if `flat`: coordinates of its own = own * (coordinates in
                                               ///< the node); otherwise not set
  bool flat;
  float error;  ///< error bound of every transformed coordinate, for both nodes together
};

/// Two nodes under arbitrary affine maps, on A's axes and on B's.
struct Skewed {
  OnAxes on[2];
};

/// Stores three rows and the absolute values of their entries.
inline void put_rows(const Float4* rows, float (*to)[4], float (*sizes)[4]) {
  for (int i = 0; i < 3; ++i) {
    const Float4 size = abs4(rows[i]);
    __builtin_memcpy(to[i], &rows[i], sizeof size);
    __builtin_memcpy(sizes[i], &size, sizeof size);
  }
}

/// Computes a map's matrix times the transposed frame of a node: the map from node coordinates to the map's
/// target axes.
inline void from_node(const KernelMap& map, const Columns& node, Float4* rows) {
  for (int i = 0; i < 3; ++i) rows[i] = combine(map.rows[i], node.c);
}

/// The same, followed by the rotation to the axes of the node `onto`.
inline void from_node_to(const TreeNode& onto, const KernelMap& map, const Columns& node, float (*to)[4],
                         float (*sizes)[4]) {
  Float4 half_way[3], r[3];
  from_node(map, node, half_way);
  for (int i = 0; i < 3; ++i) r[i] = combine(onto.frame[i], half_way);
  put_rows(r, to, sizes);
}

inline Double4 mapped_origin(const KernelMap& map, const TreeNode& n, float ratio) {
  const Double4* m = reinterpret_cast<const Double4*>(map.columns);
  return ((m[0] * splat4d(n.origin[0]) + m[1] * splat4d(n.origin[1])) + m[2] * splat4d(n.origin[2])) *
         splat4d(ratio);
}

inline float sum_of_sizes(Float4 x) {
  return __builtin_fabsf(x[0]) + __builtin_fabsf(x[1]) + __builtin_fabsf(x[2]);
}

inline Columns columns_of(const TreeNode& n) {
  return columns_of(frame_row(n, 0), frame_row(n, 1), frame_row(n, 2));
}

/// A node, with the ratio of its body's units to the query's.
struct Scaled {
  const TreeNode& n;
  float ratio;
  Columns columns;
  float radius() const { return n.radius * ratio; }
};

/// Transforms both nodes to the axes of `self`. Errors are as in between(), with two differences: no matrix
/// is inverted by transposition, and the boxes of a flat body are transformed on its own axes as well. For
/// each body, rotation (16 u for each entry), transposition of its frame (8 u), decoding (3 u), products and
/// sums take 48 u of its size, and the offset 8 u: less than the 64 u in kKernelRounding.
inline void see_on(const AffineTerms::Axes& axes, const Scaled& self, const Scaled& other, OnAxes& on) {
  // The other node's boxes on the axes of `self`: a 3 x 3 matrix and an offset.
  from_node_to(self.n, axes.other, other.columns, on.r, on.abs_r);
  // The difference of the origins in double, because both may be large.
  const Float4 offset = __builtin_convertvector(mapped_origin(axes.other, other.n, other.ratio) +
                                                    *reinterpret_cast<const Double4*>(axes.origin) -
                                                    mapped_origin(axes.own, self.n, self.ratio),
                                                Float4);
  const float parts[3] = {offset[0], offset[1], offset[2]};
  // Rotate the offset to the node's own axes.
  const Float4 t = combine(parts, self.columns.c);
  __builtin_memcpy(on.t, &t, sizeof t);
  on.flat = axes.flat;
  // The own boxes of a flattened body are not axis-aligned there, so they are transformed as well.
  if (on.flat) from_node_to(self.n, axes.own, self.columns, on.own, on.abs_own);
  on.error = axes.slack + kKernelRounding * (axes.own.size * self.radius() +
                                             axes.other.size * other.radius() + sum_of_sizes(offset));
}

inline Skewed between_skewed(const TreeKernel& k, const TreeNode& a, const TreeNode& b) {
  const Scaled of_a{a, k.ratio_a, columns_of(a)}, of_b{b, k.ratio_b, columns_of(b)};
  Skewed w;
  // There is no common rotation, so each side has its own transformation; neither is the inverse of the
  // other.
  see_on(k.affine->axes[0], of_a, of_b, w.on[0]);
  see_on(k.affine->axes[1], of_b, of_a, w.on[1]);
  return w;
}

inline float dot3(const float* row, const float* x) {
  return row[0] * x[0] + row[1] * x[1] + row[2] * x[2];
}
inline Float8 dot3(const float* row, const Float8* x) {
  return splat(row[0]) * x[0] + splat(row[1]) * x[1] + splat(row[2]) * x[2];
}

inline Boxes boxes_on_own(const Boxes& boxes, Side side, const Skewed& w) {
  const OnAxes& on = w.on[static_cast<int>(side)];
  // Well-conditioned maps: the own map is taken as the identity; its deviation is in the slack.
  if (!on.flat) return boxes;
  // Bounding box of the image: half extents |own| half (Arvo 1990).
  Boxes o;
  for (int i = 0; i < 3; ++i) {
    o.centre[i] = dot3(on.own[i], boxes.centre);
    o.half[i] = dot3(on.abs_own[i], boxes.half);
  }
  return o;
}

inline Whole whole_on_own(const Whole& whole, Side side, const Skewed& w) {
  const OnAxes& on = w.on[static_cast<int>(side)];
  if (!on.flat) return whole;
  Whole o;
  for (int i = 0; i < 3; ++i) {
    o.centre[i] = dot3(on.own[i], whole.centre);
    o.half[i] = dot3(on.abs_own[i], whole.half);
  }
  return o;
}

inline Turned turn(const Boxes& boxes, const OnAxes& on) {
  // As above, with an offset, and enlarged by the error of both nodes together.
  Turned o;
  for (int i = 0; i < 3; ++i) {
    o.centre[i] = splat(on.t[i]) + dot3(on.r[i], boxes.centre);
    o.half[i] = splat(on.error) + dot3(on.abs_r[i], boxes.half);
  }
  return o;
}

inline Whole turn(const Whole& whole, const OnAxes& on) {
  Whole o;
  for (int i = 0; i < 3; ++i) {
    o.centre[i] = on.t[i] + dot3(on.r[i], whole.centre);
    o.half[i] = on.error + dot3(on.abs_r[i], whole.half);
  }
  return o;
}

template <bool kMargin>
inline Turned turn_b(const Boxes& b, const Skewed& w) {
  return turn(b, w.on[0]);
}
template <bool kMargin>
inline Turned turn_a(const Boxes& a, const Skewed& w) {
  return turn(a, w.on[1]);
}
template <bool kMargin>
inline Whole turn_whole_b(const Whole& b, const Skewed& w) {
  return turn(b, w.on[0]);
}
template <bool kMargin>
inline Whole turn_whole_a(const Whole& a, const Skewed& w) {
  return turn(a, w.on[1]);
}

/// Transforms the corners of a leaf's simplices to the world's axes, in query units.
inline void to_world(const KernelMap& map, const Scaled& node, const LeafBlock& block, const float* offset,
                     Corners& to) {
  Float4 rows[3];
  // Directly from node axes to world axes: the body's axes have no advantage for triangles.
  from_node(map, node.columns, rows);
  for (int corner = 0; corner < 3; ++corner) {
    Float8 own[3];
    for (int axis = 0; axis < 3; ++axis) own[axis] = load8(block.corner[corner][axis]) * splat(node.ratio);
    for (int i = 0; i < 3; ++i) {
      const float row[3] = {rows[i][0], rows[i][1], rows[i][2]};
      to.x[corner][i] = offset ? splat(offset[i]) + dot3(row, own) : dot3(row, own);
    }
  }
}

/// Transforms the corners of two leaves to the world's axes, relative to the origin of A's leaf. World axes
/// do not distort lengths. Errors are as in between(), with corners of A rotated as B's are, but without
/// an offset.
inline Between corners_of(const TreeKernel& k, const TreeNode& a, const TreeNode& b, const Skewed&,
                          Corners& of_a, Corners& of_b) {
  // Positions are relative to the origin of A's leaf, which keeps coordinates small.
  const AffineTerms& f = *k.affine;
  const Scaled node_a{a, k.ratio_a, columns_of(a)}, node_b{b, k.ratio_b, columns_of(b)};
  const Float4 offset = __builtin_convertvector(mapped_origin(f.world[1], b, k.ratio_b) +
                                                    *reinterpret_cast<const Double4*>(f.between) -
                                                    mapped_origin(f.world[0], a, k.ratio_a),
                                                Float4);
  const float parts[3] = {offset[0], offset[1], offset[2]};
  to_world(f.world[0], node_a, k.blocks_a[a.first], nullptr, of_a);
  to_world(f.world[1], node_b, k.blocks_b[b.first], parts, of_b);
  Between w;
  const float size_a = f.world[0].size * node_a.radius(), size_b = f.world[1].size * node_b.radius();
  // `reach` bounds every difference of a corner of A and a corner of B.
  w.reach = size_a + size_b + sum_of_sizes(offset);
  w.error = f.world_slack + kKernelRounding * w.reach;
  // A's corners are rotated as well, so both bodies have the error of rotated edges. Only B's contain the
  // offset.
  w.edge_error[0] = 2 * f.world_slack + kTurnedEdgeRounding * size_a;
  w.edge_error[1] = 2 * f.world_slack + kTurnedEdgeRounding * size_b + kFarEdgeRounding * w.reach;
  return w;
}

}  // namespace
namespace {

/// Traversal for bodies under arbitrary affine maps.
struct AffineWalk {
  static constexpr bool kMargin = false;
  static Skewed between(const TreeKernel& k, const TreeNode& a, const TreeNode& b) {
    return between_skewed(k, a, b);
  }
  static float size(const TreeKernel& k, const TreeNode& n, Side side) {
    return n.radius * k.affine->span[static_cast<int>(side)];
  }
  static Lanes apart(const Float8* centre, const Float8* half, const float* other_centre,
                     const float* other_half, const Skewed&) {
    return lrb::apart(centre, half, other_centre, other_half);
  }
  static void leaves(TreeKernel& k, const TreeNode& a, const TreeNode& b) { leaf_pair<AffineWalk>(k, a, b); }
};

}  // namespace

void LRB_AFFINE_KERNEL_NAME(TreeKernel& k) {
  // No batched test of node boxes: it assumes that the relative map is a rotation.
  if (k.nearest_first) run_nearest<AffineWalk>(k);
  run<AffineWalk, false>(k, k.max_node_pairs);
}

}  // namespace lrb
