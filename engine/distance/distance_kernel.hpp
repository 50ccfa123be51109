#pragma once
/// The inner loop of the distance query: the best-first traversal of two OBB trees in eight-wide float
/// arithmetic. Every error is bounded, so that a pair of simplices is dropped only if it is proven not to be
/// closer than the best pair found.
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
  float bound;
  std::uint32_t a, b;
};

/// The end of a node's projection on the direction: upper for A, lower for B. Valid if `turn` equals
/// DistanceKernel::turn.
struct NodeEnd {
  float end;
  std::uint32_t turn;
};

/// A pair of simplices that may be the closest.
struct NearPair {
  SimplexId a, b;
  float lower;  ///< a bound on its distance, query units
};

/// A pair of nodes that a plane separated at an earlier step of a motion, by more than the distance of the
/// bodies.
struct FarNodes {
  std::uint32_t a, b;
  float direction[3];  ///< across the plane, on A's axes; of length 1
  /// Width of the slab between everything under them, less the offset of the nodes' origins along it.
  float width;
  float turned;  ///< DistanceKernel::least_turned of then
};

enum class KernelStop : std::uint8_t {
  done,      ///< no pair of nodes that waits can be nearer than the bound allows
  room,      ///< the buffers must grow
  limit,     ///< most_node_pairs are reached
  enough,    ///< `upper` is no more than `enough`
  doubtful,  ///< two simplices could not be proved apart: ask whether the bodies meet
};

/// One walk. Lengths are in query units: TreeKernel.
struct DistanceKernel {
  TreeKernel tree;  ///< the bodies, set up for rotations, without a stack
  float upper;      ///< the distance is no more than this
  float spare;      ///< pairs are dropped that are no nearer than the lesser of upper - spare, ...
  float share;      ///< ... and upper (1 - share)
  float widest;     ///< ... but pairs are dropped, too, that are further apart than this
  float enough;     ///< stop where `upper` is no more than this; -1: never
  bool descend;     ///< go straight down to a pair of simplices first: there is no good upper end yet
  bool begun;       ///< set by the kernel
  bool apart;       ///< the bodies are known not to meet: do not stop as `doubtful`

  /// Direction of the slabs, from A to B, on A's axes and on B's: of length 1, or 0 if it is not known.
  float direction[2][3];
  float ahead;  ///< how far B's root's origin is ahead of A's in that direction, less all errors of what is
                ///< compared along it
  /// Ends of the projections of A's and of B's nodes on that direction, relative to their root's origin.
  NodeEnd* ends[2];
  std::uint32_t turn;  ///< NodeEnd::turn of this direction

  /// Cache of separating planes of earlier steps, indexed by far_slot(); null: no cache.
  FarNodes* far;
  std::uint32_t far_slots;  ///< a power of two
  /// Sum of the norms of the changes of TreeKernel::m since the cache was cleared: rounded up, and down.
  float turned, least_turned;

  WaitingNodes* waiting;  ///< a heap, the least bound first
  std::uint32_t waiting_size, waiting_capacity;
  NearPair* near;
  std::uint32_t near_size, near_capacity;
  SimplexId best_a, best_b;  ///< the pair that gave `upper`; kNull: none of this walk

  std::uint64_t triangle_pairs;  ///< compared in floats
  KernelStop stop;
};

/// Free entries that both buffers need before a step, and twice as many before the first.
inline constexpr std::uint32_t kRoomForStep = 64;

/// Returns the pruning distance, rounded so that a dropped pair is not closer.
inline float dropped_from(const DistanceKernel& k) {
  const float by_spare = k.upper - k.spare, by_share = k.upper * (1 - k.share);
  const float least = by_spare < by_share ? by_spare : by_share;
  return least < k.widest ? least : k.widest;
}

/// Runs until there is a reason to stop. May be called again to go on.
void run_distance_kernel(DistanceKernel& k);

/// Returns a number of the kernel's, such as a length in query units, as a float that is not less, or not
/// more and at least 0.
inline float rounded_down(double x) {
  return std::max(0.0F, static_cast<float>(x) * (2 - kFloatUp) - kKernelTiny);
}

}  // namespace lrb
