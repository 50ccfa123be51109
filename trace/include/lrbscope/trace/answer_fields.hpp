#pragma once
/// Field tables of what further queries count. Python's dicts are derived from them.

#include <lrbscope/coherent.hpp>
#include <lrbscope/core/fields.hpp>
#include <lrbscope/distance.hpp>
#include <lrbscope/first_contact.hpp>
#include <lrbscope/near_pairs.hpp>

namespace lrb {

template <>
inline constexpr auto kFields<DistanceCounters> =
    std::tuple{field("steps", &DistanceCounters::steps), field("box_tests", &DistanceCounters::box_tests),
               field("pairs_in_floats", &DistanceCounters::pairs_in_floats),
               field("pairs_in_doubles", &DistanceCounters::pairs_in_doubles),
               field("pairs_exact", &DistanceCounters::pairs_exact)};

template <>
inline constexpr auto kFields<NearPairsCounters> = std::tuple{
    field("node_pairs", &NearPairsCounters::node_pairs), field("box_tests", &NearPairsCounters::box_tests),
    field("candidates", &NearPairsCounters::candidates),
    field("pairs_exact", &NearPairsCounters::pairs_exact)};

template <>
inline constexpr auto kFields<FirstContactCounters> =
    std::tuple{field("spans", &FirstContactCounters::spans), field("pairs", &FirstContactCounters::pairs),
               field("steps", &FirstContactCounters::steps),
               field("exact_queries", &FirstContactCounters::exact_queries)};

template <>
inline constexpr auto kFields<CoherentQuery::Statistics> =
    std::tuple{field("from_cache", &CoherentQuery::Statistics::from_cache),
               field("caches_made", &CoherentQuery::Statistics::caches_made),
               field("swept_caches", &CoherentQuery::Statistics::swept_caches),
               field("from_scratch", &CoherentQuery::Statistics::from_scratch),
               field("tests_saved", &CoherentQuery::Statistics::tests_saved),
               field("coarsened", &CoherentQuery::Statistics::coarsened)};

static_assert(covers_all_fields<DistanceCounters>);
static_assert(covers_all_fields<NearPairsCounters>);
static_assert(covers_all_fields<FirstContactCounters>);
static_assert(covers_all_fields<CoherentQuery::Statistics>);

}  // namespace lrb
