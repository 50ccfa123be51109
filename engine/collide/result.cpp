#include <algorithm>
#include <string>

#include "engine/collide/query_context.hpp"
#include <lrbscope/collide.hpp>
#include <lrbscope/core/fields.hpp>
#include <lrbscope/core/hash.hpp>
#include <lrbscope/error.hpp>

namespace lrb {

const char* to_string(Relation r) {
  return name_of(r).data();
}
const char* to_string(Answer a) {
  return name_of(a).data();
}
const char* to_string(Recursion r) {
  return name_of(r).data();
}

// clear() needs a line for each new member.
static_assert(detail::member_count<Counters>() == 9 && detail::member_count<CollideResult>() == 13);

void clear(Counters& counters) {
  // Each member by name, because clear() takes a quarter of a query that ends at the roots. The vector keeps
  // its memory.
  counters.face_tests = counters.real_tests = counters.exact_fallbacks = 0;
  counters.node_pairs = counters.box_tests = counters.prefilter_tests = 0;
  counters.refinements = counters.regions_opened = 0;
  counters.face_tests_by_level.clear();
}

void clear(CollideResult& result) {
  // All members, in the order of their declaration. The vectors keep their memory.
  result.relation = Relation::separate;
  result.interiors_overlap = Answer::unknown;
  result.recursion = Recursion::complete;
  result.mode = Mode::all_pairs;
  result.pairs.clear();
  result.meets.clear();
  result.contacts.clear();
  result.regions.clear();
  for (std::vector<RegionId>& opened : result.opened) opened.clear();
  result.error_bound = 0;
  result.finished = true;
  result.separation.reset();
  clear(result.counters);
}

void reject_pairs(std::uint64_t limit) {
  throw InputError("more than " + std::to_string(limit) +
                   " pairs of triangles intersect, the limit set by max_pairs; raise it (--max-pairs) if "
                   "memory allows (about 25 bytes per pair, 650 with contacts), or use mode any or first");
}

std::uint64_t fingerprint(const std::vector<SimplexPair>& pairs) {
  Fnv64 h;
  for (const SimplexPair& p : pairs) {
    h.add_value(p.a);
    h.add_value(p.b);
  }
  return h.value();
}

}  // namespace lrb
