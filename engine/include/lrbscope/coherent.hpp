#pragma once
/// Queries two bodies that move little from one query to the next (the paper's future work).
///
/// Keeps the wrappers and a candidate cache (cf. Verlet neighbour lists): all pairs of simplices that may
/// intersect while B stays within a sweep of its motion relative to A. If the motion is not steady, the cache
/// covers a neighbourhood of one pose instead. A query tests only the cached pairs that may intersect at its
/// pose: eight at a time in floats, exactly where floats cannot decide. relative_motion.hpp defines sweeps
/// and the errors they allow for. Poses that deviate from rotations by more than kRigid (scaled, sheared) are
/// queried from scratch, as fast as collide() and with the same answers.
///
/// Pairs, meets and relation equal those of collide(). The refined regions and the counters describe this
/// query's own work. In first_pair and any_pair mode the pair may differ. In any_pair mode the relation
/// describes that pair only and may differ as well.
///
/// Recursion::paper for all pairs runs on the wrappers of the last query: they are refined where faces meet
/// and coarsened where none did. Of pairs of faces that were apart, a lower bound of the gap is kept, and
/// they are tested again only when B has moved that far. Other requests that are not plain (the paper's other
/// recursions, floating predicates, coarse queries, separation) are forwarded to collide().

#include <cstdint>
#include <memory>

#include <lrbscope/collide.hpp>

namespace lrb {

class CollideProbe;

class CoherentQuery {
 public:
  /// When to create caches: only if measured to be faster than queries from scratch, or whenever possible
  /// (for tests). The answers do not depend on it.
  enum class CacheUse : std::uint8_t { as_it_pays, always };

  /// Stores references to the bodies, which must outlive it and must not be assigned to, because the cached
  /// data depend on them. Other bodies need another CoherentQuery.
  CoherentQuery(const LrbRep& a, const LrbRep& b, const CollideRequest& request = {},
                CacheUse use = CacheUse::as_it_pays);

  /// Returns the answer for these poses, valid until the next call. Throws InputError as collide() does.
  const CollideResult& collide(const Pose& pose_a, const Pose& pose_b);
  /// Also reports all events to the probe, in order. Each query starts from the outermost wrappers: regions
  /// that are still refined from earlier queries are reported as refined in Phase::kept. With
  /// CacheUse::always the events are reproducible.
  const CollideResult& collide(const Pose& pose_a, const Pose& pose_b, CollideProbe& probe);

  /// Numbers of queries and caches so far.
  struct Statistics {
    std::uint64_t from_cache = 0;    ///< queries answered from an existing cache
    std::uint64_t caches_made = 0;   ///< queries that created a new cache
    std::uint64_t swept_caches = 0;  ///< caches among these that cover a sweep of B
    std::uint64_t from_scratch = 0;  ///< queries run without a cache
    std::uint64_t tests_saved = 0;   ///< cached pairs that needed no test
    std::uint64_t coarsened = 0;     ///< regions of kept wrappers that became part of them again
  };
  const Statistics& statistics() const;

  ~CoherentQuery();
  CoherentQuery(CoherentQuery&&) noexcept;
  CoherentQuery& operator=(CoherentQuery&&) noexcept;

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace lrb
