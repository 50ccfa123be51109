#pragma once
/// Queries two bodies again and again as they move by little from one query to the next (the paper's future
/// work).
///
/// Keeps the wrappers and a candidate cache: all pairs of simplices that may meet while B stays within a
/// sweep of its motion relative to A. If that motion is not steady, the cache is for the surroundings of one
/// fixed pose. A query tests only the cached pairs that may meet at its pose: eight at a time in floats,
/// exactly where floats are not certain. relative_motion.hpp says what a sweep holds and which errors it
/// allows for. Poses further from rotations than kRigid, scaled or sheared ones, are queried from scratch: as
/// fast as collide(), and the answers the same.
///
/// The answers are those of collide(): pairs, meets and relation always; what was opened, and the counters,
/// describe this query's own work. In first_pair mode the pair may be another one; in any_pair mode too, and
/// the relation, which is what that one pair shows, may differ with it. All requests that are not plain
/// (paper's recursions, floating predicates, coarse queries, separation) are passed on to collide().

#include <cstdint>
#include <memory>

#include <lrbscope/collide.hpp>

namespace lrb {

class CollideProbe;

class CoherentQuery {
 public:
  /// When caches are made: where they turned out to be faster than queries from scratch, by the clock; or
  /// whenever one can be made (for tests). The answers do not depend on it.
  enum class CacheUse : std::uint8_t { as_it_pays, always };

  /// Keeps references to the bodies, which must outlive it. Do not assign to them, because what is kept from
  /// query to query depends on them; other bodies need another CoherentQuery.
  CoherentQuery(const LrbRep& a, const LrbRep& b, const CollideRequest& request = {},
                CacheUse use = CacheUse::as_it_pays);

  /// Returns the answer for these poses, valid until the next call. Throws InputError as collide() does.
  const CollideResult& collide(const Pose& pose_a, const Pose& pose_b);
  /// Does the same, and tells the probe everything that happens, in order, each query beginning with wrappers
  /// that are whole: regions that are still open from earlier queries are told as refined again, in
  /// Phase::kept. With CacheUse::always the same queries tell the same.
  const CollideResult& collide(const Pose& pose_a, const Pose& pose_b, CollideProbe& probe);

  /// Numbers of queries and caches so far.
  struct Statistics {
    std::uint64_t from_cache = 0;    ///< queries answered from the cache as it was
    std::uint64_t caches_made = 0;   ///< queries that made a new cache
    std::uint64_t swept_caches = 0;  ///< of these caches, those for a sweep of B
    std::uint64_t from_scratch = 0;  ///< queries done as if there had been none before
    std::uint64_t tests_saved = 0;   ///< cached pairs that needed no test
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
