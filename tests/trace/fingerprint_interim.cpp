#include "engine/lrb/fnv.hpp"
#include "engine/query/collide.hpp"
__attribute__((weak)) std::uint64_t lrb::fingerprint(const std::vector<SimplexPair>& pairs) {
  Fnv64 h;
  for (const auto& p : pairs) h.add_value(p.a), h.add_value(p.b);
  return h.value();
}
