#pragma once
/// All pairs of triangles (2D: segments) of two bodies whose distance is at most a given one, each with its
/// distance as a proven interval and its closest points.
///
/// As in collide(), the corners are the doubles given by Pose::apply(), exactly. The list is exact: it has a
/// pair if and only if the distance of its triangles is at most NearPairsRequest::within. Pairs that touch or
/// cross are at distance 0, so that `within` = 0 lists what collide() lists.
///
/// Algorithm:
/// 1. One traversal of both BVHs drops boxes, and triangles by slabs, that floats prove to be farther apart
///    than the given distance. The other pairs of triangles are the candidates (near_kernel.inl).
/// 2. The candidates are measured in doubles with proven errors, eight at a time (pair_bounds_kernel.inl).
/// 3. Where the interval contains 0 or `within`, integers decide (pair_distance.hpp).

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include <lrbscope/collide.hpp>
#include <lrbscope/contact.hpp>
#include <lrbscope/lrb_rep.hpp>
#include <lrbscope/pose.hpp>

namespace lrb {

struct NearPairsRequest {
  double within = 0;  ///< maximum distance; finite, at least 0; world units
  /// Return only this many pairs, those with the least lower bounds, in ascending order of these. 0: all, in
  /// ascending order of their ids.
  std::uint64_t nearest = 0;
  /// Maximum number of pairs; a query that finds more throws InputError. 0: kMaxPairs. Without effect if
  /// `nearest` is set.
  std::uint64_t max_pairs = 0;
  friend bool operator==(const NearPairsRequest&, const NearPairsRequest&) = default;
};

/// Two triangles (2D: segments) at most `within` from each other.
struct NearPair {
  SimplexId a, b;
  exact::Meet meet = exact::Meet::disjoint;  ///< how they intersect
  double lower = 0, upper = 0;               ///< bounds of the distance; both 0 if they intersect
  Eigen::Vector3d
      point[2];  ///< closest points on A and on B, world frame, up to rounding; equal if they intersect
};

struct NearPairsCounters {
  std::uint64_t node_pairs = 0;   ///< pairs of tree nodes expanded
  std::uint64_t box_tests = 0;    ///< tests of two boxes
  std::uint64_t candidates = 0;   ///< pairs that boxes and slabs kept
  std::uint64_t pairs_exact = 0;  ///< pairs decided in integers
  friend bool operator==(const NearPairsCounters&, const NearPairsCounters&) = default;
};

/// The numbers of the answer, with all that lines, Python, traces and pages show of them.
struct NearPairsNumbers {
  std::uint64_t found = 0;

  struct Shown {
    const char *name, *in_traces, *on_pages, *meaning;
    std::uint64_t NearPairsNumbers::*member;
    bool required;  ///< in traces; other numbers are written unless they are 0
  };
  static constexpr Shown kShown[] = {{"found", "pairs", "near pairs",
                                      "all pairs of triangles within the distance, listed or not",
                                      &NearPairsNumbers::found, true}};
  friend bool operator==(const NearPairsNumbers&, const NearPairsNumbers&) = default;
};

struct NearPairsResult : NearPairsNumbers {
  std::vector<NearPair> pairs;
  NearPairsCounters counters;
};

/// Returns the pairs of body `a` at pose_a and body `b` at pose_b. Poses may be any finite affine maps; those
/// that are not nearly rotations take new trees of both bodies. The result does not depend on `threads` (0:
/// all cores). Throws InputError unless both bodies are 3D or both 2D and world coordinates are finite, for a
/// negative or non-finite `within`, and if there are too many pairs.
NearPairsResult near_pairs(const LrbRep& a, const Pose& pose_a, const LrbRep& b, const Pose& pose_b,
                           const NearPairsRequest& request, unsigned threads = 1);

/// Throws InputError for a request that near_pairs() rejects.
void check_request(const NearPairsRequest& request);

}  // namespace lrb
