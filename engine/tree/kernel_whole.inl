#pragma once
// Part of kernel_walk.inl: the separating axis test of two node OBBs with all 15 axes (Gottschalk, Lin and
// Manocha 1996), for eight pairs of nodes at a time or for one.

#include "engine/tree/kernel_boxes.inl"

namespace lrb {
namespace {

/// Node boxes in query units: one in each lane of V, which is Float8 or float.
template <class V>
struct WholeNodes {
  V frame[3][3], centre[3], half[3];
};

/// The differences of the nodes' origins, relative to A, on A's axes.
template <class V>
struct Offsets {
  V of[3];
};

/// Up to this number of pairs are compared one by one. For more, eight at a time are faster, except on
/// processors with only four lanes.
#if defined(__AVX2__)
constexpr std::uint32_t kFewPairs = 2;
#else
constexpr std::uint32_t kFewPairs = 8;
#endif

/// Number of floats in a node's frame, base and scale.
constexpr int kWholeNumbers = 15;

/// Computes node boxes from those numbers, in query units.
template <class V>
inline WholeNodes<V> whole_nodes(const V* numbers, float ratio) {
  WholeNodes<V> out;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out.frame[i][j] = numbers[3 * i + j];
    out.half[i] = numbers[12 + i] * (ratio * (0.5f * kQuantizedMost));
    out.centre[i] = numbers[9 + i] * ratio + out.half[i];
  }
  return out;
}

/// Reads eight nodes. nodes: pointers to them.
inline WholeNodes<Float8> read_wholes(const TreeNode* const* nodes, float ratio, Float8) {
  static_assert(__builtin_offsetof(TreeNode, scale) == 12 * sizeof(float));
  // The first 16 floats of each node are four rows of four. Transposing them gathers one number of all eight
  // nodes in a vector.
  Float8 numbers[16];  // the last one is unused
  for (int part = 0; part < 4; ++part) {
    Float4 row[8];
    for (int k = 0; k < 8; ++k)
      __builtin_memcpy(&row[k], reinterpret_cast<const char*>(nodes[k]) + part * sizeof(Float4),
                       sizeof(Float4));
    transpose(row, numbers + 4 * part);
  }
  return whole_nodes(numbers, ratio);
}

inline WholeNodes<float> read_wholes(const TreeNode* const* nodes, float ratio, float) {
  float numbers[kWholeNumbers];
  __builtin_memcpy(numbers, reinterpret_cast<const char*>(nodes[0]), sizeof numbers);
  return whole_nodes(numbers, ratio);
}

inline Offsets<Float8> offsets_between(const TreeKernel& k, const TreeNode* const* a,
                                       const TreeNode* const* b, Float8) {
  Float4 row[8];
  for (int lane = 0; lane < 8; ++lane) row[lane] = offset_between(k, *a[lane], *b[lane]);
  Float8 column[4];
  transpose(row, column);
  return {{column[0], column[1], column[2]}};
}

inline Offsets<float> offsets_between(const TreeKernel& k, const TreeNode* const* a, const TreeNode* const* b,
                                      float) {
  const Float4 offset = offset_between(k, *a[0], *b[0]);
  return {{offset[0], offset[1], offset[2]}};
}

inline Float8 absolute(Float8 x) {
  return abs8(x);
}
inline float absolute(float x) {
  return __builtin_fabsf(x);
}
inline std::uint32_t is_greater(Float8 x, Float8 y) {
  return bits(greater(x, y));
}
inline std::uint32_t is_greater(float x, float y) {
  return x > y;
}

/// Returns a bit for each pair of nodes, one in each lane of V, whose boxes are disjoint: separated along a
/// face normal of either, or along a cross product of an axis of each. The result for a pair does not depend
/// on V or on the other lanes. NaN (an overflow) counts as not disjoint.
///
/// Face normals. A common point is x_a in A's node and x_b in B's. On each axis of A's node x_a and r x_b +
/// offset differ by at most slack + 48 u `size`, u = 2^-24 (see kKernelRounding; everything in a node is in
/// its box). Errors on B's axes are larger: each entry of r has an error of 16 u, so r^T r deviates from the
/// identity by at most 112 u, including the axes of both nodes. Rotating the error on A's axes back adds 84
/// u, rounding 10 u. kWholeRounding covers all of it, and the slack covers the deviation of m from a
/// rotation.
///
/// Cross products. For the i-th axis of A's node and the m-th of B's the direction is e_i x r_m, whose
/// entries are entries of r; its length is at most 1, the sum of its entries 1.5. The error of the common
/// point thus contributes 1.5 `error`. Along B's other axes the direction has the entries of r on e_i, as if
/// r were a rotation, with an error of at most 150 u, less than `error`. The rest of four times `error` is
/// for rounding. If r is not a rotation, and r^T r deviates from the identity by D, its cofactors deviate
/// from its entries by at most 2 D, which contributes 6 D times B's extent; the slack in four times `error`
/// contains 16 of that.
template <class V>
inline std::uint32_t node_boxes_disjoint(const TreeKernel& k, const TreeNode* const* nodes_a,
                                         const TreeNode* const* nodes_b) {
  // Step 1: B's axes and centre relative to A, and the error bound.
  const WholeNodes<V> a = read_wholes(nodes_a, k.ratio_a, V{}), b = read_wholes(nodes_b, k.ratio_b, V{});
  const Offsets<V> offset = offsets_between(k, nodes_a, nodes_b, V{});
  V turned[3][3], r[3][3], abs_r[3][3], c[3];  // B's axes on A's body's axes; on A's node's axes; B's centre
                                               // relative to A's
  V size{};
  for (int i = 0; i < 3; ++i) {
    const float* m = k.m_rows[i];
    for (int j = 0; j < 3; ++j)
      turned[i][j] = m[0] * b.frame[j][0] + m[1] * b.frame[j][1] + m[2] * b.frame[j][2];
    size +=
        absolute(offset.of[i]) + (absolute(a.centre[i]) + a.half[i]) + (absolute(b.centre[i]) + b.half[i]);
  }
  // `size` bounds all coordinates involved, so the error is relative to it.
  const V error = k.slack + (kWholeRounding * k.m_size * k.m_size) * size;
  // Step 2: A's three face normals.
  std::uint32_t apart = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      r[i][j] = a.frame[i][0] * turned[0][j] + a.frame[i][1] * turned[1][j] + a.frame[i][2] * turned[2][j];
      abs_r[i][j] = absolute(r[i][j]);
    }
    c[i] = a.frame[i][0] * offset.of[0] + a.frame[i][1] * offset.of[1] + a.frame[i][2] * offset.of[2] +
           (r[i][0] * b.centre[0] + r[i][1] * b.centre[1] + r[i][2] * b.centre[2]) - a.centre[i];
    apart |= is_greater(
        absolute(c[i]),
        a.half[i] + error + (abs_r[i][0] * b.half[0] + abs_r[i][1] * b.half[1] + abs_r[i][2] * b.half[2]));
  }
  // Step 3: B's three face normals.
  for (int j = 0; j < 3; ++j)
    apart |= is_greater(
        absolute(r[0][j] * c[0] + r[1][j] * c[1] + r[2][j] * c[2]),
        b.half[j] + error + (abs_r[0][j] * a.half[0] + abs_r[1][j] * a.half[1] + abs_r[2][j] * a.half[2]));
  // A single pair can stop here. For eight pairs, the remaining lanes need the other axes.
  if (sizeof(V) == sizeof(float) && apart != 0) return apart;
  // Step 4: the nine cross products of an axis of A and one of B. Nearly parallel axes give a direction near
  // 0, for which the error term prevents a separation.
  const V error_across = 4 * error;
  for (int i = 0; i < 3; ++i) {
    const int p = (i + 1) % 3, q = (i + 2) % 3;
    for (int m = 0; m < 3; ++m) {
      const int n = (m + 1) % 3, o = (m + 2) % 3;
      apart |= is_greater(absolute(r[p][m] * c[q] - r[q][m] * c[p]),
                          error_across + (a.half[p] * abs_r[q][m] + a.half[q] * abs_r[p][m]) +
                              (b.half[n] * abs_r[i][o] + b.half[o] * abs_r[i][n]));
    }
  }
  return apart;
}

/// Returns a bit for each pair of nodes, of at most eight, whose boxes are disjoint.
inline std::uint32_t pairs_disjoint(const TreeKernel& k, const NodePair* pairs, std::uint32_t count) {
  // Unused lanes repeat the first pair, so that they read valid memory.
  const TreeNode *a[8], *b[8];
  for (std::uint32_t i = 0; i < 8; ++i) {
    const NodePair& pair = pairs[i < count ? i : 0];
    a[i] = k.nodes_a + pair.a;
    b[i] = k.nodes_b + pair.b;
  }
  if (count > kFewPairs) return node_boxes_disjoint<Float8>(k, a, b) & ((1u << count) - 1);
  std::uint32_t apart = 0;
  for (std::uint32_t i = 0; i < count; ++i) apart |= node_boxes_disjoint<float>(k, a + i, b + i) << i;
  return apart;
}

}  // namespace
}  // namespace lrb
