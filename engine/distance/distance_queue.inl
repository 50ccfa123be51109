#pragma once
// Part of distance_kernel.inl: the pairs of nodes that wait.

#include "engine/distance/distance_kernel.hpp"

namespace lrb {
namespace {

/// Returns the bucket of a bound: 0 for boxes that overlap.
inline std::uint32_t bucket_of(float bound) {
  if (!(bound > 0)) return 0;
  // The exponent and three digits of the fraction: eight buckets to each doubling.
  std::int32_t code;
  __builtin_memcpy(&code, &bound, sizeof code);
  code = (code >> kBucketShift) - kFirstBucket;
  constexpr std::int32_t kLast = kBuckets - 1;
  return static_cast<std::uint32_t>(code < 1 ? 1 : code < kLast ? code : kLast);
}

/// Returns the least bound of a bucket.
inline float edge_of(std::uint32_t bucket) {
  if (bucket < 2) return bucket == 0 ? -__builtin_inff() : 0;
  if (bucket == kBuckets) return __builtin_inff();
  const std::int32_t code = (static_cast<std::int32_t>(bucket) + kFirstBucket) << kBucketShift;
  float bound;
  __builtin_memcpy(&bound, &code, sizeof bound);
  return bound;
}

/// Returns the first bucket that is not empty, or kBuckets.
inline std::uint32_t first_bucket(const DistanceKernel& k) {
  std::uint32_t word = 0;
  while (word < kBuckets / 64 && k.filled[word] == 0) ++word;
  if (word == kBuckets / 64) return kBuckets;
  return 64 * word + static_cast<std::uint32_t>(__builtin_ctzll(k.filled[word]));
}

/// Adds an entry of `k.waiting` to the list of its bucket.
inline void push_waiting(DistanceKernel& k, std::uint32_t at) {
  WaitingNodes& pair = k.waiting[at];
  const std::uint32_t bucket = bucket_of(pair.bound);
  const std::uint64_t bit = std::uint64_t{1} << bucket % 64;
  pair.next = (k.filled[bucket / 64] & bit) != 0 ? k.first[bucket] : kNoEntry;
  k.filled[bucket / 64] |= bit;
  k.first[bucket] = at;
}

/// Takes the entry that came last to a bucket.
inline std::uint32_t pop_waiting(DistanceKernel& k, std::uint32_t bucket) {
  const std::uint32_t at = k.first[bucket], next = k.waiting[at].next;
  k.first[bucket] = next;
  if (next == kNoEntry) k.filled[bucket / 64] &= ~(std::uint64_t{1} << bucket % 64);
  return at;
}

/// Pushes an entry of `k.waiting` to a binary min-heap ordered by `bound`.
inline void push_ready(DistanceKernel& k, std::uint32_t entry) {
  const ReadyNodes pair{k.waiting[entry].bound, entry};
  std::uint32_t at = k.ready_size++;
  // Sift up: parents with a larger bound move down into the hole.
  while (at > 0) {
    const std::uint32_t parent = (at - 1) / 2;
    if (!(pair.bound < k.ready[parent].bound)) break;
    k.ready[at] = k.ready[parent];
    at = parent;
  }
  k.ready[at] = pair;
}

inline std::uint32_t pop_ready(DistanceKernel& k) {
  const ReadyNodes top = k.ready[0], last = k.ready[--k.ready_size];
  const std::uint32_t size = k.ready_size;
  std::uint32_t at = 0;
  // Sift down: the smaller child moves up into the hole until the last pair fits there.
  for (std::uint32_t child = 1; child < size; child = 2 * at + 1) {
    // Choose the smaller child without a branch.
    child += static_cast<std::uint32_t>(child + 1 < size && k.ready[child + 1].bound < k.ready[child].bound);
    if (!(k.ready[child].bound < last.bound)) break;
    k.ready[at] = k.ready[child];
    at = child;
  }
  k.ready[at] = last;
  return top.entry;
}

/// Returns an unused entry of `k.waiting`.
inline std::uint32_t take_entry(DistanceKernel& k) {
  ++k.waiting_size;
  if (k.unused == kNoEntry) return k.waiting_end++;
  const std::uint32_t at = k.unused;
  k.unused = k.waiting[at].next;
  return at;
}

/// Leaves an entry of `k.waiting` unused.
inline void drop_entry(DistanceKernel& k, std::uint32_t at) {
  --k.waiting_size;
  k.waiting[at].bound = __builtin_inff();
  k.waiting[at].next = k.unused;
  k.unused = at;
}

}  // namespace
}  // namespace lrb
