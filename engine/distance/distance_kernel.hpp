#pragma once
/// The inner loop of the distance query: the best-first traversal of two OBB trees in eight-wide float
/// arithmetic. Every error is bounded: a pair of simplices is dropped only if it is proven not to be closer
/// than the best pair found.
///
/// Contains only plain structures: this header is compiled once per instruction set (cmake/kernels.cmake).

#include <algorithm>
#include <cstdint>

#include "engine/core/tolerances.hpp"
#include "engine/tree/tree_kernel.hpp"

namespace lrb {

/// A pair of nodes to be expanded. `bound`: the squared distance of their boxes, rounded down; if the boxes
/// overlap, minus the least penetration along an axis.
struct WaitingNodes {
  float bound;  ///< infinite: the entry is unused
  std::uint32_t a, b;
  std::uint32_t next;  ///< the next entry of the same list; kNoEntry: none
  /// Of a pair whose bound was raised: the direction of the slab between them, on A's axes: unit length, or
  /// 0.
  float towards[3];
};
inline constexpr std::uint32_t kNoEntry = ~0U;

/// An entry of DistanceKernel::waiting and its bound.
struct ReadyNodes {
  float bound;
  std::uint32_t entry;
};

/// Pairs wait in lists, buckets of bounds: one for overlapping boxes, one below 2^-52, then eight to each
/// doubling. A heap would order them exactly, but pairs with nearly equal bounds are all processed anyway.
inline constexpr std::uint32_t kBuckets = 512;
/// Shift and offset from a float's bits, without the sign, to its bucket.
inline constexpr int kBucketShift = 20, kFirstBucket = (127 - 52) << 3;

/// The end of a node's projection on the direction: the upper end for A, the lower end for B. Valid if `turn`
/// equals DistanceKernel::turn.
struct NodeEnd {
  float end;
  std::uint32_t turn;
};

/// A pair of simplices that may be the closest.
struct FloatPair {
  SimplexId a, b;
  float lower;  ///< lower bound on its distance, query units
};

/// A pair of nodes that a plane separated at an earlier step of a motion, by more than the distance of the
/// bodies.
struct FarNodes {
  std::uint32_t a, b;
  float direction[3];  ///< normal of the plane, on A's axes; unit length
  /// Width of the slab between their contents, less the offset of the nodes' origins along it.
  float width;
  float turned;  ///< DistanceKernel::min_turned at that step
};

enum class KernelStop : std::uint8_t {
  done,       ///< no waiting pair of nodes can be within the pruning distance
  room,       ///< the buffers must grow
  limit,      ///< max_node_pairs was reached
  enough,     ///< `upper` is at most `enough`
  undecided,  ///< two simplices were not proven disjoint: the exact query must decide
};

/// State of one traversal. Lengths are in query units; see TreeKernel.
struct DistanceKernel {
  TreeKernel tree;  ///< the bodies, set up for rotations, without a stack
  float upper;      ///< upper bound on the distance
  float spare;      ///< pruning distance: the lesser of upper - spare ...
  float share;      ///< ... and upper (1 - share) ...
  float widest;     ///< ... but at most this
  float enough;     ///< stop when `upper` is at most this; -1: never
  bool apart;       ///< the surfaces are known to be disjoint: do not stop as `undecided`

  /// Direction of the slabs, from A to B, on A's axes and on B's: unit length, or 0 if unknown.
  float direction[2][3];
  float ahead;  ///< offset of the roots' origins from A to B along it, less the errors of all comparisons
  /// Ends of the projections of A's and of B's nodes on that direction, relative to their root's origin.
  NodeEnd* ends[2];
  std::uint32_t turn;  ///< NodeEnd::turn of this direction

  /// Cache of separating planes of earlier steps, indexed by far_slot(); null: no cache.
  FarNodes* far;
  std::uint32_t far_slots;  ///< a power of two
  /// Sum of the norms of the changes of TreeKernel::m since the cache was cleared: rounded up, and down.
  float turned, min_turned;

  /// Each pair that waits or is ready has an entry.
  WaitingNodes* waiting;
  std::uint32_t waiting_size, waiting_capacity;
  std::uint32_t waiting_end;  ///< all later entries were never used
  std::uint32_t unused;       ///< a list of the unused entries before
  /// The waiting pairs, in buckets: a bit for each one that is not empty, and its list.
  std::uint64_t filled[kBuckets / 64];
  std::uint32_t first[kBuckets];
  /// The pairs whose bounds were raised, a heap: the least bound first. The capacity is that of `waiting`.
  ReadyNodes* ready;
  std::uint32_t ready_size;
  std::uint32_t next;  ///< the pair to be expanded next, which is in neither; kNoEntry: not chosen yet

  std::uint64_t next_descent;  ///< number of steps before the next descent; 0 if no good upper bound is known
  bool descends;
  /// During a step of a descent: the children with the least bounds.
  std::uint32_t nearest[8], nearest_size;

  FloatPair* near;
  std::uint32_t near_size, near_capacity;
  SimplexId best_a, best_b;  ///< the pair that gave `upper`; kNull: none in this traversal

  std::uint64_t triangle_pairs;  ///< pairs compared in floats
  KernelStop stop;
};

/// Free entries that both buffers need before a step.
inline constexpr std::uint32_t kRoomForStep = 64;

/// Returns the pruning distance, rounded so that a dropped pair is not closer.
inline float dropped_from(const DistanceKernel& k) {
  const float by_spare = k.upper - k.spare, by_share = k.upper * (1 - k.share);
  const float least = by_spare < by_share ? by_spare : by_share;
  return least < k.widest ? least : k.widest;
}

/// Number of steps before the first descent if an upper bound is known, otherwise before the second one.
/// Fewer: the descents cost more than the lower upper bounds save.
inline constexpr std::uint64_t kDescentAfter = 32;

/// Runs until there is a reason to stop. May be called again to continue.
void run_distance_kernel(DistanceKernel& k);

/// Returns a value of the kernel, such as a length in query units, as a float that is not larger, but at
/// least 0.
inline float rounded_down(double x) {
  return std::max(0.0F, static_cast<float>(x) * (2 - kFloatUp) - kKernelTiny);
}

}  // namespace lrb
