#include <algorithm>
#include <string>
#include <utility>

#include "engine/collide/query_context.hpp"
#include <lrbscope/collide.hpp>
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

void clear(Counters& counters) {
  // Reset all counters, but keep the vector's memory.
  std::vector<std::uint32_t> levels = std::move(counters.face_tests_by_level);
  levels.clear();
  counters = {};
  counters.face_tests_by_level = std::move(levels);
}

void clear(CollideResult& result) {
  // Reset all members by exchanging with a new result, then move the emptied vectors back: they keep their
  // memory.
  CollideResult old = std::exchange(result, {});
  clear(old.counters);
  old.pairs.clear();
  old.meets.clear();
  old.contacts.clear();
  old.regions.clear();
  for (std::vector<RegionId>& opened : old.opened) opened.clear();
  result.counters = std::move(old.counters);
  result.pairs = std::move(old.pairs);
  result.meets = std::move(old.meets);
  result.contacts = std::move(old.contacts);
  result.regions = std::move(old.regions);
  result.opened = std::move(old.opened);
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
